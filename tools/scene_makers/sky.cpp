// The sky. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "scene_makers/nff_text.h"
#include "scene_makers/procedural.h"

namespace gridiron::scene_makers {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are written as they lie in memory");

// Directions of a camera in the middle for each face: ahead, right, up.
struct FaceFrame {
  Point ahead, right, up;
};
constexpr std::array<FaceFrame, 6> kFrames = {{{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                               {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                               {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                               {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                               {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                                               {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}}};

Point sky_color(const Point& direction) {
  const double height = direction[1];
  if (height < 0) return Point{0.35, 0.27, 0.2} * (0.4 + 0.6 * (1 + height));
  const double haze = (1 - height) * (1 - height);
  const Point sun = Point{2, 3, -6} * (1.0 / 7.0);
  const double near_sun = std::max(0.0, dot(direction, sun));
  double glow = near_sun;
  for (int power = 0; power < 5; ++power) glow *= glow;  // to the 32nd
  return Point{0.15, 0.35, 0.8} + Point{0.6, 0.5, 0.15} * haze + Point{6, 5, 3.5} * glow;
}

}  // namespace

std::vector<char> make_sky_face(std::uint32_t face, std::uint32_t width) {
  const std::string side = std::to_string(width), header = "PF\n" + side + " " + side + "\n-1.0\n";
  std::vector<char> bytes(header.begin(), header.end());
  const FaceFrame& frame = kFrames[face];
  for (std::uint32_t row = width; row-- > 0;) {  // the format's first row is the lowest
    for (std::uint32_t column = 0; column < width; ++column) {
      const double right = (2.0 * column + 1.0) / width - 1.0, up = 1.0 - (2.0 * row + 1.0) / width;
      const Point out = frame.ahead + frame.right * right + frame.up * up;
      const Point color = sky_color(out * (1.0 / std::sqrt(dot(out, out))));
      for (const double channel : color) {
        const auto rounded = static_cast<float>(channel);
        char raw[sizeof rounded];
        std::memcpy(raw, &rounded, sizeof raw);
        bytes.insert(bytes.end(), raw, raw + sizeof raw);
      }
    }
  }
  return bytes;
}

}  // namespace gridiron::scene_makers
