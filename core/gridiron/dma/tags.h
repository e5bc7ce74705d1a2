// Transfer tags of the kernel: who waits for what. The simulated chip's clock uses them to classify waits.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

inline constexpr std::uint8_t kSetupTag = 0;           ///< what a core waits for at once: records of the frame and
                                                       ///< its scene, macrocell table, materials, lights, spilled rays
inline constexpr std::uint8_t kFirstMacroTag = 1;      ///< cell blocks, one tag per buffer; nodes of the tree
inline constexpr std::uint8_t kMacroTagCount = 8;      ///< most cell blocks in rotation
inline constexpr std::uint8_t kFirstTriangleTag = 9;   ///< triangle buffers, one tag per buffer; leaves, records
inline constexpr std::uint8_t kTriangleTagCount = 15;  ///< most triangle buffers in rotation
inline constexpr std::uint8_t kFirstOutputTag = 24;    ///< finished tiles, one tag per buffer
inline constexpr std::uint8_t kOutputTagCount = 8;     ///< most output buffers in rotation

static_assert(kFirstMacroTag + kMacroTagCount == kFirstTriangleTag);
static_assert(kFirstTriangleTag + kTriangleTagCount == kFirstOutputTag);
static_assert(kFirstOutputTag + kOutputTagCount == 32);

/// Tag of an output buffer, for any slot number.
constexpr std::uint8_t output_tag(std::uint32_t slot) {
  return static_cast<std::uint8_t>(kFirstOutputTag + slot % kOutputTagCount);
}

}  // namespace gridiron
