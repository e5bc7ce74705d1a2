// The kernel with all effects. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {

KernelPicture render_all_effects(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                 const KernelOptions& options) {
  return render_kernel<EffectLayout256K<kAllEffects>, Lanes<4>>(scene, camera, width, height, options);
}

}  // namespace gridiron::test
