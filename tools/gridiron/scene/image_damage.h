// Image damage: the place at which a scene image is wrong, for messages.
// Memory: borrows the image. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/image/scene_image.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace gridiron::tool {

struct ImageDamage {
  std::uint64_t byte_offset = 0;  ///< in the image
  std::string reason;
};

/// Finds the place of an error. A wrong check value only shows that there is one, so the other checks are run with the
/// actual value, and the first that fails names the place.
///
/// @param image  kLineBytes-aligned; its check value may be overwritten. @param error  open_scene_image's.
[[nodiscard]] ImageDamage find_image_damage(std::span<std::byte> image, const SceneImageError& error);

}  // namespace gridiron::tool
