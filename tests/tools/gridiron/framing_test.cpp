// Framing: every model whole, centred and large, measured on its vertices and on small pictures.
// SPDX-License-Identifier: Apache-2.0
#include "gridiron/scene/framing.h"

#include <scene_makers/shapes.h>

#include <glm/geometric.hpp>

#include "gridiron/scene/scene_input.h"
#include "gridiron/scene/scene_points.h"
#include "gridiron/scene/view.h"
#include "support/render_mesh.h"
#include "support/scenes.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

struct Model {
  std::string name;
  TestMesh mesh;
};

struct Shape {
  const char* name;
  std::uint32_t width, height;

  [[nodiscard]] double aspect() const { return static_cast<double>(width) / height; }
};

constexpr float kFovs[] = {20.0f, 45.0f, 100.0f};
constexpr Shape kShapes[] = {{"1:1", 96, 96}, {"16:9", 128, 72}, {"9:21", 54, 126}};
const Vec3 kUps[] = {{0, 1, 0}, {0, 0, 1}};

// --- Models -------------------------------------------------------------------------------------------------------

TestMesh made(const scene_makers::Mesh& source) {
  TestMesh mesh;
  for (const auto& p : source.vertices) {
    mesh.vertices.emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  for (const auto& t : source.triangles) mesh.triangles.emplace_back(t[0], t[1], t[2]);
  return mesh;
}

TestMesh make_helix() {
  TestMesh mesh;
  for (int i = 0; i <= 300; ++i) {
    const float angle = 0.1f * static_cast<float>(i);
    for (const float lift : {0.0f, 0.2f}) {
      mesh.vertices.emplace_back(std::cos(angle), 0.02f * static_cast<float>(i) + lift, std::sin(angle));
    }
    const auto first = static_cast<std::uint32_t>(2 * i);
    if (i == 300) break;
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first + 1, first + 3, first + 2);
  }
  return mesh;
}

TestMesh make_stairs() {
  TestMesh mesh;
  for (int i = 0; i < 12; ++i) {
    const auto step = static_cast<float>(i);
    mesh.append(make_box({step, 0, 0}, {step + 1, step + 1, 5}));
  }
  return mesh;
}

std::vector<Model> generated_models() {
  const TestMesh cube = make_box(Vec3(-1), Vec3(1)), ball = make_sphere(16, 24, 1.0f);
  TestMesh with_stray = cube;  // a vertex that no triangle has, and a triangle without an area
  with_stray.vertices.insert(with_stray.vertices.end(), {Vec3(900), Vec3(50, 0, 0), Vec3(100, 0, 0), Vec3(150, 0, 0)});
  with_stray.triangles.emplace_back(9u, 10u, 11u);
  return {
      {"cube", cube},
      {"ball", ball},
      {"triangle", make_triangle({0, 0, 0}, {2, 0, 0}, {0, 1, 0})},
      {"edge on", make_triangle({0, 0, 0}, {0, 0, 7}, {0, 1, 3})},
      {"needle", make_triangle({0, 0, 0}, {100, 0.01f, 0}, {100, 0, 0.01f})},
      {"needle along the view", make_triangle({0, 0, 0}, {47.0f, 34.2f, 81.4f}, {47.1f, 34.2f, 81.4f})},
      {"sliver fan", make_sliver_fan(64, 1e-3f)},
      {"plane", make_box({-3, 0, -2}, {3, 0, 2})},
      {"wall", make_box({0, 0, -2}, {0, 5, 2})},
      {"rod x", make_box({0, 0, 0}, {50, 0.2f, 0.2f})},
      {"rod y", make_box({0, 0, 0}, {0.2f, 50, 0.2f})},
      {"rod z", make_box({0, 0, 0}, {0.2f, 0.2f, 50})},
      {"torus", make_torus(48, 24, 1.0f, 0.3f)},
      {"torus knot", made(scene_makers::make_torus_knot(6000))},
      {"helix", make_helix()},
      {"stairs", make_stairs()},
      {"L", joined(make_box({0, 0, 0}, {1, 8, 1}), make_box({0, 0, 0}, {5, 1, 1}))},
      {"deep L", joined(make_box({0, 0, 0}, {1, 8, 1}), make_box({0, 0, 0}, {1, 1, 9}))},
      {"terrain", make_height_field(40, 0.2f, 3)},
      {"random triangles", make_random_soup(800, 0.1f, 5)},
      {"two distant balls", joined(ball, moved(ball, 1.0f, {900, 40, -700}))},
      {"large and small ball", joined(ball, moved(ball, 0.01f, {3, 0, 6}))},
      {"tiny", moved(ball, 1e-30f)},
      {"least floats", moved(ball, 1e-41f)},
      {"huge", moved(ball, 1e30f)},
      {"large and off", moved(ball, 1e12f, {3e12f, -5e12f, 2e12f})},
      {"far off", moved(make_torus(48, 24, 1.0f, 0.3f), 100.0f, {1e6f, -1e6f, 1e6f})},
      {"so far off that floats are coarse", moved(make_stairs(), 1.0f, {1e6f, 2e6f, -1e6f})},
      {"stray points", with_stray},
  };
}

// Scenes of the repository, and those of GRIDIRON_SCENES where there are any.
std::vector<Model> scene_models(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    const bool is_late_frame = entry.path().stem().string().starts_with("frame_") && entry.path().stem() != "frame_010";
    if ((extension == ".ply" || extension == ".nff") && !is_late_frame) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<Model> models;
  for (const std::filesystem::path& file : files) {
    const tool::SceneInput input = tool::read_scene_input(file);
    const auto& mesh = std::get<tool::Mesh>(input.content);
    models.push_back({file.filename().string(), TestMesh{mesh.vertices, mesh.triangles}});
  }
  return models;
}

// --- Measures -----------------------------------------------------------------------------------------------------

// What a picture shows of some points, in half pictures from its middle: -1 is the left or lower edge.
struct Outline {
  double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
  bool is_in_front = true;

  [[nodiscard]] double fill() const { return std::max(right - left, high - low) / 2; }
  [[nodiscard]] double farthest() const { return std::max({-left, right, -low, high}); }
  [[nodiscard]] double shift() const { return std::max(std::abs(left + right), std::abs(low + high)) / 2; }
};

Outline outline_of(const Camera& camera, double aspect, const tool::PointSource& points) {
  const DVec3 eye(camera.eye), forward = glm::normalize(DVec3(camera.at) - eye);
  const DVec3 right = glm::normalize(glm::cross(forward, DVec3(camera.up))), up = glm::cross(right, forward);
  Outline outline;
  points([&](std::span<const Vec3> some) {
    for (const Vec3& point : some) {
      const DVec3 offset = DVec3(point) - eye;
      const double half = glm::dot(forward, offset) * static_cast<double>(camera.tan_half_fov);
      outline.is_in_front = outline.is_in_front && half > 0;
      const double x = glm::dot(right, offset) / (half * aspect), y = glm::dot(up, offset) / half;
      outline.left = std::min(outline.left, x);
      outline.right = std::max(outline.right, x);
      outline.low = std::min(outline.low, y);
      outline.high = std::max(outline.high, y);
    }
  });
  return outline;
}

tool::PointSource points_of(const TestMesh& mesh) {
  return [&mesh](const tool::PointVisitor& visitor) { tool::visit_points(mesh.view(), visitor); };
}

tool::ViewRequest request_of(float fov, Vec3 up) {
  tool::ViewRequest request;
  request.up = up;
  request.fov_degrees = fov;
  return request;
}

// The pixels that show something: borders of their box, and how many there are.
struct Seen {
  std::uint32_t left = ~0u, right = 0, top = ~0u, bottom = 0, count = 0;
};

Seen seen_in(SceneInMemory& scene, const Camera& camera, const Shape& shape) {
  FrameSettings settings;
  settings.camera = camera;
  settings.width = shape.width;
  settings.height = shape.height;
  sim::ChipOptions chip;
  chip.mode = sim::Mode::kPlain;
  const RenderedFrame frame = scene.render(settings, chip);
  EXPECT_EQ(frame.result.status, Status::kOk);
  Seen seen;
  if (frame.result.status != Status::kOk) return seen;
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    for (std::uint32_t x = 0; x < shape.width; ++x) {
      if (frame.planes.ids[frame.pixel_index(x, y)] == kNoTriangle) continue;
      seen.left = std::min(seen.left, x);
      seen.right = std::max(seen.right, x);
      seen.top = std::min(seen.top, y);
      seen.bottom = std::max(seen.bottom, y);
      ++seen.count;
    }
  }
  return seen;
}

// Pixel p is seen where its centre p + 0.5 lies in the outline: both ends are off by a pixel at most, where the model
// is not thinner than a pixel there.
void check_picture(const Seen& seen, const Outline& outline, const Shape& shape, bool is_solid) {
  const auto place = [](double half, std::uint32_t pixels) { return 0.5 * (half + 1) * pixels; };
  const double left = place(outline.left, shape.width), right = place(outline.right, shape.width);
  const double top = place(-outline.high, shape.height), bottom = place(-outline.low, shape.height);
  if (seen.count != 0) {
    EXPECT_GE(seen.left, 1u);
    EXPECT_GE(seen.top, 1u);
    EXPECT_LT(seen.right, shape.width - 1);
    EXPECT_LT(seen.bottom, shape.height - 1);
    EXPECT_GE(seen.left + 0.5, left - 0.01);
    EXPECT_LE(seen.right + 0.5, right + 0.01);
    EXPECT_GE(seen.top + 0.5, top - 0.01);
    EXPECT_LE(seen.bottom + 0.5, bottom + 0.01);
  }
  if (!is_solid) return;
  ASSERT_NE(seen.count, 0u);
  const double width = (seen.right + 1.0 - seen.left) / shape.width;
  const double height = (seen.bottom + 1.0 - seen.top) / shape.height;
  const double pixel = 2.0 / std::min(shape.width, shape.height);
  EXPECT_GE(std::max(width, height), 0.85 - pixel);
  EXPECT_LE(std::max(width, height), 0.95);
  EXPECT_NEAR(seen.left, shape.width - 1.0 - seen.right, 2.5);
  EXPECT_NEAR(seen.top, shape.height - 1.0 - seen.bottom, 2.5);
}

// Models that pixels may slip past: thin at an end, or coarse.
bool is_solid(const std::string& name) {
  for (const char* word : {"needle", "sliver", "edge on", "rod", "distant", "small ball", "random", "triangle", "least",
                           "conference", "sponza", "cornell", "stadium", "wall", "helix", "terrain", "multisampling"}) {
    if (name.find(word) != std::string::npos) return false;
  }
  return true;
}

// Models with a point in front of the rest. A wide view has to bring the eye up to it, and still shows the rest small.
bool has_near_point(const std::string& name) {
  return name == "edge on" || name == "needle along the view" || name == "sliver fan" || name == "large and small ball";
}

// Every model in every view by its vertices; in pictures one view of each, or with GRIDIRON_FRAMING_PICTURES all.
void check_models(const std::vector<Model>& models) {
  const bool wants_all = std::getenv("GRIDIRON_FRAMING_PICTURES") != nullptr;
  std::size_t next_picture = 0;
  for (const Model& model : models) {
    std::size_t view = 0;
    std::optional<SceneInMemory> scene;
    for (const float fov : kFovs) {
      for (const Shape& shape : kShapes) {
        for (const Vec3& up : kUps) {
          SCOPED_TRACE(model.name + ", fov " + std::to_string(fov) + ", shape " + shape.name +
                       (up.z > 0 ? ", up z" : ""));
          const Camera camera = tool::complete_view(request_of(fov, up), shape.aspect(), points_of(model.mesh));
          const Outline outline = outline_of(camera, shape.aspect(), points_of(model.mesh));
          // A step of the floats that the eye is made of may be a share of the model.
          const bool is_coarse = model.name.find("coarse") != std::string::npos;
          EXPECT_TRUE(outline.is_in_front);
          EXPECT_LE(outline.farthest(), is_coarse ? 0.97 : 0.902);
          if ((fov < 90.0f && model.name != "needle along the view") || !has_near_point(model.name)) {
            EXPECT_GE(outline.fill(), is_coarse ? 0.8 : 0.85);
          }
          EXPECT_LE(outline.shift(), 0.002) << "a pixel of 1,000";
          if (wants_all || view++ == next_picture % 18) {
            // Cells of the least floats would be too small for a grid; everything else has a picture.
            if (!scene) scene.emplace(model.mesh.view(), GridParameters{});
            ASSERT_EQ(scene->status(), Status::kOk);
            check_picture(seen_in(*scene, camera, shape), outline, shape, is_solid(model.name) && !is_coarse);
          }
          if (testing::Test::HasFatalFailure()) return;
        }
      }
    }
    next_picture += 5;
  }
}

TEST(Framing, GeneratedModelsAreWholeCentredAndLarge) {
  check_models(generated_models());
}

TEST(Framing, ScenesOfTheRepositoryAreWholeCentredAndLarge) {
  const std::vector<Model> models = scene_models(GRIDIRON_SCENE_FILES);
  EXPECT_GE(models.size(), 12u);
  check_models(models);
}

TEST(Framing, ScansAreWholeCentredAndLarge) {
  const SharedFile folder = find_scene("");
  GRIDIRON_SKIP_IF_MISSING(folder);
  check_models(scene_models(folder.path));
}

// --- Limits -------------------------------------------------------------------------------------------------------

TEST(Framing, AnyFieldOfViewAndShapeWillDo) {
  const TestMesh mesh = make_torus(48, 24, 1.0f, 0.3f);
  for (const float fov : {0.01f, 1.0f, 150.0f, 170.0f, 179.0f}) {
    for (const double aspect : {1.0 / 300, 0.1, 1.0, 10.0, 300.0}) {
      if (fov < 0.1f && aspect < 0.1) continue;  // narrower than the floats of a camera can resolve
      SCOPED_TRACE(std::to_string(fov) + " degrees, " + std::to_string(aspect));
      const Camera camera = tool::complete_view(request_of(fov, {0, 1, 0}), aspect, points_of(mesh));
      const Outline outline = outline_of(camera, aspect, points_of(mesh));
      EXPECT_TRUE(outline.is_in_front);
      EXPECT_LE(outline.farthest(), 0.96);
      EXPECT_LE(outline.shift(), 0.002);
      // Wide views bring the eye so near that it would touch the model: it keeps a thousandth of its size away.
      if (fov < 10.0f) {
        EXPECT_GE(outline.fill(), 0.85);
      }
    }
  }
}

TEST(Framing, APointHasASaneView) {
  for (const Vec3 place : {Vec3(0), Vec3(5, 6, 7), Vec3(1e6f)}) {
    const tool::PointSource point = [place](const tool::PointVisitor& visitor) { visitor({&place, 1}); };
    const Camera camera = tool::complete_view({}, 1.0, point);
    const Outline outline = outline_of(camera, 1.0, point);
    EXPECT_TRUE(outline.is_in_front);
    EXPECT_LE(outline.farthest(), 0.1);
  }
}

TEST(Framing, MovingAndScalingAModelMovesItsCamera) {
  const TestMesh mesh = make_stairs();
  const Camera camera = tool::complete_view({}, 1.5, points_of(mesh));
  const TestMesh other = moved(mesh, 4.0f, {64, -32, 16});
  const Camera moved_camera = tool::complete_view({}, 1.5, points_of(other));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(moved_camera.eye[axis], 4 * camera.eye[axis] + Vec3(64, -32, 16)[axis], 1e-3);
  }
}

// --- Directions ---------------------------------------------------------------------------------------------------

Camera camera_from(std::string_view side, Vec3 up) {
  const TestMesh mesh = make_sphere(16, 24, 1.0f);
  tool::ViewRequest request;
  request.from = tool::parse_view_angles(side);
  request.up = up;
  EXPECT_TRUE(request.from) << side;
  return tool::complete_view(request, 1.0, points_of(mesh));
}

TEST(Framing, SidesAreThoseOfUp) {
  const float r = 1 / std::sqrt(3.0f);
  const struct {
    const char* side;
    Vec3 up, back;
  } cases[] = {
      {"front", {0, 1, 0}, {0, 0, 1}},  {"back", {0, 1, 0}, {0, 0, -1}},   {"right", {0, 1, 0}, {1, 0, 0}},
      {"left", {0, 1, 0}, {-1, 0, 0}},  {"top", {0, 1, 0}, {0, 1, 0}},     {"bottom", {0, 1, 0}, {0, -1, 0}},
      {"iso", {0, 1, 0}, {r, r, r}},    {"90,0", {0, 1, 0}, {1, 0, 0}},    {"-450,0", {0, 1, 0}, {-1, 0, 0}},
      {"front", {0, 0, 1}, {0, -1, 0}}, {"right", {0, 0, 1}, {1, 0, 0}},   {"top", {0, 0, 5}, {0, 0, 1}},
      {"iso", {0, 0, 1}, {r, -r, r}},   {"front", {0, -1, 0}, {0, 0, -1}}, {"right", {0, -1, 0}, {1, 0, 0}},
      {"front", {0, 0, -1}, {0, 1, 0}}, {"front", {1, 0, 0}, {0, 0, 1}},   {"right", {1, 0, 0}, {0, -1, 0}},
  };
  for (const auto& tested : cases) {
    const Camera camera = camera_from(tested.side, tested.up);
    const DVec3 back = glm::normalize(DVec3(camera.eye) - DVec3(camera.at));
    EXPECT_LT(glm::length(back - DVec3(tested.back)), 1e-3) << tested.side << " " << &tested - cases;
    EXPECT_EQ(tool::view_defect(camera.eye, camera.at, camera.up), nullptr) << tested.side;
  }
  // From the top the front is below, as on a plan.
  const Camera top = camera_from("top", {0, 0, 1});
  EXPECT_GT(top.up.y, 0.99f);
}

TEST(Framing, ABoxShowsThreeFaces) {
  constexpr float kShare = 0.25f;  // distance of the eye beyond a face's plane, over half an edge
  const std::vector<Vec3> corners = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                     {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
  const tool::PointSource points = [&](const tool::PointVisitor& visit) { visit(corners); };
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.name);
    const Camera camera = tool::complete_view({}, shape.aspect(), points);
    EXPECT_GT(camera.eye.x, 1 + kShare);
    EXPECT_GT(camera.eye.y, 1 + kShare);
    EXPECT_GT(camera.eye.z, 1 + kShare);
  }
}

TEST(Framing, WordsOfDirections) {
  EXPECT_EQ(tool::parse_up("z"), Vec3(0, 0, 1));
  EXPECT_EQ(tool::parse_up("-x"), Vec3(-1, 0, 0));
  EXPECT_EQ(tool::parse_up("0,2,0"), Vec3(0, 2, 0));
  for (const char* text : {"", "-", "w", "xy", "--x", "+x", "0,1"}) EXPECT_FALSE(tool::parse_up(text)) << text;
  EXPECT_EQ(tool::parse_view_angles("20,-90"), (tool::ViewAngles{20, -90}));
  for (const char* text : {"", "up", "20", "20,91", "20,nan", "inf,0", "20,30,40", "Front", ","}) {
    EXPECT_FALSE(tool::parse_view_angles(text)) << text;
  }
}

// --- Parts of a view ----------------------------------------------------------------------------------------------

TEST(Framing, APointToLookAtStaysInTheMiddle) {
  const TestMesh mesh = make_torus(48, 24, 1.0f, 0.3f);
  for (const Vec3 at : {Vec3(0), Vec3(1, 0.5f, -0.5f), Vec3(0, 40, 0), Vec3(0, 0, 40)}) {
    tool::ViewRequest request;
    request.at = at;
    const Camera camera = tool::complete_view(request, 1.5, points_of(mesh));
    const Outline outline = outline_of(camera, 1.5, points_of(mesh));
    EXPECT_EQ(camera.at, at);
    EXPECT_TRUE(outline.is_in_front);
    EXPECT_LE(outline.farthest(), 0.901);
    if (at.z < 40) {
      EXPECT_GE(outline.farthest(), 0.899);
    }
  }
}

// The point may lie in front of the model, behind it or next to it, near or so far that floats are coarse there.
TEST(Framing, APointAnywhereIsInTheMiddleOfAPictureOfAll) {
  const TestMesh torus = make_torus(24, 12, 1.0f, 0.3f);
  for (const TestMesh& mesh : {torus, moved(torus, 10.0f, {1e6f, 2e6f, -1e6f})}) {
    for (std::uint32_t seed = 0; seed < 2000; ++seed) {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      const auto uniform = [&random] { return static_cast<float>(random() % 20001) / 10000 - 1; };
      const Vec3 direction(uniform(), uniform(), uniform());
      tool::ViewRequest request = request_of(kFovs[seed % 3], kUps[seed % 2]);
      request.at = mesh.vertices[0] + direction * std::pow(10.0f, 6 * uniform() + 5);
      request.from = tool::ViewAngles{180.0 * uniform(), seed % 7 == 0 ? 90.0 : 90.0 * uniform()};
      const double aspect = kShapes[seed % 5 % 3].aspect();
      const Camera camera = tool::complete_view(request, aspect, points_of(mesh));
      ASSERT_EQ(tool::view_defect(camera.eye, camera.at, camera.up), nullptr);
      EXPECT_EQ(camera.at, *request.at);
      const Outline outline = outline_of(camera, aspect, points_of(mesh));
      EXPECT_TRUE(outline.is_in_front);
      EXPECT_LE(outline.farthest(), 0.96);
      // The view is from the requested side.
      request.at.reset();
      const Camera centred = tool::complete_view(request, aspect, points_of(mesh));
      const DVec3 back = glm::normalize(DVec3(camera.eye) - DVec3(camera.at));
      EXPECT_GT(glm::dot(back, glm::normalize(DVec3(centred.eye) - DVec3(centred.at))), 0.99);
      if (HasFailure()) return;
    }
  }
}

TEST(Framing, AnEyeAloneLooksAtTheMiddleOfTheBounds) {
  const TestMesh mesh = make_box({1, 2, 3}, {5, 4, 9});
  tool::ViewRequest request;
  request.eye = Vec3(20, 0, 0);
  const Camera camera = tool::complete_view(request, 1.0, points_of(mesh));
  EXPECT_EQ(camera.eye, Vec3(20, 0, 0));
  EXPECT_EQ(camera.at, Vec3(3, 3, 6));
}

TEST(Framing, ASideReplacesEyeAndAtOfOthers) {
  tool::ViewRequest file;
  file.eye = Vec3(1, 2, 3);
  file.at = Vec3(0);
  file.up = Vec3(0, 0, 1);
  file.fov_degrees = 30.0f;
  tool::ViewRequest asked;
  asked.from = tool::ViewAngles{};
  const tool::ViewRequest view = tool::join_view(asked, file);
  EXPECT_FALSE(view.eye || view.at);
  EXPECT_EQ(view.up, file.up);
  EXPECT_EQ(view.fov_degrees, 30.0f);
  EXPECT_TRUE(view.from);
}

// --- Stored scenes ------------------------------------------------------------------------------------------------

// Vertices are stored as they are. On a lattice they move by half a step; of a projection they are computed again.
TEST(Framing, AStoredSceneIsFramedAsItsMesh) {
  std::vector<Model> models = generated_models();
  models.push_back({"needles", made(scene_makers::make_needles(512))});
  for (const Model& model : models) {
    const Camera expected = tool::complete_view({}, 1.5, points_of(model.mesh));
    for (const auto format : {TriangleFormat::kVertices, TriangleFormat::kProjection, TriangleFormat::kLattice}) {
      SCOPED_TRACE(model.name + ", format " + std::to_string(static_cast<int>(format)));
      GridParameters parameters;
      parameters.format = format;
      GridNeed need;
      if (count_scene_image(model.mesh.view(), parameters, need) != Status::kOk) {
        EXPECT_EQ(format, TriangleFormat::kLattice) << "there, a model may lose all of its area";
        continue;
      }
      const auto storage = std::make_unique<std::byte[]>(need.image_bytes + kLineBytes);
      void* place = storage.get();
      std::size_t room = need.image_bytes + kLineBytes;
      const std::span image(static_cast<std::byte*>(std::align(kLineBytes, need.image_bytes, place, room)),
                            need.image_bytes);
      std::vector<std::uint64_t> scratch(need.scratch_bytes / 8 + 1);
      ASSERT_EQ(
          build_scene_image(model.mesh.view(), parameters, need, image, std::as_writable_bytes(std::span(scratch))),
          Status::kOk);
      SceneImageView view;
      SceneImageError error;
      ASSERT_EQ(open_scene_image(image, view, error), Status::kOk);
      const tool::PointSource stored = [&](const tool::PointVisitor& visitor) {
        tool::visit_points(view, image, visitor);
      };
      const Camera camera = tool::complete_view({}, 1.5, stored);
      if (format == TriangleFormat::kVertices) {
        EXPECT_EQ(camera.eye, expected.eye);
        EXPECT_EQ(camera.at, expected.at);
        continue;
      }
      const Outline outline = outline_of(camera, 1.5, stored);
      EXPECT_LE(outline.farthest(), 0.97);
      const Outline true_outline = outline_of(camera, 1.5, points_of(model.mesh));
      const bool is_coarse = model.name.find("coarse") != std::string::npos || model.name == "least floats";
      if (!is_coarse && !has_near_point(model.name)) {
        EXPECT_NEAR(true_outline.farthest(), 0.9, 0.01);
      }
    }
  }
}

}  // namespace
}  // namespace gridiron::test
