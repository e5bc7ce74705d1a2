// Children of a node in the order in which a packet visits them: sorted side by side in lanes, without a branch.
// Source: sorting network of five exchanges (Batcher 1968). Memory: values. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/bvh/bvh_node.h>
#include <gridiron/bvh/four_words.h>

#include <cstdint>

namespace gridiron::bvh {

/// The number of each child's lane, and the lanes that keep the lesser key in the network's three steps.
struct ChildLanes {
  alignas(16) std::uint32_t lane[kNodeWidth];
  alignas(16) std::uint32_t lesser[3][kNodeWidth];
};
inline constexpr ChildLanes kChildLanes = {{0, 1, 2, 3}, {{0, ~0u, 0, ~0u}, {0, 0, ~0u, ~0u}, {0, 0, ~0u, 0}}};

/// Children, the farthest first; those that are not met last.
struct OrderedChildren {
  FourWords entry;  ///< bits of the entry; the last two are the number of its lane; not met: negative
  FourWords child;
  FourWords missed;

  /// @param entry  >= 0; raised by at most 3 units in its last place. @param none  children that are not met.
  GRIDIRON_INLINE OrderedChildren(Lanes<4>::Float entries, Lanes<4>::Mask none, FourWords children, FourWords misses)
      : child(children), missed(misses) {
    // Different keys, so that two lanes always exchange consistently. An entry may be -0.
    const FourWords marked =
        (FourWords::of(entries) & FourWords::splat(0x7FFFFFFCu)) | FourWords::load(kChildLanes.lane);
    entry = marked | FourWords::where(none, 0x80000000u);
    exchange<1, 0, 3, 2>(FourWords::load(kChildLanes.lesser[0]));
    exchange<2, 3, 0, 1>(FourWords::load(kChildLanes.lesser[1]));
    exchange<0, 2, 1, 3>(FourWords::load(kChildLanes.lesser[2]));
  }

  /// Writes (entry i, child i, missed i, missed i) to consecutive quads from `target` on, 16-byte aligned, for each i.
  GRIDIRON_INLINE void store(float* target) const {
    using Four = Lanes<4>;
    const Four::Float low = Four::shuffle_quads<0, 4, 1, 5>(entry.floats(), child.floats());
    const Four::Float high = Four::shuffle_quads<2, 6, 3, 7>(entry.floats(), child.floats());
    const Four::Float third = missed.floats();
    Four::shuffle_quads<0, 1, 4, 4>(low, third).store(target);
    Four::shuffle_quads<2, 3, 5, 5>(low, third).store(target + 4);
    Four::shuffle_quads<0, 1, 6, 6>(high, third).store(target + 8);
    Four::shuffle_quads<2, 3, 7, 7>(high, third).store(target + 12);
  }

 private:
  template <int I0, int I1, int I2, int I3>
  GRIDIRON_INLINE void exchange(FourWords lesser) {
    using Four = Lanes<4>;
    const auto partner_of = [](FourWords words) GRIDIRON_INLINE_LAMBDA {
      return FourWords::of(Four::shuffle_quads<I0, I1, I2, I3>(words.floats()));
    };
    const FourWords partner = partner_of(entry);
    const auto taken = entry.less_but(partner, lesser);
    entry = FourWords::select(taken, partner, entry);
    child = FourWords::select(taken, partner_of(child), child);
    missed = FourWords::select(taken, partner_of(missed), missed);
  }
};

}  // namespace gridiron::bvh
