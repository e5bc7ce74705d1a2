// Divided picture: a picture encoded by all ranks.
// Memory: on rank 0 the picture, sixteen bands of it for another rank, and the file. Threads: starts its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "files/image_files.h"

namespace gridiron::tool {

/// Of rank 0: encode_picture(), whose bands (png_file.h) are divided among the ranks.
/// @param threads  of this rank. Errors: those of encode_picture(), and of Ranks.
[[nodiscard]] std::vector<std::byte> encode_divided(const Picture<std::uint32_t>& picture,
                                                    const std::filesystem::path& path, std::uint32_t threads);

/// The part of another rank, which calls it when rank 0 calls encode_divided().
void encode_for_first(std::uint32_t threads);

}  // namespace gridiron::tool
