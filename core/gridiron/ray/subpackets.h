// Subpackets: which parts of a packet a triangle may touch, by its edge functions as linear functions of the pixel.
// Source: own; the idea of bounding an edge function over a square is Pineda's, 1988.
// Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/edges.h>
#include <gridiron/ray/packet.h>
#include <gridiron/ray/places.h>

#include <cstdint>

namespace gridiron {

/// @returns a bit for each place whose rays surely pass an edge of triangle `index` on the outside.
///
/// @param largest  of EdgeBatch: the edge function's largest value over the place at column 0, row 0.
template <class L, class Wide>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t places_outside(const EdgeBatch<L>& batch, std::uint32_t index,
                                                           const float* largest, typename Wide::Float column,
                                                           typename Wide::Float row) {
  using Float = typename Wide::Float;
  std::uint32_t outside = 0;
  for (std::uint32_t edge = 0; edge < 3; ++edge) {
    const std::uint32_t lane = 4 * index + edge;
    const Float value =
        Float(largest[lane]) + (column * Float(batch.per_column[lane]) + row * Float(batch.per_row[lane]));
    outside |= (value < Float(batch.surely_outside[lane])).bits();
  }
  return outside;
}

/// @returns the squares of 2x2 subpackets that triangle `index` of a batch may touch.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t squares_near(const EdgeBatch<L>& batch, std::uint32_t index,
                                                         WorkCounters& work) {
  using Float = typename L::Float;
  using Four = Lanes<4>;
  constexpr std::uint32_t kSquares = PacketType::kSquareCount;
  // A group of four lanes is a quarter of the packet.
  constexpr bool kByQuarters = kSquares == 16 && L::kCount == 4;
  std::uint32_t far_quarters = 0;
  if constexpr (kByQuarters) {
    work.add(Work::kSubpacketGroup);
    far_quarters =
        places_outside<L, Four>(batch, index, batch.first_quarter, Four::Float::load(kLanePlaces.quarter_column),
                                Four::Float::load(kLanePlaces.quarter_row));
  }
  std::uint32_t squares = 0;
  for (std::uint32_t base = 0; base < kSquares; base += L::kCount) {
    if (kByQuarters && (far_quarters >> base / 4 & 1u) != 0) continue;
    work.add(Work::kSubpacketGroup);
    const std::uint32_t outside =
        places_outside<L, L>(batch, index, batch.first_square, Float::load(kSquareOrigins.column + base),
                             Float::load(kSquareOrigins.row + base));
    squares |= (~outside & L::kAllBits) << base;
  }
  return squares & ((1u << kSquares) - 1u);
}

/// Subpackets that a triangle may touch.
struct NearSubpackets {
  SubpacketSet touching;  ///< may be touched
  SubpacketSet covered;   ///< of these, all rays surely pass inside all three edges
  std::uint32_t rows;     ///< of these, rows of the packet that may be touched, bit i = row i
  bool is_linear;         ///< whether rows may be tested one by one: the edge functions' linear form holds
};

/// @returns those of the `wanted` subpackets that triangle `index` of a batch may touch. A subpacket is left out if all
/// its rays surely pass an edge on the outside. The edge function is linear, so its largest value is at a corner; its
/// least value, at the opposite corner, shows whether all rays are inside.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE NearSubpackets subpackets_near(const EdgeBatch<L>& batch, std::uint32_t index,
                                                              SubpacketSet wanted, std::uint32_t rows,
                                                              WorkCounters& work) {
  using Four = Lanes<4>;
  using Float = Four::Float;
  if constexpr (PacketType::kSubpacketCount < 4) return {wanted, 0, rows, false};
  const std::uint32_t first_lane = 4 * index;
  if (((batch.in_range >> first_lane) & 0xFu) != 0xFu) return {wanted, 0, rows, false};
  std::uint32_t squares = 1;
  if constexpr (PacketType::kSquareCount > 1) squares = squares_near<L, PacketType>(batch, index, work);

  work.charge_to(Work::kSubpacketSetup);
  Float offset[3];  // from a square's largest value to its subpackets'
  Float span[3];
  Float limit[3];
  for (std::uint32_t edge = 0; edge < 3; ++edge) {
    const std::uint32_t lane = first_lane + edge;
    offset[edge] = Float(batch.first_square[lane] + batch.square_to_subpacket[lane]) +
                   (Float::load(kLanePlaces.subpacket_column) * Float(batch.per_column[lane]) +
                    Float::load(kLanePlaces.subpacket_row) * Float(batch.per_row[lane]));
    span[edge] = Float(batch.subpacket_span[lane]);
    limit[edge] = Float(batch.surely_outside[lane]);
  }
  SubpacketSet near = 0;
  SubpacketSet covered = 0;
  for (; squares != 0; squares &= squares - 1) {
    const std::uint32_t square = lowest_bit(squares);
    const SubpacketSet four = SubpacketSet{0xF} << (4 * square);
    if ((wanted & four) == 0) continue;
    work.add(Work::kSubpacketGroup);
    std::uint32_t outside = 0;
    std::uint32_t inside = 0xF;
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      const std::uint32_t lane = first_lane + edge;
      const Float value = offset[edge] + Float(kSquareOrigins.column[square] * batch.per_column[lane] +
                                               kSquareOrigins.row[square] * batch.per_row[lane]);
      outside |= (value < limit[edge]).bits();
      inside &= (value - span[edge] > -limit[edge]).bits();
    }
    near |= SubpacketSet{~outside & 0xFu} << (4 * square);
    covered |= SubpacketSet{inside} << (4 * square);
  }
  return {near & wanted, covered & wanted, rows, true};
}

/// @returns those of a subpacket's four rows, bit i = row i, that triangle `index` of a batch may touch.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t rows_near(const EdgeBatch<L>& batch, std::uint32_t index,
                                                      std::uint32_t subpacket, WorkCounters& work) {
  using Float = Lanes<4>::Float;
  work.add(Work::kRowGroup);
  const Float column(kSubpacketOrigins.column[subpacket]);
  const Float row = Float(kSubpacketOrigins.row[subpacket]) + Float::load(kLanePlaces.row);
  return ~places_outside<L, Lanes<4>>(batch, index, batch.first_row, column, row) & 0xFu;
}

}  // namespace gridiron
