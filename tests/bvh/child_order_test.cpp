// Children come in the order of their entries. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/child_order.h>

#include "support/test_mesh.h"

namespace gridiron::bvh {
namespace {

TEST(ChildOrder, FarthestFirstAndWhatIsNotMetLast) {
  using Four = Lanes<4>;
  test::TestRandom random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    alignas(16) float entries[4];
    alignas(16) std::uint32_t children[4], missed[4];
    for (std::uint32_t i = 0; i < 4; ++i) {
      // Ties and zeros of both signs among them.
      const std::uint32_t choice = random.below(4);
      entries[i] = choice == 0 ? 0.0f : choice == 1 ? -0.0f : choice == 2 ? 1.0f : random.between(0.0f, 1e6f);
      children[i] = random.below(1u << 31);
      missed[i] = random.below(15);
    }
    const std::uint32_t none = random.below(16);
    const OrderedChildren ordered(Four::Float::load(entries), Four::mask_from_bits(none), FourWords::load(children),
                                  FourWords::load(missed));
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 4; ++i) {
      if ((none >> i & 1u) == 0) expected.push_back(i);
    }
    // Of equal ones that with the higher number is the farther.
    std::sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
      return entries[a] != entries[b] ? entries[a] > entries[b] : a > b;
    });
    alignas(16) float quads[16];
    ordered.store(quads);
    for (std::uint32_t i = 0; i < expected.size(); ++i) {
      const std::uint32_t from = expected[i];
      ASSERT_EQ(ordered.child.word(i), children[from]) << "trial " << trial << ", place " << i;
      ASSERT_EQ(ordered.missed.word(i), missed[from]) << "trial " << trial << ", place " << i;
      ASSERT_EQ(std::bit_cast<std::uint32_t>(quads[4 * i + 1]), children[from]);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(quads[4 * i + 2]), missed[from]);
      ASSERT_GE(quads[4 * i], 0.0f);
      ASSERT_LE(quads[4 * i], entries[from] * (1 + 0x1p-21f) + 0x1p-140f);
      ASSERT_GE(quads[4 * i], entries[from] * (1 - 0x1p-21f));
    }
  }
}

}  // namespace
}  // namespace gridiron::bvh
