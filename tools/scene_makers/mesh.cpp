// PLY bytes of a mesh, and a file that appears completely or not at all.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#include "scene_makers/mesh.h"

#include <bit>
#include <string_view>

#include "base/failure.h"
#include "files/atomic_file.h"

namespace gridiron::scene_makers {
namespace {

void append_word(std::vector<char>& bytes, std::uint32_t word) {
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((word >> shift) & 0xFFu));
}

}  // namespace

std::vector<char> ply_bytes(const Mesh& mesh, const std::string& comment) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment " + comment + "\nelement vertex " +
      std::to_string(mesh.vertices.size()) + "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  std::vector<char> bytes(header.begin(), header.end());
  bytes.reserve(header.size() + 12 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (const Point& point : mesh.vertices) {
    for (const double coordinate : point) {
      append_word(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (const std::uint32_t index : triangle) append_word(bytes, index);
  }
  return bytes;
}

std::string write_whole_file(const std::string& path, const std::vector<char>& bytes) {
  try {
    tool::AtomicFile file(path);
    file.write(std::string_view(bytes.data(), bytes.size()));
    file.commit();
    return {};
  } catch (const tool::Failure& failure) {
    return failure.what();
  }
}

}  // namespace gridiron::scene_makers
