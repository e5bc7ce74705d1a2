// From a mesh to planes of pixels on the simulated chip, for tests.
// Memory: owns the simulated main memory. Threads: one caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/scene/mesh.h>
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_memory.h>

#include "support/test_mesh.h"

namespace gridiron::test {

/// A frame's planes, row-major, row 0 on top.
struct Planes {
  std::vector<std::uint32_t> color;  ///< 0xAABBGGRR
  std::vector<float> depth;
  std::vector<std::uint32_t> ids;

  friend bool operator==(const Planes&, const Planes&) = default;
};

/// Long lists of triangles, empty space, silhouettes and overlapping surfaces: 5,201 triangles.
TestMesh make_mixed_mesh();

/// Which planes a frame has. Without depth, distances are estimated where that decides.
enum class PlaneSet : std::uint8_t { kColor, kColorAndIds, kAll };

/// What rendering a frame gave.
struct RenderedFrame {
  sim::ChipResult result;
  FrameRecord frame{};
  Planes planes;  ///< empty unless result.status is kOk

  [[nodiscard]] std::size_t pixel_index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y} * frame.width + x;
  }
};

class SceneInMemory;

/// One frame's record and planes in simulated main memory, to be rendered any number of times. Its memory is given back
/// at the end of its life; of several, the last one made goes first. Borrows the scene.
class PreparedFrame {
 public:
  PreparedFrame(sim::SimMemory* memory, const SceneImageView& image, MainAddress image_address, FrameSettings settings,
                const sim::ChipOptions& chip, PlaneSet planes);
  ~PreparedFrame();
  PreparedFrame(const PreparedFrame&) = delete;
  PreparedFrame& operator=(const PreparedFrame&) = delete;

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] const FrameRecord& record() const { return record_; }

  /// Puts another record in the place of the own one: other rays, or what make_frame_record would refuse. Size, tile
  /// width and the addresses of planes stay as they are; a plane may be switched off by an address of 0.
  void set_record(const FrameRecord& record);

  /// Renders into the planes. Precondition: status() is kOk; `chip` has the store it was prepared for.
  [[nodiscard]] sim::ChipResult render(const sim::ChipOptions& chip);

  /// Runs another program of a core on as many cores as `chip` has, every rule checked. The planes are cleared before.
  /// @param data_bytes  of a core's store. @param program  (core, data, address of the record) -> Status.
  /// @param engine      whose kinds of work it has.
  template <class Program>
  [[nodiscard]] sim::ChipResult run(const sim::ChipOptions& chip, std::uint32_t data_bytes, Program&& program,
                                    const sim::EngineWork& engine) {
    return run_cores(chip, data_bytes, engine, [&](sim::SimCore& core, std::span<std::byte> data) {
      return program(core, data, record_address_);
    });
  }

  /// @returns the result of the last render; planes that were not requested are empty.
  [[nodiscard]] Planes planes() const;

 private:
  [[nodiscard]] sim::ChipResult run_cores(const sim::ChipOptions& chip, std::uint32_t data_bytes,
                                          const sim::EngineWork& engine, const sim::CoreProgram& program);
  // What a tile fails to write must not look like a pixel.
  void clear_planes();

  sim::SimMemory* memory_;
  std::uint64_t mark_;
  Status status_ = Status::kOk;
  FrameRecord record_{};
  MainAddress record_address_;
  std::span<std::byte> color_, depth_, ids_;
};

/// A scene image in simulated main memory, ready for any number of frames.
class SceneInMemory {
 public:
  /// Builds the image; failures show in status().
  /// @param frame_bytes  space for the planes of the largest frame.
  SceneInMemory(const MeshView& mesh, const GridParameters& parameters,
                std::uint64_t frame_bytes = std::uint64_t{1} << 25);

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] const SceneImageView& image() const { return view_; }
  [[nodiscard]] const GridNeed& need() const { return need_; }

  /// Sets up a frame. Tile width and output addresses are set here, whatever `settings` says.
  [[nodiscard]] PreparedFrame prepare(const FrameSettings& settings, const sim::ChipOptions& chip,
                                      PlaneSet planes = PlaneSet::kAll);

  /// Renders one frame.
  [[nodiscard]] RenderedFrame render(const FrameSettings& settings, const sim::ChipOptions& chip,
                                     PlaneSet planes = PlaneSet::kAll);

 private:
  Status status_ = Status::kOk;
  GridNeed need_{};
  SceneImageView view_{};
  std::unique_ptr<sim::SimMemory> memory_;
  MainAddress image_address_;
};

/// @returns the tile width that a frame is made with: that of the settings; where it is the default, the store's usual.
std::uint32_t tile_width_of(const FrameSettings& settings, const sim::ChipOptions& chip);

/// @returns the first place where two frames differ, in words; empty where they are the same bit for bit.
std::string first_difference(const RenderedFrame& a, const RenderedFrame& b);

}  // namespace gridiron::test
