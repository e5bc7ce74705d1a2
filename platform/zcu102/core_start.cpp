// Starts the other cores: by PSCI if firmware owns EL3, else by taking them out of reset.
// Source: UG1087, modules APU and CRF_APB; Arm Power State Coordination Interface (DEN 0022).
// Memory: registers. Threads: core 0, as master. SPDX-License-Identifier: Apache-2.0
#include "core_start.h"

#include <cstdint>

#include "cache.h"
#include "memory_map.h"

extern "C" {
void _start();
// Exception level in which core 0 was entered; start.S writes it first of all.
std::uint32_t entry_level = 0;
}

namespace gridiron::port {
namespace {

constexpr std::uint64_t kResetVectorOffset = 0x40;        // APU RVBARADDR0L, 8 bytes a core
constexpr std::uint64_t kApuResetOffset = 0x104;          // CRF_APB RST_FPD_APU
constexpr std::uint32_t kCoreReset = 1u << 0;             // shifted by the core
constexpr std::uint32_t kCorePowerOnReset = 1u << 10;     // likewise
constexpr std::uint64_t kPsciCpuOn = 0xC4000003;

volatile std::uint32_t& word_at(std::uint64_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uintptr_t>(address));
}

void release_from_reset(std::uint32_t core, std::uint64_t entry) {
  const std::uint64_t vector = kApuAddress + kResetVectorOffset + 8 * std::uint64_t{core};
  word_at(vector) = static_cast<std::uint32_t>(entry);
  word_at(vector + 4) = static_cast<std::uint32_t>(entry >> 32);
  order_all();
  volatile std::uint32_t& reset = word_at(kResetAddress + kApuResetOffset);
  reset = reset & ~((kCoreReset | kCorePowerOnReset) << core);
}

bool ask_firmware(std::uint32_t core, std::uint64_t entry) {
  register std::uint64_t x0 asm("x0") = kPsciCpuOn;
  register std::uint64_t x1 asm("x1") = core;
  register std::uint64_t x2 asm("x2") = entry;
  register std::uint64_t x3 asm("x3") = 0;
  asm volatile("smc #0"
               : "+r"(x0), "+r"(x1), "+r"(x2), "+r"(x3)
               :
               : "x4", "x5", "x6", "x7", "x8", "x9", "x10", "x11", "x12", "x13", "x14", "x15", "x16", "x17", "memory");
  return x0 == 0;
}

}  // namespace

bool start_core(std::uint32_t core) {
  const std::uint64_t entry = reinterpret_cast<std::uintptr_t>(&_start);
  // The core reads these before its cache is on, so they must have left this one's.
  order_all();
  if (entry_level != 3) return ask_firmware(core, entry);
  release_from_reset(core, entry);
  return true;
}

}  // namespace gridiron::port
