// Texture: a picture of base colours, decoded to linear light, with coarser levels for large footprints.
// Memory: 8 bytes a texel. Threads: any may sample. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "import/srgb.h"

namespace gridiron::tool {

/// How coordinates outside 0..1 are meant.
enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp };

class Texture {
 public:
  static constexpr std::uint32_t kMostWidth = 16384;  ///< texels a side

  /// Decodes a PNG or JPEG file. @returns nothing if it is neither, damaged, too large, or of a kind that this build
  /// cannot read.
  [[nodiscard]] static std::optional<Texture> decode(std::span<const std::byte> file);

  /// @returns the option of the build with which decode() would read such a file; nothing if it does, or none would.
  [[nodiscard]] static std::optional<std::string_view> missing_option(std::span<const std::byte> file);

  /// @param rgb  sRGB, 3 bytes a texel, first row on top; width and height at least 1.
  Texture(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb);

  /// @returns the linear colour around a point, bilinear in the level whose texels are as wide as the footprint.
  /// @param u, v  0..1 across, and upwards from the last row. @param texels  width of the footprint, texels of the
  /// file.
  [[nodiscard]] Vec3 sample(float u, float v, Wrap wrap_u, Wrap wrap_v, float texels) const;

  [[nodiscard]] std::uint32_t width() const { return levels_[0].width; }
  [[nodiscard]] std::uint32_t height() const { return levels_[0].height; }

 private:
  struct Level {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint16_t> rgb;  ///< linear, 65535: 1

    [[nodiscard]] Vec3 texel(std::int64_t x, std::int64_t y, Wrap wrap_u, Wrap wrap_v) const;
  };
  void add_coarser_levels();

  std::vector<Level> levels_;  ///< each half as wide and high as the one before, down to one texel
};

}  // namespace gridiron::tool
