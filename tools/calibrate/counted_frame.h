// A frame rendered by the counted kernel: the same picture, and what every operation of it came to.
// Memory: owned. Threads: any; several may render other tiles of one frame. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <copy_core.h>
#include <counted_kernel.h>
#include <gridiron/base/records.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/scene/effects.h>
#include <gridiron/shade/effect_store.h>
#include <pipe_model.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gridiron/device/configurations.h"

namespace gridiron::calibrate {

/// What is rendered, and how.
struct CountedFrame {
  std::span<const Vec3> vertices;
  std::span<const UVec3> triangles;
  Camera camera{};
  std::uint32_t width = 96;  ///< and height, pixels
  /// Parameters of the grid; packets are 8 or 32 wide. fetch_depth is 8.
  const tool::Configuration* configuration = tool::find_configuration("reference");
  Accuracy accuracy = Accuracy::kStandard;
  Shading shading = Shading::kSimple;
  bool has_planes = false;               ///< depth and ids too, for which distances are exact
  const EffectsView* effects = nullptr;  ///< of Shading::kScene: of the mesh, in a store built for all effects
  /// Not 0: the cached BVH renders, with so many packets in its ring and otherwise as it is tuned. It has no choice of
  /// configuration, accuracy, planes and effects.
  std::uint32_t ring_size = 0;
};

struct CountedPicture {
  Counts counts;
  std::vector<std::uint32_t> pixels;  ///< of the tiles, and their planes, tile by tile, as the kernel puts them
};

/// A frame in main memory: frame record, picture, planes, scene image, and what secondary rays wait in.
class FrameInMemory {
 public:
  /// Errors: std::runtime_error where the scene cannot be built.
  explicit FrameInMemory(const CountedFrame& frame);

  /// Renders tiles on one core, out of a 256 KB store. @param tiles  empty: all. Errors: std::runtime_error where the
  /// kernel refuses the frame, or the counted kernel gives another picture or does other work than the kernel itself.
  /// @param usual  what branches usually do in the frame's program.
  [[nodiscard]] CountedPicture count(const Branches& usual, std::span<const std::uint32_t> tiles = {},
                                     const PipeRules& rules = {}) const;

  /// @returns what the branches of all tiles do.
  [[nodiscard]] Branches branches() const { return branches_of(run_of(all_tiles_)); }
  [[nodiscard]] CountedProgram program() const { return program_; }

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_.bytes(); }

 private:
  void set_up_grid(const CountedFrame& frame);
  void set_up_bvh(const CountedFrame& frame);
  void set_up_picture(const CountedFrame& frame, std::uint64_t begin, std::uint32_t plane_count);
  [[nodiscard]] FrameSettings settings_of(const CountedFrame& frame) const;
  [[nodiscard]] CountedRun run_of(std::span<const std::uint32_t> tiles) const {
    return {bytes_.bytes(), tiles, spill_.address.value, spill_.bytes, program_};
  }
  [[nodiscard]] std::byte* at(std::uint64_t address) const { return bytes_.bytes().data() + address; }
  [[nodiscard]] std::vector<std::uint32_t> pixels_of(std::span<const std::uint32_t> tiles) const;
  template <class Store>
  [[nodiscard]] WorkCounters render(std::span<const std::uint32_t> tiles) const;

  LineBytes bytes_{0};
  std::vector<std::uint32_t> all_tiles_;
  std::uint64_t picture_address_ = 0;
  std::uint64_t plane_bytes_ = 0;
  std::uint32_t plane_count_ = 1;
  SpillRegion spill_;
  CountedProgram program_ = CountedProgram::kPackets8;
};

}  // namespace gridiron::calibrate
