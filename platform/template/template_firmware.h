// Layout, lanes and entry point of the firmware of the made-up chip. The build may define GRIDIRON_PACKET_WIDTH, the
// rays along a packet's edge (0 without effects: eye rays go through the tree), GRIDIRON_EFFECTS, the set of effects,
// GRIDIRON_64K for the layout of a 64 KB core, which has no packets, or GRIDIRON_LAYOUT for any other layout.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/one_lane.h>
#include <gridiron/store/local_store.h>

#include <type_traits>

#include "template_board.h"

#ifndef GRIDIRON_PACKET_WIDTH
#define GRIDIRON_PACKET_WIDTH 8
#endif
#ifndef GRIDIRON_EFFECTS
#define GRIDIRON_EFFECTS 0
#endif

namespace gridiron::port {

#if defined(GRIDIRON_LAYOUT)
using FirmwareLayout = GRIDIRON_LAYOUT;
#elif defined(GRIDIRON_64K) && GRIDIRON_EFFECTS == 0
using FirmwareLayout = TreeLayout64K;
#elif GRIDIRON_EFFECTS == 0 && GRIDIRON_PACKET_WIDTH == 0
using FirmwareLayout = TreeLayout256K<>;
#elif GRIDIRON_EFFECTS == 0
using FirmwareLayout = StoreLayout256K<GRIDIRON_PACKET_WIDTH>;
#elif defined(GRIDIRON_64K)
using FirmwareLayout = EffectLayout64K<GRIDIRON_EFFECTS>;
#else
using FirmwareLayout = EffectLayout256K<GRIDIRON_EFFECTS, GRIDIRON_PACKET_WIDTH>;
#endif
// Several lanes would only make the code of a core without vectors longer. Packets require them, and so do beams.
#if defined(__ARM_NEON) || defined(__SSE2__)
inline constexpr bool kTakesOneLane = false;
#else
inline constexpr bool kTakesOneLane =
    FirmwareLayout::kPacketWidth == 0 && (FirmwareLayout::kEffects == 0 || FirmwareLayout::kArenaBytes <= 64 * 1024);
#endif
using FirmwareLanes = std::conditional_t<kTakesOneLane, Lanes<1>, Lanes<4>>;
using FirmwareStore = LocalStore<FirmwareLayout>;
static_assert(kFitsArena<FirmwareLayout>, "store, code and stack are more than the arena");

/// Renders the core's share of a frame.
///
/// @param store       start of the core's arena, kLineBytes-aligned, sizeof(FirmwareStore) bytes.
/// @param core_index  selects the core's part of the memory for rays that wait.
/// @param frame       the FrameRecord in main memory.
/// Errors: those of render_tiles; the caller stores the status for the host.
Status render_on_template_board(FirmwareStore& store, volatile EngineRegisters* engine, FrameControl* control,
                                std::uint32_t core_index, MainAddress frame);

}  // namespace gridiron::port
