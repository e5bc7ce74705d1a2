// Kernels built with the effects of single scenes: shadows; and without effects. SPDX-License-Identifier: Apache-2.0
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

RenderKernel* const render_without_effects = render_kernel<StoreLayout256K<8>, Lanes<4>>;

}  // namespace gridiron::test
