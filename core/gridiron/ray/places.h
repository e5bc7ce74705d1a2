// Places: where squares, subpackets and rows stand in a packet, in pixels.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Origins of squares of 2x2 subpackets in a packet, in pixels, along the Z curve.
struct SquareOrigins {
  alignas(64) float column[16];
  alignas(64) float row[16];
};
inline constexpr SquareOrigins kSquareOrigins = [] {
  SquareOrigins origins{};
  for (std::uint32_t i = 0; i < 16; ++i) {
    origins.column[i] = static_cast<float>(2 * kSubpacketWidth * z_curve_column(i));
    origins.row[i] = static_cast<float>(2 * kSubpacketWidth * z_curve_row(i));
  }
  return origins;
}();

/// Positions of the four lanes of a test, in pixels: quarters in a packet of 8x8 subpackets, subpackets in a square,
/// rows in a subpacket, corner pixels of a square.
struct LanePlaces {
  alignas(16) float quarter_column[4];
  alignas(16) float quarter_row[4];
  alignas(16) float subpacket_column[4];
  alignas(16) float subpacket_row[4];
  alignas(16) float row[4];
  alignas(16) float corner_column[4];
  alignas(16) float corner_row[4];
};
inline constexpr LanePlaces kLanePlaces = {{0, 16, 0, 16}, {0, 0, 16, 16}, {0, 4, 0, 4}, {0, 0, 4, 4},
                                           {0, 1, 2, 3},   {0, 7, 0, 7},   {0, 0, 7, 7}};

/// Origins of subpackets in a packet, in pixels, along the Z curve.
struct SubpacketOrigins {
  float column[64];
  float row[64];
};
inline constexpr SubpacketOrigins kSubpacketOrigins = [] {
  SubpacketOrigins origins{};
  for (std::uint32_t i = 0; i < 64; ++i) {
    origins.column[i] = static_cast<float>(kSubpacketWidth * z_curve_column(i));
    origins.row[i] = static_cast<float>(kSubpacketWidth * z_curve_row(i));
  }
  return origins;
}();

}  // namespace gridiron
