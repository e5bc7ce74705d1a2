// Frames with five transfers pending: see the header. SPDX-License-Identifier: Apache-2.0
#include "protocol/order_scenes.h"

#include <stdexcept>

namespace gridiron::test {
namespace {

// Of the view that all frames have: half of what a picture one tile or pixel high sees at z = 0 from top to bottom.
constexpr float kHalfHeight = 3.0f * 0.41421356f;

OrderScene soup(std::uint32_t count, float size, std::uint64_t seed, float lambda) {
  OrderScene scene;
  scene.mesh = make_random_soup(count, size, seed);
  scene.lambda = lambda;
  return scene;
}

// In sight of the first tile of a row and of the last.
OrderScene wide(OrderScene scene) {
  scene.mesh.transform(4.0f, Vec3(0));
  return scene;
}

void add_triangle(OrderScene& scene, Vec3 a, Vec3 b, Vec3 c, std::uint16_t material) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), {a, b, c});
  scene.mesh.triangles.emplace_back(first, first + 1, first + 2);
  scene.triangle_materials.push_back(material);
}

// Materials of five colours: more than are kept at hand.
OrderScene with_materials() {
  OrderScene scene;
  scene.eye = {0, 0, 3};
  for (int i = 0; i < 5; ++i) {
    Material material;
    material.color = {0.2f * static_cast<float>(i), 0.5f, 1.0f - 0.2f * static_cast<float>(i)};
    material.kd = 0.5f;
    scene.materials.push_back(material);
  }
  return scene;
}

// A row of pixels, each of which shows a triangle of its own.
OrderScene strips(std::uint32_t pixels, bool are_smooth) {
  OrderScene scene = with_materials();
  scene.normals = {Vec3(0, 0, 1), Vec3(0.6f, 0, 0.8f), Vec3(0, 0.6f, 0.8f)};
  for (std::uint32_t i = 0; i < pixels; ++i) {
    const float middle = kHalfHeight * (2.0f * static_cast<float>(i) + 1.0f - static_cast<float>(pixels));
    const float half = 0.9f * kHalfHeight;
    add_triangle(scene, {middle - half, -half, 0}, {middle + half, -half, 0}, {middle, half, 0},
                 static_cast<std::uint16_t>(i % 5));
    if (are_smooth) scene.triangle_normals.emplace_back(0, 1, 2);
  }
  for (Material& material : scene.materials) material.smooth_normals = are_smooth;
  if (!are_smooth) scene.normals.clear();
  return scene;
}

// Triangles with one edge, a diagonal of the box that all of them fill: a ray that meets it meets the box of each leaf.
TestMesh in_one_box(std::uint32_t count) {
  TestMesh mesh;
  mesh.vertices = {{-2, -2, -2}, {2, 2, 2}};
  const TestMesh corners = make_random_soup(count, 0.1f, 5);
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.vertices.push_back(corners.vertices[3 * i]);
    mesh.triangles.emplace_back(0, 1, i + 2);
  }
  return mesh;
}

// Triangles in one plane, as near as floats tell, in more leaves than are kept at hand: what was hit before is fetched
// again to see what is in front.
OrderScene in_one_plane(std::uint32_t count) {
  OrderScene scene = soup(count, 1.2f, 3, 2.0f);
  for (Vec3& vertex : scene.mesh.vertices) vertex.z = 0.3f * vertex.x + 0.2f * vertex.y;
  return scene;
}

// A wall before the others, so that much of what is asked for ahead turns out to be hidden.
OrderScene behind_a_wall(OrderScene scene) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), {{-9, -9, 0.4f}, {9, -9, 0.4f}, {0, 12, 0.5f}});
  scene.mesh.triangles.emplace_back(first, first + 1, first + 2);
  return scene;
}

// Triangles one behind the other in sight of few pixels that five lights shine on.
OrderScene lit(const TestMesh& things) {
  OrderScene scene = with_materials();
  for (std::size_t i = 0; i < things.triangles.size(); ++i) {
    const auto corner = [&](int k) { return things.vertices[things.triangles[i][k]]; };
    add_triangle(scene, corner(0), corner(1), corner(2), static_cast<std::uint16_t>(i % 5));
  }
  for (int i = 0; i < 5; ++i) {
    const float place = static_cast<float>(i);
    scene.lights.push_back({.corner = {place - 2.0f, 1.5f - 0.3f * place, 4.0f}, .color = {0.3f, 0.3f, 0.3f}});
  }
  return scene;
}

// Rays that leave the scene, each for another part of its environment.
OrderScene open_air() {
  OrderScene scene = with_materials();
  add_triangle(scene, {0, 0, 8}, {0.1f, 0, 8}, {0, 0.1f, 8}, 0);
  for (int i = 0; i < 16 * 16; ++i) {
    scene.environment_face.emplace_back(static_cast<float>(i % 16) / 16, static_cast<float>(i / 16) / 16, 0.5f);
  }
  return scene;
}

// Strips of glass before the last of `tiles` tiles, half a tile high: each of its rays becomes two, too many for the
// queue in the store.
OrderScene glass(std::uint32_t tiles) {
  OrderScene scene = with_materials();
  for (Material& material : scene.materials) {
    material.kd = 0.1f;
    material.ks = 0.3f;
    material.transmittance = 0.6f;
    material.index = 1.5f;
  }
  const float right = 2.0f * kHalfHeight * static_cast<float>(tiles);
  const float left = right - 4.0f * kHalfHeight;
  for (int i = 0; i < 8; ++i) {
    const float x = left + (right - left) * (static_cast<float>(i) + 0.01f) / 8;
    const float next = left + (right - left) * (static_cast<float>(i) + 0.99f) / 8;
    add_triangle(scene, {x, -4, 0}, {next, -4, 0}, {0.5f * (x + next), 40, 0}, static_cast<std::uint16_t>(i % 5));
  }
  scene.recursion_depth = 2;
  return scene;
}

}  // namespace

std::vector<OrderCase> order_cases() {
  std::vector<OrderCase> cases;
  // Packets.
  cases.push_back({"triangles_at_5", soup(10, 0.2f, 1, 0.3f), {.triangle_depth = 5}, {"rrrrr"}});
  cases.push_back({"triangles", soup(6, 0.4f, 1, 2.0f), {.macro_depth = 2, .triangle_depth = 4}, {"brrrr"}});
  cases.push_back({"both_rings", soup(4, 0.2f, 12, 8.0f), {.macro_depth = 3, .triangle_depth = 3}, {"bbrrr"}});
  cases.push_back({"blocks", soup(4, 0.4f, 2, 8.0f), {.macro_depth = 4, .triangle_depth = 2}, {"bbbrr"}});
  cases.push_back({"blocks_at_5", soup(6, 0.4f, 2, 8.0f), {.macro_depth = 5, .triangle_depth = 1}, {"bbbbb", "bbbbr"}});
  cases.push_back({"queue_of_5", soup(4, 0.8f, 11, 8.0f),
                   {.macro_depth = 4, .triangle_depth = 4, .queue_depth = 5}, {"bbbrr", "bbrrr", "brrrr"}});
  cases.push_back({"tiles", wide(soup(14, 0.6f, 7, 2.0f)),
                   {.width = 40, .output_depth = 4, .macro_depth = 2, .triangle_depth = 1}, {"bbttt", "brttt"}});
  // Tiles through the tree, two of which take turns; and while the last ones leave.
  cases.push_back({"turns", soup(40, 0.8f, 3, 2.0f),
                   {.width = 16, .height = 8, .fetch_depth = 4, .queue_depth = 5, .engine = EngineId::kTree},
                   {"bbbrr", "brrrr", "rrrrr"}});
  cases.push_back({"tiles_of_tree", wide(soup(14, 0.6f, 7, 2.0f)),
                   {.width = 80, .height = 16, .output_depth = 3, .fetch_depth = 1, .engine = EngineId::kTree},
                   {"rrrtt"}});
  cases.push_back({"one_plane", in_one_plane(40),
                   {.width = 16, .height = 8, .fetch_depth = 4, .queue_depth = 5, .engine = EngineId::kTree},
                   {"bbrrr", "mrrrr"}});
  cases.push_back({"hidden", behind_a_wall(soup(60, 0.4f, 7, 2.0f)),
                   {.width = 16, .height = 8, .fetch_depth = 4, .queue_depth = 5, .engine = EngineId::kTree},
                   {"bbbrr"}});
  // Effects: everything by lists. A root with leaves alone has five of them under way; below a root with nodes, it is
  // the queue that has no room for more.
  cases.push_back({"leaves", lit(in_one_box(12)), {.width = 2, .height = 1, .fetch_depth = 5}, {"rrrrr"}});
  cases.push_back({"nodes", lit(make_random_soup(70, 1.2f, 5)),
                   {.width = 2, .height = 1, .fetch_depth = 4, .queue_depth = 5}, {"bbbrr", "bbrrr"}});
  cases.push_back({"surfaces", strips(6, false), {.width = 6, .height = 1, .fetch_depth = 5}, {"ggggg", "ggggm"}});
  cases.push_back({"normals", strips(6, true), {.width = 6, .height = 1, .fetch_depth = 5}, {"ggggg", "ggggm"}});
  // Records across a boundary take two commands, so that it is the queue that has no room for more.
  cases.push_back({"environment", open_air(),
                   {.width = 6, .height = 1, .fetch_depth = 5, .queue_depth = 5}, {"ggggg"}});
  cases.push_back({"spilling", glass(1), {.width = 8, .height = 4, .fetch_depth = 5}, {"ggggs"}});
  cases.push_back({"spilled_back", glass(5), {.width = 40, .height = 4, .output_depth = 5}, {"stttt"}});
  return cases;
}

OrderCase order_case(std::string_view name) {
  for (OrderCase& one : order_cases()) {
    if (one.name == name) return std::move(one);
  }
  throw std::runtime_error("no case " + std::string(name));
}

}  // namespace gridiron::test
