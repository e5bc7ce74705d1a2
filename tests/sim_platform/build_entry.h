// The passes of a build by code whose loads and stores are all checked; only where the build has GRIDIRON_INSTRUMENTED.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/sim/sim_core.h>

#include <cstddef>

namespace gridiron::test {

/// Within a SimCore::AccessScope. @param store  BuildStore of the layout. @param plan  in the core's store too.
extern "C" Status build_instrumented(bool is_64k, sim::SimCore& core, std::byte* store, const BuildPlan& plan,
                                     BuildPass pass);

}  // namespace gridiron::test
