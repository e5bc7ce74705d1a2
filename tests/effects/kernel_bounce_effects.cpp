// Kernels built with the effects of single scenes: reflection, refraction, ambient occlusion.
// SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {
namespace {

constexpr KernelVariant kVariants[] = {
    variant<kSceneShading | kReflection>("mirror"),
    variant<kSceneShading | kReflection | kRefraction>("glass"),
    variant<kSceneShading | kAmbientOcclusion>("ambient_occlusion"),
};

}  // namespace

std::span<const KernelVariant> bounce_variants() { return kVariants; }

}  // namespace gridiron::test
