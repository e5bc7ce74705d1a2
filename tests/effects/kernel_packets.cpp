// The kernel with all effects and other packets. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {

RenderKernel* const render_packets_of_8 = render_kernel<EffectLayout256K<kAllEffects, 8>, Lanes<4>>;
RenderKernel* const render_packets_of_16 = render_kernel<EffectLayout256K<kAllEffects, 16>, Lanes<4>>;

}  // namespace gridiron::test
