// What a frame program runs on, and its marks. riscv64: the port of platform/sifive_u with all that its firmware puts
// around it, on a channel whose registers are memory; aarch64: a core that copies at once.
// Memory: static, small. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __riscv
#include "pdma_board.h"
#include "template_port.h"
#include "worker.h"
#endif

extern "C" std::byte gridiron_memory[], gridiron_memory_end[];

// Marks beside those of kinds of work, which `count.awk` knows: the first begins a claim, the next stands in a wait
// where it ends a command, the last two stand around what no core does: copies are a transfer engine's work.
inline constexpr int kClaimMark = 232, kCommandEndMark = 233, kCopiedMark = 234, kNothingMark = 235;
static_assert(gridiron::kEndOfKindMarks <= kClaimMark);
template <int kNumber>
[[gnu::always_inline]] inline void put_mark() {
  asm volatile(GRIDIRON_MARK_TEXT : : "n"(kNumber));
}
// No access to memory may leave a copy or enter it.
template <int kNumber>
[[gnu::always_inline]] inline void put_fence_mark() {
  asm volatile(GRIDIRON_MARK_TEXT : : "n"(kNumber) : "memory");
}
[[gnu::always_inline]] inline void mark_copy() {
  put_fence_mark<kNothingMark>();
}
[[gnu::always_inline]] inline void mark_copied() {
  put_fence_mark<kCopiedMark>();
}
/// What follows is no kind of work.
[[gnu::always_inline]] inline void mark_nothing() {
  put_mark<kNothingMark>();
}

#ifdef __riscv

/// The channel's registers, of which `run` has the linker put the section at GRIDIRON_PDMA.
[[gnu::section(".channel"), gnu::used]] inline volatile std::uint64_t channel_registers[512] = {1};

/// The board, whose engine is this program: a command has ended when it was given, as in the emulator of the board.
class ChannelBoard : public gridiron::port::PdmaBoard {
 public:
  ChannelBoard(gridiron::port::RunControl& control, const std::byte* store, std::size_t bytes)
      : PdmaBoard(control, 0, store, bytes), store_(store), bytes_(bytes) {}

  void start(const gridiron::port::EngineCommand& command) {
    PdmaBoard::start(command);
    mark_copy();
    memcpy(place_of(command.target), place_of(command.source), command.bytes);
    gridiron::port::register_at(GRIDIRON_PDMA) = 1u << 30;
    mark_copied();
  }
  [[nodiscard]] bool is_busy() {
    put_mark<kCommandEndMark>();
    return PdmaBoard::is_busy();
  }

 private:
  // Addresses of the frame's memory begin at 0, those of the store are its own.
  [[nodiscard]] std::byte* place_of(std::uint64_t address) const {
    const std::uint64_t offset = address - reinterpret_cast<std::uintptr_t>(store_);
    return offset < bytes_ ? reinterpret_cast<std::byte*>(address) : gridiron_memory + address;
  }
  const std::byte* store_;
  std::size_t bytes_;
};

/// The port that knows how many instructions were executed, as the image that counts has it.
class InstructionPort : public gridiron::port::TemplatePort<ChannelBoard> {
 public:
  using TemplatePort::TemplatePort;

  [[nodiscard]] std::uint64_t instructions() const {
    std::uint64_t count = 0;
    asm volatile("rdinstret %0" : "=r"(count));
    return count;
  }
};

class MarkedPort : public gridiron::port::CountingPort<InstructionPort> {
 public:
  using CountingPort::CountingPort;

  gridiron::ItemClaim claim_item() {
    put_mark<kClaimMark>();
    return CountingPort::claim_item();
  }
};

class ProgramCore {
 public:
  ProgramCore(const std::byte* store, std::size_t bytes, std::uint32_t tile_count)
      : board_(control_, store, bytes), inner_(board_), port_(inner_, control_.cores[0], tiles_, 0) {
    control_.tile_count = tile_count;
  }
  [[nodiscard]] MarkedPort& port() { return port_; }

 private:
  gridiron::port::RunControl control_{};
  gridiron::port::TileResult tiles_[64] = {};
  ChannelBoard board_;
  InstructionPort inner_;
  MarkedPort port_;
};

#else

class CopyingPort {
 public:
  explicit CopyingPort(std::uint32_t tile_count) : tile_count_(tile_count) {}

  [[nodiscard]] gridiron::PlatformLimits limits() const { return {}; }
  [[gnu::noinline]] gridiron::Status get(void* local, gridiron::MainAddress address, std::uint32_t bytes,
                                         gridiron::Tag) {
    mark_copy();
    memcpy(local, gridiron_memory + address.value, bytes);
    mark_copied();
    return gridiron::Status::kOk;
  }
  [[gnu::noinline]] gridiron::Status put(const void* local, gridiron::MainAddress address, std::uint32_t bytes,
                                         gridiron::Tag) {
    mark_copy();
    memcpy(gridiron_memory + address.value, local, bytes);
    mark_copied();
    return gridiron::Status::kOk;
  }
  [[nodiscard]] gridiron::Status wait(gridiron::TagMask) { return gridiron::Status::kOk; }
  [[nodiscard]] gridiron::ItemClaim claim_item() {
    if (next_tile_ == tile_count_) return {gridiron::ItemClaim::Kind::kNone, 0};
    return {gridiron::ItemClaim::Kind::kItem, next_tile_++};
  }

 private:
  std::uint32_t next_tile_ = 0;
  std::uint32_t tile_count_;
};

class ProgramCore {
 public:
  ProgramCore(const std::byte*, std::size_t, std::uint32_t tile_count) : port_(tile_count) {}
  [[nodiscard]] CopyingPort& port() { return port_; }

 private:
  CopyingPort port_;
};

#endif
