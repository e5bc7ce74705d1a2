// The contract checks on a port: what to run first on a new one. Prints the checks that failed.
// Memory: static. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include "contract_checks.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "copy_port.h"

using namespace gridiron;

namespace {

alignas(128) std::byte local_memory[contract::kLocalBytes];
alignas(4096) std::byte main_memory[contract::kMainBytes];

struct CopyBench {
  using PlatformType = example::CopyPort;
  static constexpr bool kChecksRules = true;
  static constexpr bool kChecksQueue = false;  // a call ends its transfer: nothing is ever pending
  static constexpr bool kChecksOverlap = false;

  PlatformType port{contract::kItemCount};

  PlatformType& platform() { return port; }
  std::byte* local() { return local_memory; }
  MainAddress main() { return {reinterpret_cast<std::uintptr_t>(main_memory)}; }
  void poke(std::uint32_t offset, std::byte value) { main_memory[offset] = value; }
  std::byte peek(std::uint32_t offset) { return main_memory[offset]; }
};

}  // namespace

int main() {
  std::uint32_t checks = 0, failures = 0;
  contract::for_each_check<CopyBench>([&](const char* name, auto check, bool is_rule) {
    if (is_rule && !CopyBench::kChecksRules) return;
    CopyBench bench;
    const char* failure = check(bench);
    ++checks;
    if (failure == nullptr) return;
    ++failures;
    std::printf("%s: %s\n", name, failure);
  });
  std::printf("contract: %u checks, %u failures\n", static_cast<unsigned>(checks), static_cast<unsigned>(failures));
  return failures == 0 ? 0 : 1;
}
