// glTF motion: the animations of a glTF file, sampled as its specification says: Assimp plays steps and splines as
// straight lines, and cuts weights below 0.
// Source: glTF 2.0, section 3.11 and appendix C. Memory: its own. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "import/gltf_scene.h"
#include "import/node_pose.h"

namespace gridiron::tool {

/// Keys of one property of a node.
class GltfSampler {
 public:
  /// @returns nothing if keys or values are damaged. @param width  values of a key: 3, 4, or weights of all targets.
  [[nodiscard]] static std::optional<GltfSampler> read(const GltfText& text, const Json& sampler, unsigned components,
                                                       std::size_t width);

  /// @returns the values at a moment; quaternions on the shortest arc, of length 1. @param seconds  on the file's
  /// clock.
  [[nodiscard]] std::vector<double> at(double seconds, bool is_rotation) const;
  [[nodiscard]] double last_second() const { return static_cast<double>(times_.back()); }

 private:
  enum class Curve : unsigned char { kStep, kLine, kSpline };

  [[nodiscard]] double value(std::size_t key, std::size_t part, std::size_t of) const;

  Curve curve_ = Curve::kLine;
  std::size_t width_ = 0;
  std::vector<float> times_, values_;
};

/// One animation of a file.
class GltfMotion {
 public:
  /// @param animation  nothing: the scene at rest.
  GltfMotion(const GltfScene& scene, std::optional<std::size_t> animation);

  [[nodiscard]] double seconds() const { return seconds_; }
  /// Channels with a damaged sampler.
  [[nodiscard]] std::size_t damaged_count() const { return damaged_; }
  [[nodiscard]] Movement movement_at(double seconds) const;

 private:
  struct Channel {
    std::size_t node = 0;
    std::string path;
    GltfSampler sampler;
  };

  const GltfScene& scene_;
  std::vector<Channel> channels_;
  double seconds_ = 0;
  std::size_t damaged_ = 0;
};

}  // namespace gridiron::tool
