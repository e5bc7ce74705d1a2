// The scans as the library's reader reads them, against words copied from the file.
// SPDX-License-Identifier: Apache-2.0
#include "support/ply_load.h"

#include "support/scenes.h"

namespace gridiron::test {
namespace {

static_assert(std::endian::native == std::endian::little, "little-endian words are copied as they are");

// Only the form of the scans: binary, little-endian, float x y z, triangles.
std::optional<TestMesh> copy_scan(const std::filesystem::path& path) {
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
  const char* cursor = bytes.data() + header_end + kEndOfHeader.size();
  for (std::size_t i = 0; i < vertex_count; ++i, cursor += kVertexBytes) {
    float p[3];
    std::memcpy(p, cursor, sizeof p);
    mesh.vertices.push_back({p[0], p[1], p[2]});
  }
  for (std::size_t i = 0; i < face_count; ++i, cursor += kFaceBytes) {
    std::uint32_t corners[3];
    if (*cursor != 3) return std::nullopt;
    std::memcpy(corners, cursor + 1, sizeof corners);
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  return mesh;
}

class PlyLoadTest : public testing::TestWithParam<const char*> {};

TEST_P(PlyLoadTest, EqualsTheFilesWords) {
  const SharedFile file = find_scene(std::string(GetParam()) + ".ply");
  GRIDIRON_SKIP_IF_MISSING(file);
  const auto read = load_ply(file.path);
  const auto copied = copy_scan(file.path);
  ASSERT_TRUE(read && copied);
  ASSERT_EQ(read->vertices.size(), copied->vertices.size());
  ASSERT_EQ(read->triangles.size(), copied->triangles.size());
  EXPECT_EQ(std::memcmp(read->vertices.data(), copied->vertices.data(), sizeof(Vec3) * read->vertices.size()), 0);
  EXPECT_EQ(std::memcmp(read->triangles.data(), copied->triangles.data(), sizeof(UVec3) * read->triangles.size()), 0);
}

INSTANTIATE_TEST_SUITE_P(Scans, PlyLoadTest,
                         testing::Values("bunny", "horse", "armadillo_standin_345944", "conference"),
                         [](const testing::TestParamInfo<const char*>& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace gridiron::test
