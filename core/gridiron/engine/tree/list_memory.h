// Memory of the lists of rays: the batch, lists and masks of the nodes on the way down, triangles of one leaf in lanes.
// core/TREE.md has the bound. Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/tree_records.h>
#include <gridiron/ray/ray_batch.h>

#include <cstdint>

namespace gridiron {

/// Lanes of up to four boxes test a node's boxes in four parts, quads under a union box, and have a list for each;
/// wider ones test all boxes at once.
template <class L>
inline constexpr std::uint32_t kBoxParts = L::kCount <= 4 ? 4u : 1u;
/// Lists begin at multiples of so many words.
template <class L>
inline constexpr std::uint32_t kListStep = L::kCount <= 4 ? 4u : 16u;
/// Words that a node's lists take beyond its own list, for each of its rays, at most.
template <class L>
inline constexpr std::uint32_t kListParts = kBoxParts<L> == 1 ? std::uint32_t{0} : kBoxParts<L>;

/// Words of an arena for batches of so many rays, whatever the lanes: their list, in up to eight parts that each begin
/// at a step, those of the root's parts, and at each level below at least those of one step of rays, and a step to
/// write over. @param spare  words for longer lists, which spare nodes and leaves second visits.
[[nodiscard]] constexpr std::uint32_t list_arena_words(std::uint32_t rays, std::uint32_t spare) {
  const std::uint32_t narrow = 5 * rays + 8 * 4 + (kMaxTreeDepth + 2) * (5 * 4);
  const std::uint32_t wide = rays + 8 * 16 + (kMaxTreeDepth + 2) * 16;
  return (narrow > wide ? narrow : wide) / 16 * 16 + 16 + spare;
}

/// What wide lanes prepare of a ray for boxes: entries and exits are side * scale + shift. list_rays.h has the bounds.
/// As long as a ray, so that the words of lists lead to both.
struct alignas(16) RayTerms {
  float scale[3];
  float t;  ///< the ray's
  float shift[3];
  float unused[5];
};
static_assert(sizeof(RayTerms) == sizeof(BatchRay));

/// Lanes that use RayBeam where there is no memory for groups, and code for rays of one origin. One lane needs short
/// code; to 16, which test all boxes of a node at once, beams pay in groups alone.
template <class L>
inline constexpr bool kUsesBeams = L::kCount == 4 || L::kCount == 8;
/// Rays of a group, and the most of a beam.
inline constexpr std::uint32_t kBeamRays = 16;

/// What bounds neighbouring rays: four planes, and where they are along its axis; ray_beams.h.
struct alignas(64) RayBeam {
  float planes[4][4];  ///< plane, {slope or 0 if it is below 0, slope or 0 if it is above, offset, one of four
                       ///< numbers}: the least and the greatest place along the axis, where all rays have begun, and
                       ///< the greatest |component| of a direction along it, with its sign
};

/// Beams, and what leaves take for rays of one origin.
template <std::uint32_t Count>
struct BeamMemory {
  RayBeam of[Count];
  alignas(64) std::uint32_t own_ids[kMaxTreeLeaf];  ///< no_hit() of a leaf's triangles
};
template <>
struct BeamMemory<0> {};

/// 16 neighbouring rays, one a lane: a triangle is tested against all of them at once. Boxes are tested against its
/// beams.
struct alignas(64) RayGroup {
  float origin[3][kBeamRays];
  float t[kBeamRays];  ///< as in BatchRay
  float dir[3][kBeamRays];
  float inverse[3][kBeamRays];  ///< as in BatchRay
  float dir_max[kBeamRays];
  std::uint32_t ids[kBeamRays];  ///< as in BatchRay, before anything was hit
};

/// Beams of a group, at most.
inline constexpr std::uint32_t kGroupBeams = 2;

/// What bounds rays of a group, seen from a corner: ray_groups.h.
struct alignas(64) GroupBeam {
  float corner[3];      ///< u, v, w
  float turn;           ///< 1; -1: they run backwards along their axis
  std::uint32_t lanes;  ///< the rays of the group that it bounds, as bits
  float planes[4][4];   ///< slope or 0 if it is below 0, slope or 0 if it is above, offset; a bound beside the plane
};

/// Boxes of a node's children.
struct ChildBoxes {
  alignas(64) float low[3][kTreeWidth];
  alignas(64) float high[3][kTreeWidth];
};

/// What groups need of a leaf's triangles besides TriangleLanes: their boxes, and wider bounds of errors.
struct GroupLeaf {
  alignas(64) float low[3][kMaxTreeLeaf];
  alignas(64) float high[3][kMaxTreeLeaf];
  alignas(64) float edge_error[kMaxTreeLeaf];
  alignas(64) float normal_error[kMaxTreeLeaf];
  alignas(64) float least_error[kMaxTreeLeaf];
  alignas(64) std::uint32_t own_ids[kMaxTreeLeaf];  ///< no_hit() of the triangles
};

/// A node on the way down, and the rays that met its box.
struct ListLevel {
  TreeChild children[kTreeWidth];  ///< those that rays meet, in the order of their turns
  std::uint32_t places[2];         ///< of each: its bit in the masks, 4 bits, eight to a word
  std::uint32_t child_count;       ///< of these
  std::uint32_t turn;              ///< the child whose rays are next
  std::uint32_t lists[4];          ///< of each part: where its list begins in the arena
  std::uint32_t ray_counts[4];     ///< of these lists
  std::uint32_t end;               ///< what is free behind them
  std::uint32_t taken;             ///< of a part's rays, those that the child whose turn it is has seen

  /// The bit in the masks of the child whose turn it is.
  [[nodiscard]] std::uint32_t place() const { return places[turn / 8] >> 4 * (turn % 8) & 15; }
  void set_part(std::uint32_t part, std::uint32_t list, std::uint32_t count) {
    lists[part] = list;
    ray_counts[part] = count;
  }
};

/// Up to 16 triangles in lanes.
struct TriangleLanes {
  alignas(64) float v[3][kMaxTreeLeaf];          ///< the first corner
  alignas(64) float back_e1[3][kMaxTreeLeaf];    ///< from the second one to it
  alignas(64) float e2[3][kMaxTreeLeaf];         ///< from it to the third one
  alignas(64) float normal[3][kMaxTreeLeaf];     ///< e1 x e2
  alignas(64) float edge_error[kMaxTreeLeaf];    ///< factor on sizes of rays: bounds the error of a side
  alignas(64) float normal_error[kMaxTreeLeaf];  ///< likewise, of products with the normal
};

/// Groups of a batch, and what goes with them. @tparam Beams  of all groups. @tparam Pairs  of a beam and a triangle.
template <std::uint32_t Groups, std::uint32_t Beams, std::uint32_t Pairs>
struct GroupMemory {
  RayGroup groups[Groups];
  GroupBeam group_beams[Beams];
  float reaches[Beams];                    ///< of beams: how far they look along their axis, from the corner
  std::uint32_t lanes[Beams];              ///< of each beam of a list: rays that may meet a leaf, as bits
  ChildBoxes child_boxes[kMaxTreeDepth];   ///< of the nodes on the way down
  GroupLeaf group_leaf;                    ///< the leaf that is visited
  alignas(64) std::uint32_t pairs[Pairs];  ///< of beams and its triangles, and room for lanes behind them
};

/// Memory for terms of rays, and for groups of them, where there is some.
template <std::uint32_t Rays, bool HasTerms>
struct TermsMemory {};
template <std::uint32_t Rays>
struct TermsMemory<Rays, true>
    : GroupMemory<Rays / kBeamRays, kGroupBeams*(Rays / kBeamRays), kGroupBeams * Rays + kBeamRays> {
  RayTerms terms[Rays];
};

/// @tparam Rays      of a batch: a multiple of 16.
/// @tparam Spare     words of the arena beyond the least.
/// @tparam Beams     whether there is memory for beams; with it comes code for rays of one origin.
/// @tparam HasTerms  whether there is room for terms of rays, and for groups where there are beams. Wide lanes are
///                   faster with it; answers are the same.
template <std::uint32_t Rays, std::uint32_t Spare, bool Beams, bool HasTerms = false>
struct alignas(64) ListMemory : TermsMemory<Rays, HasTerms> {
  static constexpr bool kHasTerms = HasTerms;
  static constexpr std::uint32_t kRays = Rays;
  static constexpr std::uint32_t kArenaWords = list_arena_words(Rays, Spare);
  static constexpr bool kHasBeams = Beams;
  /// All lists of beams fit, at every level, and behind the last the lists of their rays, and what these need below.
  /// What the lists of up to 16 roots are stepped up by fits in what four lanes need beyond wide ones.
  template <class L>
  static constexpr bool kHoldsBeams = [] {
    constexpr std::uint32_t step = kListStep<L>, parts = 1 + kListParts<L>,
                            most = (HasTerms ? kGroupBeams : std::uint32_t{1}) * (Rays / kBeamRays),
                            beams = (most + (step - 1)) / step * step,
                            level = beams > parts * step ? beams : parts * step;
    return kArenaWords >= (kMaxTreeDepth + 1) * level + parts * (Rays + beams) + parts * step;
  }();
  static_assert(Rays % 16 == 0 && 3 * Rays <= 1u << 13, "a word of a list has 13 bits for a ray's place");
  static_assert(Spare % 16 == 0);

  BatchRay rays[Rays];
  [[no_unique_address]] BeamMemory<Beams ? Rays / kBeamRays : std::uint32_t{0}> beams;
  std::uint32_t owners[Rays];
  alignas(64) std::uint32_t arena[kArenaWords];
  TriangleLanes triangles;
  ListLevel levels[kMaxTreeDepth];
};

}  // namespace gridiron
