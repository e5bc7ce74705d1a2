// Frame set-up. SPDX-License-Identifier: Apache-2.0
#include <gridiron/frame/frame_setup.h>

#include <gridiron/base/lanes.h>

#include <glm/geometric.hpp>

namespace gridiron {
namespace {

bool is_finite(double value) { return value - value == 0.0; }

bool is_finite(const DVec3& v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }

// The built-in compiles to the square root instruction; glm::sqrt would call libm.
double length_of(const DVec3& v) { return __builtin_sqrt(glm::dot(v, v)); }

void store(float out[3], const DVec3& v) {
  out[0] = static_cast<float>(v.x);
  out[1] = static_cast<float>(v.y);
  out[2] = static_cast<float>(v.z);
}

bool is_multiple(MainAddress address, std::uint32_t step) { return address.value % step == 0; }

// Tiles in a store start at multiples of it, so both ends of their transfers are aligned and congruent.
static_assert(kPlaneAlignment % kPortableGranuleBytes == 0 && kPlaneAlignment % kPortableCongruenceBytes == 0);

bool are_planes_aligned(const FrameSettings& settings) {
  return is_multiple(settings.color, kPlaneAlignment) && is_multiple(settings.depth, kPlaneAlignment) &&
         is_multiple(settings.ids, kPlaneAlignment);
}

// Whether an eye is finite and within its limits.
bool is_in_space(const Vec3& eye) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(magnitude(eye[axis]) <= kCoordinateLimit)) return false;
  }
  return true;
}

// Whether the grid's traversal stays inside a float's range.
bool stays_in_range(const FrameSettings& settings, const GridRecord& grid) {
  const double aspect = static_cast<double>(settings.width) / settings.height;
  const double widest = 1.0 + settings.camera.tan_half_fov * (1.0 + aspect);
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = grid.cells_per_unit[axis];
    const double distance = magnitude(double{settings.camera.eye[axis]} - grid.minimum[axis]);
    if (!(distance * scale <= kCellSpaceLimit && widest * scale <= kCellDirectionLimit)) return false;
  }
  return true;
}

}  // namespace

std::uint64_t output_plane_bytes(std::uint32_t width, std::uint32_t height, std::uint32_t tile_width) {
  const std::uint64_t tiles_x = (std::uint64_t{width} + tile_width - 1) / tile_width;
  const std::uint64_t tiles_y = (std::uint64_t{height} + tile_width - 1) / tile_width;
  return tiles_x * tiles_y * tile_width * tile_width * sizeof(std::uint32_t);
}

std::uint64_t output_plane_index(std::uint32_t width, std::uint32_t tile_width, std::uint32_t x, std::uint32_t y) {
  const std::uint64_t tiles_x = (std::uint64_t{width} + tile_width - 1) / tile_width;
  const std::uint64_t tile = tiles_x * (y / tile_width) + x / tile_width;
  return (tile * tile_width + y % tile_width) * tile_width + x % tile_width;
}

Status make_frame_head(const FrameSettings& settings, FrameHead& frame) {
  const bool size_ok = settings.width >= 1 && settings.height >= 1 && settings.width <= kMaxPictureWidth &&
                       settings.height <= kMaxPictureWidth && settings.tile_width >= 1;
  if (!size_ok || !(settings.t_far > 0.0f) || !(settings.camera.tan_half_fov > 0.0f) ||
      !is_finite(double{settings.camera.tan_half_fov})) {
    return Status::kBadFrame;
  }
  if (settings.color.value == 0) return Status::kBadFrame;
  if (!are_planes_aligned(settings)) return Status::kTransferAlignment;

  // Orthonormal frame of the camera; double keeps the steps exact to a float ulp whatever the distance.
  const DVec3 forward_raw = DVec3(settings.camera.at) - DVec3(settings.camera.eye);
  const DVec3 forward = forward_raw / length_of(forward_raw);
  const DVec3 right_raw = glm::cross(forward, DVec3(settings.camera.up));
  const DVec3 right = right_raw / length_of(right_raw);
  const DVec3 up = glm::cross(right, forward);
  if (!is_in_space(settings.camera.eye) || !is_finite(right) || !is_finite(up)) return Status::kBadFrame;

  // Rays go through pixel centres; the image plane lies at distance 1.
  const double half_height = settings.camera.tan_half_fov;
  const double pixel = 2.0 * half_height / settings.height;
  const double left = -0.5 * pixel * settings.width + 0.5 * pixel;
  const double top = half_height - 0.5 * pixel;

  frame = FrameHead{};
  frame.magic = kFrameMagic;
  frame.version = kFrameVersion;
  frame.width = settings.width;
  frame.height = settings.height;
  frame.tile_width = settings.tile_width;
  frame.tiles_x = (settings.width + settings.tile_width - 1) / settings.tile_width;
  frame.tiles_y = (settings.height + settings.tile_width - 1) / settings.tile_width;
  frame.accuracy = static_cast<std::uint32_t>(settings.accuracy);
  frame.shading = static_cast<std::uint32_t>(settings.shading);
  frame.output_depth = settings.output_depth;
  frame.background_rgba = settings.background_rgba;
  frame.t_far = settings.t_far;
  store(frame.eye, DVec3(settings.camera.eye));
  store(frame.corner, forward + left * right + top * up);
  store(frame.step_x, pixel * right);
  store(frame.step_y, -pixel * up);
  frame.color_address = settings.color.value;
  frame.depth_address = settings.depth.value;
  frame.id_address = settings.ids.value;
  return Status::kOk;
}

Status make_frame_record(const FrameSettings& settings, const SceneImageView& image, MainAddress image_address,
                         FrameRecord& frame) {
  FrameRecord made{};
  GRIDIRON_TRY(make_frame_head(settings, made));
  if (!is_multiple(image_address, kLineBytes)) return Status::kTransferAlignment;
  if (image.grid.triangle_format != static_cast<std::uint32_t>(format_of(settings.accuracy))) {
    return Status::kUnsupportedImage;
  }
  if (!stays_in_range(settings, image.grid)) return Status::kBadFrame;
  if (settings.shading == Shading::kScene) {
    if (!image.has_effects || !accuracy_traits(settings.accuracy).has_scene_shading) return Status::kUnsupportedImage;
    if (settings.walk_depth < 1 || image_address.value == 0) return Status::kBadFrame;
    made.effects_address = image_address.value + image.effects_offset_bytes;
    made.image_address = image_address.value;
    made.walk_depth = settings.walk_depth;
  }
  made.engine_id = static_cast<std::uint32_t>(EngineId::kGrid);
  made.engine.grid = image.grid;
  made.engine.macro_table_address = image_address.value + image.macro_table_offset_bytes;
  made.engine.cell_blocks_address = image_address.value + image.cell_blocks_offset_bytes;
  made.engine.triangles_address = image_address.value + image.triangles_offset_bytes;
  made.engine.macro_depth = settings.macro_depth;
  made.engine.triangle_depth = settings.triangle_depth;
  made.engine.techniques = settings.techniques;
  frame = made;
  return Status::kOk;
}

}  // namespace gridiron
