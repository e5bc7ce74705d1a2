// Target: a mesh in all the forms that rays can be shot at. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/accuracies.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/build/lattice.h>
#include <gridiron/ray/camera.h>
#include <gridiron/ray/intersect_projection.h>
#include <gridiron/ray/intersect_standard.h>

#include "core/ray/packet_cases.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {
namespace {

constexpr std::uint32_t kAllTechniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip | kUseSubpackets;
constexpr PipelineWay kPipelineWays[] = {
    {sim::Mode::kChecked, sim::StoreSize::k64KB, 8, 4, true, kUseMailbox | kUseCornerCulling | kUseEmptySkip},
    {sim::Mode::kPlain, sim::StoreSize::k256KB, 32, 16, false, kAllTechniques},
    {sim::Mode::kPlain, sim::StoreSize::k64KB, 16, 8, true, kAllTechniques},
    {sim::Mode::kChecked, sim::StoreSize::k64KB, 4, 4, false, kUseMailbox | kUseSubpackets},
    {sim::Mode::kPlain, sim::StoreSize::k256KB, 32, 4, true, kAllTechniques},
    {sim::Mode::kPlain, sim::StoreSize::k256KB, 8, 8, true, 0},
};

bool is_ray(const Vec3& origin, const Vec3& direction) {
  return std::isfinite(origin.x + origin.y + origin.z) && std::isfinite(direction.x + direction.y + direction.z) &&
         (direction.x != 0.0f || direction.y != 0.0f || direction.z != 0.0f);
}

}  // namespace

std::span<const PipelineWay> pipeline_ways() {
  return kPipelineWays;
}

// The triangles as the intersector takes them, in the three orders. `paper` and `fast` are promised triangles with an
// area: the builder drops the others.
struct Target::Records {
  std::vector<VertexTriangle> vertices[3];
  std::vector<ProjectionTriangle> projections[3];
};

struct Target::PixelFrame {
  const PipelineWay* way;
  PreparedFrame frame;
};

Target::Target(const TestMesh& mesh, const GridParameters& grid, const Profile& profile)
    : profile_(profile), mesh_(mesh), records_(std::make_unique<Records>()) {
  GridParameters parameters = grid;
  parameters.format = format_of(profile.accuracy);
  scene_ = std::make_unique<SceneInMemory>(mesh.view(), parameters, std::uint64_t{1} << 21);
  if (parameters.format == TriangleFormat::kLattice && status() == Status::kOk) {
    for (Vec3& vertex : mesh_.vertices) vertex = snap(scene_->need().grid.lattice, vertex);
  }
  TestRandom random(mesh_.triangles.size());
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const UVec3& t = mesh_.triangles[i];
    const Vec3 a = mesh_.vertices[t.x], b = mesh_.vertices[t.y], c = mesh_.vertices[t.z];
    const auto id = static_cast<std::uint32_t>(i);
    has_area_.push_back(!has_zero_area(a, b, c));
    if (!profile.is_exact && !has_area_.back()) continue;
    if (profile.accuracy == Accuracy::kPaper) {
      make_projection_triangle(a, b, c, id, records_->projections[0].emplace_back());
    } else {
      records_->vertices[0].push_back(vertex_triangle(a, b, c, id));
    }
  }
  const auto reorder = [&](auto* orders) {
    orders[1].assign(orders[0].rbegin(), orders[0].rend());
    orders[2] = orders[0];
    for (std::size_t i = orders[2].size(); i > 1; --i) {
      std::swap(orders[2][i - 1], orders[2][random.below(static_cast<std::uint32_t>(i))]);
    }
  };
  reorder(records_->vertices);
  reorder(records_->projections);
}

Target::~Target() {
  // Memory is given back from its end.
  while (!pixel_frames_.empty()) pixel_frames_.pop_back();
}

// --- The intersector alone ----------------------------------------------------------------------------------------

namespace {

// Traces rays as TileRenderer does: again where estimates left one unsure, one by one where ties are open.
template <class PacketType, class Trace>
void trace_rays(PacketType& packet, const RaySet<PacketType::kRayCount>& rays, float t_far, WorkCounters& work,
                Trace&& trace) {
  packet.active = rays;
  trace();
  RaySet<PacketType::kRayCount> unsure;
  if (!take_unsure_rays(packet, t_far, unsure, work)) return;
  packet.active = unsure;
  trace();
  if (!packet.breaks_ties || !take_unsure_rays(packet, t_far, unsure, work)) return;
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
    if (!unsure.contains(ray)) continue;
    packet.active.clear();
    packet.active.insert(ray);
    trace();
  }
}

template <class L, class PacketType>
void trace_all(PacketType& packet, const RaySet<PacketType::kRayCount>& rays, float t_far, bool is_picture,
               std::span<const VertexTriangle> vertices, std::span<const ProjectionTriangle> projections) {
  WorkCounters work;
  const Culling culling{.corner_rays = is_picture, .subpackets = is_picture};
  trace_rays(packet, rays, t_far, work, [&] {
    for (const ProjectionTriangle& triangle : projections) {
      (void)intersect_projection<L>(packet, triangle, PacketType::kAllSubpackets, is_picture, false, work);
    }
    for (std::size_t first = 0; first < vertices.size(); first += L::kCount) {
      const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(L::kCount, vertices.size() - first));
      OpenTriangle open[L::kCount];
      const std::uint32_t open_count =
          open_triangles<L>(packet, vertices.data() + first, count, PacketType::kAllSubpackets, culling, open, work);
      (void)intersect_standard_batch<L, false>(packet, open, open_count, culling, work);
    }
  });
}

// Any rays of one origin.
template <class L>
void trace_list(const Rays& rays, Accuracy accuracy, std::span<const VertexTriangle> vertices,
                std::span<const ProjectionTriangle> projections, std::vector<Answer>& answers) {
  using ListPacket = Packet<8>;
  for (std::size_t first = 0; first < rays.directions.size(); first += ListPacket::kRayCount) {
    const std::size_t count = std::min<std::size_t>(ListPacket::kRayCount, rays.directions.size() - first);
    ListPacket packet{};
    RaySet<ListPacket::kRayCount> present;
    present.clear();
    for (std::uint32_t ray = 0; ray < ListPacket::kRayCount; ++ray) {
      packet.t[ray] = rays.t_far;
      packet.id[ray] = kNoTriangle;
      if (ray >= count) continue;
      const Vec3& direction = rays.directions[first + ray];
      for (int axis = 0; axis < 3; ++axis) packet.dir[axis][ray] = direction[axis];
      // What is no ray joins no pass.
      if (is_ray(rays.origin, direction)) present.insert(ray);
    }
    for (int axis = 0; axis < 3; ++axis) packet.origin[axis] = rays.origin[axis];
    set_direction_bounds(packet);
    packet.breaks_ties = accuracy == Accuracy::kExact;
    packet.trusts_floats = accuracy == Accuracy::kFast;
    packet.ask_for_distances(!packet.trusts_floats);
    trace_all<L>(packet, present, rays.t_far, false, vertices, projections);
    for (std::uint32_t ray = 0; ray < count; ++ray) answers[first + ray] = {packet.id[ray], packet.t[ray]};
  }
}

// A picture, packet by packet.
template <class L, std::uint32_t Width>
void trace_picture(const Rays& rays, FrameRecord frame, std::span<const VertexTriangle> vertices,
                   std::span<const ProjectionTriangle> projections, std::vector<Answer>& answers) {
  using PicturePacket = Packet<Width>;
  auto packet = std::make_unique<PicturePacket>();
  WorkCounters work;
  bool is_picture = true;
  for (std::uint32_t top = 0; top < frame.height; top += Width) {
    for (std::uint32_t left = 0; left < frame.width; left += Width) {
      RaySet<PicturePacket::kRayCount> present;
      generate_packet<L>(frame, left, top, *packet, present, work);
      const auto index_of = [&](std::uint32_t ray) {
        return std::size_t{top + PicturePacket::row_of(ray)} * frame.width + left + PicturePacket::column_of(ray);
      };
      RaySet<PicturePacket::kRayCount> traced = present;
      for (std::uint32_t ray = 0; ray < PicturePacket::kRayCount; ++ray) {
        if (present.contains(ray) && !is_ray(rays.origin, rays.directions[index_of(ray)])) traced.erase(ray);
      }
      trace_all<L>(*packet, traced, frame.t_far, true, vertices, projections);
      for (std::uint32_t ray = 0; ray < PicturePacket::kRayCount; ++ray) {
        if (!present.contains(ray)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const float wanted = rays.directions[index_of(ray)][axis];
          is_picture = is_picture && (packet->dir[axis][ray] == wanted || std::isnan(wanted));
        }
        answers[index_of(ray)] = {packet->id[ray], packet->t[ray]};
      }
    }
  }
  EXPECT_TRUE(is_picture) << "the kernel's directions are others";
}

}  // namespace

std::vector<Answer> Target::by_intersector(const Rays& rays, const IntersectorWay& way) const {
  std::vector<Answer> answers(rays.directions.size());
  const std::span<const VertexTriangle> vertices = records_->vertices[static_cast<int>(way.order)];
  const std::span<const ProjectionTriangle> projections = records_->projections[static_cast<int>(way.order)];
  if (rays.columns == 0) {
    if (way.lanes == 4) trace_list<Lanes<4>>(rays, profile_.accuracy, vertices, projections, answers);
    if (way.lanes == 8) trace_list<Lanes<8>>(rays, profile_.accuracy, vertices, projections, answers);
    if (way.lanes == 16) trace_list<Lanes<16>>(rays, profile_.accuracy, vertices, projections, answers);
  } else {
    FrameRecord frame{};
    frame.width = rays.columns;
    frame.height = static_cast<std::uint32_t>(rays.directions.size()) / rays.columns;
    frame.accuracy = static_cast<std::uint32_t>(profile_.accuracy);
    frame.depth_address = 1;  // distances are wanted
    frame = aimed(frame, rays, pipeline_ways()[0]);
    const auto is_way = [&](std::uint32_t lanes, std::uint32_t width) {
      return way.lanes == lanes && way.packet_width == width;
    };
    if (is_way(4, 8)) trace_picture<Lanes<4>, 8>(rays, frame, vertices, projections, answers);
    if (is_way(8, 8)) trace_picture<Lanes<8>, 8>(rays, frame, vertices, projections, answers);
    if (is_way(8, 32)) trace_picture<Lanes<8>, 32>(rays, frame, vertices, projections, answers);
    if (is_way(16, 8)) trace_picture<Lanes<16>, 8>(rays, frame, vertices, projections, answers);
    if (is_way(16, 16)) trace_picture<Lanes<16>, 16>(rays, frame, vertices, projections, answers);
  }
  for (Answer& answer : answers) {
    if (answer.id == kNoTriangle) answer.t = kFloatMax;
  }
  return answers;
}

// --- All of the pipeline ------------------------------------------------------------------------------------------

FrameSettings Target::settings_of(const PipelineWay& way, std::uint32_t width, std::uint32_t height) const {
  // A camera that every grid takes; the rays are put in afterwards.
  const float* const m = grid().minimum;
  return {.camera = {.eye = {m[0], m[1], m[2]}, .at = {m[0], m[1], m[2] + std::fmax(std::fabs(m[2]), 1.0f)}},
          .width = width,
          .height = height,
          .accuracy = profile_.accuracy,
          .techniques = way.techniques};
}

FrameRecord Target::aimed(const FrameRecord& record, const Rays& rays, const PipelineWay& way) const {
  FrameRecord frame = record;
  for (int axis = 0; axis < 3; ++axis) {
    frame.eye[axis] = rays.origin[axis];
    frame.corner[axis] = rays.corner[axis];
    frame.step_x[axis] = rays.step_x[axis];
    frame.step_y[axis] = rays.step_y[axis];
  }
  frame.t_far = rays.t_far;
  if (!way.wants_distances) frame.depth_address = 0;
  return frame;
}

namespace {

sim::ChipOptions chip_of(const PipelineWay& way) {
  return {.mode = way.mode,
          .lanes = std::min(way.lanes, sim::widest_lanes()),
          .store = way.store,
          .packet_width = way.packet_width};
}

// C: as many steps as the counts of the grid allow.
void check_steps(const FrameRecord& frame, const PipelineWay& way, const sim::WorkTotals& work, bool only_rays) {
  const auto count = [&](WorkId kind) { return work[kind.number()]; };
  const std::uint64_t packets_across = (frame.tile_width + way.packet_width - 1) / way.packet_width;
  const std::uint64_t packets = packets_across * packets_across * frame.tiles_x * frame.tiles_y;
  const std::uint64_t rays = std::uint64_t{way.packet_width} * way.packet_width;
  const bool is_exact = frame.accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
  const std::uint64_t passes_each = (only_rays ? std::min<std::uint64_t>(6, rays) : rays) * 2 + (is_exact ? rays : 0);
  const std::uint64_t passes = count(GridWork::kPacketStart);
  const GridRecord& grid = frame.engine.grid;
  const std::uint32_t* const macro = grid.macro_cell_count;
  const std::uint64_t macro_cells = std::uint64_t{macro[0]} * macro[1] * macro[2];
  const std::uint64_t m = grid.macro_width;
  EXPECT_LE(passes, packets * passes_each);
  EXPECT_LE(count(GridWork::kMacroSliceStep), passes * std::max({macro[0], macro[1], macro[2]}));
  EXPECT_LE(count(GridWork::kMacroCellStep), passes * macro_cells);
  EXPECT_LE(count(GridWork::kMacroCellVisit), count(GridWork::kMacroCellStep));
  EXPECT_LE(count(GridWork::kSliceStep), count(GridWork::kMacroCellVisit) * m);
  const std::uint64_t cell_steps = count(GridWork::kCellStep) + count(GridWork::kCellBoundStep);
  EXPECT_LE(cell_steps, count(GridWork::kMacroCellVisit) * m * m * m);
  EXPECT_LE(count(GridWork::kCellVisit), cell_steps);
  EXPECT_LE(count(GridWork::kTriangleBatch), passes * grid.reference_count);
  EXPECT_LE(count(Work::kTriangleSetup), passes * grid.reference_count);
}

}  // namespace

void Target::render(PreparedFrame& frame, const PipelineWay& way, bool only_rays, sim::WorkTotals* work) {
  const sim::ChipResult result = frame.render(chip_of(way));
  ++frames_;
  EXPECT_EQ(result.status, Status::kOk) << profile_.name;
  EXPECT_TRUE(result.violations.empty()) << result.violations.front().detail;
  if (way.mode != sim::Mode::kChecked) return;
  check_steps(frame.record(), way, result.work, only_rays);
  if (work == nullptr) return;
  for (std::size_t i = 0; i < work->size(); ++i) (*work)[i] += result.work[i];
}

PreparedFrame& Target::pixel_frame(const PipelineWay& way) {
  for (const auto& known : pixel_frames_) {
    if (known->way == &way) return known->frame;
  }
  pixel_frames_.push_back(
      std::unique_ptr<PixelFrame>(new PixelFrame{&way, scene_->prepare(settings_of(way, 1, 1), chip_of(way))}));
  EXPECT_EQ(pixel_frames_.back()->frame.status(), Status::kOk) << profile_.name;
  return pixel_frames_.back()->frame;
}

std::vector<Answer> Target::by_pipeline(const Rays& rays, const PipelineWay& way, std::span<const std::size_t> only,
                                        sim::WorkTotals* work) {
  std::vector<Answer> answers;
  const auto take = [&](const PreparedFrame& frame) {
    const Planes planes = frame.planes();
    for (std::size_t i = 0; i < planes.ids.size(); ++i) {
      answers.push_back({planes.ids[i], way.wants_distances ? planes.depth[i] : 0.0f});
    }
  };
  const auto ray_at = [&](std::size_t i) { return is_ray(rays.origin, rays.directions[i]); };
  if (rays.columns != 0) {
    const auto rows = static_cast<std::uint32_t>(rays.directions.size()) / rays.columns;
    bool only_rays = true;
    for (std::size_t i = 0; i < rays.directions.size(); ++i) only_rays = only_rays && ray_at(i);
    PreparedFrame frame = scene_->prepare(settings_of(way, rays.columns, rows), chip_of(way));
    EXPECT_EQ(frame.status(), Status::kOk) << profile_.name;
    frame.set_record(aimed(frame.record(), rays, way));
    render(frame, way, only_rays, work);
    take(frame);
    return answers;
  }
  PreparedFrame& frame = pixel_frame(way);
  const FrameRecord untouched = frame.record();
  const std::size_t count = only.empty() ? rays.directions.size() : only.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t ray = only.empty() ? i : only[i];
    Rays one{rays.origin};
    one.corner = rays.directions[ray];
    one.t_far = rays.t_far;
    frame.set_record(aimed(untouched, one, way));
    render(frame, way, ray_at(ray), work);
    take(frame);
  }
  frame.set_record(untouched);
  return answers;
}

}  // namespace gridiron::test::hard
