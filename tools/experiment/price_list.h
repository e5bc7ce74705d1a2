// Price list: the cost of every accuracy profile on the simulated chip, and the errors of its answers.
// Memory: owns views and results. Threads: collect() starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/answers.h"
#include "experiment/plan.h"
#include "experiment/systems.h"
#include "experiment/views.h"

namespace gridiron::experiment {

/// An accuracy profile as shown in the list.
struct Profile {
  std::string key;  ///< its name on the command line
  Accuracy accuracy;
  std::string words;  ///< what it does
};

/// @returns all accuracy profiles, the least accurate first; those that change the geometry last.
[[nodiscard]] std::vector<Profile> make_profiles();

/// Names of the configurations that each profile is rendered with; the first gives the truth. Profile paper has no
/// triangles for the last.
inline constexpr const char* kPricedConfigurations[] = {"grid", "reference", "best"};

/// One profile in one configuration on one view.
struct Price {
  std::size_t view, configuration, profile;  ///< indices
  GridVariant variant;
  Plan::RunId frame, with_distances, starved;  ///< the last: `frame` on the starved machine
  std::optional<Comparison> errors{};          ///< nothing where the frame or its truth cannot be rendered
  /// Of rays aimed at edges and vertices, about as many as pixels. Nothing also through the tree: such rays lie closer
  /// together than its tiles have filters for, so that every pixel is decided exactly, triangle by triangle.
  std::optional<HitCounts> at_edges{};
  bool same_picture = false;  ///< with distances and without

  /// Whether there are triangles for the profile. If not, its runs fail, and tables have no row.
  [[nodiscard]] bool is_possible() const {
    return variant.configuration.has_grid() || variant.accuracy != Accuracy::kPaper;
  }
};

/// The runs to time, and their results.
class PriceList {
 public:
  /// Plans all frames. @param views  not empty; their cameras do not depend on the profile.
  PriceList(std::vector<View> views, std::uint32_t width, std::uint32_t height);

  /// Runs everything. Results do not depend on `threads`. Errors: as Plan::execute().
  /// @param step_done  called serialised after each of step_count() steps.
  void collect(std::uint32_t threads, const std::function<void()>& step_done);
  [[nodiscard]] std::size_t step_count() const { return plan_.run_count() + prices_.size(); }

  [[nodiscard]] const std::vector<View>& views() const { return views_; }
  [[nodiscard]] const std::vector<Profile>& profiles() const { return profiles_; }
  [[nodiscard]] const std::vector<Price>& prices() const { return prices_; }  ///< by view, configuration, profile
  [[nodiscard]] const Machine& machine() const { return machine_; }
  [[nodiscard]] const Machine& starved() const { return starved_; }
  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] FrameRequest request() const;

  [[nodiscard]] const Price& price(std::size_t view, std::size_t configuration, std::size_t profile) const;
  /// @returns the profile's index, or nothing.
  [[nodiscard]] std::optional<std::size_t> find_profile(std::string_view key) const;

  [[nodiscard]] const RunResult& frame(const Price& price) const { return plan_.result(price.frame); }
  [[nodiscard]] const RunResult& with_distances(const Price& price) const { return plan_.result(price.with_distances); }
  [[nodiscard]] const RunResult& on_starved(const Price& price) const { return plan_.result(price.starved); }

 private:
  void compare_view(std::size_t view, const std::function<void()>& step_done);
  [[nodiscard]] Answers answers_at(const std::vector<Vec3>& points, const Price& price) const;

  std::vector<View> views_;
  std::vector<Profile> profiles_;
  Machine machine_, starved_;
  std::uint32_t width_, height_;
  Plan plan_;
  std::vector<Price> prices_;
};

}  // namespace gridiron::experiment
