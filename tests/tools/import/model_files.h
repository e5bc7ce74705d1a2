// Model files: one mesh as OBJ, STL and glTF, written by the tests themselves; and whole files from parts.
// Memory: strings. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/model_import.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// Reads a model as the program does. Errors: Failure.
tool::ImportedModel import_file(const std::filesystem::path& path, const tool::ImportOptions& options = {});

/// The same mesh with every coordinate a multiple of 1/64: all text formats have the same floats then.
TestMesh rounded(TestMesh mesh);

std::string obj_text(const TestMesh& mesh);
std::string stl_text(const TestMesh& mesh);
std::string stl_bytes(const TestMesh& mesh);

/// A glTF scene of one mesh.
struct GltfParts {
  std::string node = "\"mesh\":0";          ///< members of the mesh's node beside nothing else
  std::string material = "";                ///< members of material 0; empty: none
  std::string more = "";                    ///< members of the root, each with a comma before it
  std::vector<Vec3> normals{};              ///< of each vertex, or none
  std::vector<std::array<float, 2>> uvs{};  ///< of each vertex, or none
  std::vector<Vec3> colors{};               ///< of each vertex, or none
  std::string picture = "";                 ///< bytes of an image for material 0's texture 0, or none
  std::string buffer_uri = "";              ///< of buffer 0; empty: a data URI in text, none in a .glb
  std::string extra = "";                   ///< more bytes of the buffer, at extra_offset()
};

/// The buffer of a scene: positions, indices, normals, uvs, colours, picture.
std::string gltf_buffer(const TestMesh& mesh, const GltfParts& parts = {});
std::string gltf_text(const TestMesh& mesh, const GltfParts& parts = {});
std::string glb_bytes(const TestMesh& mesh, const GltfParts& parts = {});

/// A .glb file with any JSON and any buffer.
std::string glb_of(std::string json, std::string buffer);

/// A picture of sRGB bytes as a PNG file, first row on top.
std::string png_bytes(std::uint32_t width, std::uint32_t height,
                      const std::vector<std::array<std::uint8_t, 3>>& texels);

std::string base64(std::string_view bytes);

}  // namespace gridiron::test
