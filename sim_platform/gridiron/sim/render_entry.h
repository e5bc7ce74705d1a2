// Entry points of the kernel, each compiled for one lane count and one mode. Each is an object of its own in which only
// the entry point is visible, so that the linker never uses code built for a wide instruction set, or with
// instrumentation, elsewhere.
// Memory: the core's arena. Threads: one core per call. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/plain_core.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/store/local_store.h>

#include <cstddef>
#include <cstdint>

extern "C" {

/// Renders tiles until none is left. `store` is zeroed, kLineBytes-aligned, as large as the layout's LocalStore. The
/// layout is one of CommonLayouts, with one lane of OneLaneLayouts; for ..._sweep one of SweepLayouts, for ..._effects
/// one of EffectLayouts (compiled_layouts.h). It is passed as a copy because instrumented code may access a core's own
/// memory only. Errors: kUnsupportedFrame for a layout that is not built; the kernel's.
gridiron::Status gridiron_sim_render_checked_lanes1(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                    gridiron::sim::SimCore& core, gridiron::MainAddress frame,
                                                    gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_checked_lanes4(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                    gridiron::sim::SimCore& core, gridiron::MainAddress frame,
                                                    gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_checked_lanes8(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                    gridiron::sim::SimCore& core, gridiron::MainAddress frame,
                                                    gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_checked_lanes16(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                     gridiron::sim::SimCore& core, gridiron::MainAddress frame,
                                                     gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_checked_sweep_lanes4(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                          gridiron::sim::SimCore& core, gridiron::MainAddress frame,
                                                          gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_checked_effects_lanes4(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                            gridiron::sim::SimCore& core, gridiron::MainAddress frame,
                                                            gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_instrumented_lanes4(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                         gridiron::sim::SimCore& core, gridiron::MainAddress frame,
                                                         gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_instrumented_effects_lanes4(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                                 gridiron::sim::SimCore& core,
                                                                 gridiron::MainAddress frame,
                                                                 gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_plain_lanes1(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                  gridiron::sim::PlainCore& core, gridiron::MainAddress frame,
                                                  gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_plain_lanes4(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                  gridiron::sim::PlainCore& core, gridiron::MainAddress frame,
                                                  gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_plain_lanes8(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                  gridiron::sim::PlainCore& core, gridiron::MainAddress frame,
                                                  gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_plain_lanes16(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                   gridiron::sim::PlainCore& core, gridiron::MainAddress frame,
                                                   gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_plain_effects_lanes4(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                          gridiron::sim::PlainCore& core, gridiron::MainAddress frame,
                                                          gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_plain_effects_lanes8(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                          gridiron::sim::PlainCore& core, gridiron::MainAddress frame,
                                                          gridiron::SpillRegion spill);
gridiron::Status gridiron_sim_render_plain_effects_lanes16(gridiron::sim::LayoutChoice layout, std::byte* store,
                                                           gridiron::sim::PlainCore& core, gridiron::MainAddress frame,
                                                           gridiron::SpillRegion spill);
}
