// The reach of a whole packet, for tests that march one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/engine/grid/reach.h>

namespace gridiron::test {

template <class L, class PacketType>
[[nodiscard]] float reach_of(const PacketType& packet) {
  SubpacketReach<PacketType> reaches{};
  WorkCounters work;
  return reaches.template update<L>(packet, PacketType::kAllSubpackets, work);
}

}  // namespace gridiron::test
