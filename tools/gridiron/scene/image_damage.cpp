// Image damage. SPDX-License-Identifier: Apache-2.0
#include "image_damage.h"

#include <cstring>
#include <string_view>

#include "base/words.h"

namespace gridiron::tool {

ImageDamage find_image_damage(std::span<std::byte> image, const SceneImageError& error) {
  const auto reason_of = [](const SceneImageError& each) {
    return std::string(words_of(each.status)) + " (field " + each.field + ")";
  };
  const std::string_view field = error.field;
  if (field == "image" || field == "header.image_bytes") {
    const bool has_header = image.size() >= sizeof(ImageHeader);
    std::uint64_t wanted_bytes = sizeof(ImageHeader);
    if (has_header) std::memcpy(&wanted_bytes, image.data() + offsetof(ImageHeader, image_bytes), sizeof wanted_bytes);
    return {error.byte_offset, reason_of(error) + ": there are " + words_of_count(image.size(), "byte") + ", the " +
                                   (has_header ? "image" : "header") + " has " + words_of_count(wanted_bytes)};
  }
  if (field != "header.check_value") return {error.byte_offset, reason_of(error)};

  ImageHeader header{};
  std::memcpy(&header, image.data(), sizeof header);
  header.check_value = scene_image_check_value(image.first(header.image_bytes));
  std::memcpy(image.data(), &header, sizeof header);
  SceneImageView view{};
  SceneImageError place;
  if (open_scene_image(image, view, place) != Status::kOk) {
    return {place.byte_offset, reason_of(place) + "; its check_value differs too"};
  }
  return {error.byte_offset,
          reason_of(error) + ": some number of the image has changed, and no other check finds which"};
}

}  // namespace gridiron::tool
