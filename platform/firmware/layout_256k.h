// Layout and lanes of an image for cores of 256 KB, chosen by GRIDIRON_EFFECTS (0: none) and GRIDIRON_PACKET_WIDTH.
// Memory: none. Threads: none. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/store/local_store.h>

namespace gridiron::port {

#if GRIDIRON_EFFECTS == 0
using FirmwareLayout = StoreLayout256K<GRIDIRON_PACKET_WIDTH>;
#else
using FirmwareLayout = EffectLayout256K<GRIDIRON_EFFECTS, GRIDIRON_PACKET_WIDTH>;
#endif
using FirmwareLanes = Lanes<4>;
using FirmwareStore = LocalStore<FirmwareLayout>;
static_assert(kFitsArena<FirmwareLayout>, "store, code and stack are more than the arena");

}  // namespace gridiron::port
