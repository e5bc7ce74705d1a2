// What the stored forms of a triangle take, and which an accuracy works on.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

/// @returns bytes of a triangle record.
[[nodiscard]] constexpr std::uint32_t triangle_bytes_of(TriangleFormat format) {
  return format == TriangleFormat::kLattice ? std::uint32_t{sizeof(LatticeTriangle)} : kTriangleRecordBytes;
}

/// @returns the stored form that an accuracy works on.
[[nodiscard]] constexpr TriangleFormat format_of(Accuracy accuracy) {
  if (accuracy == Accuracy::kPaper) return TriangleFormat::kProjection;
  if (accuracy == Accuracy::kCompact) return TriangleFormat::kLattice;
  return TriangleFormat::kVertices;
}

}  // namespace gridiron
