// The passes of a build, compiled with instrumentation: tree_build_test calls them.
// Memory: the core's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include "build_entry.h"

#include <gridiron/build/passes/build_passes.h>

namespace gridiron::test {

Status build_instrumented(bool is_64k, sim::SimCore& core, std::byte* store, const BuildPlan& plan, BuildPass pass) {
  if (is_64k) return run_build_pass(core, *reinterpret_cast<BuildStore<BuildLayout64K>*>(store), plan, pass);
  return run_build_pass(core, *reinterpret_cast<BuildStore<BuildLayout256K>*>(store), plan, pass);
}

}  // namespace gridiron::test
