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
// GRIDIRON_STORE_BYTES    of the layout's store, for the firmware too; another number does not compile. Optional.
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
#ifdef GRIDIRON_STORE_BYTES
// A wrong number is in the compiler's message, with the right one.
template <std::size_t Stated, std::size_t OfTheLayout>
struct StoreBytes {
  static_assert(Stated == OfTheLayout, "gridiron: GRIDIRON_STORE_BYTES is not the size of the layout's store");
};
template struct StoreBytes<GRIDIRON_STORE_BYTES, sizeof(CStore)>;
#endif
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
    std::uint32_t item = 0xFFFFFFFFu;  // no tile of any frame: one that is not written is refused
    switch (gridiron_claim_item(core_, &item)) {
      case kGridironClaimItem:
        return {ItemClaim::Kind::kItem, item};
      case kGridironClaimAborted:
        return {ItemClaim::Kind::kAborted, 0};
      case kGridironClaimDeadline:
        return {ItemClaim::Kind::kDeadline, 0};
      case kGridironClaimNone:
        return {ItemClaim::Kind::kNone, 0};
    }
    // The kernel ends the frame with no transfer pending.
    has_bad_claim_ = true;
    return {ItemClaim::Kind::kAborted, 0};
  }
  [[nodiscard]] bool has_bad_claim() const { return has_bad_claim_; }

 private:
  std::uint32_t core_;
  bool has_bad_claim_ = false;
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

// The most triangles of a tree's leaf that the layout reads.
template <class Layout>
constexpr std::uint32_t most_leaf_triangles() {
  if constexpr (requires { Layout::kLeafTriangles; }) {
    return Layout::kLeafTriangles;
  } else {
    return kMaxTreeLeaf;
  }
}

// Core's usual number, where the layout's limit is not lower.
template <class Layout>
constexpr std::uint32_t usual_leaf_triangles() {
  constexpr std::uint32_t usual = GridParameters{}.leaf_triangles, most = most_leaf_triangles<Layout>();
  return most < usual ? most : usual;
}

// A member of a frame as a fault, and one of the parameters.
#define GRIDIRON_MEMBER(member)              \
  GridironFault {                            \
    offsetof(GridironFrame, member), #member \
  }
constexpr GridironFault parameter(const char* name) {
  return {sizeof(GridironFrame), name};
}

// What a field of the frame record is made of.
[[gnu::always_inline]] inline GridironFault fault_of(const FrameFault& fault) {
  switch (fault.place) {
    case offsetof(FrameHead, width):
      return GRIDIRON_MEMBER(width);
    case offsetof(FrameHead, height):
      return GRIDIRON_MEMBER(height);
    case offsetof(FrameHead, accuracy):
      return GRIDIRON_MEMBER(accuracy);
    case offsetof(FrameHead, shading):
      return GRIDIRON_MEMBER(shading);
    case offsetof(FrameHead, t_far):
      return GRIDIRON_MEMBER(t_far);
    case offsetof(FrameHead, output_depth):
      return GRIDIRON_MEMBER(output_depth);
    case offsetof(FrameHead, fetch_depth):
      return GRIDIRON_MEMBER(fetch_depth);
    case offsetof(FrameHead, color_address):
      return GRIDIRON_MEMBER(color_address);
    default:
      return parameter("image");
  }
}

// The layout's limits, which TileRenderer and the engines have too. @tparam MostFetches  the greatest fetch_depth.
template <class Layout, std::uint32_t MostFetches>
struct LayoutLimits : Layout {
  static constexpr std::uint32_t kLeastTileWidth = Layout::kTileWidth;
  static constexpr std::uint32_t kMostTileWidth = Layout::kTileWidth;
  static constexpr std::uint32_t kMaxFetchDepth = MostFetches;
  static constexpr Status kBeyond = Status::kUnsupportedFrame;
};
template <class Layout>
struct GridLimits : LayoutLimits<Layout, 0> {
  static constexpr std::uint32_t kMaxCellBlockBytes = LocalStore<Layout>::EyeStore::kCellBlockBytes;
};

// The first limit of the layout that a frame's record is beyond.
template <class Layout>
FrameFault find_layout_fault(const FrameRecord& frame) {
  using Engine = typename Layout::Engine;
  FrameFault fault = find_picture_fault<LayoutLimits<Layout, 0> >(frame);
  if (fault.status != Status::kOk) return fault;
  if constexpr (Engine::kId == static_cast<std::uint32_t>(EngineId::kTree)) {
    fault = find_tree_fault<LayoutLimits<Layout, Engine::template kMaxDepth<Layout> > >(frame);
  } else if constexpr (kTracesEyes<Layout>) {
    fault = find_grid_fault<GridLimits<Layout> >(frame);
  }
  if (fault.status != Status::kOk) return fault;
  if constexpr (Layout::kEffects != 0) {
    fault = find_scene_fault<LayoutLimits<Layout, Layout::RayEngine::template kMaxDepth<Layout> > >(frame);
  }
  return fault;
}

bool is_finite(const Vec3& v) {
  return v.x - v.x == 0.0f && v.y - v.y == 0.0f && v.z - v.z == 0.0f;
}

// Main memory of a frame. A range may end where the addresses do.
struct Range {
  std::uint64_t begin, bytes;

  [[nodiscard]] bool ends_beyond_addresses() const { return bytes != 0 && begin + (bytes - 1) < begin; }
  [[nodiscard]] bool overlaps(const Range& other) const {
    return other.begin - begin < bytes || begin - other.begin < other.bytes;
  }
};

// The first plane of a frame that is misaligned.
GridironFault find_misaligned_plane(const GridironFrame& frame) {
  if (frame.color_address % kPlaneAlignment != 0) return GRIDIRON_MEMBER(color_address);
  if (frame.depth_address % kPlaneAlignment != 0) return GRIDIRON_MEMBER(depth_address);
  if (frame.ids_address % kPlaneAlignment != 0) return GRIDIRON_MEMBER(ids_address);
  return {0, nullptr};
}

// The first plane of a frame that lies on the image or on a plane before it, or that no address space holds.
GridironFault find_overlap(const GridironFrame& frame, const Range& image) {
  const std::uint64_t bytes = output_plane_bytes(frame.width, frame.height, CLayout::kTileWidth);
  const Range color{frame.color_address, bytes};
  const Range depth{frame.depth_address, frame.depth_address != 0 ? bytes : 0};
  const Range ids{frame.ids_address, frame.ids_address != 0 ? bytes : 0};
  if (image.ends_beyond_addresses()) return parameter("image_address");
  if (color.ends_beyond_addresses() || color.overlaps(image)) return GRIDIRON_MEMBER(color_address);
  if (depth.bytes != 0 && (depth.ends_beyond_addresses() || depth.overlaps(image) || depth.overlaps(color))) {
    return GRIDIRON_MEMBER(depth_address);
  }
  if (ids.bytes != 0 && (ids.ends_beyond_addresses() || ids.overlaps(image) || ids.overlaps(color) ||
                         (depth.bytes != 0 && ids.overlaps(depth)))) {
    return GRIDIRON_MEMBER(ids_address);
  }
  return {0, nullptr};
}

FrameSettings settings_of(const GridironFrame& frame) {
  FrameSettings settings;
  settings.camera = {place_of(frame.eye), place_of(frame.at), place_of(frame.up), frame.tan_half_fov};
  settings.width = frame.width;
  settings.height = frame.height;
  settings.tile_width = CLayout::kTileWidth;
  settings.accuracy = static_cast<Accuracy>(frame.accuracy);
  settings.shading = static_cast<Shading>(frame.shading);
  settings.engine = static_cast<EngineId>(CLayout::Engine::kId);
  settings.output_depth = frame.output_depth;
  settings.fetch_depth = frame.fetch_depth;
  settings.background_rgba = frame.background_rgba;
  settings.t_far = frame.t_far;
  settings.color = {frame.color_address};
  settings.depth = {frame.depth_address};
  settings.ids = {frame.ids_address};
  return settings;
}

// The first fault of a frame's own fields, whatever image and layout.
FrameFault find_settings_fault(const FrameSettings& settings) {
  FrameHead head{};
  head.magic = kFrameMagic;
  head.version = kFrameVersion;
  head.width = settings.width;
  head.height = settings.height;
  head.tile_width = settings.tile_width;
  head.tiles_x = tiles_across(settings.width, settings.tile_width);
  head.tiles_y = tiles_across(settings.height, settings.tile_width);
  head.accuracy = static_cast<std::uint32_t>(settings.accuracy);
  head.shading = static_cast<std::uint32_t>(settings.shading);
  head.output_depth = settings.output_depth;
  head.t_far = settings.t_far;
  head.color_address = settings.color.value;
  return find_picture_fault<AnyLayout>(head);
}

// Makes a frame's record, or names what is wrong. make_frame_record() and the kernel decide: each rule here finds the
// field for one of theirs, and what is then left of make_frame_record()'s is `up`, or a camera too far from a grid.
Status make_record(const GridironFrame& frame, const SceneImageView& image, std::uint64_t image_address,
                   FrameRecord& made, GridironFault& fault) {
  const auto refuse = [&fault](Status status, const GridironFault& found) {
    fault = found;
    return status;
  };
  FrameSettings settings = settings_of(frame);
  const FrameFault own = find_settings_fault(settings);
  if (own.status != Status::kOk) return refuse(own.status, fault_of(own));
  if (const GridironFault plane = find_misaligned_plane(frame); plane.field != nullptr) {
    return refuse(Status::kTransferAlignment, plane);
  }
  if (image_address % kLineBytes != 0) return refuse(Status::kTransferAlignment, parameter("image_address"));
  if (image_address == 0) return refuse(Status::kBadFrame, parameter("image_address"));

  // 1. The camera.
  const Camera& camera = settings.camera;
  if (!(camera.tan_half_fov > 0.0f && camera.tan_half_fov - camera.tan_half_fov == 0.0f)) {
    return refuse(Status::kBadFrame, GRIDIRON_MEMBER(tan_half_fov));
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!(magnitude(camera.eye[axis]) <= kCoordinateLimit)) return refuse(Status::kBadFrame, GRIDIRON_MEMBER(eye));
  }
  if (!is_finite(camera.at) || camera.at == camera.eye) return refuse(Status::kBadFrame, GRIDIRON_MEMBER(at));

  // 2. What the image lacks, and the layout.
  const bool is_scene = settings.shading == Shading::kScene;
  if (is_scene && CLayout::kEffects == 0) return refuse(Status::kMissingEffect, GRIDIRON_MEMBER(shading));
  if (!(kHasGrid ? image.has_grid : image.has_tree)) return refuse(Status::kUnsupportedImage, parameter("image"));
  const std::uint32_t format = kHasGrid ? image.grid.triangle_format : image.tree.triangle_format;
  if (!reads_format(static_cast<std::uint32_t>(settings.accuracy), format) ||
      (is_scene && !accuracy_traits(settings.accuracy).has_scene_shading)) {
    return refuse(Status::kUnsupportedImage, GRIDIRON_MEMBER(accuracy));
  }
  if (is_scene && !image.has_effects) return refuse(Status::kUnsupportedImage, GRIDIRON_MEMBER(shading));
  const bool uses_tree = !kHasGrid || is_scene;
  if (uses_tree && settings.fetch_depth == 0) return refuse(Status::kBadFrame, GRIDIRON_MEMBER(fetch_depth));
  if (is_scene) {
    const Status built = check_effects_built(image.effects.called_for, CLayout::kEffects);
    if (built != Status::kOk) return refuse(built, parameter("image"));
  }
  if (!kTracesEyes<CLayout> && !is_scene) return refuse(Status::kUnsupportedFrame, GRIDIRON_MEMBER(shading));
  if (!kTracesEyes<CLayout> && frame.depth_address != 0) {
    return refuse(Status::kUnsupportedFrame, GRIDIRON_MEMBER(depth_address));
  }
  if (uses_tree && image.tree.leaf_triangles > most_leaf_triangles<CLayout>()) {
    return refuse(Status::kUnsupportedImage, parameter("image"));
  }

  // 3. The record, and the layout's limits.
  const MainAddress address{image_address};
  const Status status = make_frame_record(settings, image, address, made);
  if (status != Status::kOk) {
    FrameHead head;
    if (make_frame_head(settings, head) != Status::kOk) return refuse(status, GRIDIRON_MEMBER(up));
    settings.camera.tan_half_fov = Camera{}.tan_half_fov;
    const bool is_too_wide = make_frame_record(settings, image, address, made) == Status::kOk;
    return refuse(status, is_too_wide ? GRIDIRON_MEMBER(tan_half_fov) : GRIDIRON_MEMBER(eye));
  }
  const FrameFault beyond = find_layout_fault<CLayout>(made);
  if (beyond.status != Status::kOk) return refuse(beyond.status, fault_of(beyond));

  // 4. Places in main memory.
  const GridironFault overlap = find_overlap(frame, {image_address, image.header.image_bytes});
  return overlap.field != nullptr ? refuse(Status::kBadFrame, overlap) : Status::kOk;
}
#undef GRIDIRON_MEMBER

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
          .leaf_triangles = usual_leaf_triangles<CLayout>(),
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
                                   void* record, GridironFault* fault) {
  GridironFault found{0, ""};
  FrameRecord made;
  Status status = Status::kBadParameter;
  if (frame == nullptr) {
    found = parameter("frame");
  } else if (image == nullptr) {
    found = parameter("image");
  } else if (record == nullptr || !is_aligned(record, kLineBytes)) {
    found = parameter("record");
  } else {
    status = make_record(*frame, kept_in<SceneImageView>(image->internal), image_address, made, found);
  }
  if (status == Status::kOk) std::memcpy(record, &made, sizeof made);
  if (fault != nullptr) *fault = found;
  return to_c(status);
}

GridironStatus gridiron_render(uint32_t core, void* store, uint64_t record_address, uint64_t spill_address,
                               uint64_t spill_bytes) {
  if (store == nullptr || !is_aligned(store, alignof(CStore))) return kGridironBadParameter;
  // Not initialised: the kernel writes each byte before it reads it.
  auto& local = *::new (store) CStore;
  CPort port(core);
  const Status status =
      render_tiles<CLanes>(local, port, MainAddress{record_address}, {MainAddress{spill_address}, spill_bytes});
  return port.has_bad_claim() && status == Status::kAborted ? kGridironBadParameter : to_c(status);
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
