// Leaves of the tree against lists of rays, or groups of them: which triangle each ray hits. Every hit equals that of
// exact arithmetic, except with Accuracy::kFast.
// Source: own; core/TREE.md. Memory: ListMemory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/leaf_test.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/engine/tree/list_rays.h>
#include <gridiron/engine/tree/ray_beams.h>
#include <gridiron/engine/tree/ray_groups.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/intersect_rays.h>
#include <gridiron/ray/ray_batch.h>

#include <cstdint>
#include <type_traits>

namespace gridiron {

/// What RayLists does in a leaf; its parameters.
template <class L, class Memory, class Source>
class LeafVisits {
 protected:
  LeafVisits(Memory& memory, Source& source, WorkCounters& work) : memory_(memory), source_(source), work_(work) {}

  using Float = typename L::Float;
  // Where products round apart from sums, terms would have no bound.
  static constexpr bool kHasTerms = L::kRoundsOnce && Memory::kHasTerms;
  // Wide lanes with memory for groups test their rays at once.
  static constexpr bool kHasGroups = L::kCount > 4 && Memory::kHasTerms&& Memory::kHasBeams;
  static constexpr bool kHasBeams = kHasGroups || (kUsesBeams<L> && Memory::kHasBeams);

  // Where all rays begin, if it is one place.
  [[nodiscard]] bool share_origin() const { return kHasBeams && shares_origin_; }

  [[nodiscard]] GRIDIRON_OUTLINE Status visit_leaf(TreeChild leaf, const std::uint32_t* list, std::uint32_t count) {
    work_.charge_to(Work::kListLeaf);
    const VertexTriangle* records = nullptr;
    GRIDIRON_TRY(source_.leaf(leaf, records));
    const Work leaf_kind = share_origin() ? Work::kListSharedLeaf : Work::kListLeaf;
    work_.add(leaf_kind);
    work_.charge_to(leaf_kind);
    set_up_leaf<L>(records, leaf.count(), memory_.triangles);
    if constexpr (kHasBeams) {
      if (shares_origin_) {
        set_up_origin<L>(memory_.rays[0].origin, leaf.count(), memory_.triangles);
        for (std::uint32_t i = 0; i < leaf.count(); ++i) memory_.beams.own_ids[i] = no_hit(records[i].triangle_id);
      }
    }
    return test_rays(records, leaf, list, count);
  }
  // The triangles in lanes against the rays of a list.
  [[nodiscard]] GRIDIRON_INLINE Status test_rays(const VertexTriangle* records, TreeChild leaf,
                                                 const std::uint32_t* list, std::uint32_t count) {
    const Work leaf_kind = share_origin() ? Work::kListSharedLeaf : Work::kListLeaf;
    const Work group_kind = share_origin() ? Work::kListSharedGroup : Work::kListTriangleGroup;
    for (std::uint32_t base = 0; base < leaf.count(); base += L::kCount) {
      const std::uint32_t rest = leaf.count() - base;
      const std::uint32_t there = rest >= L::kCount ? std::uint32_t{L::kAllBits} : (1u << rest) - 1u;
      work_.add(group_kind, count);
      work_.charge_to(leaf_kind);
      if constexpr (L::kCount > 4) wide_.records = records + base;
      LeafAnswer<L> answer;
      for (std::uint32_t i = next_candidate(list, 0, count, base, there, answer); i < count;
           i = next_candidate(list, i + 1, count, base, there, answer)) {
        GRIDIRON_TRY(decide(ray_of(memory_.rays, list[i]), records + base, answer, base));
      }
    }
    return Status::kOk;
  }

  // A leaf against beams of groups: for each its triangles one by one against all rays, or its rays one by one against
  // all triangles, whichever are fewer.
  // @param boxes  of the node, the leaf's in place `child`. @param rays  room for the words of all rays of the list.
  [[nodiscard]] GRIDIRON_OUTLINE Status visit_leaf_by_groups(TreeChild leaf, const ChildBoxes& boxes,
                                                             std::uint32_t child, std::uint32_t* list,
                                                             std::uint32_t count, std::uint32_t* rays) {
    // Without a branch that depends on a beam.
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t word = list[i], beam = beam_index(word);
      const RayGroup& group = memory_.groups[beam / kGroupBeams];
      std::uint32_t lanes = rays_in_box<L>(group, 0, boxes, child);
      if constexpr (L::kCount < kBeamRays) lanes |= rays_in_box<L>(group, L::kCount, boxes, child) << L::kCount;
      lanes &= memory_.group_beams[beam].lanes;
      list[met] = word;
      memory_.lanes[met] = lanes;
      met += lanes != 0 ? std::uint32_t{1} : std::uint32_t{0};
    }
    if (met == 0) return Status::kOk;
    const VertexTriangle* records = nullptr;
    GRIDIRON_TRY(source_.leaf(leaf, records));
    work_.add(share_origin() ? Work::kListSharedLeaf : Work::kListLeaf);
    set_up_leaf<L>(records, leaf.count(), memory_.triangles, &memory_.group_leaf);
    for (std::uint32_t i = 0; i < leaf.count(); ++i) memory_.group_leaf.own_ids[i] = no_hit(records[i].triangle_id);
    const std::uint32_t cost = question_.any_hit ? kTriangleCost : std::uint32_t{1};
    std::uint32_t pair_count = 0, ray_count = 0;
    for (std::uint32_t i = 0; i < met; ++i) {
      const std::uint32_t beam = beam_index(list[i]);
      std::uint32_t lanes = memory_.lanes[i], triangles = 0;
      if (count_bits(lanes) > cost) {
        triangles = triangles_in_group<L>(memory_.group_beams[beam], memory_.reaches[beam], beam_axis(list[i]),
                                          memory_.group_leaf, leaf.count());
        (cost * count_bits(triangles) <= count_bits(lanes) ? lanes : triangles) = 0;
      }
      const typename L::Int first_pair = L::Int::splat(beam * kTreeWidth);
      const typename L::Int first_ray = L::Int::splat(list_word(beam / kGroupBeams * kBeamRays, 0));
      for (std::uint32_t base = 0; base < kTreeWidth; base += L::kCount) {
        const std::uint32_t some = triangles >> base & L::kAllBits, others = lanes >> base & L::kAllBits;
        L::compress(L::Int::load(kLaneNumbers.of + base) + first_pair, some, memory_.pairs + pair_count);
        pair_count += count_bits(some);
        L::compress(L::Int::load(kLaneNumbers.rays + base) + first_ray, others, rays + ray_count);
        ray_count += count_bits(others);
      }
    }
    const std::uint32_t hits = hit_count_;
    if (shares_origin_) {
      set_up_origin<L>(memory_.rays[0].origin, leaf.count(), memory_.triangles);
      for (std::uint32_t i = 0; i < leaf.count(); ++i) memory_.beams.own_ids[i] = memory_.group_leaf.own_ids[i];
    }
    if (pair_count != 0) {
      GRIDIRON_TRY(shares_origin_ ? test_pairs<true>(records, pair_count) : test_pairs<false>(records, pair_count));
    }
    // Rays in beams have not been set up: the group has their largest components.
    for (std::uint32_t i = 0; i < ray_count; ++i) {
      const std::uint32_t ray = ((rays[i] & kPlaceBits) >> kPlaceShift) / kRayQuads;
      memory_.rays[ray].dir_max = memory_.groups[ray / kBeamRays].dir_max[ray % kBeamRays];
    }
    GRIDIRON_TRY(test_rays(records, leaf, rays, ray_count));
    if (hit_count_ == hits) return Status::kOk;
    for (std::uint32_t i = 0; i < met; ++i) {
      const std::uint32_t beam = beam_index(list[i]);
      memory_.reaches[beam] =
          group_reach<L>(memory_.groups[beam / kGroupBeams], memory_.group_beams[beam], beam_axis(list[i]));
    }
    return Status::kOk;
  }
  // The first loop leaves the pairs of a beam and a triangle that wide bounds leave open for some ray, without a branch
  // that depends on a pair. The second one decides these.
  template <bool kShares>
  [[nodiscard]] GRIDIRON_OUTLINE Status test_pairs(const VertexTriangle* records, std::uint32_t pair_count) {
    std::uint32_t* const pairs = memory_.pairs;
    std::uint32_t open_count = 0;
    work_.add(kShares ? Work::kListSharedGroup : Work::kListTriangleGroup, pair_count);
    for (std::uint32_t i = 0; i < pair_count; ++i) {
      const std::uint32_t pair = pairs[i];
      const RayGroup& group = memory_.groups[pair / (kGroupBeams * kTreeWidth)];
      const GroupTriangle<L, kShares> triangle(memory_.triangles, memory_.group_leaf, pair % kTreeWidth);
      bool is_open = triangle.may_be_hit(group, 0);
      if constexpr (L::kCount < kBeamRays) is_open |= triangle.may_be_hit(group, L::kCount);
      pairs[open_count] = pair;
      open_count += is_open ? std::uint32_t{1} : std::uint32_t{0};
    }
    for (std::uint32_t i = 0; i < open_count; ++i) {
      const std::uint32_t beam = pairs[i] / kTreeWidth, triangle = pairs[i] % kTreeWidth, place = beam / kGroupBeams;
      const RayGroup& group = memory_.groups[place];
      for (std::uint32_t base = 0; base < kBeamRays; base += L::kCount) {
        const auto own = L::equal(memory_.group_leaf.own_ids[triangle], group.ids + base);
        const std::uint32_t there = memory_.group_beams[beam].lanes >> base & L::kAllBits & ~own.bits();
        const LeafAnswer<L> answer = test_one<kShares>(triangle, LeafRay<L>(group, base), there);
        if ((answer.inside | answer.unsure) != 0) {
          GRIDIRON_TRY(decide_group(place * kBeamRays, base, answer, records[triangle]));
        }
      }
    }
    return Status::kOk;
  }
  // What a triangle takes in lanes of rays, in what a ray takes in lanes of triangles. Of closest hits it takes no
  // more: single rays find their distances one by one.
  static constexpr std::uint32_t kTriangleCost = 2;
  struct LaneNumbers {
    alignas(64) std::uint32_t of[kTreeWidth];
    alignas(64) std::uint32_t rays[kTreeWidth];  // words of lists
  };
  static constexpr LaneNumbers kLaneNumbers = [] {
    LaneNumbers numbers{};
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) numbers.of[i] = i, numbers.rays[i] = list_word(i, 0);
    return numbers;
  }();
  template <bool kShares>
  [[nodiscard]] GRIDIRON_INLINE LeafAnswer<L> test_one(std::uint32_t triangle, const LeafRay<L>& rays,
                                                       std::uint32_t there) const {
    if constexpr (kShares) {
      return SharedLanes<L, true, true>(memory_.triangles, triangle, memory_.group_leaf.own_ids).test(rays, there);
    } else {
      return LeafLanes<L, true, true>(memory_.triangles, triangle).test(rays, there);
    }
  }
  // Decides one triangle for the rays of a group, from `base` on, that floats do not rule out.
  // @param first  ray of the group.
  [[nodiscard]] GRIDIRON_INLINE Status decide_group(std::uint32_t first, std::uint32_t base,
                                                    const LeafAnswer<L>& answer, const VertexTriangle& triangle) {
    const RayGroup& group = memory_.groups[first / kBeamRays];
    BatchRay* const rays = memory_.rays + first + base;
    const bool any_hit = question_.any_hit;
    std::uint32_t passed = answer.inside;
    for (std::uint32_t rest = answer.unsure; rest != 0; rest &= rest - 1) {
      const std::uint32_t lane = lowest_bit(rest);
      rays[lane].dir_max = group.dir_max[base + lane];
      if (passes_through(rays[lane], triangle, work_)) passed |= 1u << lane;
    }
    work_.add(Work::kListCandidate, count_bits(passed));
    if (any_hit) {
      for (std::uint32_t sure = passed & answer.within; sure != 0; sure &= sure - 1) {
        end_ray(rays[lowest_bit(sure)], triangle.triangle_id);
      }
      passed &= ~answer.within;
    }
    if (passed == 0) return Status::kOk;
    PlaneNormal plane;
    set_up_plane_normal(triangle, plane);
    alignas(64) float distance[L::kCount];
    for (std::uint32_t open = group_distances<L>(group, base, triangle, plane, distance) & passed; open != 0;
         open &= open - 1) {
      const std::uint32_t lane = lowest_bit(open);
      rays[lane].dir_max = group.dir_max[base + lane];
      distance[lane] = ray_distance(rays[lane], triangle, work_);
    }
    const Float t = Float::load(distance);
    const std::uint32_t near = ((t > Float(0.0f)) & (t <= Float::load(group.t + base))).bits() & passed;
    for (std::uint32_t rest = near; rest != 0; rest &= rest - 1) {
      const std::uint32_t lane = lowest_bit(rest);
      BatchRay& ray = rays[lane];
      if (any_hit) {
        end_ray(ray, triangle.triangle_id);
        continue;
      }
      if (distance[lane] == ray.t && ray.has_hit()) {
        bool is_first = false;
        GRIDIRON_TRY(comes_before(ray, triangle, is_first));
        if (!is_first) continue;
      }
      set_t(ray, distance[lane]);
      ray.id = triangle.triangle_id;
    }
    return Status::kOk;
  }

  // @returns the first ray of a list, from `begin` on, that floats do not rule out for all triangles of a group, or the
  // list's end. Wide lanes stop rays on the way that surely hit one, if any hit will do: to leave and come back loads
  // all lanes again. @param answer  gets what floats say.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t next_candidate(const std::uint32_t* list, std::uint32_t begin,
                                                             std::uint32_t end, std::uint32_t base, std::uint32_t there,
                                                             LeafAnswer<L>& answer) {
    if constexpr (kHasBeams) {
      if (shares_origin_) {
        if constexpr (L::kRoundsOnce) {
          if (question_.trusts_floats) return search_shared<false>(list, begin, end, base, there, answer);
        }
        return search_shared<true>(list, begin, end, base, there, answer);
      }
    }
    if constexpr (L::kRoundsOnce) {
      if (question_.trusts_floats) return search_own<false>(list, begin, end, base, there, answer);
    }
    return search_own<true>(list, begin, end, base, there, answer);
  }
  template <bool kBounded>
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t search_shared(const std::uint32_t* list, std::uint32_t begin,
                                                             std::uint32_t end, std::uint32_t base, std::uint32_t there,
                                                             LeafAnswer<L>& answer) {
    return search(SharedLanes<L, kBounded>(memory_.triangles, base, memory_.beams.own_ids), list, begin, end, there,
                  answer);
  }
  template <bool kBounded>
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t search_own(const std::uint32_t* list, std::uint32_t begin,
                                                          std::uint32_t end, std::uint32_t base, std::uint32_t there,
                                                          LeafAnswer<L>& answer) {
    return search(LeafLanes<L, kBounded>(memory_.triangles, base), list, begin, end, there, answer);
  }
  template <class LaneTriangles>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t search(const LaneTriangles& lanes, const std::uint32_t* list,
                                                     std::uint32_t begin, std::uint32_t end, std::uint32_t there,
                                                     LeafAnswer<L>& answer) {
    work_.charge_to(share_origin() ? Work::kListSharedGroup : Work::kListTriangleGroup);
    for (std::uint32_t i = begin; i < end; ++i) {
      BatchRay& ray = ray_of(memory_.rays, list[i]);
      const LeafAnswer<L> found = lanes.test(ray, there);
      if ((found.inside | found.unsure) == 0) continue;
      if constexpr (L::kCount > 4) {
        const std::uint32_t sure = found.inside & found.within;
        if (question_.any_hit && sure != 0 && !ray.has_hit()) {
          work_.add(Work::kListCandidate);
          end_ray(ray, wide_.records[lowest_bit(sure)].triangle_id);
          continue;
        }
      }
      answer = found;
      return i;
    }
    return end;
  }

  // Decides the triangles that floats leave to one ray. @param base  of the answer's lanes.
  [[nodiscard]] GRIDIRON_OUTLINE Status decide(BatchRay& ray, const VertexTriangle* triangles,
                                               const LeafAnswer<L>& answer, std::uint32_t base) {
    work_.add(Work::kListCandidate);
    work_.charge_to(Work::kListCandidate);
    const bool any_hit = question_.any_hit;
    std::uint32_t passed = answer.inside;
    // Floats alone take what is unsure for a hit, so two triangles that share an edge leave no gap. Where a ray begins
    // or ends, it would hit its own triangle's neighbours.
    if (question_.trusts_floats) passed |= answer.unsure & answer.within;
    if (any_hit) {
      if (ray.has_hit()) return Status::kOk;
      const std::uint32_t sure = passed & answer.within;
      if (sure != 0) return stop(ray, triangles[lowest_bit(sure)].triangle_id);
    }
    // The nearest first, by estimates: exact distances cost the most, and a near hit spares those behind it.
    const std::uint32_t candidates = answer.inside | answer.unsure;
    alignas(64) float least[L::kCount];
    const bool are_several = !any_hit && (candidates & (candidates - 1)) != 0;
    if (are_several) answer.least_t().store(least);
    for (std::uint32_t rest = candidates, lane = 0; rest != 0; rest &= ~(1u << lane)) {
      lane = lowest_bit(rest);
      if (are_several) {
        for (std::uint32_t more = rest & (rest - 1); more != 0; more &= more - 1) {
          if (least[lowest_bit(more)] < least[lane]) lane = lowest_bit(more);
        }
        if (least[lane] > ray.t) break;
      }
      const VertexTriangle& triangle = triangles[lane];
      if ((triangle.triangle_id | kNoHit) == ray.id) continue;
      if ((passed >> lane & 1u) == 0 && !passes_through(ray, triangle, work_)) continue;
      if (any_hit && (answer.within >> lane & 1u) != 0) return stop(ray, triangle.triangle_id);
      const float t =
          question_.trusts_floats ? float_distance(ray, triangle, base + lane) : ray_distance(ray, triangle, work_);
      work_.charge_to(Work::kListCandidate);
      if (!(t > 0.0f) || t > ray.t) continue;
      if (any_hit) return stop(ray, triangle.triangle_id);
      if (t == ray.t && ray.has_hit()) {
        bool is_first = false;
        GRIDIRON_TRY(comes_before(ray, triangle, is_first));
        if (!is_first) continue;
      }
      set_t(ray, t);
      ray.id = triangle.triangle_id;
    }
    return Status::kOk;
  }

  GRIDIRON_INLINE void set_t(BatchRay& ray, float t) {
    ray.t = t;
    if constexpr (kHasGroups) ++hit_count_;
    if constexpr (kHasTerms) memory_.terms[&ray - memory_.rays].t = t;
    if constexpr (kHasGroups) {
      const auto place = static_cast<std::uint32_t>(&ray - memory_.rays);
      memory_.groups[place / kBeamRays].t[place % kBeamRays] = t;
    }
  }

  // A ray of no length meets no box any more.
  GRIDIRON_INLINE void end_ray(BatchRay& ray, std::uint32_t id) {
    ray.id = id;
    set_t(ray, -1.0f);
    ++dead_count_;
  }
  [[nodiscard]] Status stop(BatchRay& ray, std::uint32_t id) {
    end_ray(ray, id);
    return Status::kOk;
  }

  // Single precision alone. @param place  of the triangle in the lanes.
  [[nodiscard]] float float_distance(const BatchRay& ray, const VertexTriangle& triangle, std::uint32_t place) const {
    const TriangleLanes& lanes = memory_.triangles;
    float ahead = 0.0f, along = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      ahead = ahead + (triangle.v[0][axis] - ray.origin[axis]) * lanes.normal[axis][place];
      along = along + ray.dir[axis] * lanes.normal[axis][place];
    }
    return ahead / along;
  }

  // Decides between two triangles at the same rounded distance: the lower id, or the truly nearer one. The earlier
  // triangle is fetched for that, which is hardly ever needed.
  [[nodiscard]] GRIDIRON_RARE Status comes_before(const BatchRay& ray, const VertexTriangle& triangle, bool& is_first) {
    is_first = triangle.triangle_id < ray.id;
    if (!question_.breaks_ties) return Status::kOk;
    VertexTriangle other;
    GRIDIRON_TRY(source_.triangle_of(question_.surfaces, ray.id, other));
    if (in_one_plane(triangle, other)) return Status::kOk;
    is_first = comes_first_exactly(ray.origin, ray.dir, triangle, other, is_first, work_);
    return Status::kOk;
  }

  Memory& memory_;
  Source& source_;
  WorkCounters& work_;
  RayQuestion question_{};
  std::uint32_t dead_count_ = 0;
  std::uint32_t hit_count_ = 0;  // hits that changed a ray
  bool shares_origin_ = false;
  // What wide lanes alone keep.
  struct Wide {
    TermsList terms;
    bool uses_terms = false;
    const VertexTriangle* records = nullptr;  // of those in the lanes
  };
  struct None {};
  [[no_unique_address]] std::conditional_t<(L::kCount > 4), Wide, None> wide_;
};

}  // namespace gridiron
