// Loads a PLY file: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/ply_load.h"

#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace gridiron::test {

static_assert(std::endian::native == std::endian::little, "the loader copies little-endian words as they are");

std::optional<TestMesh> load_ply(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const std::string bytes(std::istreambuf_iterator<char>(file), {});

  constexpr std::string_view kEndOfHeader = "end_header\n";
  const std::size_t header_end = bytes.find(kEndOfHeader);
  if (header_end == std::string::npos) return std::nullopt;
  std::istringstream header(bytes.substr(0, header_end));
  std::size_t vertex_count = 0;
  std::size_t face_count = 0;
  bool little_endian = false;
  for (std::string line; std::getline(header, line);) {
    if (line == "format binary_little_endian 1.0") little_endian = true;
    if (line.starts_with("element vertex ")) vertex_count = std::stoul(line.substr(15));
    if (line.starts_with("element face ")) face_count = std::stoul(line.substr(13));
  }

  constexpr std::size_t kVertexBytes = 12;
  constexpr std::size_t kFaceBytes = 13;
  const std::size_t faces_begin = header_end + kEndOfHeader.size() + vertex_count * kVertexBytes;
  if (!little_endian || bytes.size() != faces_begin + face_count * kFaceBytes) return std::nullopt;

  TestMesh mesh;
  mesh.vertices.resize(vertex_count);
  mesh.triangles.resize(face_count);
  const char* cursor = bytes.data() + header_end + kEndOfHeader.size();
  for (Vec3& vertex : mesh.vertices) {
    float p[3];
    std::memcpy(p, cursor, sizeof p);
    vertex = {p[0], p[1], p[2]};
    cursor += kVertexBytes;
  }
  for (UVec3& triangle : mesh.triangles) {
    std::uint32_t corners[3];
    if (*cursor != 3) return std::nullopt;
    std::memcpy(corners, cursor + 1, sizeof corners);
    triangle = {corners[0], corners[1], corners[2]};
    cursor += kFaceBytes;
  }
  return mesh;
}

}  // namespace gridiron::test
