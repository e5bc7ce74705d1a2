// Handles the fault of a core: prints it and ends the run.
// Memory: a stack of start.S. Threads: any core. SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "console.h"
#include "master.h"
#include "semihost.h"
#include "uart.h"

extern "C" void report_fault(std::uint64_t vector, std::uint64_t core, std::uint64_t cause, std::uint64_t pc,
                             std::uint64_t address);

// Called by start.S. The first core prints; others that fault too stay silent.
void report_fault(std::uint64_t vector, std::uint64_t core, std::uint64_t cause, std::uint64_t pc,
                  std::uint64_t address) {
  using namespace gridiron::port;
  if (!take_uart()) return;
  print("\nfault: core ", core, " vector ", vector, " ESR ", Hex{cause}, " FAR ", Hex{address}, " pc ", Hex{pc}, "\n");
  exit_run(static_cast<std::uint32_t>(RunExit::kTrapped));
}
