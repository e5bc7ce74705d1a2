// Picture files: PNG for colour, PFM for one float per pixel.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace gridiron::tool {

/// A rectangle of pixels, row-major, first row on top.
template <class Pixel>
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<Pixel> pixels;
};

/// @param picture  RGBA8, 0xAABBGGRR in each word: bytes R, G, B, A.
/// @returns the bytes of a PNG file, 8-bit RGBA, compressed if the build has libpng (GRIDIRON_WITH_PNG). Errors:
/// Failure (kBadInput) with libpng's reason.
[[nodiscard]] std::vector<std::byte> encode_png(const Picture<std::uint32_t>& picture);

/// @returns the bytes of a PFM file: "Pf", little-endian floats, last row first as the format says.
[[nodiscard]] std::vector<std::byte> encode_pfm(const Picture<float>& picture);

/// @returns the bytes of a PFM file, "PF": red, green and blue of a picture as encode_png() takes it, from 0 to 1.
[[nodiscard]] std::vector<std::byte> encode_color_pfm(const Picture<std::uint32_t>& picture);

/// @returns the bytes of a picture in the format of the path's ending: PFM for .pfm, PNG for all others.
[[nodiscard]] std::vector<std::byte> encode_picture(const Picture<std::uint32_t>& picture,
                                                    const std::filesystem::path& path);

}  // namespace gridiron::tool
