// Implements gridiron/c/gridiron.h over the kernel for one layout: each firmware compiles this file for its own, by the
// definitions below or by gridiron_c_library() of CMake.
// Memory: caller's; no heap, no exceptions. Threads: one core per store. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/base/one_lane.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/c/gridiron.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/platform/transfer_rules.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>

// GRIDIRON_LAYOUT         the layout's type, such as StoreLayout256K<8>; names of namespace gridiron need no prefix.
// GRIDIRON_LAYOUT_HEADER  a header that is included for it, "my_layout.h" or <...>; may be left out.
// GRIDIRON_LANES          4, 8 or 16; 1 for layouts without packets on cores without vectors.
// GRIDIRON_QUEUE_DEPTH    commands that the port holds; 1 is legal. Default 16.
// GRIDIRON_IMAGE_BUDGETS  also defines the symbols that image_budgets.ld compares.
#ifdef GRIDIRON_LAYOUT_HEADER
#include GRIDIRON_LAYOUT_HEADER
#endif
#ifdef GRIDIRON_IMAGE_BUDGETS
#include "image_budgets.h"
#endif
#if !defined(GRIDIRON_LAYOUT) || !defined(GRIDIRON_LANES)
#error "define GRIDIRON_LAYOUT and GRIDIRON_LANES, or use gridiron_c_library() of CMake"
#endif
#ifndef GRIDIRON_QUEUE_DEPTH
#define GRIDIRON_QUEUE_DEPTH 16
#endif

namespace gridiron {
namespace {

using CLayout = GRIDIRON_LAYOUT;
using CStore = LocalStore<CLayout>;
using CLanes = Lanes<GRIDIRON_LANES>;
static_assert(kFitsArena<CLayout>, "store, code and stack are more than the layout's memory");
constexpr bool kHasGrid = CLayout::Engine::kId == static_cast<std::uint32_t>(EngineId::kGrid);
constexpr std::uint32_t kQueueDepth = GRIDIRON_QUEUE_DEPTH;
static_assert(kQueueDepth >= 1);

// The header's numbers are core's.
static_assert(kGridironBadEffects == static_cast<int>(Status::kBadEffects) &&
              kGridironBadFrame == static_cast<int>(Status::kBadFrame) &&
              kGridironMissingEffect == static_cast<int>(Status::kMissingEffect) &&
              kGridironBadParameter == static_cast<int>(Status::kBadParameter));
static_assert(kGridironLineBytes == kLineBytes && kGridironPlaneAlignment == kPlaneAlignment &&
              kGridironSpillAlignment == kSpillAlignment && kGridironTagCount == PlatformLimits{}.tag_count);
static_assert(kGridironTransferGranuleBytes == kPortableGranuleBytes &&
              kGridironTransferCongruenceBytes == kPortableCongruenceBytes &&
              kGridironTransferMostBytes == kPortableMaxTransferBytes &&
              kGridironTransferEdgeBytes == kPortableBoundaryBytes);
static_assert(kGridironFormatLattice == static_cast<int>(TriangleFormat::kLattice) &&
              kGridironFormatProjection == static_cast<int>(TriangleFormat::kProjection) &&
              kGridironFormatVertices == static_cast<int>(TriangleFormat::kVertices));
static_assert(kGridironAccuracyCompact == static_cast<int>(Accuracy::kCompact) &&
              kGridironAccuracyFast == static_cast<int>(Accuracy::kFast) &&
              kGridironAccuracyExact == static_cast<int>(Accuracy::kExact) &&
              kGridironAccuracyPaper == static_cast<int>(Accuracy::kPaper) &&
              kGridironShadingScene == static_cast<int>(Shading::kScene));
static_assert(sizeof(Vec3) == 3 * sizeof(float) && sizeof(UVec3) == 3 * sizeof(std::uint32_t));

constexpr GridironStatus to_c(Status status) {
  return static_cast<GridironStatus>(status);
}

// A number that is no Status counts as a failed transfer; cut off, it could be kOk.
Status from_c(GridironStatus status) {
  const auto number = static_cast<unsigned>(status);
  return number <= static_cast<unsigned>(Status::kBadEffects) ? static_cast<Status>(number) : Status::kTransferFailed;
}

// The firmware's functions as a platform.
class CPort {
 public:
  explicit CPort(std::uint32_t core) : core_(core) {}

  [[nodiscard]] PlatformLimits limits() const {
    PlatformLimits limits;
    limits.max_transfer_bytes = kPortableMaxTransferBytes;
    limits.queue_depth = kQueueDepth;
    return limits;
  }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return from_c(gridiron_dma_get(core_, local, address.value, bytes, tag.index));
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return from_c(gridiron_dma_put(core_, local, address.value, bytes, tag.index));
  }
  Status wait(TagMask tags) { return from_c(gridiron_dma_wait(core_, tags.bits)); }
  ItemClaim claim_item() {
    std::uint32_t item = 0;
    switch (gridiron_claim_item(core_, &item)) {
      case kGridironClaimItem:
        return {ItemClaim::Kind::kItem, item};
      case kGridironClaimAborted:
        return {ItemClaim::Kind::kAborted, 0};
      case kGridironClaimDeadline:
        return {ItemClaim::Kind::kDeadline, 0};
      case kGridironClaimNone:
        break;
    }
    return {ItemClaim::Kind::kNone, 0};
  }

 private:
  std::uint32_t core_;
};
static_assert(Platform<CPort>);

bool is_aligned(const void* place, std::size_t step) {
  return reinterpret_cast<std::uintptr_t>(place) % step == 0;
}

// Core's objects are kept in the words of C's, byte by byte.
template <class Kept, class Words>
void keep(const Kept& kept, Words& words) {
  static_assert(std::is_trivially_copyable_v<Kept> && sizeof(Kept) <= sizeof(Words));
  std::memcpy(&words, &kept, sizeof kept);
}
template <class Kept, class Words>
Kept kept_in(const Words& words) {
  static_assert(std::is_trivially_copyable_v<Kept> && sizeof(Kept) <= sizeof(Words));
  Kept kept;
  std::memcpy(&kept, &words, sizeof kept);
  return kept;
}

MeshView view_of_mesh(const GridironMesh& mesh) {
  return {{reinterpret_cast<const Vec3*>(mesh.vertices), mesh.vertex_count},
          {reinterpret_cast<const UVec3*>(mesh.indices), mesh.triangle_count}};
}

bool has_arrays(const GridironMesh* mesh) {
  return mesh != nullptr && (mesh->vertex_count == 0 || mesh->vertices != nullptr) &&
         (mesh->triangle_count == 0 || mesh->indices != nullptr);
}

GridParameters parameters_of(const GridironBuild& build) {
  return {.lambda = build.lambda,
          .macro_width = build.macro_width,
          .format = static_cast<TriangleFormat>(build.format),
          .leaf_triangles = build.leaf_triangles,
          .has_tree = build.has_tree,
          .has_grid = build.has_grid};
}

Vec3 place_of(const float (&numbers)[3]) {
  return {numbers[0], numbers[1], numbers[2]};
}

// Of a tree's leaf: core's usual number, where the layout's limit is not lower.
template <class Layout>
constexpr std::uint32_t leaf_triangles() {
  constexpr std::uint32_t usual = GridParameters{}.leaf_triangles;
  if constexpr (requires { Layout::kLeafTriangles; }) {
    return Layout::kLeafTriangles < usual ? Layout::kLeafTriangles : usual;
  }
  return usual;
}

}  // namespace
}  // namespace gridiron

using namespace gridiron;

#ifdef GRIDIRON_IMAGE_BUDGETS
template struct gridiron::port::ImageBudgets<CLayout>;
#endif

GridironSizes gridiron_sizes() {
  return {.store_bytes = sizeof(CStore),
          .stack_budget_bytes = CLayout::kStackBudgetBytes,
          .code_budget_bytes = CLayout::kCodeBudgetBytes,
          .arena_bytes = CLayout::kArenaBytes,
          .code_memory_bytes = kCodeMemoryBytes<CLayout>,
          .frame_record_bytes = sizeof(FrameRecord),
          .tile_width = CLayout::kTileWidth,
          .effects = CLayout::kEffects,
          .has_grid_engine = kHasGrid};
}

GridironBuild gridiron_usual_build() {
  const GridParameters usual;
  return {.lambda = usual.lambda,
          .macro_width = usual.macro_width,
          .format = kGridironFormatVertices,
          .leaf_triangles = leaf_triangles<CLayout>(),
          .has_tree = !kHasGrid,
          .has_grid = kHasGrid};
}

GridironStatus gridiron_count_image(const GridironMesh* mesh, const GridironBuild* build, GridironNeed* need) {
  if (!has_arrays(mesh) || build == nullptr || need == nullptr) return kGridironBadParameter;
  GridNeed counted{};
  const Status status = count_scene_image(view_of_mesh(*mesh), parameters_of(*build), counted);
  if (status != Status::kOk) return to_c(status);
  need->image_bytes = counted.image_bytes;
  need->scratch_bytes = counted.scratch_bytes;
  need->dropped_triangle_count = counted.dropped_triangle_count;
  keep(counted, need->internal);
  return kGridironOk;
}

GridironStatus gridiron_build_image(const GridironMesh* mesh, const GridironBuild* build, const GridironNeed* need,
                                    void* image, size_t image_bytes, void* scratch, size_t scratch_bytes) {
  if (!has_arrays(mesh) || build == nullptr || need == nullptr || image == nullptr) return kGridironBadParameter;
  if (!is_aligned(image, kLineBytes) || !is_aligned(scratch, alignof(std::uint64_t))) return kGridironBadParameter;
  return to_c(build_scene_image(view_of_mesh(*mesh), parameters_of(*build), kept_in<GridNeed>(need->internal),
                                {static_cast<std::byte*>(image), image_bytes},
                                {static_cast<std::byte*>(scratch), scratch_bytes}));
}

GridironStatus gridiron_open_image(const void* bytes, size_t byte_count, GridironImage* image, GridironFault* fault) {
  if (fault != nullptr) *fault = {0, ""};
  if (bytes == nullptr || image == nullptr || !is_aligned(bytes, kLineBytes)) return kGridironBadParameter;
  SceneImageView view;
  SceneImageError error;
  const Status status = open_scene_image({static_cast<const std::byte*>(bytes), byte_count}, view, error);
  if (status != Status::kOk) {
    if (fault != nullptr) *fault = {error.byte_offset, error.field};
    return to_c(status);
  }
  constexpr std::uint32_t kWaits = kReflection | kRefraction;
  const bool has_waiting = view.has_effects && (view.effects.called_for & kWaits) != 0;
  image->image_bytes = view.header.image_bytes;
  image->spill_bytes = has_waiting ? spill_bytes(view.effects.recursion_depth) : 0;
  image->triangle_count = view.header.triangle_count;
  image->effects = view.has_effects ? view.effects.called_for : 0;
  image->has_grid = view.has_grid;
  image->has_tree = view.has_tree;
  keep(view, image->internal);
  return kGridironOk;
}

GridironFrame gridiron_usual_frame() {
  const FrameSettings usual;
  const Camera& camera = usual.camera;
  return {.eye = {camera.eye.x, camera.eye.y, camera.eye.z},
          .at = {camera.at.x, camera.at.y, camera.at.z},
          .up = {camera.up.x, camera.up.y, camera.up.z},
          .tan_half_fov = camera.tan_half_fov,
          .width = 64,
          .height = 64,
          .accuracy = kGridironAccuracyStandard,
          .shading = kGridironShadingSimple,
          .background_rgba = usual.background_rgba,
          .t_far = usual.t_far,
          .output_depth = usual.output_depth,
          .fetch_depth = usual.fetch_depth,
          .color_address = 0,
          .depth_address = 0,
          .ids_address = 0};
}

uint64_t gridiron_plane_bytes(uint32_t width, uint32_t height) {
  return output_plane_bytes(width, height, CLayout::kTileWidth);
}

uint64_t gridiron_plane_index(uint32_t width, uint32_t x, uint32_t y) {
  return output_plane_index(width, CLayout::kTileWidth, x, y);
}

uint32_t gridiron_tile_count(uint32_t width, uint32_t height) {
  constexpr std::uint32_t tile = CLayout::kTileWidth;
  return ((width + tile - 1) / tile) * ((height + tile - 1) / tile);
}

GridironStatus gridiron_make_frame(const GridironFrame* frame, const GridironImage* image, uint64_t image_address,
                                   void* record) {
  if (frame == nullptr || image == nullptr || record == nullptr) return kGridironBadParameter;
  if (!is_aligned(record, kLineBytes)) return kGridironBadParameter;
  FrameSettings settings;
  settings.camera = {place_of(frame->eye), place_of(frame->at), place_of(frame->up), frame->tan_half_fov};
  settings.width = frame->width;
  settings.height = frame->height;
  settings.tile_width = CLayout::kTileWidth;
  settings.accuracy = static_cast<Accuracy>(frame->accuracy);
  settings.shading = static_cast<Shading>(frame->shading);
  settings.engine = static_cast<EngineId>(CLayout::Engine::kId);
  settings.output_depth = frame->output_depth;
  settings.fetch_depth = frame->fetch_depth;
  settings.background_rgba = frame->background_rgba;
  settings.t_far = frame->t_far;
  settings.color = {frame->color_address};
  settings.depth = {frame->depth_address};
  settings.ids = {frame->ids_address};
  FrameRecord made;
  const Status status =
      make_frame_record(settings, kept_in<SceneImageView>(image->internal), MainAddress{image_address}, made);
  if (status == Status::kOk) std::memcpy(record, &made, sizeof made);
  return to_c(status);
}

GridironStatus gridiron_render(uint32_t core, void* store, uint64_t record_address, uint64_t spill_address,
                               uint64_t spill_bytes) {
  if (store == nullptr || !is_aligned(store, alignof(CStore))) return kGridironBadParameter;
  // Not initialised: the kernel writes each byte before it reads it.
  auto& local = *::new (store) CStore;
  CPort port(core);
  return to_c(
      render_tiles<CLanes>(local, port, MainAddress{record_address}, {MainAddress{spill_address}, spill_bytes}));
}

const uint32_t* gridiron_work(const void* store, uint32_t* count) {
  *count = kWorkKindCount;
  return static_cast<const CStore*>(store)->work.counts;
}

GridironStatus gridiron_check_transfer(const void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  if (tag >= kGridironTagCount) return kGridironTransferTag;
  return to_c(check_transfer(CPort(0).limits(), reinterpret_cast<std::uintptr_t>(local), MainAddress{main_address},
                             bytes, Tag{static_cast<std::uint8_t>(tag)}));
}

// A value of Status that is missing here does not compile.
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
const char* gridiron_status_text(GridironStatus status) {
  switch (status) {
    case kGridironOk:
      return "no error";
    case kGridironTransferSize:
      return "a transfer's size is 0, too large or not a multiple of 16 bytes";
    case kGridironTransferAlignment:
      return "an end of a transfer is misaligned, or the ends are not congruent";
    case kGridironTransferBoundary:
      return "a transfer crosses a boundary in main memory";
    case kGridironTransferTag:
      return "a transfer's tag is out of range";
    case kGridironTransferQueueFull:
      return "more transfers are pending than the queue holds";
    case kGridironTransferLocalRange:
      return "a transfer's local side is not inside the core's memory";
    case kGridironTransferMainRange:
      return "a transfer's main-memory side is not inside memory that it may use";
    case kGridironTransferOverlap:
      return "a transfer overlaps a pending one";
    case kGridironTransferFailed:
      return "a transfer failed";
    case kGridironTransferTimedOut:
      return "a transfer did not end in time";
    case kGridironTransferPending:
      return "a transfer was never waited for";
    case kGridironBadAccess:
      return "a load or store touched bytes that it must not";
    case kGridironBadFrame:
      return "the frame has a size, camera, depth or plane out of range";
    case kGridironBadImage:
      return "the scene image is damaged or of another version";
    case kGridironUnsupportedImage:
      return "the scene image lacks what this layout or accuracy reads";
    case kGridironUnsupportedFrame:
      return "this layout was not built for such a frame";
    case kGridironAborted:
      return "the frame was stopped";
    case kGridironDeadline:
      return "the frame's deadline has passed";
    case kGridironIncompleteFrame:
      return "part of the picture was not written";
    case kGridironMissingEffect:
      return "the scene calls for effects that this layout lacks";
    case kGridironSpillTooSmall:
      return "the memory for rays that wait is too small";
    case kGridironMemoryTooSmall:
      return "the memory is smaller than the counted need";
    case kGridironTooManyTriangles:
      return "there are too many triangles";
    case kGridironNoTriangles:
      return "the mesh has no triangle of non-zero area";
    case kGridironBadVertex:
      return "a vertex is NaN, infinite or too far away";
    case kGridironBadIndex:
      return "a triangle names a vertex that does not exist";
    case kGridironBadParameter:
      return "a parameter is out of range, null or misaligned";
    case kGridironBadEffects:
      return "a light, material, normal or texel is out of range";
  }
  return "unknown status";
}
#pragma GCC diagnostic pop
