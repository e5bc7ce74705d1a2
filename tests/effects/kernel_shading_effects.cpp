// Kernels with effects of single scenes: environment, normals, highlights. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {
namespace {

constexpr KernelVariant kVariants[] = {
    variant<kSceneShading | kEnvironment>("environment"),
    variant<kSceneShading | kSmoothNormals>("smooth_normals"),
    variant<kSceneShading | kHighlights>("highlight"),
};

}  // namespace

std::span<const KernelVariant> shading_variants() { return kVariants; }

}  // namespace gridiron::test
