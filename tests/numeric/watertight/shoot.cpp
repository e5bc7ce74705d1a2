// One build of core's intersectors. It is compiled with core's own sources for some instructions, with some rules of
// floating point or over some other type of number, all of it in a namespace of its own:
//   -Dgridiron=...          core's namespace for this build
//   -DWATERTIGHT_LANES=...  4, 8 or 16
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/intersect_projection.h>
#include <gridiron/ray/intersect_standard.h>
#include <gridiron/ray/lattice_run.h>

#include <cstddef>
#include <cstring>

#include "numeric/watertight/shot.h"

namespace gridiron {
namespace {

using L = Lanes<WATERTIGHT_LANES>;
using ShotPacket = Packet<4>;
static_assert(ShotPacket::kRayCount == watertight::kShotRays);
static_assert(sizeof(watertight::VertexRecord) == sizeof(VertexTriangle));
static_assert(sizeof(watertight::ProjectionRecord) == sizeof(ProjectionTriangle));
static_assert(sizeof(watertight::LatticeRecord) == sizeof(LatticeTriangle));
static_assert(sizeof(watertight::Shot::lattice) == sizeof(Lattice));

constexpr std::uint32_t kBlock = 32;

// Some of a shot's triangles as the standard test takes them.
struct Block {
  alignas(16) std::byte bytes[kBlock * sizeof(VertexTriangle)];

  const VertexTriangle* load(const watertight::Shot& shot, std::uint32_t first, std::uint32_t count,
                             Accuracy accuracy) {
    if (accuracy == Accuracy::kCompact) {
      Lattice lattice;
      std::memcpy(static_cast<void*>(&lattice), shot.lattice, sizeof(lattice));
      constexpr std::uint32_t kFirstByte = 16;
      std::memcpy(bytes + kFirstByte, shot.places + first, count * sizeof(LatticeTriangle));
      return spread_lattice_run(lattice, bytes, kFirstByte, count);
    }
    std::memcpy(bytes, shot.vertices + first, count * sizeof(VertexTriangle));
    return reinterpret_cast<const VertexTriangle*>(bytes);
  }
};

// Everything against everything: no grid, no culling.
void test_all(const watertight::Shot& shot, Accuracy accuracy, ShotPacket& packet) {
  WorkCounters work;
  for (std::uint32_t first = 0; first < shot.triangle_count; first += kBlock) {
    const std::uint32_t count = shot.triangle_count - first < kBlock ? shot.triangle_count - first : kBlock;
    if (accuracy == Accuracy::kPaper) {
      for (std::uint32_t i = 0; i < count; ++i) {
        ProjectionTriangle triangle;
        std::memcpy(static_cast<void*>(&triangle), shot.projections + first + i, sizeof(triangle));
        (void)intersect_projection<L>(packet, triangle, ShotPacket::kAllSubpackets, false, false, work);
      }
      continue;
    }
    Block block;
    const VertexTriangle* const triangles = block.load(shot, first, count, accuracy);
    OpenTriangle open[kBlock];
    for (std::uint32_t i = 0; i < count; ++i) open[i] = {triangles + i, ShotPacket::kAllSubpackets, ~0u, false};
    (void)intersect_standard_batch<L, false>(packet, open, count, {.corner_rays = false, .subpackets = false}, work);
  }
}

}  // namespace

// As tile_renderer.h's trace_packet: estimates, then the rays that they leave unsure with exact distances, then, where
// ties are to be broken, those of which one still is open, alone.
void shoot(const watertight::Shot& shot, std::uint32_t accuracy_value, watertight::Hits& hits) {
  const Accuracy accuracy = static_cast<Accuracy>(accuracy_value);
  ShotPacket packet;
  packet.dir_max = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    packet.origin[axis] = shot.origin[axis];
    for (std::uint32_t ray = 0; ray < ShotPacket::kRayCount; ++ray) {
      packet.dir[axis][ray] = shot.dir[axis][ray];
      if (magnitude(packet.dir[axis][ray]) > packet.dir_max) packet.dir_max = magnitude(packet.dir[axis][ray]);
    }
  }
  packet.range_factor = packet.dir_max;
  if (packet.range_factor < 1.0f) packet.range_factor = 1.0f;
  for (std::uint32_t ray = 0; ray < ShotPacket::kRayCount; ++ray) {
    packet.t[ray] = kFloatMax;
    packet.id[ray] = kNoTriangle;
  }
  packet.trusts_floats = accuracy == Accuracy::kFast;
  packet.breaks_ties = accuracy == Accuracy::kExact;
  packet.is_linear = false;
  packet.unsure.clear();
  packet.ask_for_distances(shot.with_distances && !packet.trusts_floats);
  packet.active.words[0] = shot.active;
  test_all(shot, accuracy, packet);
  WorkCounters work;
  RaySet<ShotPacket::kRayCount> unsure;
  if (take_unsure_rays(packet, kFloatMax, unsure, work)) {
    packet.active = unsure;
    test_all(shot, accuracy, packet);
    RaySet<ShotPacket::kRayCount> open;
    if (packet.breaks_ties && take_unsure_rays(packet, kFloatMax, open, work)) {
      for (std::uint32_t ray = 0; ray < ShotPacket::kRayCount; ++ray) {
        if (!open.contains(ray)) continue;
        packet.active.clear();
        packet.active.insert(ray);
        test_all(shot, accuracy, packet);
      }
    }
  }
  std::memcpy(hits.t, packet.t, sizeof(hits.t));
  std::memcpy(hits.id, packet.id, sizeof(hits.id));
}

}  // namespace gridiron
