// What the master tells workers of the next pass of a frame that moves (moving_frames.h).
// Memory: shared memory. Threads: the master writes while the workers sleep. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridiron::port {

// What workers are woken for: a BuildPass, or one of these.
inline constexpr std::uint32_t kMeshPass = kBuildPassCount, kPicturePass = kMeshPass + 1;

struct MovingFrame {
  std::uint32_t pass;    ///< that the workers run next
  std::uint32_t number;  ///< of the frame, as of wave_vertex()
  alignas(BuildPlan) std::byte plan_bytes[sizeof(BuildPlan)];  ///< raw: shared memory has no constructor

  [[nodiscard]] BuildPlan& plan() { return *reinterpret_cast<BuildPlan*>(plan_bytes); }
  [[nodiscard]] const BuildPlan& plan() const { return *reinterpret_cast<const BuildPlan*>(plan_bytes); }
};
static_assert(std::is_trivially_default_constructible_v<MovingFrame>);

}  // namespace gridiron::port
