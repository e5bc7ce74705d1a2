// The kernel with all effects and wider lanes, as the baseline's instructions make them.
// SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {

KernelPicture render_eight_lanes(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                 const KernelOptions& options) {
  return render_kernel<EffectLayout256K<kAllEffects>, Lanes<8>>(scene, camera, width, height, options);
}

KernelPicture render_sixteen_lanes(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                   const KernelOptions& options) {
  return render_kernel<EffectLayout256K<kAllEffects>, Lanes<16>>(scene, camera, width, height, options);
}

}  // namespace gridiron::test
