// The kernel with all effects and wider lanes, as the baseline's instructions make them.
// SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {

RenderKernel* const render_eight_lanes = render_kernel<EffectLayout256K<kAllEffects>, Lanes<8>>;
RenderKernel* const render_sixteen_lanes = render_kernel<EffectLayout256K<kAllEffects>, Lanes<16>>;

}  // namespace gridiron::test
