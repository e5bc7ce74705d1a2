// From a mesh to planes of pixels: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/render_mesh.h"

#include <gridiron/store/local_store.h>

#include "support/instrumented.h"
#include "support/views.h"

namespace gridiron::test {
namespace {

constexpr std::uint64_t kAlignmentSlackBytes = 16 * kLineBytes;

// Scratch memory of the builder: raw, since the builder writes before it reads.
struct Scratch {
  explicit Scratch(std::uint64_t count) : bytes(std::make_unique_for_overwrite<std::uint64_t[]>(count / 8 + 1)) {}
  std::unique_ptr<std::uint64_t[]> bytes;
};

// Copies a tile-major plane of 4-byte elements into rows.
template <class Element>
std::vector<Element> untile(const FrameRecord& frame, std::span<const std::byte> plane) {
  std::vector<Element> rows(std::size_t{frame.width} * frame.height);
  for (std::uint32_t y = 0; y < frame.height; ++y) {
    for (std::uint32_t x = 0; x < frame.width; ++x) {
      const std::uint64_t index = output_plane_index(frame.width, frame.tile_width, x, y);
      std::memcpy(&rows[std::size_t{y} * frame.width + x], plane.data() + index * sizeof(Element), sizeof(Element));
    }
  }
  return rows;
}

}  // namespace

TestMesh make_mixed_mesh() {
  TestMesh mesh = make_torus(60, 30, 1.0f, 0.35f);
  mesh.append(make_random_soup(800, 0.15f, 3));
  mesh.append(make_height_field(20, 0.2f, 4));
  mesh.append(make_triangle({-3, -0.5f, -3}, {3, -0.5f, -3}, {0, -0.4f, 3}));
  return mesh;
}

Camera framed_camera(const MeshView& mesh) {
  DVec3 low(mesh.vertices.front());
  DVec3 high = low;
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::fmin(low[axis], double{vertex[axis]});
      high[axis] = std::fmax(high[axis], double{vertex[axis]});
    }
  }
  const DVec3 center = (low + high) * 0.5;
  const DVec3 extent = high - low;
  const double diagonal = std::sqrt(extent.x * extent.x + extent.y * extent.y + extent.z * extent.z);
  const DVec3 toward_eye = DVec3(0.35, 0.25, 1.0) / std::sqrt(0.35 * 0.35 + 0.25 * 0.25 + 1.0);
  return {Vec3(center + 1.05 * diagonal * toward_eye), Vec3(center), {0, 1, 0}, kTanHalf45Degrees};
}

SceneInMemory::SceneInMemory(const MeshView& mesh, const GridParameters& parameters, std::uint64_t frame_bytes) {
  status_ = count_scene_image(mesh, parameters, need_);
  if (status_ != Status::kOk) return;
  memory_ = std::make_unique<sim::SimMemory>(need_.image_bytes + frame_bytes + kAlignmentSlackBytes);
  const auto image = memory_->allocate(need_.image_bytes);
  if (!image) {
    status_ = Status::kMemoryTooSmall;
    return;
  }
  const Scratch scratch(need_.scratch_bytes);
  status_ = build_scene_image(mesh, parameters, need_, image->bytes,
                              std::as_writable_bytes(std::span(scratch.bytes.get(), need_.scratch_bytes / 8 + 1)));
  if (status_ != Status::kOk) return;
  image_address_ = image->address;
  SceneImageError error;
  status_ = open_scene_image(image->bytes, view_, error);
}

PreparedFrame::PreparedFrame(sim::SimMemory* memory, const SceneImageView& image, MainAddress image_address,
                             FrameSettings settings, const sim::ChipOptions& chip, PlaneSet planes)
    : memory_(memory), mark_(memory->used_bytes()) {
  settings.tile_width = tile_width_of(settings, chip);
  const std::uint64_t plane_bytes = output_plane_bytes(settings.width, settings.height, settings.tile_width);
  const auto color = memory_->allocate(plane_bytes);
  const bool has_depth = planes == PlaneSet::kAll, has_ids = planes != PlaneSet::kColor;
  const auto depth = memory_->allocate(has_depth ? plane_bytes : kLineBytes);
  const auto ids = memory_->allocate(has_ids ? plane_bytes : kLineBytes);
  const auto record = memory_->allocate(sizeof(FrameRecord));
  if (!color || !depth || !ids || !record) {
    status_ = Status::kMemoryTooSmall;
    return;
  }
  color_ = color->bytes;
  settings.color = color->address;
  settings.depth = settings.ids = MainAddress{};
  if (has_depth) {
    depth_ = depth->bytes;
    settings.depth = depth->address;
  }
  if (has_ids) {
    ids_ = ids->bytes;
    settings.ids = ids->address;
  }
  clear_planes();
  status_ = make_frame_record(settings, image, image_address, record_);
  record_address_ = record->address;
  std::memcpy(record->bytes.data(), &record_, sizeof(FrameRecord));
}

PreparedFrame::~PreparedFrame() {
  memory_->release_to(mark_);
}

void PreparedFrame::set_record(const FrameRecord& record) {
  record_ = record;
  std::memcpy(memory_->bytes_at(record_address_, sizeof(FrameRecord)).data(), &record_, sizeof(FrameRecord));
}

sim::ChipResult PreparedFrame::render(const sim::ChipOptions& chip) {
  return render_in_test(*memory_, record_address_, chip);
}

void PreparedFrame::clear_planes() {
  for (const std::span<std::byte> plane : {color_, depth_, ids_}) {
    if (!plane.empty()) std::memset(plane.data(), 0xA5, plane.size());
  }
}

sim::ChipResult PreparedFrame::run_cores(const sim::ChipOptions& chip, std::uint32_t data_bytes,
                                         const sim::EngineWork& engine, const sim::CoreProgram& program) {
  clear_planes();
  sim::FrameShape shape(engine);
  shape.tile_count = record_.tiles_x * record_.tiles_y;
  shape.output_depth = record_.output_depth;
  shape.data_bytes = data_bytes;
  shape.is_picture = true;
  const std::uint64_t bytes = color_.size();
  for (const std::uint64_t plane : {record_.color_address, record_.depth_address, record_.id_address}) {
    if (plane != 0) shape.writable.push_back({plane, plane + bytes});
  }
  return sim::run_cores(*memory_, shape, chip, program);
}

Planes PreparedFrame::planes() const {
  Planes planes;
  planes.color = untile<std::uint32_t>(record_, color_);
  if (!depth_.empty()) planes.depth = untile<float>(record_, depth_);
  if (!ids_.empty()) planes.ids = untile<std::uint32_t>(record_, ids_);
  return planes;
}

PreparedFrame SceneInMemory::prepare(const FrameSettings& settings, const sim::ChipOptions& chip, PlaneSet planes) {
  return {memory_.get(), view_, image_address_, settings, chip, planes};
}

RenderedFrame SceneInMemory::render(const FrameSettings& settings, const sim::ChipOptions& chip, PlaneSet planes) {
  RenderedFrame rendered;
  PreparedFrame frame = prepare(settings, chip, planes);
  rendered.result.status = frame.status();
  rendered.frame = frame.record();
  if (frame.status() != Status::kOk) return rendered;
  rendered.result = frame.render(chip);
  if (rendered.result.status == Status::kOk) rendered.planes = frame.planes();
  return rendered;
}

std::uint32_t tile_width_of(const FrameSettings& settings, const sim::ChipOptions& chip) {
  const bool is_usual = settings.tile_width == FrameSettings{}.tile_width;
  return is_usual ? sim::usual_tile_width(chip.store) : settings.tile_width;
}

std::string first_difference(const RenderedFrame& a, const RenderedFrame& b) {
  std::ostringstream words;
  if (a.frame.width != b.frame.width || a.planes.color.size() != b.planes.color.size()) return "sizes differ";
  for (std::size_t i = 0; i < a.planes.color.size(); ++i) {
    const bool same =
        a.planes.ids[i] == b.planes.ids[i] && a.planes.color[i] == b.planes.color[i] &&
        std::bit_cast<std::uint32_t>(a.planes.depth[i]) == std::bit_cast<std::uint32_t>(b.planes.depth[i]);
    if (same) continue;
    words << "pixel (" << i % a.frame.width << ", " << i / a.frame.width << "): triangle " << a.planes.ids[i] << " or "
          << b.planes.ids[i] << ", depth " << std::hexfloat << a.planes.depth[i] << " or " << b.planes.depth[i]
          << ", colour " << std::hex << a.planes.color[i] << " or " << b.planes.color[i];
    return words.str();
  }
  return {};
}

}  // namespace gridiron::test
