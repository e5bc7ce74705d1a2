// The kernel with all effects. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_variants.h"

namespace gridiron::test {

RenderKernel* const render_all_effects = render_kernel<EffectLayout256K<kAllEffects>, Lanes<4>>;

}  // namespace gridiron::test
