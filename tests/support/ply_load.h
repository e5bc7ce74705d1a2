// Loads a PLY file whole into a test mesh.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "support/test_mesh.h"

namespace gridiron::test {

/// @returns the mesh of a binary little-endian PLY with float x y z first and triangles only; nothing where the file is
///          of another kind or cannot be read.
std::optional<TestMesh> load_ply(const std::filesystem::path& path);

}  // namespace gridiron::test
