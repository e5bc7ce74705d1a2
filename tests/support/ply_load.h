// Loads a PLY file whole into a test mesh, by the library's own reader.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/test_mesh.h"

namespace gridiron::test {

/// @returns the mesh; nothing where the file cannot be read or the reader refuses it.
std::optional<TestMesh> load_ply(const std::filesystem::path& path);

}  // namespace gridiron::test
