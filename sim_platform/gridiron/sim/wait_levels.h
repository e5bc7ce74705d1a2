// Levels at which a core waits for transfers, by the tags that it waits for.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/dma/tags.h>

#include <cstddef>
#include <cstdint>

namespace gridiron::sim {

/// Levels at which a core waits for transfers (paper, Fig. 4), and the frame's own set-up.
enum class WaitLevel : std::uint8_t {
  kTile,       ///< output buffers
  kMacroCell,  ///< cell blocks; nodes of the tree
  kTriangle,   ///< triangle buffers; leaves of the tree, records for shading
  kSetup,      ///< frame record and macrocell table
  kCount
};
/// Levels, kSetup among them.
inline constexpr std::size_t kWaitLevelCount = static_cast<std::size_t>(WaitLevel::kCount);

/// Levels by the name of the awaited tag (core/gridiron/dma/tags.h), as above.
[[nodiscard]] constexpr WaitLevel wait_level_of_tag(std::uint32_t tag) {
  if (tag < kFirstMacroTag) return WaitLevel::kSetup;
  if (tag < kFirstTriangleTag) return WaitLevel::kMacroCell;
  if (tag < kFirstOutputTag) return WaitLevel::kTriangle;
  return WaitLevel::kTile;
}

}  // namespace gridiron::sim
