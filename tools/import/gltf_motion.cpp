// glTF motion. SPDX-License-Identifier: Apache-2.0
#include "import/gltf_motion.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace gridiron::tool {
namespace {

using Values = std::vector<double>;

double length_of(const Values& values) {
  double square = 0;
  for (const double value : values) square += value * value;
  return std::sqrt(square);
}

Values unit(Values values) {
  const double length = length_of(values);
  if (!(length > 0)) return {0, 0, 0, 1};
  for (double& value : values) value /= length;
  return values;
}

// Between two quaternions, on the shorter of two arcs.
Values on_arc(Values from, Values to, double share) {
  from = unit(std::move(from));
  to = unit(std::move(to));
  double cosine = 0;
  for (std::size_t i = 0; i < 4; ++i) cosine += from[i] * to[i];
  if (cosine < 0) {
    for (double& value : to) value = -value;
    cosine = -cosine;
  }
  constexpr double kNearlyOne = 1 - 1e-9;
  double a = 1 - share, b = share;
  if (cosine < kNearlyOne) {
    const double angle = std::acos(cosine), sine = std::sin(angle);
    a = std::sin((1 - share) * angle) / sine;
    b = std::sin(share * angle) / sine;
  }
  for (std::size_t i = 0; i < 4; ++i) from[i] = a * from[i] + b * to[i];
  return unit(std::move(from));
}

// Translation times rotation times scale.
NodeMatrix matrix_of(const Values& translation, const Values& rotation, const Values& scale) {
  const Values q = unit(rotation);
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                             {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  NodeMatrix matrix;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column) matrix[row][column] = turn[row][column] * scale[column];
    matrix[row][3] = translation[row];
  }
  return matrix;
}

Values numbers_or(const Json& node, const char* key, Values otherwise) {
  return numbers_in(node, key, otherwise.size()).value_or(otherwise);
}

}  // namespace

std::optional<GltfSampler> GltfSampler::read(const GltfText& text, const Json& sampler, unsigned components,
                                             std::size_t width) {
  GltfSampler result;
  const std::string curve = words_in(sampler, "interpolation");
  if (curve == "STEP") result.curve_ = Curve::kStep;
  if (curve == "CUBICSPLINE") result.curve_ = Curve::kSpline;
  auto times = text.numbers(index_in(sampler, "input"), 1);
  auto values = text.numbers(index_in(sampler, "output"), components);
  const std::size_t parts = result.curve_ == Curve::kSpline ? 3 : 1;
  if (!times || !values || width == 0 || values->size() != times->size() * width * parts) return std::nullopt;
  const auto is_finite = [](float value) { return std::isfinite(value); };
  if (!std::ranges::all_of(*times, is_finite) || !std::ranges::all_of(*values, is_finite)) return std::nullopt;
  if (!std::ranges::is_sorted(*times)) return std::nullopt;
  result.width_ = width;
  result.times_ = std::move(*times);
  result.values_ = std::move(*values);
  return result;
}

// Of a spline's key the parts are the tangent before it, its value, the tangent behind it.
double GltfSampler::value(std::size_t key, std::size_t part, std::size_t of) const {
  const bool is_spline = curve_ == Curve::kSpline;
  const std::size_t place = is_spline ? (3 * key + part) * width_ + of : key * width_ + of;
  return static_cast<double>(values_[place]);
}

std::vector<double> GltfSampler::at(double seconds, bool is_rotation) const {
  constexpr std::size_t kBefore = 0, kValue = 1, kBehind = 2;
  const auto after = std::upper_bound(times_.begin(), times_.end(), seconds,
                                      [](double moment, float time) { return moment < static_cast<double>(time); });
  const auto next = static_cast<std::size_t>(after - times_.begin());
  const auto key_values = [&](std::size_t key) {
    Values values(width_);
    for (std::size_t i = 0; i < width_; ++i) values[i] = value(key, kValue, i);
    return is_rotation ? unit(std::move(values)) : values;
  };
  if (next == 0) return key_values(0);
  if (next == times_.size() || curve_ == Curve::kStep) return key_values(next - 1);
  const double begin = static_cast<double>(times_[next - 1]), span = static_cast<double>(times_[next]) - begin;
  const double t = (seconds - begin) / span;  // the times differ: one is after the moment
  if (curve_ == Curve::kLine && is_rotation) return on_arc(key_values(next - 1), key_values(next), t);
  Values values(width_);
  for (std::size_t i = 0; i < width_; ++i) {
    const double a = value(next - 1, kValue, i), b = value(next, kValue, i);
    if (curve_ == Curve::kLine) {
      values[i] = a + (b - a) * t;
      continue;
    }
    const double behind = span * value(next - 1, kBehind, i), before = span * value(next, kBefore, i);
    const double t2 = t * t, t3 = t2 * t;
    values[i] = (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * behind + (3 * t2 - 2 * t3) * b + (t3 - t2) * before;
  }
  return is_rotation ? unit(std::move(values)) : values;
}

GltfMotion::GltfMotion(const GltfScene& scene, std::optional<std::size_t> animation) : scene_(scene) {
  const GltfText& text = scene.text();
  const Json* const own = text.item("animations", animation);
  const Json *const channels = member(own, "channels"), *const samplers = member(own, "samplers");
  if (channels == nullptr || samplers == nullptr) return;
  for (const Json& channel : *channels) {
    const Json* const target = member(&channel, "target");
    const std::optional<std::size_t> node = target != nullptr ? index_in(*target, "node") : std::nullopt;
    if (!node) continue;  // an extension's
    const std::string path = words_in(*target, "path");
    const Json* const owner = text.item("nodes", node);
    const std::optional<std::size_t> index = index_in(channel, "sampler");
    std::optional<GltfSampler> sampler;
    if (owner != nullptr && index && samplers->is_array() && *index < samplers->size()) {
      const bool is_rotation = path == "rotation";
      if (is_rotation || path == "translation" || path == "scale") {
        const unsigned width = is_rotation ? 4 : 3;
        sampler = GltfSampler::read(text, (*samplers)[*index], width, width);
      } else if (path == "weights") {
        const Json* const primitives = member(text.item("meshes", index_in(*owner, "mesh")), "primitives");
        const bool has_one = primitives != nullptr && primitives->is_array() && !primitives->empty();
        const Json* const targets = has_one ? member(&primitives->front(), "targets") : nullptr;
        if (targets != nullptr) sampler = GltfSampler::read(text, (*samplers)[*index], 1, targets->size());
      }
    }
    if (!sampler) {
      ++damaged_;
      continue;
    }
    constexpr double kMostSeconds = 1e6;
    seconds_ = std::max(seconds_, std::clamp(sampler->last_second(), 0.0, kMostSeconds));
    channels_.push_back({*node, path, std::move(*sampler)});
  }
}

Movement GltfMotion::movement_at(double seconds) const {
  std::unordered_map<std::size_t, std::unordered_map<std::string, Values>> moved;
  for (const Channel& channel : channels_) {
    moved[channel.node][channel.path] = channel.sampler.at(seconds, channel.path == "rotation");
  }
  Movement movement;
  movement.has_weights = true;
  for (const auto& [node, index] : scene_.nodes()) {
    const auto found = moved.find(index);
    const std::unordered_map<std::string, Values> none;
    const auto& values = found != moved.end() ? found->second : none;
    const auto value_of = [&values](const std::string& path, const Values& otherwise) {
      const auto place = values.find(path);
      return place != values.end() ? place->second : otherwise;
    };
    if (values.contains("translation") || values.contains("rotation") || values.contains("scale")) {
      const Json& own = *scene_.text().item("nodes", index);
      movement.parent_from_node.emplace(node,
                                        matrix_of(value_of("translation", numbers_or(own, "translation", {0, 0, 0})),
                                                  value_of("rotation", numbers_or(own, "rotation", {0, 0, 0, 1})),
                                                  value_of("scale", numbers_or(own, "scale", {1, 1, 1}))));
    }
    std::vector<float> weights = scene_.rest_weights(index);
    if (const auto place = values.find("weights"); place != values.end()) {
      weights.assign(place->second.begin(), place->second.end());
    }
    if (!weights.empty()) movement.weights.emplace(node, std::move(weights));
  }
  return movement;
}

}  // namespace gridiron::tool
