// Faces of environment cubes. SPDX-License-Identifier: Apache-2.0
#ifdef GRIDIRON_HAS_PNG
#include <png.h>
#endif

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "base/failure.h"
#include "files/input_file.h"
#include "scene_text/scene_files.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMostFaceBytes = std::size_t{64} << 20;

static_assert(std::endian::native == std::endian::little, "PFM floats are read as they lie in memory");

void require_size(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width != height) input_error(path, "is " + size + " texels; a face of an environment cube is square");
  if (width == 0 || width > kMostEnvironmentWidth) {
    input_error(path, "is " + size + " texels; a face has 1 to " + std::to_string(kMostEnvironmentWidth) + " a side");
  }
}

#ifdef GRIDIRON_HAS_PNG
// Frees libpng's memory between the two calls, even if the second one is never made.
struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(this); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

EnvironmentFace read_png(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  PngImage image;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
    input_error(path, std::string("broken PNG file: ") + image.message);
  }
  require_size(path, image.width, image.height);
  image.format = PNG_FORMAT_RGB;
  EnvironmentFace face{image.width, {}};
  std::vector<std::uint8_t> channels(PNG_IMAGE_SIZE(image));
  const png_color black{};
  if (png_image_finish_read(&image, &black, channels.data(), 0, nullptr) == 0) {
    input_error(path, std::string("broken PNG file: ") + image.message);
  }
  face.texels.resize(std::size_t{face.width} * face.width);
  for (std::size_t i = 0; i < face.texels.size(); ++i) {
    const auto value = [&](std::size_t channel) { return static_cast<float>(channels[3 * i + channel]) / 255.0f; };
    face.texels[i] = Vec3(value(0), value(1), value(2));
  }
  return face;
}
#else
[[noreturn]] EnvironmentFace read_png(const std::filesystem::path& path, std::span<const std::byte>) {
  input_error(path,
              "is a PNG file, which this build of gridiron cannot read (GRIDIRON_WITH_PNG=OFF); a PFM file it can");
}
#endif

// Takes the next word of a PFM header and one white space after it. @returns an empty word if there is none.
std::string_view take_word(std::string_view& text) {
  const std::size_t end = text.find_first_of(" \t\r\n");
  if (end == std::string_view::npos) return {};
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end + 1);
  return word;
}

template <class Number>
Number take_number(const std::filesystem::path& path, std::string_view& text) {
  const std::string_view word = take_word(text);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (word.empty() || error != std::errc{} || end != word.data() + word.size())
    input_error(path, "broken header of a PFM file");
  return number;
}

EnvironmentFace read_pfm(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t channel_count = take_word(text) == "PF" ? 3 : 1;
  EnvironmentFace face;
  face.width = take_number<std::uint32_t>(path, text);
  require_size(path, face.width, take_number<std::uint32_t>(path, text));
  const auto scale = take_number<double>(path, text);
  if (!std::isfinite(scale) || scale == 0) input_error(path, "the scale of a PFM file is a finite number other than 0");
  const std::size_t row_floats = face.width * channel_count;
  if (text.size() != row_floats * face.width * sizeof(float)) {
    input_error(path, "holds " + std::to_string(text.size()) + " bytes of texels instead of " +
                          std::to_string(row_floats * face.width * sizeof(float)));
  }
  face.texels.resize(std::size_t{face.width} * face.width);
  for (std::uint32_t y = 0; y < face.width; ++y) {
    // The format's first row is the lowest.
    const char* row = text.data() + (face.width - 1 - y) * row_floats * sizeof(float);
    for (std::uint32_t x = 0; x < face.width; ++x) {
      Vec3& texel = face.texels[std::size_t{y} * face.width + x];
      for (std::size_t channel = 0; channel < 3; ++channel) {
        std::uint32_t bits = 0;
        const std::size_t from = x * channel_count + (channel_count == 3 ? channel : 0);
        std::memcpy(&bits, row + from * sizeof bits, sizeof bits);
        if (scale > 0) bits = __builtin_bswap32(bits);  // in the format a negative scale means little-endian
        const auto value = std::bit_cast<float>(bits);
        if (!(value >= 0) || std::isinf(value)) {
          input_error(path, "texel " + std::to_string(x) + ", " + std::to_string(y) + " is negative, NaN or infinite");
        }
        texel[static_cast<int>(channel)] = value;
      }
    }
  }
  return face;
}

}  // namespace

EnvironmentFace read_environment_face(const std::filesystem::path& path) {
  require_regular_file(path);
  const InputFile file = read_input_file(path, "expected a PNG or PFM picture", kMostFaceBytes);
  const std::string_view text(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
  if (text.starts_with("\x89PNG")) return read_png(path, file.bytes);
  const auto is_pfm = [&text](std::string_view magic) {
    return text.starts_with(magic) && text.size() > 2 && (text[2] == '\n' || text[2] == '\r' || text[2] == ' ');
  };
  if (is_pfm("PF") || is_pfm("Pf")) return read_pfm(path, file.bytes);
  input_error(path, "is neither a PNG nor a PFM file");
}

}  // namespace gridiron::tool
