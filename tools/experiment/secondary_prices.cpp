// Prices of secondary rays. SPDX-License-Identifier: Apache-2.0
#include "experiment/secondary_prices.h"

#include <gridiron/base/accuracies.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <utility>

#include "base/value_bytes.h"
#include "experiment/result_bytes.h"
#include "experiment/workers.h"
#include "gridiron/device/configurations.h"

namespace gridiron::experiment {
namespace {

constexpr std::string_view kSceneKeys[] = {"balls", "mount", "gallery"};
constexpr std::string_view kTruth = "exact";
constexpr std::uint32_t kReduction = 8, kLeastWidth = 16, kMostWidth = 256;

std::uint32_t reduced(std::uint32_t width) {
  return std::clamp(width / kReduction, kLeastWidth, kMostWidth);
}

float distance_of(const TracedRay& ray, const RayHit& hit) {
  return hit.id == kNoTriangle ? std::numeric_limits<float>::infinity() : hit.t * glm::length(ray.dir);
}

// Any hit is as good as any other.
std::uint32_t id_for(const TracedRay& ray, std::uint32_t id) {
  return named(ray.kind).wants_any_hit && id != kNoTriangle ? 0 : id;
}

Answers answers_of(std::span<const TracedRay> rays, std::span<const RayHit> hits) {
  Answers answers;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    answers.ids.push_back(id_for(rays[i], hits[i].id));
    answers.depth.push_back(distance_of(rays[i], hits[i]));
  }
  return answers;
}

// The kernel's own answers, with the distances of the nearest hits.
Answers traced_answers(std::span<const TracedRay> rays, std::span<const RayHit> nearest) {
  Answers answers = answers_of(rays, nearest);
  for (std::size_t i = 0; i < rays.size(); ++i) answers.ids[i] = id_for(rays[i], rays[i].id);
  return answers;
}

// Counts of rays of which all must hit something, or none may.
HitCounts count_known(std::span<const TracedRay> rays, bool must_hit, const std::function<bool(std::size_t)>& has_hit) {
  Answers truth, answers;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    truth.ids.push_back(must_hit ? 0 : kNoTriangle);
    answers.ids.push_back(has_hit(i) ? 0 : kNoTriangle);
  }
  return count_hits(truth, answers);
}

}  // namespace

RayErrors& RayErrors::operator+=(const RayErrors& more) {
  hits += more.hits;
  self_hits += more.self_hits;
  return *this;
}

RayErrors compare_rays(const Answers& truth, const Answers& answers, double near) {
  RayErrors errors{count_hits(truth, answers)};
  for (std::size_t i = 0; i < truth.ids.size(); ++i) {
    if (answers.ids[i] == kNoTriangle || !(double{answers.depth[i]} <= near)) continue;
    const bool is_false = truth.ids[i] == kNoTriangle;
    const bool is_nearer = !is_false && truth.ids[i] != answers.ids[i] &&
                           double{answers.depth[i]} * (1 + kBehind) < double{truth.depth[i]};
    errors.self_hits += is_false || is_nearer ? 1u : 0u;
  }
  return errors;
}

SolidPrice price_solid(const Solid& solid, const EffectFrameRequest& request) {
  PreparedEffectFrame frame(solid.scene, request);
  std::vector<TracedRay> enclosed, open;
  for (const TracedRay& ray : trace_secondary_rays(frame)) {
    (solid.is_room || ray.kind == RayKind::kRefraction ? enclosed : open).push_back(ray);
  }
  SolidPrice price;
  price.enclosed = count_known(enclosed, true, [&](std::size_t i) { return enclosed[i].has_hit(); });
  price.open = count_known(open, false, [&](std::size_t i) { return open[i].has_hit(); });
  const RayTree tree(frame);
  const std::vector<TracedRay> aimed = tree.aimed_at_edges(enclosed, tree.nearest(enclosed, Accuracy::kExact));
  WorkCounters work;
  const std::vector<RayHit> hits = tree.nearest(aimed, request.accuracy, work);
  price.edge_integers = std::uint64_t{work[Work::kExactSign]} + work[Work::kExactDistance] + work[Work::kExactOrder];
  price.at_edges = count_known(aimed, true, [&](std::size_t i) { return hits[i].id != kNoTriangle; });
  return price;
}

std::uint64_t SecondaryPrice::rays() const {
  switch (kind) {
    case RayKind::kShadow:
    case RayKind::kArea:
      return frame.count(Work::kShadowRay);
    case RayKind::kOcclusion:
      return frame.count(Work::kOcclusionRay);
    case RayKind::kReflection:
      return frame.count(Work::kMirrorRay);
    case RayKind::kRefraction:
      break;
  }
  return frame.count(Work::kMirrorRay) + frame.count(Work::kRefractedRay);
}

SecondaryPrices::SecondaryPrices(const View& view, std::uint32_t width, std::uint32_t height)
    : width_(reduced(width)), height_(reduced(height)) {
  for (Profile& profile : make_profiles()) {
    const bool renders = accuracy_traits(profile.accuracy).has_scene_shading;
    (renders ? profiles_ : refused_).push_back(std::move(profile));
  }
  for (const std::string_view key : kSceneKeys) scenes_.push_back(make_effect_scene(key));
  scenes_.push_back(scene_of_view(view));
  plain_.resize(scenes_.size() * profiles_.size());
  for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
    for (const NamedRayKind& kind : kRayKinds) {
      for (std::size_t profile = 0; profile < profiles_.size(); ++profile) {
        prices_.push_back({.scene = scene, .profile = profile, .kind = kind.kind});
      }
    }
  }
  for (const NamedRayKind& kind : kRayKinds) {
    for (std::size_t profile = 0; profile < profiles_.size(); ++profile) {
      solids_.push_back({.profile = profile, .kind = kind.kind});
    }
  }
}

const SecondaryPrice& SecondaryPrices::price(std::size_t scene, RayKind kind, std::size_t profile) const {
  return prices_[(scene * std::size(kRayKinds) + static_cast<std::size_t>(kind)) * profiles_.size() + profile];
}

const SolidPrice& SecondaryPrices::solid(RayKind kind, std::size_t profile) const {
  return solids_[static_cast<std::size_t>(kind) * profiles_.size() + profile];
}

const EffectFrame& SecondaryPrices::without(const SecondaryPrice& price) const {
  return plain_[price.scene * profiles_.size() + price.profile];
}

std::size_t SecondaryPrices::find_profile(std::string_view key) const {
  return static_cast<std::size_t>(std::ranges::find(profiles_, key, &Profile::key) - profiles_.begin());
}

EffectFrameRequest SecondaryPrices::request(std::size_t profile) const {
  const tool::Configuration& grid = *tool::find_configuration("grid");
  return {.width = width_,
          .height = height_,
          .lambda = grid.lambda,
          .depths = grid.depths,
          .accuracy = profiles_[profile].accuracy};
}

void SecondaryPrices::compare(SecondaryPrice& price) const {
  const EffectFrame& truth = this->price(price.scene, price.kind, find_profile(kTruth)).frame;
  price.picture = compare_colors(truth.picture.pixels, price.frame.picture.pixels);
  PreparedEffectFrame frame(with_rays_of(scenes_[price.scene], price.kind), request(price.profile));
  const std::vector<TracedRay> rays = trace_secondary_rays(frame);
  const RayTree tree(frame);
  const double near = kVeryNear * double{tree.diagonal()};
  const Accuracy accuracy = profiles_[price.profile].accuracy;
  const std::vector<RayHit> true_hits = tree.nearest(rays, Accuracy::kExact);
  price.errors = compare_rays(answers_of(rays, true_hits), traced_answers(rays, tree.nearest(rays, accuracy)), near);
  const std::vector<TracedRay> aimed = tree.aimed_at_edges(rays, true_hits);
  price.at_edges = compare_rays(answers_of(aimed, tree.nearest(aimed, Accuracy::kExact)),
                                answers_of(aimed, tree.nearest(aimed, accuracy)), near);
}

void SecondaryPrices::collect(std::uint32_t threads, const std::function<void()>& step_done) {
  std::mutex mutex;
  const auto share = [&](std::size_t count, const std::function<void(std::size_t)>& work, ResultBytes results) {
    const auto do_step = [&](std::size_t i) {
      work(i);
      const std::lock_guard lock(mutex);
      step_done();
    };
    const auto unpack = [&](std::size_t i, const tool::Bytes& bytes) {
      results.unpack(i, bytes);
      step_done();
    };
    share_work(threads, count, do_step, {results.pack, unpack});
  };
  const auto frame_bytes = [](auto frame_of) {
    return ResultBytes{[frame_of](std::size_t i) { return bytes_of_frame(frame_of(i)); },
                       [frame_of](std::size_t i, const tool::Bytes& bytes) { take_frame(bytes, frame_of(i)); }};
  };
  const auto render_plain = [&](std::size_t i) {
    plain_[i] =
        render_effect_frame(with_rays_of(scenes_[i / profiles_.size()], std::nullopt), request(i % profiles_.size()));
  };
  share(plain_.size(), render_plain, frame_bytes([this](std::size_t i) -> EffectFrame& { return plain_[i]; }));
  const auto render_price = [&](std::size_t i) {
    SecondaryPrice& price = prices_[i];
    price.frame = render_effect_frame(with_rays_of(scenes_[price.scene], price.kind), request(price.profile));
  };
  share(prices_.size(), render_price, frame_bytes([this](std::size_t i) -> EffectFrame& { return prices_[i].frame; }));
  const auto pack_errors = [this](std::size_t i) {
    tool::ByteWriter writer;
    writer.add(prices_[i].picture);
    writer.add(prices_[i].errors);
    writer.add(prices_[i].at_edges);
    return writer.take();
  };
  const auto unpack_errors = [this](std::size_t i, const tool::Bytes& bytes) {
    tool::ByteReader reader(bytes);
    reader.take(prices_[i].picture);
    reader.take(prices_[i].errors);
    reader.take(prices_[i].at_edges);
  };
  share(prices_.size(), [&](std::size_t i) { compare(prices_[i]); }, {pack_errors, unpack_errors});
  const auto ask_solids = [&](std::size_t i) {
    SolidPrice& price = solids_[i];
    EffectFrameRequest large = request(price.profile);  // nothing is timed, so there is time for more rays
    large.width *= 2;
    large.height *= 2;
    for (const Solid& solid : make_solids(price.kind)) {
      const SolidPrice one = price_solid(solid, large);
      price.enclosed += one.enclosed;
      price.at_edges += one.at_edges;
      price.edge_integers += one.edge_integers;
      price.open += one.open;
    }
  };
  const auto pack_solid = [this](std::size_t i) {
    tool::ByteWriter writer;
    writer.add(solids_[i]);
    return writer.take();
  };
  const auto unpack_solid = [this](std::size_t i, const tool::Bytes& bytes) {
    tool::ByteReader(bytes).take(solids_[i]);
  };
  share(solids_.size(), ask_solids, {pack_solid, unpack_solid});
}

}  // namespace gridiron::experiment
