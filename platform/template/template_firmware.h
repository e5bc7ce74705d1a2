// Layout, lanes and entry point of the firmware of the made-up chip. The build may define GRIDIRON_PACKET_WIDTH, the
// rays along a packet's edge, GRIDIRON_EFFECTS, the set of effects, GRIDIRON_64K for the layout of a 64 KB core, which
// has no packets, or GRIDIRON_LAYOUT for any other layout.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/one_lane.h>
#include <gridiron/store/local_store.h>

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
#error "GRIDIRON_64K is for effects; packets in 64 KB: GRIDIRON_LAYOUT, StoreLayout64K<8>"
#elif GRIDIRON_EFFECTS == 0
using FirmwareLayout = StoreLayout256K<GRIDIRON_PACKET_WIDTH>;
#elif defined(GRIDIRON_64K)
using FirmwareLayout = EffectLayout64K<GRIDIRON_EFFECTS>;
#else
using FirmwareLayout = EffectLayout256K<GRIDIRON_EFFECTS, GRIDIRON_PACKET_WIDTH>;
#endif
// Several lanes would only make the code of a core without vectors longer; such a core has no packets either.
#if defined(GRIDIRON_64K) && !defined(__ARM_NEON) && !defined(__SSE2__)
using FirmwareLanes = Lanes<1>;
#else
using FirmwareLanes = Lanes<4>;
#endif
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
