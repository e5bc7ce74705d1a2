// PNG files in bands: groups of rows that any thread or process encodes on its own.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "image_files.h"

namespace gridiron::tool {

/// Consecutive rows of a picture, and what their encoding takes from the rest of it.
struct PngRows {
  std::uint32_t width = 0;                    ///< pixels of a row, 1 to 2^28
  std::span<const std::uint32_t> rows = {};   ///< one row or more, pixels as in encode_png()
  std::span<const std::uint32_t> above = {};  ///< the row above them; empty: they are the picture's first
  bool is_last = false;                       ///< they are the picture's last
};

/// Encoded rows.
struct PngBand {
  std::vector<std::byte> bytes;  ///< an IDAT chunk, whole
  std::uint32_t adler = 1;       ///< Adler-32 of the filtered rows
  std::uint64_t raw_bytes = 0;   ///< of the filtered rows
};

/// @returns the rows of every band of encode_png() but the last, which may have fewer: about 1 MB, one row at least.
[[nodiscard]] std::uint32_t png_band_rows(std::uint32_t width);

/// @returns how many bands encode_png() makes. @param width, height  of the picture, above 0.
[[nodiscard]] std::uint32_t png_band_count(std::uint32_t width, std::uint32_t height);

/// @returns the rows of a band of encode_png(), borrowed. @param band  from 0, below png_band_count().
[[nodiscard]] PngRows png_rows_of_band(const Picture<std::uint32_t>& picture, std::uint32_t band);

/// Encodes rows; compressed if the build has libpng and its zlib (GRIDIRON_WITH_PNG).
/// Errors: std::bad_alloc; Failure (kBadInput) with zlib's reason.
[[nodiscard]] PngBand encode_png_band(const PngRows& rows);

/// Encodes bands 0 to count - 1. @param rows_of  called once for each, on any thread. @param threads  as encode_png().
[[nodiscard]] std::vector<PngBand> encode_png_bands(std::size_t count, std::uint32_t threads,
                                                    const std::function<PngRows(std::size_t band)>& rows_of);

/// The same as encode_png_band(), not compressed, as in a build with GRIDIRON_WITH_PNG=OFF. Errors: std::bad_alloc.
[[nodiscard]] PngBand encode_stored_png_band(const PngRows& rows);

/// @param bands  all of a picture, from the top, by one of the two encoders; freed one by one.
/// @returns the bytes of a PNG file, 8-bit RGBA.
[[nodiscard]] std::vector<std::byte> join_png_bands(std::uint32_t width, std::uint32_t height,
                                                    std::vector<PngBand> bands);

/// encode_png() as in a build with GRIDIRON_WITH_PNG=OFF: 4 bytes a pixel and some more a row.
[[nodiscard]] std::vector<std::byte> encode_stored_png(const Picture<std::uint32_t>& picture);

}  // namespace gridiron::tool
