// Picture files as numbers: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/picture.h"

#include <OpenImageIO/imageio.h>

namespace gridiron::test {

std::optional<Picture> load_picture(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) return std::nullopt;
  const OIIO::ImageSpec& spec = input->spec();
  Picture picture{static_cast<std::uint32_t>(spec.width),
                  static_cast<std::uint32_t>(spec.height),
                  static_cast<std::uint32_t>(spec.nchannels),
                  {}};
  const std::size_t count = std::size_t{picture.width} * picture.height * picture.channels;
  picture.values.resize(count);
  if (spec.format == OIIO::TypeDesc::UINT8) {
    std::vector<std::uint8_t> bytes(count);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, bytes.data())) return std::nullopt;
    std::copy(bytes.begin(), bytes.end(), picture.values.begin());
  } else if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.values.data())) {
    return std::nullopt;
  }
  return picture;
}

std::optional<PictureDifference> compare_pictures(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) return std::nullopt;
  PictureDifference difference;
  for (std::size_t pixel = 0; pixel < std::size_t{a.width} * a.height; ++pixel) {
    bool differs = false;
    for (std::size_t channel = 0; channel < a.channels; ++channel) {
      const float left = a.values[pixel * a.channels + channel];
      const float right = b.values[pixel * a.channels + channel];
      if (left == right) continue;
      differs = true;
      difference.largest = std::max(difference.largest, std::fabs(double{left} - double{right}));
    }
    if (differs && difference.differing_pixels++ == 0) difference.first_pixel = pixel;
  }
  return difference;
}

}  // namespace gridiron::test
