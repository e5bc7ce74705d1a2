// Kernels with effects of single scenes: environment, normals, highlights. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {
namespace {

template <std::uint32_t Effects>
constexpr KernelVariant variant(std::string_view name) {
  return {name, Effects, +[](KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                             const KernelOptions& options) {
            return render_kernel<EffectLayout256K<Effects>, Lanes<4>>(scene, camera, width, height, options);
          }};
}

constexpr KernelVariant kVariants[] = {
    variant<kSceneShading | kEnvironment>("environment"),
    variant<kSceneShading | kSmoothNormals>("smooth_normals"),
    variant<kSceneShading | kHighlights>("highlight"),
};

}  // namespace

std::span<const KernelVariant> shading_variants() { return kVariants; }

}  // namespace gridiron::test
