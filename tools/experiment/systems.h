// Systems: ways of rendering a frame on the simulated chip, and those that the experiment compares. Memory: a recording
// owns its trace. Threads: any; record() and time() share nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/build_work.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "experiment/answers.h"
#include "experiment/paper_values.h"
#include "experiment/views.h"
#include "gridiron/animate/frame_figures.h"
#include "gridiron/device/configurations.h"
#include "gridiron/device/machine_file.h"

namespace gridiron::experiment {

/// Requirements of a frame besides the view.
struct FrameRequest {
  std::uint32_t width = 1024, height = 1024;
  Shading shading = Shading::kNone;
};

/// Facts of a frame that need no clock.
struct FrameFacts {
  sim::BuildWork build;                  ///< of the structure by the general core
  std::uint64_t traversal_steps = 0;     ///< steps through the structure, all packets
  std::uint64_t intersection_tests = 0;  ///< (SIMD group, triangle) tests; 0 of tiles, which draw triangles
  std::uint64_t scene_bytes = 0;         ///< structure and triangles in main memory
  std::uint64_t picture_hash = 0;
  std::uint32_t dropped_triangles = 0;       ///< of zero area
  std::optional<GridRecord> grid;            ///< of systems that have one
  std::uint64_t triangle_bytes = 0;          ///< of the scene: triangle records; from here on for the grid alone
  std::uint64_t fetched_triangle_bytes = 0;  ///< requested by gets of triangle records
  std::uint64_t main_memory_bytes = 0;       ///< scene, frame record and output planes
  std::uint64_t local_store_bytes = 0;       ///< data, and the budgets of code and stack

  /// Counted steps of the build, of all kinds.
  [[nodiscard]] std::uint64_t build_steps() const;
};

/// Counts of software caches, over all cores.
struct CacheFacts {
  double node_hit_percent = 0, triangle_hit_percent = 0;  ///< look-ups that started no fetch
  std::uint64_t suspended_packets = 0;                    ///< times that a packet waited for its line
};

/// The result of a run on a machine.
struct TimedFrame {
  sim::FrameTiming timing;
  std::optional<CacheFacts> caches;              ///< of systems that have them
  std::optional<tool::BuildCost> cores_build{};  ///< of systems whose cores build; with the passes, the picture's last
};

/// A frame that can be timed on any machine: by replay, or by rendering it again.
class Recording {
 public:
  virtual ~Recording() = default;
  [[nodiscard]] virtual const FrameFacts& facts() const = 0;
  /// @param core_count  0: the machine's. A pure function of its arguments. Errors: Failure.
  [[nodiscard]] virtual TimedFrame time(const sim::MachineProfile& machine, std::uint32_t core_count) const = 0;
};

/// A way of rendering.
class System {
 public:
  virtual ~System() = default;
  /// @returns a name that identifies equal systems.
  [[nodiscard]] virtual std::string key() const = 0;
  /// Renders a frame on the calling thread. Errors: Failure; kBadInput if the scene does not fit the machine.
  [[nodiscard]] virtual std::unique_ptr<Recording> record(const View& view, const FrameRequest& request) const = 0;
};

/// A system as shown in tables: one column each.
struct Contender {
  std::string key;    ///< suffix of CSV columns
  std::string title;  ///< for people
  std::shared_ptr<const System> system;
  std::shared_ptr<const System> unhidden;  ///< the same without hiding the latency of its fetches
  std::string hiding;                      ///< how `system` hides it, for people
  bool is_grid = true;                     ///< false: a hierarchy
  PaperGrowth paper_growth;                ///< growth of such a structure by the paper's Table 1
};

/// The columns of every table that compares systems.
[[nodiscard]] std::vector<Contender> make_contenders();

/// The machine whose main memory must hold every scene.
[[nodiscard]] const tool::Machine& home_machine();

/// Parameters of core's own engines, the grid and the tree.
struct GridVariant {
  std::string key;
  tool::Configuration configuration;
  Accuracy accuracy = Accuracy::kStandard;
  sim::StoreSize store = sim::StoreSize::k256KB;
  std::uint32_t tile_width = sim::usual_tile_width(sim::StoreSize::k256KB);
  bool depth = false;  ///< whether distances are requested too
  /// Whether a packet fetches the normals of the triangles that it shows, one after another, when it has traced its
  /// rays.
  bool late_normals = false;
  tool::Builder builder = tool::Builder::kMaster;  ///< of a tree
};

/// @returns the configuration with that name, e.g. "grid". Precondition: it exists.
[[nodiscard]] GridVariant grid_variant(std::string_view configuration);

/// @returns "4 cell blocks and 3 triangle buffers": the buffers of a configuration. Precondition as above.
[[nodiscard]] std::string buffer_words(std::string_view configuration);

/// An engine of core, rendered in checked mode with 4 lanes and timed by replay.
class GridSystem : public System {
 public:
  explicit GridSystem(GridVariant variant) : variant_(std::move(variant)) {}
  [[nodiscard]] std::string key() const override { return variant_.key; }
  [[nodiscard]] std::unique_ptr<Recording> record(const View& view, const FrameRequest& request) const override;

 private:
  GridVariant variant_;
};

/// Renders the frame with all its planes, without a clock: in plain mode, in the chip's groups of 4 rays. Errors:
/// Failure; kBadInput if the scene does not fit the machine.
[[nodiscard]] Answers render_answers(const GridVariant& variant, const View& view, const FrameRequest& request);

/// A profile's answers about rays that pass very close to a point.
///
/// A look is a picture of kWidth x kWidth pixels from the eye of a view, so small that all its rays pass the point
/// within a few roundings of their directions.
class CloseLook {
 public:
  static constexpr std::uint32_t kWidth = 32;
  /// Errors: Failure; kBadInput if the scene does not fit the machine.
  CloseLook(const GridVariant& variant, const View& view);
  ~CloseLook();

  /// Appends the answers about the rays of a look, but for colours. Errors: Failure.
  void look_at(const Vec3& point, Answers& answers);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Runs `work` several times. @returns the least of each time.
[[nodiscard]] tool::HostSeconds least_host_seconds(std::uint32_t repeats, const std::function<void()>& work);

struct HostFrame {
  tool::HostSeconds seconds;  ///< the scene's build not included
  FrameRecord record{};       ///< camera and size of it
};

/// Renders the frame directly on this host: plain mode, no simulated clock. @param threads  host threads. Errors:
/// Failure.
[[nodiscard]] HostFrame render_on_host(const GridVariant& variant, const View& view, const FrameRequest& request,
                                       std::uint32_t threads, std::uint32_t repeats);

}  // namespace gridiron::experiment
