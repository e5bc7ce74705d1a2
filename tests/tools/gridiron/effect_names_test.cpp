// Effect names: each effect has its own, and renderers are named as in C++. SPDX-License-Identifier: Apache-2.0
#include "gridiron/scene/effect_names.h"

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

TEST(EffectNames, EveryBitHasItsOwn) {
  std::uint32_t bits = 0;
  std::set<std::string_view> names, constants, words, labels;
  for (const EffectName& effect : tool::effects()) {
    EXPECT_EQ(bits & effect.bit, 0u) << effect.name;
    bits |= effect.bit;
    EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
    EXPECT_TRUE(constants.insert(effect.constant).second) << effect.constant;
    EXPECT_TRUE(words.insert(effect.words).second) << effect.words;
    EXPECT_TRUE(labels.insert(effect.label).second) << effect.label;
    EXPECT_LE(std::string_view(effect.label).size(), 10u) << "it stands below a bar of a chart";
    // "point_shadows" and "kPointShadows" are one word.
    std::string word = "k";
    bool is_first = true;
    for (const char letter : std::string_view(effect.name)) {
      if (letter != '_') word += is_first ? static_cast<char>(letter - 'a' + 'A') : letter;
      is_first = letter == '_';
    }
    EXPECT_EQ(word, effect.constant);
  }
  EXPECT_EQ(bits, kAllEffects);
}

TEST(EffectNames, SetsAreLists) {
  EXPECT_EQ(tool::words_of_effects(0), "none");
  EXPECT_EQ(tool::words_of_effects(kReflection | kSceneShading), "scene_shading, reflection");
  EXPECT_EQ(tool::effect_names(kAllEffects).size(), kEffectCount);
}

TEST(EffectNames, MissingOnesAreNamed) {
  EXPECT_EQ(tool::words_of_missing_effects(kReflection),
            "the scene calls for reflection, which this renderer was built without");
  EXPECT_EQ(tool::words_of_missing_effects(kReflection | kPointShadows),
            "the scene calls for shadows of point lights, reflection, which this renderer was built without");
}

TEST(EffectNames, RenderersAreTypes) {
  EXPECT_EQ(tool::renderer_type(0, 128, 8), "StoreLayout128K<8>");
  EXPECT_EQ(tool::renderer_type(0, 64, 0), "TreeLayout64K");
  EXPECT_EQ(tool::renderer_type(0, 256, 0), "TreeLayout256K<>");
  EXPECT_EQ(tool::renderer_type(kSceneShading, 256, 32), "EffectLayout256K<kSceneShading>");
  EXPECT_EQ(tool::renderer_type(kSceneShading | kPointShadows | kHighlights, 512, 8),
            "EffectLayout256K<kSceneShading | kPointShadows | kHighlights, 8>");
}

}  // namespace
}  // namespace gridiron::test
