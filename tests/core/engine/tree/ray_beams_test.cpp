// A beam meets every box that one of its rays meets. Boxes of lists of rays are grown, which would hide beams that are
// a little too narrow; these here are the least around single points of rays. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/tree/ray_beams.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "numeric/rounding_scope.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

struct Beam {
  BatchRay rays[kBeamRays] = {};
  RayBeam planes{};
  std::uint32_t axis = kNoBeam, octant = 0;
};

// Rays from neighbouring places, or one place, to neighbouring places, or one place, some with other lengths; from
// within the scene or from afar.
std::optional<Beam> random_beam(float scene, TestRandom& random) {
  const auto around = [&](double place, double size) {
    return static_cast<float>(place + size * (2.0 * random.unit() - 1.0));
  };
  Beam beam;
  const double far = scene * std::exp2(13.0 * random.unit() - 3.0);
  const double spread = scene * std::exp2(-2.0 - static_cast<double>(random.next() % 20));
  const std::uint64_t kind = random.next() % 4, along = random.next() % 6;
  double starts[3], ends[3];
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    starts[axis] = far * (2.0 * random.unit() - 1.0);
    ends[axis] = along < 3 && axis != along ? starts[axis] : scene * (2.0 * random.unit() - 1.0);
  }
  for (std::uint32_t i = 0; i < kBeamRays; ++i) {
    BatchRay& ray = beam.rays[i];
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = around(starts[axis], kind == 0 ? 0 : spread);
      ray.dir[axis] = around(ends[axis], kind == 1 ? 0 : spread) - ray.origin[axis];
    }
    const float length = kind == 2 ? std::exp2(-static_cast<float>(random.next() % 10)) : 1.0f;
    for (float& component : ray.dir) component *= length;
    ray.t = random.next() % 2 == 0 ? 1.0f : kFloatMax;
    ray.id = no_hit(kNoTriangle);
    const std::uint32_t octant = set_up_list_ray<Lanes<4>>(ray, scene);
    if (i != 0 && octant != beam.octant) return {};
    beam.octant = octant;
  }
  beam.axis = make_beam(beam.rays, kBeamRays, scene, beam.planes);
  if (beam.axis == kNoBeam) return {};
  if (random.next() % 2 == 0) {
    // As lists do it once hits are known.
    float most = -1.0f;
    for (BatchRay& ray : beam.rays) {
      const double end = std::min(double{ray.t}, 2.0 * scene / std::fabs(double{ray.dir[beam.axis]}));
      ray.t = static_cast<float>(end * random.unit());
      most = std::max(most, ray.t);
    }
    shorten_beam(beam.planes, most);
  }
  return beam;
}

// Box i is the least that holds a point of ray i.
TreeNode boxes_on(const Beam& beam, float scene, TestRandom& random) {
  TreeNode node{};
  for (std::uint32_t i = 0; i < kBeamRays; ++i) {
    const BatchRay& ray = beam.rays[i];
    const double reach = (std::fabs(double{ray.origin[beam.axis]}) + scene) / std::fabs(double{ray.dir[beam.axis]});
    const double t = std::min(double{ray.t}, reach) * (random.next() % 3 == 0 ? 1.0 : random.unit());
    for (int axis = 0; axis < 3; ++axis) {
      const double place = ray.origin[axis] + t * ray.dir[axis];
      const auto nearest = static_cast<float>(place);
      node.low[axis][i] = nearest > place ? std::nextafterf(nearest, -kFloatMax) : nearest;
      node.high[axis][i] = nearest < place ? std::nextafterf(nearest, kFloatMax) : nearest;
    }
  }
  node.child_count = kBeamRays;
  return node;
}

template <class L>
class RayBeamsTest : public testing::Test {};
using BeamLanes = testing::Types<Lanes<4>, Lanes<8>>;
TYPED_TEST_SUITE(RayBeamsTest, BeamLanes);

TYPED_TEST(RayBeamsTest, MeetTheBoxesThatTheirRaysMeet) {
  for (const int exponent : {-59, -20, 0, 60, 118}) {
    const float scene = std::ldexp(1.0f, exponent);
    for (const int mode : kRoundingModes) {
      SCOPED_TRACE(testing::Message() << "scene of 2^" << exponent << ", rounding " << mode);
      TestRandom random(static_cast<std::uint64_t>(exponent + 1000));
      std::uint32_t beams = 0, missed = 0;
      for (std::uint32_t i = 0; i < 4000; ++i) {
        std::optional<Beam> beam;
        {
          const RoundingScope scope(mode, true);
          beam = random_beam(scene, random);
        }
        if (!beam) continue;
        ++beams;
        const TreeNode node = boxes_on(*beam, scene, random);
        const RoundingScope scope(mode, true);
        WorkCounters work;
        alignas(64) std::uint32_t list[16] = {beam_word(0, beam->axis, beam->octant)};
        missed += count_bits(~mark_beams<TypeParam>(node, &beam->planes, list, 1, work) & kMaskBits);
      }
      EXPECT_GT(beams, 500u);
      EXPECT_EQ(missed, 0u);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
