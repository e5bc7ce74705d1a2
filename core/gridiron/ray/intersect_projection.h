// The `paper` ray/triangle test: a precomputed projection, distance first, then three barycentric tests. Single
// precision and no filter: rays may slip through edges. The reciprocal is an estimate of 12 bits and one Newton step.
// Source: Cho, Kim, Han 2012, section 4.1; Wald 2004, section 7.1. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Rays of one SIMD group against a projected triangle: the distance to the plane and the three barycentric values.
template <class L>
struct ProjectionHit {
  typename L::Float t, beta, gamma, alpha, denominator;
};

/// Evaluates the projection for four or more rays that share the origin.
/// @param numerator  n_d - o_k - n_u o_u - n_v o_v
template <class L>
[[nodiscard]] GRIDIRON_INLINE ProjectionHit<L> project(const ProjectionTriangle& triangle, float numerator, float o_u,
                                                       float o_v, typename L::Float d_k, typename L::Float d_u,
                                                       typename L::Float d_v) {
  using Float = typename L::Float;
  ProjectionHit<L> hit;
  hit.denominator = d_k + Float(triangle.n_u) * d_u + Float(triangle.n_v) * d_v;
  const Float estimate = L::reciprocal_estimate(hit.denominator);
  hit.t = Float(numerator) * (estimate + estimate * (Float(1.0f) - hit.denominator * estimate));
  const Float p_u = Float(o_u) + hit.t * d_u;
  const Float p_v = Float(o_v) + hit.t * d_v;
  hit.beta = Float(triangle.b_u) * p_u + Float(triangle.b_v) * p_v + Float(triangle.b_d);
  hit.gamma = Float(triangle.c_u) * p_u + Float(triangle.c_v) * p_v + Float(triangle.c_d);
  hit.alpha = Float(1.0f) - hit.beta - hit.gamma;
  return hit;
}

/// Intersects one projected triangle with the active rays of some subpackets, keeping the least (t, id).
/// @returns the subpackets in which a ray's hit changed. Errors: none (hot path).
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE SubpacketSet intersect_projection(PacketType& packet, const ProjectionTriangle& triangle,
                                                                 SubpacketSet subpackets, bool use_culling,
                                                                 bool want_facing, WorkCounters& work) {
  using Float = typename L::Float;
  if (use_culling) work.add(Work::kCullTestPaper);
  const std::uint32_t k = triangle.axis_k;
  const std::uint32_t u = k == 2 ? std::uint32_t{0} : k + 1;
  const std::uint32_t v = u == 2 ? std::uint32_t{0} : u + 1;
  const float o_u = packet.origin[u];
  const float o_v = packet.origin[v];
  const float numerator = triangle.n_d - packet.origin[k] - triangle.n_u * o_u - triangle.n_v * o_v;
  if (use_culling) {
    // All four corner rays outside of one barycentric edge, all in front of the plane.
    using Four = Lanes<4>;
    using Corner = typename Four::Float;
    const ProjectionHit<Four> corner =
        project<Four>(triangle, numerator, o_u, o_v, Corner::load(packet.corner_dir[k]),
                      Corner::load(packet.corner_dir[u]), Corner::load(packet.corner_dir[v]));
    const Corner zero(0.0f);
    const bool in_front = (corner.t > zero).bits() == 0xFu;
    const bool outside = (corner.beta < zero).bits() == 0xFu || (corner.gamma < zero).bits() == 0xFu ||
                         (corner.alpha < zero).bits() == 0xFu;
    if (in_front && outside) return 0;
  }
  SubpacketSet changed = 0;
  work.charge_to(Work::kGroupTestPaper);
  for (std::uint32_t base = 0; base < PacketType::kRayCount; base += L::kCount) {
    const SubpacketSet subpacket = SubpacketSet{1} << (base / kSubpacketRays);
    if ((subpackets & subpacket) == 0) continue;
    const std::uint32_t active = packet.active.template group<L>(base);
    if (active == 0) continue;
    work.add(Work::kGroupTestPaper);
    const ProjectionHit<L> hit = project<L>(triangle, numerator, o_u, o_v, Float::load(packet.dir[k] + base),
                                            Float::load(packet.dir[u] + base), Float::load(packet.dir[v] + base));
    const Float zero(0.0f);
    std::uint32_t inside = ((hit.t > zero) & (hit.t <= Float::load(packet.t + base)) & (hit.beta >= zero) &
                            (hit.gamma >= zero) & (hit.alpha >= zero))
                               .bits() &
                           active;
    if (inside == 0) continue;
    work.add(Work::kHitGroupPaper);
    for (; inside != 0; inside &= inside - 1) {
      const std::uint32_t lane = lowest_bit(inside);
      const std::uint32_t ray = base + lane;
      const float t = L::lane(hit.t, lane);
      if (t == packet.t[ray] && triangle.triangle_id >= packet.id[ray]) continue;
      packet.t[ray] = t;
      packet.id[ray] = triangle.triangle_id;
      changed |= subpacket;
      if (want_facing) {
        const float length = square_root(1.0f + triangle.n_u * triangle.n_u + triangle.n_v * triangle.n_v);
        const float cosine = L::lane(hit.denominator, lane) / length;
        packet.facing[ray] = cosine < 0.0f ? -cosine : cosine;
      }
    }
  }
  return changed;
}

}  // namespace gridiron
