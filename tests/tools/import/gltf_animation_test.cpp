// Animations of glTF files: curves of their samplers, which of several, skins, morph targets.
// SPDX-License-Identifier: Apache-2.0
#include "gltf_writer.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using tool::ImportedModel;
using tool::ImportOptions;

// A triangle with its first corner at the origin, in node 0, and what a test adds.
class Moving {
 public:
  Moving() { position_ = writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3); }

  [[nodiscard]] std::string sampler(const std::vector<float>& times, const std::vector<float>& values,
                                    const std::string& curve, std::size_t components = 3) {
    const std::string types[] = {"SCALAR", "", "VEC3", "VEC4"};
    const std::size_t input = writer.add_floats(times, "SCALAR", 1);
    const std::size_t output = writer.add_floats(values, types[components - 1], components);
    return "{\"input\":" + std::to_string(input) + ",\"output\":" + std::to_string(output) +
           (curve.empty() ? "" : ",\"interpolation\":\"" + curve + "\"") + "}";
  }
  [[nodiscard]] static std::string animation(const std::string& samplers, const std::string& path = "translation",
                                             const std::string& name = "", int node = 0) {
    return "{" + (name.empty() ? "" : "\"name\":\"" + name + "\",") +
           "\"channels\":[{\"sampler\":0,\"target\":{\"node\":" + std::to_string(node) + ",\"path\":\"" + path +
           "\"}}],\"samplers\":[" + samplers + "]}";
  }
  [[nodiscard]] std::string text(const std::string& animations, const std::string& node = "\"mesh\":0",
                                 const std::string& primitive = "", const std::string& mesh = "") const {
    return writer.text("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{" + node + "}],\"meshes\":[{\"primitives\":[{" +
                       "\"attributes\":{\"POSITION\":" + std::to_string(position_) + "}" + primitive + "}]" + mesh +
                       "}]" + (animations.empty() ? "" : ",\"animations\":[" + animations + "]"));
  }

  GltfWriter writer;

 private:
  std::size_t position_ = 0;
};

ImportedModel at(const std::string& text, double moment, const std::string& animation = "") {
  return model_of("a.gltf", text, {.moment = moment, .animation = animation});
}

// Keys at 1, 2 and 4 seconds; moments are shares of 4 seconds.
TEST(GltfAnimation, CurvesAreThoseOfTheFile) {
  const std::vector<float> times = {1, 2, 4}, points = {0, 0, 0, 2, 0, 0, 2, 4, 0};
  Moving steps;
  const std::string step = steps.text(Moving::animation(steps.sampler(times, points, "STEP")));
  Moving lines;
  const std::string line = lines.text(Moving::animation(lines.sampler(times, points, "")));
  const struct {
    double second;
    Vec3 of_step, of_line;
  } cases[] = {{0.0, {0, 0, 0}, {0, 0, 0}},
               {1.5, {0, 0, 0}, {1, 0, 0}},
               {2.0, {2, 0, 0}, {2, 0, 0}},
               {3.0, {2, 0, 0}, {2, 2, 0}},
               {4.0, {2, 4, 0}, {2, 4, 0}}};
  for (const auto& each : cases) {
    SCOPED_TRACE(each.second);
    expect_corner(at(step, each.second / 4).mesh, 0, 0, each.of_step);
    expect_corner(at(line, each.second / 4).mesh, 0, 0, each.of_line);
  }
  EXPECT_EQ(at(step, 0).report.animations.at(0).seconds, 4.0);
}

// The last moment is that of the last key, whatever float it is.
TEST(GltfAnimation, TheLastKeyIsReached) {
  for (const float last : {0.3f, 0.7f, 1.1f, 2.9f, 0.033333335f}) {
    SCOPED_TRACE(last);
    Moving moving;
    const std::string text = moving.text(Moving::animation(moving.sampler({0, last}, {0, 0, 0, 6, 0, 0}, "STEP")));
    expect_corner(at(text, 1).mesh, 0, 0, Vec3(6, 0, 0));
  }
}

// A spline from 0 to 1 with slopes 3 and 0 at its ends, over 2 seconds: tangents count per second.
TEST(GltfAnimation, SplinesUseTheirTangents) {
  Moving moving;
  const std::vector<float> keys = {9, 9, 9, 0, 0, 0, 3, 0, 0, 0, 0, 0, 1, 0, 0, 9, 9, 9};
  const std::string text = moving.text(Moving::animation(moving.sampler({0, 2}, keys, "CUBICSPLINE")));
  const auto expected = [](double t) { return 2 * 3 * (t * t * t - 2 * t * t + t) + 3 * t * t - 2 * t * t * t; };
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    SCOPED_TRACE(t);
    expect_corner(at(text, t).mesh, 0, 0, Vec3(static_cast<float>(expected(t)), 0, 0));
  }
}

TEST(GltfAnimation, RotationsTakeTheShortArcAtConstantSpeed) {
  // From 0 to 90 degrees around z; the second quaternion has its other sign.
  Moving moving;
  const float half = std::sqrt(0.5f);
  const std::string text =
      moving.text(Moving::animation(moving.sampler({0, 1}, {0, 0, 0, 1, 0, 0, -half, -half}, "LINEAR", 4), "rotation"));
  for (const double t : {0.0, 0.25, 1.0}) {
    const auto angle = static_cast<float>(t * 3.14159265358979 / 2);
    expect_corner(at(text, t).mesh, 0, 1, Vec3(std::cos(angle), std::sin(angle), 0));
  }
}

TEST(GltfAnimation, RotationsMayBeIntegers) {
  Moving moving;
  const std::size_t times = moving.writer.add_floats({0, 1}, "SCALAR", 1);
  const std::vector<std::int16_t> turns = {0, 0, 0, 32767, 0, 0, 32767, 0};
  const std::size_t values = moving.writer.add(turns, kGltfShort, "VEC4", 2, ",\"normalized\":true");
  const std::string sampler = "{\"input\":" + std::to_string(times) + ",\"output\":" + std::to_string(values) + "}";
  const std::string text = moving.text(Moving::animation(sampler, "rotation"));
  expect_corner(at(text, 1).mesh, 0, 1, Vec3(-1, 0, 0));
}

// What the animation leaves alone stays as the node has it.
TEST(GltfAnimation, OtherPartsOfANodeStay) {
  Moving moving;
  const std::string text = moving.text(Moving::animation(moving.sampler({0, 1}, {0, 0, 0, 4, 0, 0}, "")),
                                       "\"mesh\":0,\"translation\":[7,7,7],\"scale\":[-2,2,2]");
  const tool::Mesh mesh = at(text, 0.5).mesh;
  expect_corner(mesh, 0, 0, Vec3(2, 0, 0));
  expect_corner(mesh, 0, 1, Vec3(2, 2, 0));  // mirrored, so its corners are in the other order
  expect_corner(mesh, 0, 2, Vec3(0, 0, 0));
}

TEST(GltfAnimation, OneOfSeveralIsChosen) {
  Moving moving;
  const std::string walk = Moving::animation(moving.sampler({0, 1}, {1, 0, 0, 1, 0, 0}, ""), "translation", "walk");
  const std::string run = Moving::animation(moving.sampler({0, 2}, {0, 5, 0, 0, 5, 0}, ""), "translation", "2");
  const std::string jump = Moving::animation(moving.sampler({0, 3}, {0, 0, 9, 0, 0, 9}, ""));
  const std::string text = moving.text(walk + "," + run + "," + jump);
  expect_corner(at(text, 0).mesh, 0, 0, Vec3(1, 0, 0));
  expect_corner(at(text, 0, "1").mesh, 0, 0, Vec3(1, 0, 0));
  expect_corner(at(text, 0, "walk").mesh, 0, 0, Vec3(1, 0, 0));
  expect_corner(at(text, 0, "2").mesh, 0, 0, Vec3(0, 5, 0));
  expect_corner(at(text, 0, "3").mesh, 0, 0, Vec3(0, 0, 9));
  const ImportedModel model = at(text, 0, "3");
  ASSERT_EQ(model.report.animations.size(), 3u);
  EXPECT_EQ(model.report.animations[1].name, "2");
  EXPECT_EQ(model.report.animations[2].seconds, 3.0);
  EXPECT_TRUE(ignores(model, "2 animations"));
  for (const char* wrong : {"0", "4", "Walk", "-1", "1.5"}) {
    const std::string reason = reason_of("a.gltf", text, {.moment = 0.0, .animation = wrong});
    EXPECT_NE(reason.find("a.gltf: has 3 animations, 1 'walk', 2 '2' and 3; none is '" + std::string(wrong) + "'"),
              std::string::npos)
        << reason;
  }
}

TEST(GltfAnimation, DamagedKeysAreReported) {
  const std::vector<float> points = {0, 0, 0, 4, 0, 0};
  const auto ignored = [&](const std::vector<float>& times, const std::string& curve) {
    Moving moving;
    return ignores(at(moving.text(Moving::animation(moving.sampler(times, points, curve))), 0.5),
                   "1 channel with damaged keys");
  };
  EXPECT_FALSE(ignored({0, 1}, ""));
  EXPECT_TRUE(ignored({1, 0}, ""));
  EXPECT_TRUE(ignored({0, std::nanf("")}, ""));
  EXPECT_TRUE(ignored({0}, ""));
  EXPECT_TRUE(ignored({0, 1}, "CUBICSPLINE"));
}

// Two nodes of one name: the animation moves the one that it names.
TEST(GltfAnimation, NodesAreToldByNumber) {
  Moving moving;
  const std::string animation = Moving::animation(moving.sampler({0, 1}, {5, 0, 0, 5, 0, 0}, ""), "translation", "", 1);
  const std::string nodes = "\"mesh\":0,\"name\":\"a\",\"children\":[1]},{\"mesh\":0,\"name\":\"a\"";
  const tool::Mesh mesh = at(moving.text(animation, nodes), 0).mesh;
  expect_corner(mesh, 0, 0, Vec3(0, 0, 0));
  expect_corner(mesh, 1, 0, Vec3(5, 0, 0));
}

// A skin of two joints of one name, weights as shares of 255.
TEST(GltfAnimation, SkinsFollowTheirJoints) {
  Moving moving;
  const std::vector<std::uint8_t> joints = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  const std::vector<std::uint8_t> weights = {127, 128, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0};
  const std::size_t joint_list = moving.writer.add(joints, kGltfUnsignedByte, "VEC4", 3);
  const std::size_t weight_list = moving.writer.add(weights, kGltfUnsignedByte, "VEC4", 3, ",\"normalized\":true");
  const std::vector<float> units = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const std::size_t binds = moving.writer.add(units, kGltfFloat, "MAT4", 2);
  const std::string nodes =
      "\"children\":[1,2,3]},{\"mesh\":0,\"skin\":0,\"translation\":[50,0,0]},{\"name\":\"j\"},"
      "{\"name\":\"j\",\"translation\":[0,0,10]";
  const std::string text = moving.writer.text(
      "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{" + nodes +
      "}],\"skins\":[{\"joints\":[2,3],\"inverseBindMatrices\":" + std::to_string(binds) +
      "}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":" + std::to_string(joint_list) +
      ",\"WEIGHTS_0\":" + std::to_string(weight_list) + "}}]}]");
  const tool::Mesh mesh = model_of("a.gltf", text).mesh;
  // The place of a skinned mesh's own node makes no difference.
  expect_corner(mesh, 0, 0, Vec3(0, 0, 10.0f * 128 / 255));
  expect_corner(mesh, 0, 1, Vec3(1, 0, 10));
  expect_corner(mesh, 0, 2, Vec3(0, 1, 0));
}

// Two targets that move along x and y.
struct Morphing : Moving {
  Morphing() {
    const std::size_t x = writer.add_floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3", 3);
    const std::size_t y = writer.add_floats({0, 1, 0, 0, 1, 0, 0, 1, 0}, "VEC3", 3);
    targets = ",\"targets\":[{\"POSITION\":" + std::to_string(x) + "},{\"POSITION\":" + std::to_string(y) + "}]";
  }
  std::string targets;
};

TEST(GltfAnimation, MorphTargetsHaveTheWeightsOfMeshOrNode) {
  const Morphing morphing;
  const auto first = [&](const std::string& node, const std::string& mesh) {
    return model_of("a.gltf", morphing.text("", node, morphing.targets, mesh)).mesh;
  };
  expect_corner(first("\"mesh\":0", ""), 0, 0, Vec3(0, 0, 0));
  expect_corner(first("\"mesh\":0", ",\"weights\":[0.5,2]"), 0, 0, Vec3(0.5f, 2, 0));
  expect_corner(first("\"mesh\":0,\"weights\":[-1,0.25]", ",\"weights\":[0.5,2]"), 0, 0, Vec3(-1, 0.25f, 0));
}

TEST(GltfAnimation, MorphTargetsMove) {
  Morphing lines;
  const std::string line = lines.text(Moving::animation(lines.sampler({0, 1}, {0, 0, -2, 4}, "", 1), "weights"),
                                      "\"mesh\":0", lines.targets, ",\"weights\":[9,9]");
  expect_corner(at(line, 0.5).mesh, 0, 0, Vec3(-1, 2, 0));
  expect_corner(model_of("a.gltf", line).mesh, 0, 0, Vec3(9, 9, 0));
  // Of each key the tangents before it, the weights, the tangents behind it, of both targets each.
  Morphing splines;
  const std::vector<float> keys = {0, 0, 0, 0, 3, 0, 0, 0, 1, 8, 0, 0};
  const std::string spline = splines.text(Moving::animation(splines.sampler({0, 1}, keys, "CUBICSPLINE", 1), "weights"),
                                          "\"mesh\":0", splines.targets);
  expect_corner(at(spline, 0.5).mesh, 0, 0, Vec3(0.875f, 4, 0));
  expect_corner(at(spline, 1).mesh, 0, 0, Vec3(1, 8, 0));
}

}  // namespace
}  // namespace gridiron::test
