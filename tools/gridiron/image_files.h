// Picture files: PNG for colour, PFM for one float per pixel.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gridiron::tool {

/// A rectangle of pixels, row-major, first row on top.
template <class Pixel>
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<Pixel> pixels;
};

/// @param picture  RGBA8, 0xAABBGGRR in each word: bytes R, G, B, A.
/// @returns the bytes of a PNG file, 8-bit RGBA. It is compressed where
///          the build has libpng (GRIDIRON_WITH_PNG). Errors: Failure (kBadInput) with libpng's reason.
[[nodiscard]] std::vector<std::byte> encode_png(const Picture<std::uint32_t>& picture);

/// @returns the bytes of a PFM file: "Pf", little-endian floats, last row first as the format says.
[[nodiscard]] std::vector<std::byte> encode_pfm(const Picture<float>& picture);

}  // namespace gridiron::tool
