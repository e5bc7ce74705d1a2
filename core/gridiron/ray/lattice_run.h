// Converts runs of lattice triangles into triangles by their vertices, in the buffer where they have arrived.
// Memory: the run's buffer. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Spreads LatticeTriangles over the buffer they lie in, from the last to the first: triangle i moves from `first_byte`
/// + 24 i to 48 i, which overwrites no record that is still to be read (first_byte <= 24). Every place is a float, so
/// nothing is rounded, and triangles that shared a vertex still do.
///
/// @param buffer  16-byte aligned, room for 48 count bytes; its records at first_byte, a multiple of 8 up to 24.
/// @returns the first of `count` triangles, at the buffer's first byte. Cost: linear.
GRIDIRON_INLINE const VertexTriangle* spread_lattice_run(const Lattice& lattice, std::byte* buffer,
                                                         std::uint32_t first_byte, std::uint32_t count) {
  using Four = Lanes<4>;
  using Float = typename Four::Float;
  // A record's words are x0 y0 z0 x1 | y1 z1 x2 y2 | z2, two unused ones, id.
  alignas(16) float words[3][4];
  for (int i = 0; i < 3; ++i) {
    for (int lane = 0; lane < 4; ++lane) words[i][lane] = lattice.origin[(4 * i + lane) % 3];
  }
  const Float origins[3] = {Float::load(words[0]), Float::load(words[1]), Float::load(words[2])};
  const Float step(lattice.step);
  const auto* const records = reinterpret_cast<const LatticeTriangle*>(buffer + first_byte);
  auto* const triangles = reinterpret_cast<VertexTriangle*>(buffer);
  for (std::uint32_t rest = count; rest != 0; --rest) {
    const std::uint32_t i = rest - 1;
    const std::uint16_t* const places = &records[i].v[0][0];
    const std::uint32_t triangle_id = records[i].triangle_id;
    const Float first = Four::load_halves(places), second = Four::load_halves(places + 4),
                third = Four::load_halves(places + 8);
    float* const target = &triangles[i].v[0][0];
    (first * step + origins[0]).store(target);
    (second * step + origins[1]).store(target + 4);
    (third * step + origins[2]).store(target + 8);
    triangles[i].triangle_id = triangle_id;
  }
  return triangles;
}

}  // namespace gridiron
