// A Board of the template port on the host: the engine is a copy that takes a few polls, or fails, or never ends.
// Memory: borrows main memory and an arena. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_memory.h>

#include "support/test_headers.h"
#include "template_port.h"

namespace gridiron::contract {

/// Local memory has bus addresses from kLocalBase on; everything below is main memory.
class HostBoard {
 public:
  static constexpr std::uint64_t kLocalBase = std::uint64_t{1} << 40;

  HostBoard(sim::SimMemory& memory, std::span<std::byte> arena, std::uint32_t tile_count)
      : memory_(&memory), arena_(arena), tile_count_(tile_count) {}

  std::uint32_t polls_per_command = 2;  ///< how often a command is reported busy before its bytes move
  std::uint64_t fail_command = 0;       ///< this command (from 1) reports an error and moves nothing
  std::uint64_t hang_command = 0;       ///< this command never ends
  std::uint64_t starts = 0;             ///< commands the engine was given
  std::uint64_t starts_while_busy = 0;  ///< a port must never do that
  bool stop = false;

  void start(const port::EngineCommand& command) {
    if (busy_polls_ != 0) ++starts_while_busy;
    ++starts;
    command_ = command;
    busy_polls_ = polls_per_command;
    if (busy_polls_ == 0) copy();
  }
  bool is_busy() {
    if (starts == hang_command) return true;
    if (busy_polls_ == 0) return false;
    if (--busy_polls_ == 0) copy();
    return busy_polls_ != 0;
  }
  bool has_failed() { return starts == fail_command; }
  [[nodiscard]] std::uint64_t bus_address(const void* local) const {
    return kLocalBase + static_cast<std::uint64_t>(static_cast<const std::byte*>(local) - arena_.data());
  }
  [[nodiscard]] bool holds(const void* local, std::uint32_t bytes) const {
    const std::uint64_t offset = bus_address(local) - kLocalBase;
    return offset <= arena_.size() && bytes <= arena_.size() - offset;
  }
  void write_back(const void*, std::uint32_t) {}
  void discard(const void*, std::uint32_t) {}
  std::uint32_t next_tile() { return next_tile_++; }
  bool must_stop() { return stop; }
  [[nodiscard]] std::uint32_t tile_count() const { return tile_count_; }

 private:
  void copy() {
    if (starts != fail_command) std::memcpy(host(command_.target), host(command_.source), command_.bytes);
  }
  std::byte* host(std::uint64_t bus_address) {
    return bus_address >= kLocalBase ? arena_.data() + (bus_address - kLocalBase) : memory_->base() + bus_address;
  }

  sim::SimMemory* memory_;
  std::span<std::byte> arena_;
  std::uint32_t tile_count_;
  std::uint32_t next_tile_ = 0;
  std::uint32_t busy_polls_ = 0;
  port::EngineCommand command_;
};

}  // namespace gridiron::contract
