// Frame set-up. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/frame_rules.h>
#include <gridiron/base/lanes.h>
#include <gridiron/frame/frame_setup.h>

#include <glm/geometric.hpp>

namespace gridiron {
namespace {

bool is_finite(double value) {
  return value - value == 0.0;
}

bool is_finite(const DVec3& v) {
  return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

// The built-in compiles to the square root instruction; glm::sqrt would call libm.
double length_of(const DVec3& v) {
  return __builtin_sqrt(glm::dot(v, v));
}

void store(float out[3], const DVec3& v) {
  out[0] = static_cast<float>(v.x);
  out[1] = static_cast<float>(v.y);
  out[2] = static_cast<float>(v.z);
}

bool is_multiple(MainAddress address, std::uint32_t step) {
  return address.value % step == 0;
}

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

// Fills the grid's part. Errors: of find_grid_fault; kBadFrame out of range.
Status add_grid(const FrameSettings& settings, const SceneImageView& image, MainAddress image_address,
                FrameRecord& frame) {
  frame.engine.grid = image.grid;
  frame.engine.macro_table_address = image_address.value + image.macro_table_offset_bytes;
  frame.engine.cell_blocks_address = image_address.value + image.cell_blocks_offset_bytes;
  frame.engine.triangles_address = image_address.value + image.triangles_offset_bytes;
  frame.engine.macro_depth = settings.macro_depth;
  frame.engine.triangle_depth = settings.triangle_depth;
  frame.engine.techniques = settings.techniques;
  GRIDIRON_TRY(find_grid_fault<AnyLayout>(frame).status);
  return stays_in_range(settings, image.grid) ? Status::kOk : Status::kBadFrame;
}

// Says where the tree lies.
void add_tree(const FrameSettings& settings, const SceneImageView& image, MainAddress image_address, FrameHead& head) {
  head.image_address = image_address.value;
  head.tree_address = image_address.value + image.tree_offset_bytes;
  head.fetch_depth = settings.fetch_depth;
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
  if (settings.tile_width == 0) return Status::kBadFrame;
  FrameHead made{};
  made.magic = kFrameMagic;
  made.version = kFrameVersion;
  made.width = settings.width;
  made.height = settings.height;
  made.tile_width = settings.tile_width;
  made.tiles_x = tiles_across(settings.width, settings.tile_width);
  made.tiles_y = tiles_across(settings.height, settings.tile_width);
  made.accuracy = static_cast<std::uint32_t>(settings.accuracy);
  made.shading = static_cast<std::uint32_t>(settings.shading);
  made.output_depth = settings.output_depth;
  made.background_rgba = settings.background_rgba;
  made.t_far = settings.t_far;
  made.color_address = settings.color.value;
  made.depth_address = settings.depth.value;
  made.id_address = settings.ids.value;
  GRIDIRON_TRY(find_picture_fault<AnyLayout>(made).status);
  if (!(settings.camera.tan_half_fov > 0.0f) || !is_finite(double{settings.camera.tan_half_fov})) {
    return Status::kBadFrame;
  }
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

  store(made.eye, DVec3(settings.camera.eye));
  store(made.corner, forward + left * right + top * up);
  store(made.step_x, pixel * right);
  store(made.step_y, -pixel * up);
  frame = made;
  return Status::kOk;
}

Status make_frame_record(const FrameSettings& settings, const SceneImageView& image, MainAddress image_address,
                         FrameRecord& frame) {
  FrameRecord made{};
  GRIDIRON_TRY(make_frame_head(settings, made));
  if (!is_multiple(image_address, kLineBytes)) return Status::kTransferAlignment;
  made.engine_id = static_cast<std::uint32_t>(settings.engine);
  if (settings.engine == EngineId::kGrid) {
    if (!image.has_grid) return Status::kUnsupportedImage;
    GRIDIRON_TRY(add_grid(settings, image, image_address, made));
  } else if (settings.engine != EngineId::kTree) {
    return Status::kUnsupportedFrame;
  } else {
    if (!image.has_tree || !reads_format(made.accuracy, image.tree.triangle_format)) return Status::kUnsupportedImage;
    add_tree(settings, image, image_address, made);
    GRIDIRON_TRY(find_tree_fault<AnyLayout>(made).status);
  }
  if (settings.shading == Shading::kScene) {
    if (!image.has_effects || !accuracy_traits(settings.accuracy).has_scene_shading) return Status::kUnsupportedImage;
    made.effects_address = image_address.value + image.effects_offset_bytes;
    add_tree(settings, image, image_address, made);
    GRIDIRON_TRY(find_scene_fault<AnyLayout>(made).status);
  }
  frame = made;
  return Status::kOk;
}

}  // namespace gridiron
