// What an effect renderer says of effects that it was not built for; frames are rendered by tests/effects.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/effect_renderer.h>

#include "support/test_headers.h"

namespace gridiron {
namespace {

TEST(EffectsBuilt, AreEnoughExactlyWhereAllThatIsCalledForIsAmongThem) {
  for (std::uint32_t called_for = 0; called_for < 1u << kEffectCount; called_for += 3) {
    for (std::uint32_t built = 0; built < 1u << kEffectCount; built += 5) {
      const Status expected = (called_for & built) == called_for ? Status::kOk : Status::kMissingEffect;
      ASSERT_EQ(check_effects_built(called_for, built), expected) << called_for << " of " << built;
    }
  }
}

TEST(EffectsBuilt, AnEffectThatNobodyKnowsIsABadFrame) {
  EXPECT_EQ(check_effects_built(1u << kEffectCount, kAllEffects), Status::kBadFrame);
}

}  // namespace
}  // namespace gridiron
