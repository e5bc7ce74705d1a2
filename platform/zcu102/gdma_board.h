// One core's view of the chip, for TemplatePort: its GDMA channel, the cache of its arena, the tile counter.
// Source: Zynq UltraScale+ register reference (UG1087), module ZDMA; UG1085, chapter 19.
// Memory: registers and the shared RunControl. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "cache.h"
#include "memory_map.h"
#include "run_control.h"
#include "template_port.h"

namespace gridiron::port {

/// Registers of a GDMA channel in simple mode; 32-bit accesses only.
struct GdmaRegisters {
  std::uint32_t reserved0[64];
  std::uint32_t interrupt_status;  ///< 0x100; write a one to clear
  std::uint32_t reserved1[3];
  std::uint32_t control0;          ///< 0x110
  std::uint32_t control1;
  std::uint32_t flow_control;
  std::uint32_t status;
  std::uint32_t data_attributes;   ///< 0x120
  std::uint32_t descriptor_attributes;
  std::uint32_t source_low;        ///< 0x128
  std::uint32_t source_high;
  std::uint32_t source_bytes;
  std::uint32_t source_attributes;
  std::uint32_t target_low;        ///< 0x138
  std::uint32_t target_high;
  std::uint32_t target_bytes;
  std::uint32_t target_attributes;
  std::uint32_t reserved2[46];
  std::uint32_t control2;          ///< 0x200; write kEnable to start
};
static_assert(offsetof(GdmaRegisters, interrupt_status) == 0x100 && offsetof(GdmaRegisters, control0) == 0x110 &&
              offsetof(GdmaRegisters, source_low) == 0x128 && offsetof(GdmaRegisters, target_low) == 0x138 &&
              offsetof(GdmaRegisters, control2) == 0x200);

/// Local memory is on-chip memory behind the core's data cache, which the DMA does not read. So lines are written back
/// and discarded by address. Buffers share no line with other data.
class GdmaBoard : public SharedTiles {
 public:
  static constexpr std::uint32_t kEnable = 1u << 0;        // control2
  static constexpr std::uint32_t kOverfetch = 1u << 7;     // control0: its value after reset; simple mode, copy
  static constexpr std::uint32_t kDone = 1u << 10;         // interrupt_status
  static constexpr std::uint32_t kWriteError = 1u << 9;    // AXI_WR_DATA
  static constexpr std::uint32_t kReadError = 1u << 8;     // AXI_RD_DATA
  static constexpr std::uint32_t kAccessError = 1u << 0;   // INV_APB
  static constexpr std::uint32_t kErrors = kWriteError | kReadError | kAccessError;
  static constexpr std::uint32_t kAllCauses = 0xFFF;

  /// @param local_base  address of the core's arena, `local_bytes` long.
  GdmaBoard(volatile GdmaRegisters& engine, RunControl& control, std::uint64_t local_base, std::uint64_t local_bytes)
      : SharedTiles(control), engine_(engine), local_base_(local_base), local_bytes_(local_bytes) {}

  void start(const EngineCommand& command) {
    engine_.interrupt_status = kAllCauses;
    engine_.control0 = kOverfetch;
    engine_.source_low = static_cast<std::uint32_t>(command.source);
    engine_.source_high = static_cast<std::uint32_t>(command.source >> 32);
    engine_.source_bytes = command.bytes;
    engine_.source_attributes = 0;
    engine_.target_low = static_cast<std::uint32_t>(command.target);
    engine_.target_high = static_cast<std::uint32_t>(command.target >> 32);
    engine_.target_bytes = command.bytes;
    engine_.target_attributes = 0;
    // Stores to normal memory, and what write_back() cleaned, come before the store that starts the channel.
    order_all();
    engine_.control2 = kEnable;
  }
  [[nodiscard]] bool is_busy() { return (engine_.interrupt_status & (kDone | kErrors)) == 0; }
  [[nodiscard]] bool has_failed() {
    const bool failed = (engine_.interrupt_status & kErrors) != 0;
    // Loads of the data come after the load that reported it.
    order_all();
    return failed;
  }
  [[nodiscard]] std::uint64_t bus_address(const void* local) const { return reinterpret_cast<std::uintptr_t>(local); }
  [[nodiscard]] bool holds(const void* local, std::uint32_t bytes) const {
    const std::uint64_t offset = bus_address(local) - local_base_;
    return offset <= local_bytes_ && bytes <= local_bytes_ - offset;
  }
  // The DMA is behind no MMU, so the board must also refuse copies of memory that the core must not touch.
  [[nodiscard]] bool reaches(MainAddress address, std::uint32_t bytes) const {
    constexpr std::uint64_t kJobBytes = kMainMemoryEnd - kJobAddress;
    const std::uint64_t offset = address.value - kJobAddress;
    return offset <= kJobBytes && bytes <= kJobBytes - offset;
  }

  // For a put this sends the stored bytes; for a get no dirty line is left that could overwrite the new bytes.
  void write_back(const void* local, std::uint32_t bytes) { clean_and_invalidate(bus_address(local), bytes); }
  // Lines that were fetched while the DMA wrote are old.
  void discard(const void* local, std::uint32_t bytes) { invalidate(bus_address(local), bytes); }

 private:
  volatile GdmaRegisters& engine_;
  std::uint64_t local_base_;
  std::uint64_t local_bytes_;
};

static_assert(BoundedBoard<GdmaBoard>);
static_assert(Platform<TemplatePort<GdmaBoard>>);

}  // namespace gridiron::port
