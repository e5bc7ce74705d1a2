// Price list. SPDX-License-Identifier: Apache-2.0
#include "experiment/price_list.h"

#include <report/report.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/failure.h"
#include "base/value_bytes.h"
#include "experiment/edge_points.h"
#include "experiment/sections.h"
#include "experiment/workers.h"
#include "files/interrupt.h"
#include "gridiron/device/accuracies.h"

namespace gridiron::experiment {
namespace {

constexpr const char* kTruth = "exact";
constexpr double kStarvation = 8;  ///< divisor of the bandwidth for the starved machine

Machine make_starved(const Machine& machine) {
  Machine starved = machine;
  starved.profile.channel_bytes_per_cycle /= kStarvation;
  starved.key += "/bandwidth=1/" + number_text(kStarvation);
  return starved;
}

}  // namespace

std::vector<Profile> make_profiles() {
  std::vector<Profile> profiles;
  for (const tool::NamedAccuracy& named : tool::accuracies()) {
    profiles.push_back({std::string(named.name), named.accuracy, std::string(named.description)});
  }
  return profiles;
}

PriceList::PriceList(std::vector<View> views, std::uint32_t width, std::uint32_t height)
    : views_(std::move(views)),
      profiles_(make_profiles()),
      machine_(built_in_machine("cell-ps3")),
      starved_(make_starved(machine_)),
      width_(width),
      height_(height),
      plan_(width, height) {
  for (std::size_t view = 0; view < views_.size(); ++view) {
    for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
      for (std::size_t profile = 0; profile < profiles_.size(); ++profile) {
        GridVariant variant = grid_variant(kPricedConfigurations[configuration]);
        variant.key += "/" + profiles_[profile].key;
        variant.accuracy = profiles_[profile].accuracy;
        GridVariant deep = variant;
        deep.key += "/distances";
        deep.depth = true;
        const auto system = std::make_shared<GridSystem>(variant), deep_system = std::make_shared<GridSystem>(deep);
        const auto add = [&](const std::shared_ptr<const System>& added, const Machine& on) {
          return plan_.add(views_[view], added, request().shading, on, kPaperCores);
        };
        prices_.push_back({.view = view,
                           .configuration = configuration,
                           .profile = profile,
                           .variant = std::move(variant),
                           .frame = add(system, machine_),
                           .with_distances = add(deep_system, machine_),
                           .starved = add(system, starved_)});
      }
    }
  }
}

FrameRequest PriceList::request() const {
  return {.width = width_, .height = height_, .shading = Shading::kSimple};
}

const Price& PriceList::price(std::size_t view, std::size_t configuration, std::size_t profile) const {
  return prices_[(view * std::size(kPricedConfigurations) + configuration) * profiles_.size() + profile];
}

std::optional<std::size_t> PriceList::find_profile(std::string_view key) const {
  const auto found = std::ranges::find(profiles_, key, &Profile::key);
  return found == profiles_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - profiles_.begin()));
}

Answers PriceList::answers_at(const std::vector<Vec3>& points, const Price& price) const {
  CloseLook look(price.variant, views_[price.view]);
  Answers answers;
  for (const Vec3& point : points) look.look_at(point, answers);
  return answers;
}

void PriceList::compare_view(std::size_t view, const std::function<void()>& step_done) {
  // If a frame failed for the clock, it is not rendered for its answers; the results of its runs say why.
  const auto answers_of = [&](const Price& price) -> std::optional<Answers> {
    tool::stop_if_interrupted();
    if (frame(price).failed()) return std::nullopt;
    return render_answers(price.variant, views_[view], request());
  };
  const Price& true_price = price(view, 0, *find_profile(kTruth));
  const std::optional<Answers> truth = answers_of(true_price);
  std::vector<Vec3> points;
  Answers truth_at_edges;
  if (truth) {
    constexpr std::size_t kRays = std::size_t{CloseLook::kWidth} * CloseLook::kWidth;
    points = edge_points(views_[view].mesh().view(), truth->ids, (truth->ids.size() + kRays - 1) / kRays);
    truth_at_edges = answers_at(points, true_price);
  }
  for (Price& price : prices_) {
    if (price.view != view) continue;
    const std::optional<Answers> answers = truth ? answers_of(price) : std::nullopt;
    if (answers) {
      price.errors = compare_answers(*truth, *answers);
      if (price.variant.configuration.has_grid()) {
        price.at_edges = count_hits(truth_at_edges, answers_at(points, price));
      }
      const std::uint64_t hash = tool::image_hash(answers->color);
      price.same_picture = hash == frame(price).facts.picture_hash && hash == with_distances(price).facts.picture_hash;
    }
    step_done();
  }
}

void PriceList::collect(std::uint32_t threads, const std::function<void()>& step_done) {
  plan_.execute(threads, [&](std::uint32_t, std::uint32_t) { step_done(); });
  std::mutex mutex;
  const auto compare = [&](std::size_t view) {
    compare_view(view, [&] {
      const std::lock_guard lock(mutex);
      step_done();
    });
  };
  const auto pack = [this](std::size_t view) {
    tool::ByteWriter writer;
    for (const Price& price : prices_) {
      if (price.view != view) continue;
      writer.add(price.errors);
      writer.add(price.at_edges);
      writer.add(price.same_picture);
    }
    return writer.take();
  };
  const auto unpack = [&](std::size_t view, const tool::Bytes& bytes) {
    tool::ByteReader reader(bytes);
    for (Price& price : prices_) {
      if (price.view != view) continue;
      reader.take(price.errors);
      reader.take(price.at_edges);
      reader.take(price.same_picture);
      step_done();
    }
  };
  share_work(threads, views_.size(), compare, {pack, unpack});
}

}  // namespace gridiron::experiment
