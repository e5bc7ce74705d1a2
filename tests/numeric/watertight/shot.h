// Shots: what the suite hands to an intersector and gets back. Numbers alone, none of core's types: core is compiled
// here several times over, each time in a namespace of its own (shoot.cpp).
// Memory: borrowed. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace watertight {

inline constexpr std::uint32_t kShotRays = 16;  ///< of one packet, all from one origin
inline constexpr std::uint32_t kNothing = 0xFFFFFFFFu;

/// The bytes of core's VertexTriangle.
struct VertexRecord {
  float v[3][3];
  std::uint32_t reserved[2];
  std::uint32_t triangle_id;
};

/// The bytes of core's ProjectionTriangle.
struct ProjectionRecord {
  float plane[9];
  std::uint32_t axis, reserved;
  std::uint32_t triangle_id;
};

/// The bytes of core's LatticeTriangle.
struct LatticeRecord {
  std::uint16_t v[3][3];
  std::uint16_t reserved;
  std::uint32_t triangle_id;
};

/// A packet and the triangles to hold against it.
struct Shot {
  float origin[3];
  float dir[3][kShotRays];
  std::uint32_t active;  ///< bit i = ray i
  bool with_distances;   ///< t is wanted, as if a frame had a depth plane; else it may be an estimate
  const VertexRecord* vertices;
  const ProjectionRecord* projections;  ///< the same triangles
  const LatticeRecord* places;          ///< the same, where they lie on a lattice; else null
  float lattice[4];                     ///< the bytes of core's Lattice
  std::uint32_t triangle_count;
};

/// What the rays hit: kNothing for none, and for those that are not active.
struct Hits {
  float t[kShotRays];
  std::uint32_t id[kShotRays];
};

/// One build of core's intersectors. @param accuracy  the value of one of core's Accuracy.
using Shooter = void (*)(const Shot& shot, std::uint32_t accuracy, Hits& hits);

}  // namespace watertight
