// Configurations: named sets of traversal, grid, packet, tile and buffering parameters.
// Memory: one table. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::tool {

/// How many buffers each level rotates: 1 is single buffering (ask, wait, use), 2 double, more prefetches deeper.
struct BufferDepths {
  std::uint32_t output = 2;    ///< finished tiles
  std::uint32_t macro = 2;     ///< cell blocks
  std::uint32_t triangle = 2;  ///< triangle buffers
  std::uint32_t walks = 2;     ///< walks of secondary rays under way at once

  bool operator==(const BufferDepths&) const = default;

  /// @returns the same, none deeper than in `most`.
  [[nodiscard]] BufferDepths within(const BufferDepths& most) const {
    return {std::min(output, most.output), std::min(macro, most.macro), std::min(triangle, most.triangle),
            std::min(walks, most.walks)};
  }
};
inline constexpr BufferDepths kSingleBuffering = {.output = 1, .macro = 1, .triangle = 1, .walks = 1};
inline constexpr BufferDepths kDoubleBuffering = {.output = 2, .macro = 2, .triangle = 2, .walks = 2};

/// What a frame is rendered with unless an option of the command line says otherwise.
struct Configuration {
  std::string_view name;
  std::string_view description;
  float lambda;                ///< cells per triangle, Eq. (1)
  float walk_lambda;           ///< the same of scenes that cast secondary rays: each by itself, these want small cells
  std::uint32_t macro_width;   ///< cells along a macrocell's edge
  std::uint32_t packet_width;  ///< rays along a packet's edge
  BufferDepths depths;
  std::uint32_t techniques;  ///< TechniqueBits
};

/// All configurations, `reference` (the default) first.
[[nodiscard]] std::span<const Configuration> configurations();

/// @returns nullptr where no configuration has that name.
[[nodiscard]] const Configuration* find_configuration(std::string_view name);

}  // namespace gridiron::tool
