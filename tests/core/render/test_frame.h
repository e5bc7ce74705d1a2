// A scene and a frame in the memory of a test platform, rendered by the kernel on one core.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/frame/frame_setup.h>
#include <gridiron/render/tile_renderer.h>

#include "core/build/grid/built_image.h"
#include "core/dma/test_platform.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// What a core did with a frame. Planes are row-major, row 0 on top.
struct KernelFrame {
  Status status = Status::kOk;
  WorkCounters work;
  std::vector<std::uint32_t> color, ids;
  std::vector<float> depth;
};

/// Where things lie in the platform's memory.
inline constexpr std::uint64_t kFrameAddress = 128;
inline constexpr std::uint64_t kPlanesAddress = 8192;

/// One frame: made, put into memory, rendered, and what it wrote outside of its planes.
class TestFrame {
 public:
  /// @param settings  output addresses are set here. Planes start 128 bytes and `plane_shift` into a 4 KB page.
  TestFrame(const BuiltImage& scene, FrameSettings settings, std::uint32_t queue_depth = 16,
            Moves moves = Moves::kAtTheWait, std::uint64_t plane_shift = 0) {
    plane_bytes_ = output_plane_bytes(settings.width, settings.height, settings.tile_width);
    settings.color = {kPlanesAddress + kLineBytes + plane_shift};
    settings.depth = {settings.color.value + plane_bytes_ + kLineBytes};
    settings.ids = {settings.depth.value + plane_bytes_ + kLineBytes};
    const std::uint64_t image_address = round_up(settings.ids.value + plane_bytes_ + kLineBytes, std::uint64_t{4096});
    platform = std::make_unique<TestPlatform>(queue_depth, moves, image_address + scene.image.bytes().size());
    const Status made = make_frame_record(settings, scene.view, {image_address}, record);
    EXPECT_EQ(made, Status::kOk);
    std::memset(platform->at(0), 0xA5, image_address);
    std::memcpy(platform->at(image_address), scene.image.bytes().data(), scene.image.bytes().size());
    claim_all();
  }

  /// All tiles in order, then none.
  void claim_all() {
    platform->claims.clear();
    for (std::uint32_t tile = 0; tile < record.tiles_x * record.tiles_y; ++tile) {
      platform->claims.push_back({ItemClaim::Kind::kItem, tile});
    }
    platform->claims.push_back({});
  }

  template <class L, class Layout>
  [[nodiscard]] KernelFrame render() {
    std::memcpy(platform->at(kFrameAddress), &record, sizeof(record));
    const auto store = std::make_unique<LocalStore<Layout>>();
    KernelFrame result;
    result.status = render_tiles<L>(*store, *platform, MainAddress{kFrameAddress});
    result.work = store->work;
    result.color = plane<std::uint32_t>(record.color_address);
    result.depth = plane<float>(record.depth_address);
    result.ids = plane<std::uint32_t>(record.id_address);
    return result;
  }

  /// @returns true where the lines between the planes are as they were.
  [[nodiscard]] bool gaps_are_untouched() const {
    for (std::uint64_t gap = record.color_address - kLineBytes; gap <= record.id_address + plane_bytes_;
         gap += plane_bytes_ + kLineBytes) {
      for (std::uint64_t i = 0; i < kLineBytes; ++i) {
        if (*platform->at(gap + i) != std::byte{0xA5}) return false;
      }
    }
    return true;
  }

  std::unique_ptr<TestPlatform> platform;
  FrameRecord record{};

 private:
  template <class Element>
  [[nodiscard]] std::vector<Element> plane(std::uint64_t address) const {
    std::vector<Element> rows;
    if (address == 0 || record.width > kMaxPictureWidth || record.tile_width == 0) return rows;
    for (std::uint32_t y = 0; y < record.height; ++y) {
      for (std::uint32_t x = 0; x < record.width; ++x) {
        const std::uint64_t index = output_plane_index(record.width, record.tile_width, x, y);
        Element element;
        std::memcpy(&element, platform->at(address + index * sizeof(Element)), sizeof(Element));
        rows.push_back(element);
      }
    }
    return rows;
  }

  std::uint64_t plane_bytes_ = 0;
};

}  // namespace gridiron::test
