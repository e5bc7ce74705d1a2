// Page tables: what each core may touch. All mappings are identities; unmapped addresses fault.
// Memory: tables in main memory that no core but the first, as master, can write. Threads: built by one core before the
// others run. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "memory_map.h"

namespace gridiron::port {

/// What a page may be used for. Values are the descriptor's bits: attribute index, AP, SH, UXN, PXN.
enum class Rights : std::uint64_t {
  kCode = 0x0040'0000'0000'0380,       ///< cached, read-only, run at EL1
  kConstants = 0x0060'0000'0000'0380,  ///< cached, read-only
  kData = 0x0060'0000'0000'0300,       ///< cached, inner shareable
  kRegisters = 0x0060'0000'0000'0004,  ///< device-nGnRnE
};

/// One translation, of addresses below 4 GB, with pages of 4 KB and blocks of 2 MB.
class AddressSpace {
 public:
  /// Maps [address, address + bytes) on itself.
  ///
  /// @param address  multiple of 4,096, as is bytes.
  /// @returns        false if the tables do not suffice; earlier mappings stay.
  [[nodiscard]] bool map(std::uint64_t address, std::uint64_t bytes, Rights rights);

  /// For TTBR0 with T0SZ = 32.
  [[nodiscard]] std::uint64_t root() const { return reinterpret_cast<std::uintptr_t>(&tables_[0]); }

 private:
  static constexpr std::uint32_t kTableCount = 12;

  struct alignas(4096) Table {
    std::uint64_t entries[512];
  };

  Table* next_table(std::uint64_t& entry);

  Table tables_[kTableCount];  // the first one is the root, of which 4 entries are used
  std::uint32_t used_;
};

}  // namespace gridiron::port
