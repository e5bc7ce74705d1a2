// What an effect renderer says of effects that it was not built for; frames are rendered by tests/effects.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/effect_renderer.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace gridiron {
namespace {

struct Named {
  std::uint32_t effect;
  Status status;
};
// In the order of EffectBits: of several that are missing the first is named.
constexpr Named kNamed[] = {
    {kPointShadows, Status::kNeedsPointShadows},
    {kAreaLights, Status::kNeedsAreaLights},
    {kReflection, Status::kNeedsReflection},
    {kRefraction, Status::kNeedsRefraction},
    {kAmbientOcclusion, Status::kNeedsAmbientOcclusion},
    {kEnvironment, Status::kNeedsEnvironment},
    {kSmoothNormals, Status::kNeedsSmoothNormals},
    {kHighlights, Status::kNeedsHighlights},
    {kMultisampling, Status::kNeedsMultisampling},
    {kSceneShading, Status::kNeedsSceneShading},
};
static_assert(sizeof kNamed / sizeof kNamed[0] == kEffectCount);

TEST(MissingEffect, IsNoneExactlyWhereAllThatIsCalledForWasBuilt) {
  for (std::uint32_t called_for = 0; called_for < 1u << kEffectCount; called_for += 3) {
    for (std::uint32_t built = 0; built < 1u << kEffectCount; built += 5) {
      const bool has_all = (called_for & built) == called_for;
      ASSERT_EQ(missing_effect(called_for, built) == Status::kOk, has_all) << called_for << " of " << built;
    }
  }
}

TEST(MissingEffect, IsNamedTheFirstFirst) {
  std::uint32_t before = 0;
  for (const Named& named : kNamed) {
    EXPECT_EQ(missing_effect(named.effect, kAllEffects & ~named.effect), named.status);
    EXPECT_EQ(missing_effect(kAllEffects, before), named.status);
    before |= named.effect;
  }
  EXPECT_EQ(before, kAllEffects);
}

TEST(MissingEffect, ThatNobodyKnowsIsABadFrame) {
  EXPECT_EQ(missing_effect(1u << kEffectCount, kAllEffects), Status::kBadFrame);
}

}  // namespace
}  // namespace gridiron
