// Loads a PLY file: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/ply_load.h"

#include <gridiron/io/ply_reader.h>

#include <iterator>

namespace gridiron::test {

std::optional<TestMesh> load_ply(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  std::span<const std::byte> rest = std::as_bytes(std::span(bytes));

  constexpr std::size_t kBatch = 4096;
  std::vector<Vec3> vertices(kBatch);
  std::vector<UVec3> triangles(kBatch);
  TestMesh mesh;
  PlyReader reader;
  reader.set_output({vertices, triangles});
  for (;;) {
    const PlyStep step = rest.empty() ? reader.finish() : reader.feed(rest);
    rest = rest.subspan(step.consumed_bytes);
    const auto count = static_cast<std::ptrdiff_t>(step.item_count);
    switch (step.event) {
      case PlyEvent::kVertices:
        mesh.vertices.insert(mesh.vertices.end(), vertices.begin(), vertices.begin() + count);
        break;
      case PlyEvent::kTriangles:
        mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.begin() + count);
        break;
      case PlyEvent::kNeedInput:
      case PlyEvent::kHeader:
        break;
      case PlyEvent::kEnd:
        return mesh;
      case PlyEvent::kError:
        return std::nullopt;
    }
  }
}

}  // namespace gridiron::test
