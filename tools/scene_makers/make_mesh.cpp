// make_mesh: writes one of our own scenes, at any size, as binary PLY.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "files/interrupt.h"
#include "firmware/wave_mesh.h"
#include "scene_makers/mesh.h"
#include "scene_makers/shapes.h"

namespace {

using namespace gridiron::scene_makers;

constexpr std::uint32_t kMaxTriangles = 100'000'000;

// Segments of the largest teapot of at most `triangle_count` triangles.
std::uint32_t teapot_segments(std::uint32_t triangle_count) {
  std::uint32_t segments = 2;
  while (64 * (segments + 1) * (segments + 1) + 8 * (segments + 1) <= triangle_count) ++segments;
  return segments;
}

// The animated sheet that firmware makes on the device.
Mesh make_wave(std::uint32_t frame) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < gridiron::port::kWaveVertexCount; ++i) {
    const gridiron::Vec3 vertex = gridiron::port::wave_vertex(i, frame);
    mesh.add_vertex({vertex.x, vertex.y, vertex.z});
  }
  for (std::uint32_t i = 0; i < gridiron::port::kWaveTriangleCount; ++i) {
    const gridiron::UVec3 corners = gridiron::port::wave_triangle(i);
    mesh.triangles.push_back({corners.x, corners.y, corners.z});
  }
  return mesh;
}

}  // namespace

int main(int argument_count, char** arguments) {
  gridiron::tool::watch_for_interrupt();
  CLI::App app{"Makes a triangle mesh, closed but for the wave, and writes it as binary PLY."};
  std::string shape = "knot";
  std::string output;
  std::uint32_t triangle_count = 100'000;
  std::uint32_t frame = 0;
  app.add_option("--shape", shape, "knot: exactly --triangles (even); teapot, needles: at most so many; wave: 2048")
      ->check(CLI::IsMember({"knot", "teapot", "needles", "wave"}))
      ->capture_default_str();
  app.add_option("--triangles", triangle_count, "number of triangles")
      ->check(CLI::Range(kMinKnotTriangles, kMaxTriangles))
      ->capture_default_str();
  app.add_option("--frame", frame, "of the animated wave")->check(CLI::Range(0, 1 << 20))->capture_default_str();
  app.add_option("-o,--output", output, "PLY file to write")->required();
  try {
    app.parse(argument_count, arguments);
    if (shape == "knot" && triangle_count % 2 != 0) {
      throw CLI::ValidationError("--triangles", "a closed surface has an even number of triangles");
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  const Mesh mesh = shape == "teapot"    ? make_teapot(teapot_segments(triangle_count))
                    : shape == "wave"    ? make_wave(frame)
                    : shape == "needles" ? make_needles(triangle_count / 12 / 4 * 4)
                                         : make_torus_knot(triangle_count);
  const std::string reason = write_whole_file(output, ply_bytes(mesh, "made by make_mesh --shape " + shape));
  if (!reason.empty()) {
    std::fprintf(stderr, "%s\n", reason.c_str());
    return 1;
  }
  std::printf("%s: %zu vertices, %zu triangles\n", output.c_str(), mesh.vertices.size(), mesh.triangles.size());
  return 0;
}
