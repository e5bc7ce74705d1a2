// What each accuracy profile costs for each kind of secondary rays, and what is wrong with their answers.
// Memory: owns scenes and results. Threads: collect() starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiment/answers.h"
#include "experiment/effect_frames.h"
#include "experiment/price_list.h"
#include "experiment/ray_tap.h"
#include "experiment/secondary_scenes.h"
#include "experiment/views.h"

namespace gridiron::experiment {

/// Wrong answers to rays.
struct RayErrors {
  HitCounts hits;
  std::uint64_t self_hits = 0;  ///< of the false or too near hits, those very near the ray's origin

  RayErrors& operator+=(const RayErrors& more);
};

/// The share of a scene's diagonal within which a hit that is not there counts as a self-hit.
inline constexpr double kVeryNear = 1e-3;

/// Compares answers with true ones. Of rays that want any hit it only matters whether there is one.
///
/// @param truth, answers  ids, and distances as far as kVeryNear counts them; as many as rays.
/// @param near            a distance. Rays with a wrong hit that is not farther away have hit themselves.
[[nodiscard]] RayErrors compare_rays(const Answers& truth, const Answers& answers, double near);

/// A kind of rays in a scene with an accuracy.
struct SecondaryPrice {
  std::size_t scene = 0, profile = 0;  ///< indices
  RayKind kind{};
  EffectFrame frame{};             ///< with the rays
  PictureErrors picture{};         ///< against exact
  RayErrors errors{}, at_edges{};  ///< against exact on the triangles as the frame stores them

  /// Rays of the kind that the frame counts; of refraction those that glass reflects too.
  [[nodiscard]] std::uint64_t rays() const;
};

/// A kind of rays in all closed solids with an accuracy: how many go astray, of those that must hit and must not hit.
struct SolidPrice {
  std::size_t profile = 0;
  RayKind kind{};
  HitCounts enclosed{}, at_edges{};  ///< rays that hit something whatever their direction; the same, aimed at edges
  std::uint64_t edge_integers = 0;   ///< decisions in integers that these rays took
  HitCounts open{};                  ///< rays that leave a convex body
};

/// @returns the counts of a solid's rays, profile and kind left open. Errors: tool::Failure.
[[nodiscard]] SolidPrice price_solid(const Solid& solid, const EffectFrameRequest& request);

/// The frames to time, the rays to ask, and their results.
class SecondaryPrices {
 public:
  /// @param view  a mesh to render beside the scenes of effects. @param width, height  of the accuracy experiment's
  /// pictures; those of secondary rays have an eighth of them, 16 to 256 pixels.
  SecondaryPrices(const View& view, std::uint32_t width, std::uint32_t height);

  /// Runs everything. Results do not depend on `threads`. Errors: tool::Failure.
  /// @param step_done  called serialised after each of step_count() steps.
  void collect(std::uint32_t threads, const std::function<void()>& step_done);
  [[nodiscard]] std::size_t step_count() const { return plain_.size() + 2 * prices_.size() + solids_.size(); }
  [[nodiscard]] std::size_t frame_count() const { return plain_.size() + prices_.size(); }

  [[nodiscard]] const std::vector<EffectScene>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<Profile>& profiles() const { return profiles_; }     ///< that render effects
  [[nodiscard]] const std::vector<Profile>& refused() const { return refused_; }       ///< that do not
  [[nodiscard]] const std::vector<SecondaryPrice>& prices() const { return prices_; }  ///< by scene, kind, profile
  [[nodiscard]] const std::vector<SolidPrice>& solids() const { return solids_; }      ///< by kind, profile
  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }

  [[nodiscard]] const SecondaryPrice& price(std::size_t scene, RayKind kind, std::size_t profile) const;
  [[nodiscard]] const SolidPrice& solid(RayKind kind, std::size_t profile) const;
  /// @returns the frame of a price's scene and profile without secondary rays.
  [[nodiscard]] const EffectFrame& without(const SecondaryPrice& price) const;
  [[nodiscard]] std::size_t find_profile(std::string_view key) const;  ///< Precondition: it renders effects.

 private:
  [[nodiscard]] EffectFrameRequest request(std::size_t profile) const;
  void compare(SecondaryPrice& price) const;

  std::vector<EffectScene> scenes_;
  std::vector<Profile> profiles_, refused_;
  std::uint32_t width_, height_;
  std::vector<EffectFrame> plain_;  ///< by scene, profile
  std::vector<SecondaryPrice> prices_;
  std::vector<SolidPrice> solids_;
};

}  // namespace gridiron::experiment
