// Simulated main memory: one range of host memory with addresses of its own.
// Memory: owns. Threads: allocate before the frame; bytes are shared during it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gridiron::sim {

/// A piece of main memory: its address for cores, its bytes for the host.
struct MemoryRegion {
  MainAddress address;         ///< of the first byte
  std::span<std::byte> bytes;  ///< of the host
};

/// Main memory of `capacity_bytes`. Address 0 is never allocated, so that it can mean "none". The host needs memory
/// only for allocations, so the capacity may exceed what it has.
class SimMemory {
 public:
  static constexpr std::uint64_t kFirstAddress = 4096;  ///< the lowest that is handed out

  /// Errors: throws std::bad_alloc if the host has no addresses left.
  explicit SimMemory(std::uint64_t capacity_bytes);
  ~SimMemory();
  SimMemory(const SimMemory&) = delete;
  SimMemory& operator=(const SimMemory&) = delete;

  /// Allocates zeroed, aligned bytes (a power of two). @returns nothing if the capacity is used up or the alignment is
  /// no power of two. Errors: throws std::bad_alloc if the host has too little memory; nothing is changed then.
  [[nodiscard]] std::optional<MemoryRegion> allocate(std::uint64_t bytes, std::uint64_t alignment_bytes = 128);

  /// Frees everything allocated after `mark` = used_bytes() at some earlier time.
  void release_to(std::uint64_t mark);

  /// End of the allocations, from address 0 on; the argument of release_to.
  [[nodiscard]] std::uint64_t used_bytes() const { return used_bytes_; }
  /// The constructor's argument.
  [[nodiscard]] std::uint64_t capacity_bytes() const { return capacity_bytes_; }

  /// Host bytes of [address, address + bytes). Empty unless the range was allocated.
  [[nodiscard]] std::span<std::byte> bytes_at(MainAddress address, std::uint64_t bytes);

  /// Host pointer of address 0 (for the plain mode: base() + address.value). Addresses outside of the allocations may
  /// be inaccessible.
  [[nodiscard]] std::byte* base() const { return base_; }

 private:
  /// Takes host memory for all addresses below `end_address`. Errors: throws std::bad_alloc.
  void commit(std::uint64_t end_address);

  std::byte* base_ = nullptr;  ///< virtual: host address that stands for main address 0
  std::byte* storage_ = nullptr;
  std::uint64_t storage_bytes_ = 0;  ///< reserved from storage_ on
  std::uint64_t page_bytes_ = 0;     ///< of the host
  std::uint64_t committed_end_ = 0;  ///< addresses below it are open to reads and writes, but for the first page
  std::uint64_t capacity_bytes_ = 0;
  std::uint64_t used_bytes_ = 0;   ///< end of the allocations, from kFirstAddress on
  std::uint64_t dirty_bytes_ = 0;  ///< largest used_bytes_ ever: later bytes are still zero
};

}  // namespace gridiron::sim
