// Addresses of a Zynq UltraScale+ as this port uses it, sizes, and access rights. zcu102.ld and start.S use the same
// numbers; address_space.cpp makes page tables of them.
// Source: Zynq UltraScale+ Device Technical Reference Manual (UG1085), chapter 10, and register reference (UG1087).
// Memory: constants alone. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

/// Application cores: Cortex-A53.
inline constexpr std::uint32_t kCoreCount = 4;

/// On-chip memory: a quarter of it is a core's local memory.
inline constexpr std::uint64_t kOnChipAddress = 0xFFFC0000;
inline constexpr std::uint32_t kOnChipBytes = 256 * 1024;
inline constexpr std::uint32_t kArenaBytes = kOnChipBytes / kCoreCount;

/// Main memory. Nothing is mapped below the firmware, so that null pointers fault; the job lies after it.
inline constexpr std::uint64_t kFirmwareAddress = 0x00200000;
inline constexpr std::uint64_t kFirmwareBytes = 0x00200000;
inline constexpr std::uint64_t kJobAddress = kFirmwareAddress + kFirmwareBytes;
inline constexpr std::uint64_t kMainMemoryEnd = 0x40000000;

/// Registers. Channel i of the GDMA (DMA of the full-power domain) is core i's alone.
inline constexpr std::uint64_t kResetAddress = 0xFD1A0000;  ///< CRF_APB
inline constexpr std::uint64_t kApuAddress = 0xFD5C0000;
inline constexpr std::uint64_t kGdmaAddress = 0xFD500000;
inline constexpr std::uint64_t kGdmaChannelBytes = 0x10000;
inline constexpr std::uint64_t kUartAddress = 0xFF000000;
inline constexpr std::uint64_t kRegisterPageBytes = 4096;

inline constexpr std::uint32_t kCacheLineBytes = 64;

}  // namespace gridiron::port
