// Sizes of the stored forms of triangles and cells.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

/// @returns bytes of a triangle record.
[[nodiscard]] constexpr std::uint32_t triangle_bytes_of(TriangleFormat format) {
  return format == TriangleFormat::kLattice ? std::uint32_t{sizeof(LatticeTriangle)} : kTriangleRecordBytes;
}

/// @returns bytes of a block of macro_width^3 cells. CellRecords are padded to a line; the CellBounds of lattice
/// triangles to a multiple of 32 bytes, the modulus in which every platform's transfers are congruent.
[[nodiscard]] constexpr std::uint32_t cell_block_bytes_of(TriangleFormat format, std::uint32_t macro_width) {
  const std::uint32_t cells = macro_width * macro_width * macro_width;
  if (format == TriangleFormat::kLattice) {
    return ((cells + 1) * std::uint32_t{sizeof(CellBound)} + 31) / 32 * 32;
  }
  return (cells * std::uint32_t{sizeof(CellRecord)} + kLineBytes - 1) / kLineBytes * kLineBytes;
}

}  // namespace gridiron
