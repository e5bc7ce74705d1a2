// The paper's figures. SPDX-License-Identifier: Apache-2.0
#include "experiment/paper_values.h"

#include <algorithm>

namespace gridiron::experiment {
namespace {

// Table 2: the paper's text keeps these digits of the horse (48,...; 96,...) and of the armadillo (...,974; ...,944);
// the counts are those of the models it names. The conference room's begin in one of its two columns and end in the
// other (166,...; ...,867; 282,...; ...,755). Table 3 and Figs. 5-7 lost their numbers altogether.
constexpr std::array<PaperView, 5> kViews = {{
    {"bunny", 35'947, 69'451, {71.7, 71.2}, {15.4, 15.6}},
    {"horse", 48'485, 96'966, {75.2, 73.8}, {14.1, 14.7}},
    {"armadillo_standin", 172'974, 345'944, {75.7, 75.4}, {10.3, 10.6}},
    {"conference_1", 166'867, 282'755, {71.6, 62.1}, {18.8, 16.5}},
    {"conference_2", 166'867, 282'755, {73.5, 60.1}, {21.8, 18.5}},
}};

}  // namespace

std::span<const PaperView> paper_views() {
  return kViews;
}

const PaperView* find_paper_view(std::string_view key) {
  const auto* found = std::ranges::find(kViews, key, &PaperView::key);
  return found == kViews.end() ? nullptr : found;
}

double derived_single_wait_percent(const PaperView& view, std::size_t cores_index) {
  const double hidden = view.hidden[cores_index] / 100, gain = view.fps_gain[cores_index] / 100;
  return 100 * gain / ((1 + gain) * hidden);
}

double derived_double_wait_percent(const PaperView& view, std::size_t cores_index) {
  const double hidden = view.hidden[cores_index] / 100, gain = view.fps_gain[cores_index] / 100;
  return derived_single_wait_percent(view, cores_index) * (1 - hidden) * (1 + gain);
}

}  // namespace gridiron::experiment
