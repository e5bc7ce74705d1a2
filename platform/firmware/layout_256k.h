// Layout and lanes of an image for cores of 256 KB, chosen by GRIDIRON_EFFECTS (0: none) and GRIDIRON_PACKET_WIDTH (0:
// eye rays go through the tree).
// Memory: none. Threads: none. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/one_lane.h>
#include <gridiron/store/local_store.h>

namespace gridiron::port {

// The boards' cores have no vectors: where the renderer runs with one lane, it has half of the code, and is faster.
#if GRIDIRON_EFFECTS == 0 && GRIDIRON_PACKET_WIDTH == 0
using FirmwareLayout = TreeLayout256K<>;
using FirmwareLanes = Lanes<1>;
#elif GRIDIRON_EFFECTS == 0
using FirmwareLayout = StoreLayout256K<GRIDIRON_PACKET_WIDTH>;
using FirmwareLanes = Lanes<4>;
#else
using FirmwareLayout = EffectLayout256K<GRIDIRON_EFFECTS, GRIDIRON_PACKET_WIDTH>;
using FirmwareLanes = Lanes<4>;
#endif
using FirmwareStore = LocalStore<FirmwareLayout>;
static_assert(kFitsArena<FirmwareLayout>, "store, code and stack are more than the arena");

}  // namespace gridiron::port
