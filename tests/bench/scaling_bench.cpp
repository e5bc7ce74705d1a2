// Growth with the number of triangles: build work, memory, work of the kernel, cycles per ray on a simulated chip.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>

#include "bench/bench.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"

namespace gridiron::bench {
namespace {

constexpr double kTrianglesPerPixel = 4.0;
constexpr double kCyclesExponentLimit = 0.5;
constexpr double kLinearExponentLimit = 1.1;  // build and memory; above 1 for caches and rounding

struct Point {
  double triangles, build_seconds, memory_bytes, references, cycles_per_ray;
};

// Least-squares slope of log(value) over log(triangles).
template <class Value>
double exponent(const std::vector<Point>& points, Value value) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Point& p : points) {
    const double x = std::log(p.triangles);
    const double y = std::log(value(p));
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const auto n = static_cast<double>(points.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

const sim::MachineProfile& roomy_machine() {
  const sim::MachineProfile* best = &sim::machine_profiles().front();
  for (const sim::MachineProfile& machine : sim::machine_profiles()) {
    if (machine.main_memory_bytes > best->main_memory_bytes) best = &machine;
  }
  return *best;
}

// The largest lambda of 4, 2, 1 ... whose image and frame fit a machine's memory.
void print_fit(const MeshView& mesh, std::uint64_t frame_bytes, const sim::MachineProfile& machine) {
  for (float lambda = 4.0f; lambda >= 1.0f / 64; lambda *= 0.5f) {
    const GridParameters parameters{.lambda = lambda};
    GridNeed need;
    if (count_scene_image(mesh, parameters, need) != Status::kOk) break;
    if (need.image_bytes + frame_bytes > machine.main_memory_bytes) continue;
    std::printf("    %s (%.0f MB): lambda %g fits with %.1f MB\n", machine.name.data(),
                0x1p-20 * static_cast<double>(machine.main_memory_bytes), double{lambda},
                0x1p-20 * static_cast<double>(need.image_bytes + frame_bytes));
    return;
  }
  std::printf("    %s (%.0f MB): no lambda down to 1/64 fits\n", machine.name.data(),
              0x1p-20 * static_cast<double>(machine.main_memory_bytes));
}

bool measure(std::uint32_t cells, const sim::MachineProfile& machine, Point& point) {
  const test::TestMesh mesh = test::make_height_field(cells, 0.3f, 7);
  const auto width = static_cast<std::uint32_t>(
      std::lround(std::sqrt(static_cast<double>(mesh.triangles.size()) / kTrianglesPerPixel)));
  Status status = Status::kOk;
  const Candidate build[] = {{"build", [&] {
                                const test::SceneInMemory scene(mesh.view(), GridParameters{}, 1);
                                status = scene.status();
                              }}};
  const double build_seconds = least_seconds(build, 1)[0];
  if (status != Status::kOk) {
    std::printf("  %zu triangles: build status %u\n", mesh.triangles.size(), static_cast<unsigned>(status));
    return false;
  }

  test::SceneInMemory scene(mesh.view(), GridParameters{});
  const FrameSettings settings{
      .camera = {{0.3f, 1.2f, 1.9f}, {0, -0.1f, 0}, {0, 1, 0}, 0.5f}, .width = width, .height = width};
  const test::RenderedFrame rendered = scene.render(settings, {});
  if (rendered.result.status != Status::kOk) {
    std::printf("  %zu triangles: render status %u\n", mesh.triangles.size(),
                static_cast<unsigned>(rendered.result.status));
    return false;
  }
  const sim::FrameTiming timing = sim::replay(rendered.result.trace, machine, {});
  const double rays = static_cast<double>(width) * width;
  const auto per_ray = [&](WorkId kind) { return static_cast<double>(rendered.result.work[kind.number()]) / rays; };
  const GridNeed& need = scene.need();
  point = {static_cast<double>(mesh.triangles.size()), build_seconds,
           static_cast<double>(need.image_bytes + need.scratch_bytes), need.grid.reference_count * 1.0,
           timing.frame_cycles * static_cast<double>(timing.cores.size()) / rays};
  std::printf(
      "  %zu triangles, %ux%u: build %.1f ms (count, build, validate), image %.1f MB, scratch %.1f MB, "
      "%.2f references a triangle, grid %ux%ux%u\n"
      "    a ray: %.3f macro steps, %.3f cell steps, %.3f cell visits, %.3f set-ups, %.3f group tests, "
      "%.0f core cycles on %s\n",
      mesh.triangles.size(), width, width, 1e3 * build_seconds, 0x1p-20 * static_cast<double>(need.image_bytes),
      0x1p-20 * static_cast<double>(need.scratch_bytes), point.references / point.triangles, need.grid.cell_count[0],
      need.grid.cell_count[1], need.grid.cell_count[2], per_ray(GridWork::kMacroCellStep), per_ray(GridWork::kCellStep),
      per_ray(GridWork::kCellVisit), per_ray(Work::kTriangleSetup),
      per_ray(Work::kGroupTestStandard) + per_ray(Work::kRowTest), point.cycles_per_ray, machine.name.data());
  if (const sim::MachineProfile* small = sim::find_machine_profile("cell-ps3"); small != nullptr) {
    print_fit(mesh.view(), 3 * output_plane_bytes(width, width, rendered.frame.tile_width), *small);
  }
  return true;
}

bool bench_scaling(const BenchOptions& options) {
  const sim::MachineProfile& machine = roomy_machine();
  std::printf("height field, %g triangles a pixel, lambda 4, machine %s with %.0f MB\n", kTrianglesPerPixel,
              machine.name.data(), 0x1p-20 * static_cast<double>(machine.main_memory_bytes));
  std::vector<Point> points;
  for (const std::uint32_t cells : {224u, 707u, 1414u}) {
    if (options.quick && cells > 1000) continue;
    Point point;
    if (!measure(cells, machine, point)) return false;
    points.push_back(point);
  }
  bool within = true;
  const auto check = [&](const char* what, double value, double limit) {
    const bool holds = value < limit;
    within = within && holds;
    std::printf("  %s grows as n^%.3f (limit %.2f)%s\n", what, value, limit, holds ? "" : "  EXCEEDED");
  };
  check("build time", exponent(points, [](const Point& p) { return p.build_seconds; }), kLinearExponentLimit);
  check("memory (image and scratch)", exponent(points, [](const Point& p) { return p.memory_bytes; }),
        kLinearExponentLimit);
  check("references", exponent(points, [](const Point& p) { return p.references; }), kLinearExponentLimit);
  check("cycles per ray", exponent(points, [](const Point& p) { return p.cycles_per_ray; }), kCyclesExponentLimit);
  return within;
}

const Registration kRegistration("scaling", bench_scaling);

}  // namespace
}  // namespace gridiron::bench
