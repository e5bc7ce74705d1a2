// The camera files of the scans show what the framing rule and the reference views say.
// SPDX-License-Identifier: Apache-2.0
#include "support/ply_load.h"
#include "support/scenes.h"
#include "support/views.h"

namespace gridiron::test {
namespace {

std::map<std::string, std::vector<double>> read_camera(const std::string& name) {
  std::ifstream file(std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes" / (name + ".camera"));
  EXPECT_TRUE(file) << name;
  std::map<std::string, std::vector<double>> lines;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string key;
    if (!(words >> key)) continue;
    for (double value = 0; words >> value;) lines[key].push_back(value);
  }
  return lines;
}

void expect_camera(const std::string& name, const Camera& camera) {
  SCOPED_TRACE(name);
  const auto lines = read_camera(name);
  const auto expect_vector = [&](const char* key, const Vec3& expected) {
    ASSERT_EQ(lines.count(key), 1u) << key;
    ASSERT_EQ(lines.at(key).size(), 3u) << key;
    const double scale = std::fabs(expected.x) + std::fabs(expected.y) + std::fabs(expected.z);
    EXPECT_NEAR(lines.at(key)[0], static_cast<double>(expected.x), 1e-6 * scale + 1e-8) << key;
    EXPECT_NEAR(lines.at(key)[1], static_cast<double>(expected.y), 1e-6 * scale + 1e-8) << key;
    EXPECT_NEAR(lines.at(key)[2], static_cast<double>(expected.z), 1e-6 * scale + 1e-8) << key;
  };
  expect_vector("eye", camera.eye);
  expect_vector("at", camera.at);
  expect_vector("up", camera.up);
  ASSERT_EQ(lines.count("fov"), 1u);
  const double half_fov = lines.at("fov").at(0) * 3.14159265358979 / 360;
  EXPECT_NEAR(std::tan(half_fov), static_cast<double>(camera.tan_half_fov), 1e-6);
}

TEST(Cameras, ConferenceViewsAreTheReferenceOnes) {
  expect_camera("conference_1", *kConferenceView.camera);
  expect_camera("conference_2", *kConferenceView2.camera);
}

TEST(Cameras, FramedScansFollowTheFramingRule) {
  for (const auto& [name, file] : std::map<std::string, std::string>{
           {"bunny", "bunny.ply"}, {"horse", "horse.ply"}, {"armadillo", "armadillo_standin_345944.ply"}}) {
    const SharedFile scan = find_scene(file);
    GRIDIRON_SKIP_IF_MISSING(scan);
    const std::optional<TestMesh> mesh = load_ply(scan.path);
    ASSERT_TRUE(mesh) << scan.path;
    expect_camera(name, framed_camera(mesh->view()));
  }
}

}  // namespace
}  // namespace gridiron::test
