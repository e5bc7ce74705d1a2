// Renders a scene with the kernel's effects on one core, without a simulated chip: for any set of effects built, any
// lane type, any number of records of rays under way.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include "scene_text/scene_description.h"
#include "scene_text/scene_effects.h"
#include "support/test_headers.h"

namespace gridiron::test {

struct KernelOptions {
  Accuracy accuracy = Accuracy::kStandard;
  float lambda = 2.0f;
  std::uint32_t macro_width = 4;
  std::uint32_t fetch_depth = 8, macro_depth = 2, triangle_depth = 4;
  std::uint32_t queue_depth = 16;
  bool moves_late = false;   ///< a get's bytes come at the wait, garbage before
  std::uint64_t spill_bytes = ~0ull;  ///< ~0: what the scene asks for
  std::uint64_t spill_shift = 0;      ///< of the region from a multiple of kSpillAlignment
  bool claims_backwards = false;      ///< the last tile is handed out first
  bool wants_planes = false;          ///< depth and ids too
  Shading shading = Shading::kScene;
  EngineId engine = EngineId::kGrid;  ///< of eye rays
  void (*alter)(FrameRecord& record) = nullptr;  ///< breaks a frame that its set-up would not have made
};

/// A scene's image and what it was made of.
struct KernelScene {
  std::vector<std::byte> memory;  ///< the image
  SceneImageView view;
  std::uint32_t called_for = 0;
  Status status = Status::kOk;

  [[nodiscard]] std::byte* image() {
    const auto start = reinterpret_cast<std::uintptr_t>(memory.data());
    return memory.data() + (kLineBytes - start % kLineBytes) % kLineBytes;
  }
};

[[nodiscard]] KernelScene build_kernel_scene(const tool::SceneDescription& scene, const KernelOptions& options);

/// What a frame came to.
struct KernelPicture {
  Status status = Status::kOk;
  std::uint32_t missing_effects = 0;  ///< where the status is kMissingEffect
  std::string violation;             ///< the first broken rule of transfers
  std::vector<std::uint32_t> color;  ///< row-major, 0xAABBGGRR
  std::vector<float> depth;          ///< where wanted
  std::vector<std::uint32_t> ids;
  WorkCounters work;
  std::array<std::uint64_t, kStageCount> stage_bytes{};  ///< moved in and out
  std::array<std::uint64_t, kStageCount> stage_transfers{};
  std::vector<std::uint64_t> tile_bytes;  ///< moved from the claim of each tile to that of the next
  std::uint64_t spilled_bytes = 0;        ///< put where rays wait
};

/// One core with its main memory: addresses are offsets into it.
class KernelBoard {
 public:
  KernelBoard(std::vector<std::byte>& memory, const KernelOptions& options, std::uint32_t tile_count)
      : memory_(memory), options_(options), tile_count_(tile_count) {}

  [[nodiscard]] PlatformLimits limits() const {
    PlatformLimits limits;
    limits.queue_depth = options_.queue_depth;
    return limits;
  }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    check(local, address, bytes);
    if (!violation.empty()) return Status::kTransferAlignment;
    if (options_.moves_late) {
      std::memset(local, 0xA5, bytes);
    } else {
      std::memcpy(local, base() + address.value, bytes);
    }
    pending_.push_back({static_cast<std::byte*>(local), address.value, bytes, tag.index, true});
    if (pending_.size() > options_.queue_depth) violation = "queue depth";
    return Status::kOk;
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    check(local, address, bytes);
    if (!violation.empty()) return Status::kTransferAlignment;
    std::memcpy(base() + address.value, local, bytes);
    pending_.push_back({nullptr, address.value, bytes, tag.index, false});
    if (pending_.size() > options_.queue_depth) violation = "queue depth";
    if (address.value >= spill.address.value && address.value < spill.address.value + spill.bytes) {
      spilled_bytes += bytes;
    }
    return Status::kOk;
  }
  Status wait(TagMask tags) {
    std::size_t kept = 0;
    for (const Pending& transfer : pending_) {
      if ((tags.bits >> transfer.tag & 1u) == 0) {
        pending_[kept++] = transfer;
      } else if (transfer.is_get && options_.moves_late) {
        std::memcpy(transfer.local, base() + transfer.address, transfer.bytes);
      }
    }
    pending_.resize(kept);
    return Status::kOk;
  }
  ItemClaim claim_item() {
    if (next_tile_ == tile_count_) return {};
    tile_bytes.push_back(0);
    const std::uint32_t tile = next_tile_++;
    return {ItemClaim::Kind::kItem, options_.claims_backwards ? tile_count_ - 1 - tile : tile};
  }
  void note_stage(std::uint8_t stage) { stage_ = stage; }

  [[nodiscard]] std::byte* base() {
    const auto start = reinterpret_cast<std::uintptr_t>(memory_.data());
    return memory_.data() + (4096 - start % 4096) % 4096;
  }

  std::string violation;
  std::array<std::uint64_t, kStageCount> stage_bytes{};
  std::array<std::uint64_t, kStageCount> stage_transfers{};
  std::vector<std::uint64_t> tile_bytes;
  SpillRegion spill;  ///< puts to it are counted
  std::uint64_t spilled_bytes = 0;

 private:
  struct Pending {
    std::byte* local;
    std::uint64_t address;
    std::uint32_t bytes;
    std::uint8_t tag;
    bool is_get;
  };
  void check(const void* local, MainAddress address, std::uint32_t bytes) {
    const auto place = reinterpret_cast<std::uintptr_t>(local);
    if (bytes == 0 || bytes % kPortableGranuleBytes != 0 || bytes > kPortableMaxTransferBytes) violation = "size";
    if (place % kPortableGranuleBytes != 0 || address.value % kPortableGranuleBytes != 0) violation = "alignment";
    if ((place - address.value) % kPortableCongruenceBytes != 0) violation = "congruence";
    if (address.value / kPortableBoundaryBytes != (address.value + bytes - 1) / kPortableBoundaryBytes) {
      violation = "boundary";
    }
    if (address.value == 0 || address.value + bytes > memory_.size() - 4096) violation = "beyond main memory";
    stage_bytes[stage_] += bytes;
    if (!tile_bytes.empty()) tile_bytes.back() += bytes;
    ++stage_transfers[stage_];
  }

  std::vector<std::byte>& memory_;
  const KernelOptions& options_;
  std::uint32_t tile_count_;
  std::uint32_t next_tile_ = 0;
  std::uint8_t stage_ = 0;
  std::vector<Pending> pending_;
};

/// Main memory of one frame: image, frame record, planes, waiting rays.
struct KernelFrame {
  std::vector<std::byte> memory;
  std::uint64_t frame_address = 0;
  SpillRegion spill;
  std::uint64_t color = 0, depth = 0, ids = 0;
  std::uint32_t tile_count = 0;
  Status status = Status::kOk;
};
[[nodiscard]] KernelFrame make_kernel_frame(KernelScene& scene, const Camera& camera, std::uint32_t width,
                                            std::uint32_t height, std::uint32_t tile_width,
                                            const KernelOptions& options);
[[nodiscard]] Camera camera_of(const tool::SceneView& view);
/// Byte 0 of its main memory, which is never touched.
[[nodiscard]] const std::byte* kernel_memory(const KernelFrame& frame);
void read_kernel_planes(const KernelFrame& frame, std::byte* base, std::uint32_t width, std::uint32_t height,
                        std::uint32_t tile_width, KernelPicture& picture);

/// The parameters of a layout that identify its kernel.
struct KernelLayout {
  std::uint32_t arena_bytes, tile_width, packet_width;
  bool has_effects;
};
/// Where is_instrumented() (support/instrumented.h): renders a frame that was rendered without a simulated chip once
/// more, by the instrumented kernel. @returns what is wrong with it; empty where that is nothing, or where there is no
/// instrumented kernel of this layout. Of a set of effects it is the one with all of them.
[[nodiscard]] std::string instrumented_violation(const KernelFrame& frame, const KernelLayout& kernel,
                                                 const KernelOptions& options);

/// Renders a scene with a layout and lanes.
template <class Layout, class L = Lanes<4>>
[[nodiscard]] KernelPicture render_kernel(KernelScene& scene, const Camera& camera, std::uint32_t width,
                                          std::uint32_t height, const KernelOptions& options = {}) {
  KernelPicture picture;
  KernelFrame frame = make_kernel_frame(scene, camera, width, height, Layout::kTileWidth, options);
  picture.status = frame.status;
  if (frame.status != Status::kOk) return picture;
  KernelBoard board(frame.memory, options, frame.tile_count);
  board.spill = frame.spill;
  const auto store = std::make_unique<LocalStore<Layout>>();
  std::memset(static_cast<void*>(store.get()), 0xC3, sizeof(*store));
  picture.status = render_tiles<L>(*store, board, MainAddress{frame.frame_address}, frame.spill);
  if (picture.status == Status::kMissingEffect) picture.missing_effects = missing_effects(*store);
  picture.violation = board.violation;
  if (picture.status == Status::kOk && picture.violation.empty()) {
    constexpr KernelLayout kLayout{Layout::kArenaBytes, Layout::kTileWidth, Layout::kPacketWidth,
                                   Layout::kEffects != 0};
    picture.violation = instrumented_violation(frame, kLayout, options);
    if (!picture.violation.empty()) picture.status = Status::kBadAccess;
  }
  picture.work = store->work;
  picture.stage_bytes = board.stage_bytes;
  picture.stage_transfers = board.stage_transfers;
  picture.tile_bytes = board.tile_bytes;
  picture.spilled_bytes = board.spilled_bytes;
  read_kernel_planes(frame, board.base(), width, height, Layout::kTileWidth, picture);
  return picture;
}

}  // namespace gridiron::test
