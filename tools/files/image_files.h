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
/// @param threads  of the host that share the work, the caller's included, or as many as it can start; the bytes are
///                 the same for any number.
/// @returns the bytes of a PNG file, 8-bit RGBA, compressed if the build has libpng (GRIDIRON_WITH_PNG). png_file.h
/// encodes parts of a picture. Errors: std::bad_alloc; Failure (kBadInput) with zlib's reason.
[[nodiscard]] std::vector<std::byte> encode_png(const Picture<std::uint32_t>& picture, std::uint32_t threads = 1);

/// @returns the bytes of a PFM file: "Pf", little-endian floats, last row first as the format says.
[[nodiscard]] std::vector<std::byte> encode_pfm(const Picture<float>& picture);

/// @returns the bytes of a PFM file, "PF": red, green and blue of a picture as encode_png() takes it, from 0 to 1.
[[nodiscard]] std::vector<std::byte> encode_color_pfm(const Picture<std::uint32_t>& picture);

/// @returns the bytes of a picture in the format of the path's ending: PFM for .pfm, PNG for all others.
/// @param threads  as for encode_png().
[[nodiscard]] std::vector<std::byte> encode_picture(const Picture<std::uint32_t>& picture,
                                                    const std::filesystem::path& path, std::uint32_t threads = 1);

}  // namespace gridiron::tool
