// Configurations: named sets of traversal, grid, packet, tile and buffering parameters.
// Memory: one table. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::tool {

/// Buffers in rotation at each level: 1 is single buffering (get, wait, use), 2 double; more prefetch deeper.
struct BufferDepths {
  std::uint32_t output = 2;    ///< finished tiles
  std::uint32_t macro = 2;     ///< cell blocks
  std::uint32_t triangle = 2;  ///< triangle buffers
  std::uint32_t fetch = 2;     ///< children of a tree's node, or records for shading

  bool operator==(const BufferDepths&) const = default;

  /// @returns the same depths, limited to those of `most`.
  [[nodiscard]] BufferDepths within(const BufferDepths& most) const {
    return {std::min(output, most.output), std::min(macro, most.macro), std::min(triangle, most.triangle),
            std::min(fetch, most.fetch)};
  }
};
inline constexpr BufferDepths kSingleBuffering = {.output = 1, .macro = 1, .triangle = 1, .fetch = 1};
inline constexpr BufferDepths kDoubleBuffering = {.output = 2, .macro = 2, .triangle = 2, .fetch = 2};

/// Default parameters of a frame; options of the command line override them.
struct Configuration {
  std::string_view name;
  std::string_view description;
  float lambda;                ///< cells per triangle, Eq. (1)
  std::uint32_t macro_width;   ///< cells along a macrocell's edge
  std::uint32_t packet_width;  ///< rays along a packet's edge; 0: none, eye rays go through the tree
  BufferDepths depths;
  std::uint32_t techniques;  ///< TechniqueBits

  /// Whether eye rays go through a grid, by packets.
  [[nodiscard]] constexpr bool has_grid() const { return packet_width != 0; }
};

/// @returns what traces its eye rays, but where a 64 KB store traces them by lists.
[[nodiscard]] constexpr EngineId engine_of(const Configuration& configuration) {
  return configuration.has_grid() ? EngineId::kGrid : EngineId::kTree;
}

/// All configurations, the fastest first.
[[nodiscard]] std::span<const Configuration> configurations();

/// @returns nullptr if no configuration has that name.
[[nodiscard]] const Configuration* find_configuration(std::string_view name);

/// What decides the configuration where a command line names none.
struct ConfigurationNeed {
  bool has_projection = false;  ///< triangles are those of Accuracy::kPaper
  bool has_tree = true;         ///< false: a packed scene without a tree
  bool has_kernel = true;       ///< false: no kernel of `best` is built for the store, the mode and the lanes
  bool has_bounds = true;       ///< false: `best` has no bounds of its errors in the view
  bool has_prices = true;       ///< false: the machine counts instructions, in a mode that counts
};

/// @returns `best`; `reference` for triangles of Accuracy::kPaper; `grid` where `best` cannot render the frame.
[[nodiscard]] const Configuration& default_configuration(const ConfigurationNeed& need);

}  // namespace gridiron::tool
