// The `standard` ray/triangle test, watertight by construction: every decision equals the one exact arithmetic takes.
// Source: own. Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/edges.h>
#include <gridiron/ray/packet.h>
#include <gridiron/ray/subpackets.h>

#include <cstdint>

namespace gridiron {

/// Intersects triangle `index` of a batch with the active rays of some subpackets, keeping the least (t, id).
///
/// @param packet  t, id (and facing where wanted) are updated. @returns the subpackets of which a ray's hit changed.
/// Errors: none (hot path). Cost: at most kSubpacketRays / L::kCount group tests per subpacket.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE SubpacketSet test_groups(PacketType& packet, const VertexTriangle& triangle,
                                                       const EdgeBatch<L>& batch, std::uint32_t index,
                                                       const NearSubpackets& near, WorkCounters& work) {
  constexpr bool kGroupsAreRows = L::kCount == kSubpacketWidth;
  work.charge_to(Work::kTriangleSetup);
  const SplatEdges<L> edges(batch, index);
  HitSetups<L> setups;
  SubpacketSet changed = 0;
  for_each_subpacket<PacketType::kSubpacketCount>(near.touching, [&](std::uint32_t subpacket) GRIDIRON_INLINE_LAMBDA {
    const std::uint32_t first_ray = subpacket * kSubpacketRays;
    const bool is_covered = (near.covered >> subpacket & 1u) != 0;
    std::uint32_t rows = ~0u;
    if constexpr (kGroupsAreRows) {
      rows = near.rows >> (kSubpacketWidth * subpacket_row(subpacket));
      if (near.is_linear && !is_covered) rows &= rows_near(batch, index, subpacket, work);
    }
    work.charge_to(Work::kGroupTestStandard);
    for (std::uint32_t group = 0; group < kSubpacketRays / L::kCount; ++group) {
      const std::uint32_t base = first_ray + group * L::kCount;
      const std::uint32_t active = packet.active.template group<L>(base);
      if (active == 0 || (kGroupsAreRows && (rows >> group & 1u) == 0)) continue;
      const std::uint32_t hit =
          is_covered ? active
                     : lanes_inside<L>(packet, base, active, edges, triangle, batch.orientation[index], work);
      if (hit == 0) continue;
      if (merge_hits<L, kWantFacing>(packet, base, hit, triangle, setups, work)) {
        changed |= SubpacketSet{1} << subpacket;
      }
    }
  });
  return changed;
}

/// Intersects 1..EdgeBatch<L>::kTriangles triangles with the active rays of a packet.
///
/// @param subpackets  per triangle, those to look at. @returns the subpackets of which a ray's hit changed.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE SubpacketSet intersect_standard_batch(PacketType& packet,
                                                                    const VertexTriangle* const* triangles,
                                                                    const SubpacketSet* subpackets, std::uint32_t count,
                                                                    Culling culling, WorkCounters& work) {
  constexpr std::uint32_t kTriangles = EdgeBatch<L>::kTriangles;
  const VertexTriangle* padded[kTriangles];
  for (std::uint32_t i = 0; i < kTriangles; ++i) padded[i] = triangles[i < count ? i : 0];
  NearSubpackets near[kTriangles];
  for (std::uint32_t i = 0; i < count; ++i) near[i] = {subpackets[i], 0, false, ~0u};

  // 1. The pixels they can cover at all: most small triangles are done with here.
  bool is_small[kTriangles] = {};
  const bool has_boxes = PacketType::kHasBoxes && culling.subpackets;
  if (has_boxes) work.add(Work::kPixelBox, count);
  const VertexLanes<L> vertices(padded, packet.origin);
  std::uint32_t open_count = count;
  if (has_boxes) {
    const PixelBoxes<L> boxes = pixel_boxes<L>(packet, vertices);
    open_count = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const PixelBox box(boxes, i);
      near[i].touching &= box.subpackets();
      if (near[i].touching == 0) continue;
      ++open_count;
      near[i].rows = box.rows();
      is_small[i] = box.is_small();
    }
    if (open_count == 0) return 0;
  }

  // 2. Their edges, and what the packet or its subpackets tell of them.
  work.add(Work::kTriangleSetup, open_count);
  if (culling.corner_rays) work.add(Work::kCullTest, open_count);
  work.charge_to(Work::kTriangleSetup);
  EdgeBatch<L> batch;
  set_up_edges<L>(packet, padded, vertices, culling, batch, work);
  SubpacketSet changed = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (near[i].touching == 0 || ((batch.missed >> (4 * i)) & 0xFu) != 0 || batch.orientation[i] == 0) continue;
    if (culling.subpackets && !is_small[i]) {
      work.add(Work::kSubpacketSetup);
      const std::uint32_t rows = near[i].rows;
      near[i] = subpackets_near<L, PacketType>(batch, i, near[i].touching, work);
      near[i].rows = rows;
    }
    // 3. Its rays.
    changed |= test_groups<L, kWantFacing>(packet, *triangles[i], batch, i, near[i], work);
  }
  return changed;
}

/// Intersects one triangle with every active ray of a packet.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool intersect_standard(PacketType& packet, const VertexTriangle& triangle,
                                                      bool use_culling, WorkCounters& work) {
  const VertexTriangle* const triangles[] = {&triangle};
  const SubpacketSet subpackets[] = {PacketType::kAllSubpackets};
  const Culling culling{.corner_rays = use_culling, .subpackets = false};
  return intersect_standard_batch<L, kWantFacing>(packet, triangles, subpackets, 1, culling, work) != 0;
}

}  // namespace gridiron
