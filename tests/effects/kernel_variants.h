// Kernels compiled for the tests of effects: every set of effects, packet width and lane type that they ask for, each
// once. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "effects/kernel_scene.h"

namespace gridiron::test {

/// A kernel as one translation unit instantiates it.
using RenderKernel = KernelPicture(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                   const KernelOptions& options);

struct KernelVariant {
  std::string_view name;  ///< of the scene in scenes/ that calls for just these effects, without .nff
  std::uint32_t effects;  ///< EffectBits built
  RenderKernel* render;   ///< packets of 32, four lanes
};

/// The kernel built with just these effects; the test that uses it compiles it.
template <std::uint32_t Effects>
[[nodiscard]] constexpr KernelVariant variant(std::string_view name) {
  return {name, Effects, render_kernel<EffectLayout256K<Effects>, Lanes<4>>};
}

/// Built with all effects; packets of 32, four lanes.
extern RenderKernel* const render_all_effects;
/// The same with packets of 8 and of 16.
extern RenderKernel* const render_packets_of_8;
extern RenderKernel* const render_packets_of_16;
/// The same as the first with 8 and with 16 lanes.
extern RenderKernel* const render_eight_lanes;
extern RenderKernel* const render_sixteen_lanes;
/// Built without effects.
extern RenderKernel* const render_without_effects;

/// One for each scene of scenes/ but for the one that calls for everything.
[[nodiscard]] std::span<const KernelVariant> plain_variants();    ///< no ray beyond shadow rays
[[nodiscard]] std::span<const KernelVariant> bounce_variants();   ///< reflection, refraction, ambient occlusion
[[nodiscard]] std::span<const KernelVariant> shading_variants();  ///< environment, normals, highlights, samples

}  // namespace gridiron::test
