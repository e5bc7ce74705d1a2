// Runs on each core of the made-up chip: its share of the passes that build a tree, beside template_firmware.cpp, which
// renders. A core of 256 KB has one program for all passes; with GRIDIRON_64K there is a program for each, which the
// chip loads before the pass: all together would leave too little for the store.
// Memory: the arena that the loader gives. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/passes/build_passes.h>

#include "template_board.h"

namespace gridiron::port {
namespace {

template <class Store>
GRIDIRON_INLINE Status run_on_board(Store& store, volatile EngineRegisters* engine, FrameControl* control,
                                    const BuildPlan& plan, BuildPass pass) {
  TemplateBoard board(engine, control, reinterpret_cast<std::uintptr_t>(&store), sizeof store);
  TemplatePort<TemplateBoard> port(board);
  return run_build_pass(port, store, plan, pass);
}

}  // namespace

// @param store  start of the core's arena, kLineBytes-aligned. Errors: those of run_build_pass; the caller stores the
// status for the host.
#ifdef GRIDIRON_64K
template <BuildPass kPass>
Status build_on_template_board(BuildStore<BuildLayout64K>& store, volatile EngineRegisters* engine,
                               FrameControl* control, const BuildPlan& plan) {
  return run_on_board(store, engine, control, plan, kPass);
}

#define GRIDIRON_PROGRAM(pass)                                                                                         \
  template Status build_on_template_board<pass>(BuildStore<BuildLayout64K>&, volatile EngineRegisters*, FrameControl*, \
                                                const BuildPlan&);
GRIDIRON_PROGRAM(BuildPass::kBounds)
GRIDIRON_PROGRAM(BuildPass::kCodes)
GRIDIRON_PROGRAM(BuildPass::kBuckets)
GRIDIRON_PROGRAM(BuildPass::kCuts)
GRIDIRON_PROGRAM(BuildPass::kSort)
GRIDIRON_PROGRAM(BuildPass::kTop)
GRIDIRON_PROGRAM(BuildPass::kSubtrees)
GRIDIRON_PROGRAM(BuildPass::kJoin)
GRIDIRON_PROGRAM(BuildPass::kNumbers)
GRIDIRON_PROGRAM(BuildPass::kCheck)
#undef GRIDIRON_PROGRAM
#else
Status build_on_template_board(BuildStore<BuildLayout256K>& store, volatile EngineRegisters* engine,
                               FrameControl* control, const BuildPlan& plan, BuildPass pass);

Status build_on_template_board(BuildStore<BuildLayout256K>& store, volatile EngineRegisters* engine,
                               FrameControl* control, const BuildPlan& plan, BuildPass pass) {
  return run_on_board(store, engine, control, plan, pass);
}
#endif

}  // namespace gridiron::port
