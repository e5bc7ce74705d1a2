// A trial: one mesh, rays at it, and what every accuracy promises of them, compared with the oracle in two ways: the
// intersector alone, and all of the pipeline from the builder to the pixels.
// Memory: std::vector. Threads: one caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/records.h>
#include <gridiron/build/grid/grid_builder.h>

#include <cfenv>

#include "numeric/oracle.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"

namespace gridiron::test::hard {

/// The requirements of a case, in the letters of README.md.
enum class Grade : std::uint8_t {
  kEqual,    ///< A: the oracle's triangle, and the float that its distance rounds to
  kTie,      ///< B: one of the oracle's ties
  kBounded,  ///< C: bounded steps, no crash, no triangle and no distance that cannot be
  kClosed,   ///< D: no hole in a closed mesh
};

/// An accuracy and what it promises: A, and with it B and D; or C alone.
struct Profile {
  const char* name;
  Accuracy accuracy;
  bool is_exact;
};
consteval Profile profile_of(const char* name, Accuracy accuracy) {
  return {name, accuracy, !accuracy_traits(accuracy).may_leak};
}
inline constexpr Profile kProfiles[] = {
    profile_of("standard", Accuracy::kStandard), profile_of("exact", Accuracy::kExact),
    profile_of("compact", Accuracy::kCompact),   profile_of("fast", Accuracy::kFast),
    profile_of("paper", Accuracy::kPaper),
};
static_assert(std::size(kProfiles) == kAccuracyCount);

/// Rays from one point: any directions, or the pixels of a picture.
struct Rays {
  Vec3 origin{0.0f};
  std::vector<Vec3> directions = {};
  float t_far = kFloatMax;
  std::uint32_t columns = 0;  ///< of the picture; 0: any directions
  Vec3 corner{}, step_x{}, step_y{};
};

/// Rays through the pixels of a picture: (corner + x step_x) + y step_y, row by row.
Rays picture(Vec3 origin, Vec3 corner, Vec3 step_x, Vec3 step_y, std::uint32_t columns, std::uint32_t rows);
/// Makes a picture's directions anew, from its corner and steps. Any other directions stay.
void recompute_picture(Rays& rays);

/// @returns ray i as the oracle takes it.
OracleRay oracle_ray(const Rays& rays, std::size_t i);

/// What a ray was found to hit. By the pipeline `t` is the depth plane's: times the direction's length; 0 where the
/// frame asked for no distances.
struct Answer {
  std::uint32_t id = kNoTriangle;
  float t = kFloatMax;

  /// The same bits.
  friend bool operator==(const Answer& a, const Answer& b);
};

/// How many lanes the intersector runs in, how wide a picture's packets are, in which order it meets the triangles.
struct IntersectorWay {
  std::uint32_t lanes;         ///< 4, 8, 16
  std::uint32_t packet_width;  ///< 8; with lanes 8 also 32, with 16 also 16
  enum class Order : std::uint8_t { kAscending, kDescending, kShuffled } order = Order::kAscending;
};

/// How a frame is rendered.
struct PipelineWay {
  sim::Mode mode;
  sim::StoreSize store;
  std::uint32_t packet_width, lanes;  ///< lanes: or what the host has
  bool wants_distances;
  std::uint32_t techniques;
};
std::span<const PipelineWay> pipeline_ways();

/// A mesh as one accuracy stores it, in all the forms that rays can be shot at.
class Target {
 public:
  Target(const TestMesh& mesh, const GridParameters& grid, const Profile& profile);
  ~Target();
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  [[nodiscard]] Status status() const { return scene_->status(); }
  [[nodiscard]] const Profile& profile() const { return profile_; }
  [[nodiscard]] const TestMesh& mesh() const { return mesh_; }  ///< as stored
  [[nodiscard]] const GridRecord& grid() const { return scene_->need().grid; }
  [[nodiscard]] const GridNeed& need() const { return scene_->need(); }
  [[nodiscard]] bool has_area(std::uint32_t triangle_id) const { return has_area_[triangle_id]; }

  /// The kernel's test of a packet of rays against a triangle, for every packet and every triangle.
  [[nodiscard]] std::vector<Answer> by_intersector(const Rays& rays, const IntersectorWay& way) const;

  /// Frames on the simulated chip: of a picture one, else one of a single pixel for each ray.
  /// More steps than the grid's counts allow (in checked modes), and broken rules, fail the running test.
  /// @param only  rays to be shot, by index; empty: all. @param work  where not null, checked work is added to it.
  [[nodiscard]] std::vector<Answer> by_pipeline(const Rays& rays, const PipelineWay& way,
                                                std::span<const std::size_t> only = {},
                                                sim::WorkTotals* work = nullptr);

  /// Frames rendered so far.
  [[nodiscard]] std::uint64_t frames() const { return frames_; }

 private:
  struct Records;
  struct PixelFrame;
  [[nodiscard]] FrameRecord aimed(const FrameRecord& record, const Rays& rays, const PipelineWay& way) const;
  [[nodiscard]] FrameSettings settings_of(const PipelineWay& way, std::uint32_t width, std::uint32_t height) const;
  void render(PreparedFrame& frame, const PipelineWay& way, bool only_rays, sim::WorkTotals* work);
  PreparedFrame& pixel_frame(const PipelineWay& way);

  Profile profile_;
  TestMesh mesh_;
  std::vector<bool> has_area_;
  std::unique_ptr<Records> records_;
  std::unique_ptr<SceneInMemory> scene_;
  std::vector<std::unique_ptr<PixelFrame>> pixel_frames_;
  std::uint64_t frames_ = 0;
};

/// Rays at the mesh as an accuracy stores it.
using AimAtMesh = std::function<std::vector<Rays>(const TestMesh& stored)>;

/// One mesh and the rays at it.
struct Trial {
  TestMesh mesh;
  Grade grade = Grade::kEqual;
  AimAtMesh aim;
  GridParameters grid = {};
  int rounding = FE_TONEAREST;  ///< while the scene is built and rays are traced
  bool flush = false;           ///< denormals, likewise
  bool flush_builder = true;    ///< as for the rays; else the builder keeps them
};

/// What was shot, by all profiles together where nothing else is said.
struct Tally {
  std::uint64_t rays = 0;    ///< of one profile
  std::uint64_t hits = 0;    ///< of these, that hit by the oracle
  std::uint64_t ties = 0;    ///< of these, with several triangles at one float
  std::uint64_t traced = 0;  ///< times a ray was traced
  std::uint64_t frames = 0;  ///< rendered

  Tally& operator+=(const Tally& other);
};

/// Shoots a trial in every profile, on both ways, and holds each answer against what the profile promises; what differs
/// fails the test that is running. With GRIDIRON_HARD_CASES_TABLE=file the numbers of every trial are appended to it.
Tally shoot(const Trial& trial);

/// As many as a test requests, times GRIDIRON_HARD_CASES_FACTOR if that is set.
std::uint32_t times(std::uint32_t count);

}  // namespace gridiron::test::hard
