// The kernel with all effects and other packets. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {

KernelPicture render_packets_of_8(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                  const KernelOptions& options) {
  return render_kernel<EffectLayout256K<kAllEffects, 8>, Lanes<4>>(scene, camera, width, height, options);
}

KernelPicture render_packets_of_16(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                   const KernelOptions& options) {
  return render_kernel<EffectLayout256K<kAllEffects, 16>, Lanes<4>>(scene, camera, width, height, options);
}

}  // namespace gridiron::test
