// PNG files without libpng: what encode_png writes in a build with GRIDIRON_WITH_PNG=OFF.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "image_files.h"

namespace gridiron::tool {

/// @param picture  as for encode_png.
/// @returns the bytes of a PNG file, 8-bit RGBA, not compressed: 4 bytes a pixel and some more a row.
[[nodiscard]] std::vector<std::byte> encode_stored_png(const Picture<std::uint32_t>& picture);

}  // namespace gridiron::tool
