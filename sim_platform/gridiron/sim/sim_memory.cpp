// Simulated main memory: one zeroed host block whose byte i stands for main address i.
// Memory: owns. Threads: allocate before the frame; bytes are shared during it. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/sim_memory.h>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

namespace gridiron::sim {

namespace {

// Host alignment of main address 0: as strict as any boundary a transfer rule knows.
constexpr std::uint64_t kHostAlignmentBytes = 4096;

}  // namespace

SimMemory::SimMemory(std::uint64_t capacity_bytes) : capacity_bytes_(capacity_bytes) {
  constexpr std::uint64_t kOverhead = kFirstAddress + kHostAlignmentBytes;
  if (capacity_bytes > std::numeric_limits<std::size_t>::max() - kOverhead) throw std::bad_alloc();
  // calloc leaves untouched pages unmapped, so that a large capacity costs what is used of it.
  storage_ = static_cast<std::byte*>(std::calloc(1, static_cast<std::size_t>(capacity_bytes + kOverhead)));
  if (storage_ == nullptr) throw std::bad_alloc();
  const std::uintptr_t misaligned = reinterpret_cast<std::uintptr_t>(storage_) % kHostAlignmentBytes;
  base_ = storage_ + (misaligned == 0 ? 0 : kHostAlignmentBytes - misaligned);
}

SimMemory::~SimMemory() {
  std::free(storage_);
}

std::optional<MemoryRegion> SimMemory::allocate(std::uint64_t bytes, std::uint64_t alignment_bytes) {
  if (alignment_bytes == 0 || (alignment_bytes & (alignment_bytes - 1)) != 0) return std::nullopt;
  const std::uint64_t first_free = kFirstAddress + used_bytes_;
  const std::uint64_t padding = (alignment_bytes - first_free % alignment_bytes) % alignment_bytes;
  const std::uint64_t free_bytes = capacity_bytes_ - used_bytes_;
  if (padding > free_bytes || bytes > free_bytes - padding) return std::nullopt;

  const std::uint64_t address = first_free + padding;
  used_bytes_ += padding + bytes;
  // Only bytes that were handed out before can be non-zero.
  const std::uint64_t dirty_end = kFirstAddress + dirty_bytes_;
  if (address < dirty_end) {
    const std::uint64_t dirty = dirty_end - address;
    std::memset(base_ + address, 0, static_cast<std::size_t>(dirty < bytes ? dirty : bytes));
  }
  if (used_bytes_ > dirty_bytes_) dirty_bytes_ = used_bytes_;
  return MemoryRegion{MainAddress{address}, {base_ + address, static_cast<std::size_t>(bytes)}};
}

void SimMemory::release_to(std::uint64_t mark) {
  if (mark < used_bytes_) used_bytes_ = mark;
}

std::span<std::byte> SimMemory::bytes_at(MainAddress address, std::uint64_t bytes) {
  if (address.value < kFirstAddress) return {};
  const std::uint64_t offset = address.value - kFirstAddress;
  if (offset > used_bytes_ || bytes > used_bytes_ - offset) return {};
  return {base_ + address.value, static_cast<std::size_t>(bytes)};
}

}  // namespace gridiron::sim
