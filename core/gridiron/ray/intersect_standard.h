// The `standard` ray/triangle test, watertight by construction: every decision equals that of exact arithmetic.
// Source: own. Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/edges.h>
#include <gridiron/ray/packet.h>
#include <gridiron/ray/pixel_box.h>
#include <gridiron/ray/subpackets.h>

#include <cstdint>

namespace gridiron {

/// Intersects triangle `index` of a batch with the active rays of some subpackets, keeping the least (t, id).
///
/// @param packet  t, id (and facing if requested) are updated. @returns the subpackets in which a ray's hit changed.
/// Errors: none (hot path). Cost: at most kSubpacketRays / L::kCount group tests per subpacket.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE SubpacketSet test_groups(PacketType& packet, const VertexTriangle& triangle,
                                                       const EdgeBatch<L>& batch, std::uint32_t index,
                                                       const NearSubpackets& near, Culling culling,
                                                       WorkCounters& work) {
  constexpr bool kGroupsAreRows = L::kCount == kSubpacketWidth;
  // Rows that may be left out make tests dearer: a branch each that goes either way, and fewer operations side by side.
  const Work visit_kind = culling.subpackets ? Work::kRowVisit : Work::kSubpacketVisit;
  const Work skip_kind = culling.subpackets ? Work::kRowSkip : Work::kGroupSkip;
  // A few subpackets are gone through one by one, many are picked.
  constexpr Work kPick = PacketType::kSubpacketCount > 4 ? Work::kSubpacketPick : Work::kSubpacketVisit;
  work.add(Work::kTriangleTest);
  const SplatEdges<L> edges(batch, index);
  HitSetups<L> setups;
  SubpacketSet changed = 0;
  for_each_subpacket<PacketType::kSubpacketCount>(near.touching, [&](std::uint32_t subpacket) GRIDIRON_INLINE_LAMBDA {
    if constexpr (kPick == Work::kSubpacketPick) work.add(kPick);
    const std::uint32_t first_ray = subpacket * kSubpacketRays;
    const bool is_covered = (near.covered >> subpacket & 1u) != 0;
    std::uint32_t rows = ~0u;
    if constexpr (kGroupsAreRows) {
      rows = near.rows >> (kSubpacketWidth * z_curve_row(subpacket));
      if (near.is_linear && !is_covered) rows &= rows_near(batch, index, subpacket, work);
    }
    if (is_covered && packet.active.subpacket(subpacket) == kAllSubpacketRays &&
        take_subpacket<L, kWantFacing>(packet, first_ray, triangle, setups, work)) {
      work.charge_to(kPick);
      changed |= SubpacketSet{1} << subpacket;
      return;
    }
    work.add(visit_kind);
    for (std::uint32_t group = 0; group < kSubpacketRays / L::kCount; ++group) {
      work.charge_to(visit_kind);
      const std::uint32_t base = first_ray + group * L::kCount;
      const std::uint32_t active = packet.active.template group<L>(base);
      if (active == 0 || (kGroupsAreRows && (rows >> group & 1u) == 0)) {
        work.add(skip_kind);
        continue;
      }
      const std::uint32_t hit = is_covered ? active
                                           : lanes_inside<L>(packet, base, active, edges, triangle,
                                                             batch.orientation[index], culling.subpackets, work);
      if (hit == 0) continue;
      if (merge_hits<L, kWantFacing>(packet, base, hit, triangle, setups, work)) {
        work.charge_to(Work::kHitGroup);
        changed |= SubpacketSet{1} << subpacket;
      }
    }
    work.charge_to(kPick);
  });
  return changed;
}

/// A triangle of a batch that the edge tests still have to decide.
struct OpenTriangle {
  const VertexTriangle* triangle;
  SubpacketSet subpackets;  ///< to be looked at
  std::uint32_t rows;       ///< of the packet, of these
  bool is_small;            ///< too few of them to be worth asking which it touches
};

/// Appends those of 1..L::kCount triangles that may cover a pixel of the wanted subpackets. @returns how many.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t keep_covering(const PacketType& packet, const VertexTriangle* triangles,
                                                           std::uint32_t count, SubpacketSet wanted, OpenTriangle* open,
                                                           WorkCounters& work) {
  work.add(Work::kPixelBoxGroup);
  const VertexTriangle* padded[L::kCount];
  for (std::uint32_t i = 0; i < L::kCount; ++i) padded[i] = i < count ? triangles + i : triangles;
  PixelBoxes<L> boxes;
  find_pixel_boxes<L>(packet, padded, boxes);
  std::uint32_t open_count = 0;
  for (std::uint32_t rest = boxes.covering & (~0u >> (32 - count)); rest != 0; rest &= rest - 1) {
    work.add(Work::kOpenTriangle);
    const std::uint32_t i = lowest_bit(rest);
    const PixelBox box{boxes.first_column[i], boxes.end_column[i], boxes.first_row[i], boxes.end_row[i]};
    open[open_count] = {triangles + i, wanted & box.subpackets(), box.rows(), box.is_small()};
    open_count += open[open_count].subpackets != 0 ? 1u : 0u;
  }
  return open_count;
}

/// Finds those of 1..L::kCount triangles that some subpackets have to test.
///
/// @param triangles  consecutive records. @param open  out: space for `count`. @returns how many were found.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t open_triangles(const PacketType& packet, const VertexTriangle* triangles,
                                                           std::uint32_t count, SubpacketSet wanted, Culling culling,
                                                           OpenTriangle* open, WorkCounters& work) {
  if constexpr (PacketType::kHasBoxes) {
    if (culling.subpackets) return keep_covering<L>(packet, triangles, count, wanted, open, work);
  }
  work.add(Work::kListedTriangle, count);
  for (std::uint32_t i = 0; i < count; ++i) open[i] = {triangles + i, wanted, ~0u, false};
  return count;
}

/// Intersects triangles with the active rays of a packet.
///
/// @returns the subpackets in which a ray's hit changed.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE SubpacketSet intersect_standard_batch(PacketType& packet, const OpenTriangle* open,
                                                                    std::uint32_t open_count, Culling culling,
                                                                    WorkCounters& work) {
  static constexpr std::uint32_t kTriangles = EdgeBatch<L>::kTriangles;
  SubpacketSet changed = 0;
  for (std::uint32_t first = 0; first < open_count; first += kTriangles) {
    std::uint32_t in_batch = open_count - first;
    if (in_batch > kTriangles) in_batch = kTriangles;
    const VertexTriangle* batched[kTriangles];
    for (std::uint32_t i = 0; i < kTriangles; ++i) {
      const std::uint32_t place = i < in_batch ? first + i : first;
      batched[i] = open[place].triangle;
    }
    work.add(Work::kTriangleSetup, in_batch);
    if (culling.corner_rays) work.add(Work::kCullTest, in_batch);
    if (culling.subpackets) work.add(Work::kSlopeSetup, in_batch);
    work.charge_to(Work::kTriangleSetup);
    EdgeBatch<L> batch;
    set_up_edges<L>(packet, batched, culling, batch, work);
    for (std::uint32_t i = 0; i < in_batch; ++i) {
      if (((batch.missed >> (4 * i)) & 0xFu) != 0 || batch.orientation[i] == 0) continue;
      const OpenTriangle& one = open[first + i];
      NearSubpackets near{one.subpackets, 0, one.rows, false};
      if (culling.subpackets && !one.is_small) {
        work.add(Work::kSubpacketSetup);
        near = subpackets_near<L, PacketType>(batch, i, one.subpackets, one.rows, work);
      }
      changed |= test_groups<L, kWantFacing>(packet, *one.triangle, batch, i, near, culling, work);
    }
  }
  return changed;
}

/// Intersects one triangle with every active ray of a packet.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool intersect_standard(PacketType& packet, const VertexTriangle& triangle,
                                                      bool use_culling, WorkCounters& work) {
  const OpenTriangle open{&triangle, PacketType::kAllSubpackets, ~0u, false};
  const Culling culling{.corner_rays = use_culling, .subpackets = false};
  return intersect_standard_batch<L, kWantFacing>(packet, &open, 1, culling, work) != 0;
}

}  // namespace gridiron
