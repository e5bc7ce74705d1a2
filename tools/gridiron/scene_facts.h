// Scene facts: what `info` tells about a scene, as values.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstdint>

#include "arguments.h"
#include "scene_input.h"

namespace gridiron::tool {

/// The most that the kernel's loops can turn for this scene: what a worst-case analysis multiplies.
struct LoopBounds {
  std::uint32_t passes_per_packet = 0;      ///< three axes, two directions
  std::uint32_t macro_slices_per_pass = 0;  ///< macrocells along the longest axis
  std::uint64_t macro_cells_per_pass = 0;
  std::uint32_t slices_per_pass = 0;  ///< cells along the longest axis
  std::uint64_t cells_per_pass = 0;
  std::uint64_t triangle_tests_per_pass = 0;  ///< references
};

struct SceneFacts {
  std::uint64_t vertices = 0, triangles = 0, dropped_triangles = 0;
  GridRecord grid{};
  float wanted_lambda = 0;
  bool is_packed = false;
  std::uint64_t image_bytes = 0;
  std::uint64_t scratch_bytes = 0;  ///< of the builder, free again afterwards; 0 for a packed scene
  std::uint64_t picture_bytes = 0;  ///< colour plane and frame record
  bool fits = false;                ///< in the machine's main memory
  LoopBounds bounds;
};

/// Reads the scene and counts; builds nothing. Errors: Failure.
[[nodiscard]] SceneFacts collect_scene_facts(const InfoArguments& arguments);

}  // namespace gridiron::tool
