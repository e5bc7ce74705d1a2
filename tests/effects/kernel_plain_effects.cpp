// Kernels built with the effects of single scenes: shadows. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {
namespace {

constexpr KernelVariant kVariants[] = {
    variant<kSceneShading | kPointShadows>("shadow"),
    variant<kSceneShading | kAreaLights>("area_light"),
    variant<kSceneShading | kMultisampling>("multisampling"),
};

}  // namespace

std::span<const KernelVariant> plain_variants() { return kVariants; }

}  // namespace gridiron::test
