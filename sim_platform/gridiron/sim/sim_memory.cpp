// Simulated main memory: one zeroed range of host addresses whose byte i stands for main address i. The whole range is
// reserved; the host's memory is taken only for allocations.
// Memory: owns. Threads: allocate before the frame; bytes are shared during it. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/sim/sim_memory.h>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#include <unistd.h>
#define GRIDIRON_SIM_RESERVES_ADDRESSES
#endif

namespace gridiron::sim {

#if defined(GRIDIRON_SIM_RESERVES_ADDRESSES)

SimMemory::SimMemory(std::uint64_t capacity_bytes) : capacity_bytes_(capacity_bytes) {
  if (capacity_bytes > std::numeric_limits<std::uint64_t>::max() / 2) throw std::bad_alloc();
  page_bytes_ = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  // The range begins on a page, which is as strict as any boundary of a transfer rule. If the host's addresses are
  // limited (ulimit -v), half as many, or a quarter, still suffice for small allocations.
  constexpr std::uint64_t kMostBytes = std::numeric_limits<std::size_t>::max() / 2;
  std::uint64_t bytes = capacity_bytes;
  while (true) {
    storage_bytes_ = round_up(bytes + kFirstAddress, page_bytes_);
    void* const range = bytes > kMostBytes ? MAP_FAILED
                                           : ::mmap(nullptr, static_cast<std::size_t>(storage_bytes_), PROT_NONE,
                                                    MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (range != MAP_FAILED) {
      base_ = storage_ = static_cast<std::byte*>(range);
      return;
    }
    if (bytes <= page_bytes_) throw std::bad_alloc();
    bytes /= 2;
  }
}

SimMemory::~SimMemory() {
  ::munmap(storage_, static_cast<std::size_t>(storage_bytes_));
}

void SimMemory::commit(std::uint64_t end_address) {
  const std::uint64_t end = round_up(end_address, page_bytes_);
  if (end <= committed_end_) return;
  if (end > storage_bytes_) throw std::bad_alloc();
  const std::uint64_t begin = committed_end_ != 0 ? committed_end_ : kFirstAddress / page_bytes_ * page_bytes_;
  if (::mprotect(base_ + begin, static_cast<std::size_t>(end - begin), PROT_READ | PROT_WRITE) != 0) {
    throw std::bad_alloc();
  }
  committed_end_ = end;
}

#else

SimMemory::SimMemory(std::uint64_t capacity_bytes) : capacity_bytes_(capacity_bytes) {
  // Host alignment of main address 0: as strict as any boundary of a transfer rule.
  constexpr std::uint64_t kHostAlignmentBytes = 4096;
  constexpr std::uint64_t kOverhead = kFirstAddress + kHostAlignmentBytes;
  if (capacity_bytes > std::numeric_limits<std::size_t>::max() - kOverhead) throw std::bad_alloc();
  storage_ = static_cast<std::byte*>(std::calloc(1, static_cast<std::size_t>(capacity_bytes + kOverhead)));
  if (storage_ == nullptr) throw std::bad_alloc();
  const std::uintptr_t misaligned = reinterpret_cast<std::uintptr_t>(storage_) % kHostAlignmentBytes;
  base_ = storage_ + (misaligned == 0 ? 0 : kHostAlignmentBytes - misaligned);
}

SimMemory::~SimMemory() {
  std::free(storage_);
}

void SimMemory::commit(std::uint64_t) {}

#endif

std::optional<MemoryRegion> SimMemory::allocate(std::uint64_t bytes, std::uint64_t alignment_bytes) {
  if (alignment_bytes == 0 || (alignment_bytes & (alignment_bytes - 1)) != 0) return std::nullopt;
  const std::uint64_t first_free = kFirstAddress + used_bytes_;
  const std::uint64_t padding = (alignment_bytes - first_free % alignment_bytes) % alignment_bytes;
  const std::uint64_t free_bytes = capacity_bytes_ - used_bytes_;
  if (padding > free_bytes || bytes > free_bytes - padding) return std::nullopt;

  const std::uint64_t address = first_free + padding;
  commit(address + bytes);
  used_bytes_ += padding + bytes;
  // Only bytes that were allocated before can be non-zero.
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
