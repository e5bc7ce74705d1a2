// Lists of rays through the wide tree: a batch is filtered down the nodes, child by child. A node or leaf is looked at
// once for all rays of a list. Every hit equals that of exact arithmetic, except with Accuracy::kFast.
// Source: own; core/TREE.md. Memory: ListMemory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/box_test.h>
#include <gridiron/engine/tree/leaf_visits.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/engine/tree/list_rays.h>
#include <gridiron/engine/tree/ray_beams.h>
#include <gridiron/engine/tree/ray_groups.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/ray_batch.h>

#include <cstdint>
#include <utility>

namespace gridiron {

/// @tparam Memory  ListMemory.
/// @tparam Source  where nodes and records are: ahead(child) has a child fetched that will be taken soon, node(index,
///                 node) and leaf(child, records) wait for it. What they give stays until the next call of either.
///                 triangle_of(id, triangle) fetches any triangle. All return a Status. window(): how many children
///                 are asked for at once, the one that is taken next among them.
template <class L, class Memory, class Source>
class RayLists : LeafVisits<L, Memory, Source> {
 public:
  RayLists(Memory& memory, Source& source, WorkCounters& work) : LeafVisits<L, Memory, Source>(memory, source, work) {}

  /// Answers the first `count` rays of the memory: id is a triangle's where a ray hits one. Directions and t of rays
  /// may be changed by powers of two.
  /// @param largest  |coordinate| of the tree's triangles.
  [[nodiscard]] GRIDIRON_OUTLINE Status trace(const RayQuestion& question, std::uint32_t count, float largest) {
    question_ = question;
    if constexpr (kHasBeams) {
      if (!(largest >= kLeastBeamScene)) question_.are_neighbors = false;
    }
    ray_count_ = count;
    dead_count_ = 0;
    std::uint32_t begins[kRoots], counts[kRoots];
    list_rays(count, largest, begins, counts);
    if (question.any_hit) {
      if constexpr (kHasBeams) {
        const std::uint32_t beams = sum_of(counts + kBeamRoot);
        if (beams != 0) GRIDIRON_TRY(walk(begins[kBeamRoot], beams, true));
        const std::uint32_t rays = sum_of(counts);
        return rays != 0 ? walk(0, rays, false) : Status::kOk;
      }
      return walk(0, count, false);
    }
    // The nearest hit is found soonest front to back, and front is another side for each octant. The last list goes
    // first: it needs the room behind it.
    for (std::uint32_t root = kRoots; root > 0; --root) {
      if (counts[root - 1] == 0) continue;
      GRIDIRON_TRY(walk(begins[root - 1], counts[root - 1], root > kBeamRoot));
    }
    return Status::kOk;
  }

 private:
  using Leaves = LeafVisits<L, Memory, Source>;
  using Float = typename L::Float;
  using Leaves::kHasTerms, Leaves::kHasGroups, Leaves::kHasBeams;
  using Leaves::memory_, Leaves::source_, Leaves::work_, Leaves::question_, Leaves::dead_count_, Leaves::shares_origin_,
      Leaves::wide_;
  using Leaves::share_origin, Leaves::visit_leaf, Leaves::visit_leaf_by_groups;
  // Lists that a batch begins with: rays by octants, then beams. Of unsorted words, a bit says which.
  static constexpr std::uint32_t kBeamRoot = 8, kIsBeam = 1;
  static constexpr std::uint32_t kStep = kListStep<L>, kParts = kBoxParts<L>;
  static constexpr std::uint32_t kLevelWords = (1 + kListParts<L>)*kStep;
  static_assert(!kHasBeams || Memory::template kHoldsBeams<L>);
  static constexpr std::uint32_t kRoots = kHasBeams ? 2 * kBeamRoot : kBeamRoot;
  [[nodiscard]] static std::uint32_t sum_of(const std::uint32_t* counts) {
    std::uint32_t sum = 0;
    for (std::uint32_t octant = 0; octant < 8; ++octant) sum += counts[octant];
    return sum;
  }
  [[nodiscard]] static std::uint32_t step_up(std::uint32_t words) { return (words + (kStep - 1)) & ~(kStep - 1); }

  // Lists the batch in the order of octants: rays that run alike along all axes follow each other.
  GRIDIRON_OUTLINE void list_rays(std::uint32_t count, float largest, std::uint32_t* begins, std::uint32_t* counts) {
    for (std::uint32_t root = 0; root < kRoots; ++root) counts[root] = 0;
    std::uint32_t* const unsorted = memory_.arena + (Memory::kArenaWords - Memory::kRays);
    work_.add(Work::kListRay, count);
    work_.charge_to(Work::kListRay);
    if constexpr (L::kCount > 4) {
      list_by_lanes(count, largest, unsorted, begins, counts);
    } else {
      list_one_by_one(count, largest, unsorted, begins, counts);
    }
  }
  GRIDIRON_INLINE void list_one_by_one(std::uint32_t count, float largest, std::uint32_t* unsorted,
                                       std::uint32_t* begins, std::uint32_t* counts) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t octant = set_up_list_ray<L>(memory_.rays[i], largest);
      unsorted[i] = list_word(i, octant);
      ++counts[octant];
    }
    shares_origin_ = false;
    std::uint32_t words = count;
    if constexpr (kHasBeams) {
      if (question_.are_neighbors) {
        shares_origin_ = have_one_origin(memory_.rays, count);
        words = list_beams(unsorted, count, largest, counts);
      }
    }
    std::uint32_t places[kRoots], end = 0;
    for (std::uint32_t root = 0; root < kRoots; ++root) {
      if (root == kBeamRoot) end = step_up(end);
      begins[root] = places[root] = end;
      end += question_.any_hit ? counts[root] : step_up(counts[root]);
    }
    for (std::uint32_t i = 0; i < words; ++i) {
      const std::uint32_t word = unsorted[i];
      std::uint32_t& place = places[octant_of(word) + (word & kIsBeam) * kBeamRoot];
      memory_.arena[place] = word & ~kIsBeam;
      ++place;
    }
  }

  // Wide lanes prepare as many rays at once, and pick those of one root after the other, as those that meet a child:
  // a counter of each octant would be a chain through memory where rays run alike.
  GRIDIRON_INLINE void list_by_lanes(std::uint32_t count, float largest, std::uint32_t* unsorted, std::uint32_t* begins,
                                     std::uint32_t* counts) {
    // Copies of the last ray fill the last lanes. They are listed nowhere.
    static constexpr std::uint32_t kFilled = kHasGroups ? kBeamRays : static_cast<std::uint32_t>(L::kCount);
    for (std::uint32_t i = count; i % kFilled != 0; ++i) memory_.rays[i] = memory_.rays[count - 1];
    shares_origin_ = false;
    if constexpr (kHasBeams) {
      if (question_.are_neighbors) shares_origin_ = have_one_origin(memory_.rays, count);
    }
    // Accuracy::kFast meets the same boxes with all lanes. Sides measured from one origin take less than terms.
    std::uint32_t roots = kHasTerms && !share_origin() && !question_.trusts_floats
                              ? set_up_by_lanes<kHasTerms>(count, largest, unsorted)
                              : set_up_by_lanes<false>(count, largest, unsorted);
    std::uint32_t words = count;
    if constexpr (kHasGroups) {
      words = listed_;
    } else if constexpr (kHasBeams) {
      if (question_.are_neighbors) {
        words = list_beams(unsorted, count, largest, counts);
        for (std::uint32_t octant = 0; octant < 8; ++octant) {
          if (counts[kBeamRoot + octant] != 0) roots |= 1u << (kBeamRoot + octant);
        }
      }
    }
    for (std::uint32_t i = words; i % L::kCount != 0; ++i) unsorted[i] = kMaskBits;
    std::uint32_t end = 0;
    for (std::uint32_t root = 0; root < kRoots; ++root) {
      if (root == kBeamRoot) end = step_up(end);
      begins[root] = end;
      counts[root] =
          (roots >> root & 1u) == 0 ? std::uint32_t{0} : take_marked<L>(unsorted, words, root, memory_.arena + end);
      end += question_.any_hit ? counts[root] : step_up(counts[root]);
    }
  }
  // @param unsorted  gets words of rays that miss all roots but their own. @returns the rays' roots, as bits.
  template <bool kSetsTerms>
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t set_up_by_lanes(std::uint32_t count, float largest,
                                                               std::uint32_t* unsorted) {
    RaySetup<L, kSetsTerms> setup(largest);
    std::uint32_t groups = 0;
    if constexpr (kHasGroups) {
      groups = set_up_groups(setup, count, largest, unsorted);
    } else {
      for (std::uint32_t i = 0; i < count; i += L::kCount) add_rays(setup, i, unsorted + i);
    }
    wide_.uses_terms = false;
    if constexpr (kSetsTerms) {
      const float farthest[3] = {setup.farthest(0), setup.farthest(1), setup.farthest(2)};
      wide_.uses_terms = wide_.terms.set_up(memory_.terms, farthest, largest);
    }
    return setup.octants() | groups;
  }
  template <bool kSetsTerms>
  GRIDIRON_INLINE void add_rays(RaySetup<L, kSetsTerms>& setup, std::uint32_t first, std::uint32_t* words) {
    RayTerms* terms = nullptr;
    if constexpr (kSetsTerms) terms = memory_.terms + first;
    setup.add(memory_.rays + first, terms, first, words);
  }
  // Makes groups of neighbours, and sets up the rays of those that make none. @returns the groups' roots, as bits.
  template <bool kSetsTerms>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t set_up_groups(RaySetup<L, kSetsTerms>& setup, std::uint32_t count,
                                                            float largest, std::uint32_t* words) {
    // Between the lists, which will be written from the front, and the unsorted words at the end.
    static constexpr std::uint32_t kListWords = Memory::kRays + kRoots * kStep,
                                   kBeams = kGroupBeams * (Memory::kRays / kBeamRays);
    static_assert(Memory::kArenaWords >= kListWords + kBeams + Memory::kRays);
    std::uint32_t* const beams = memory_.arena + kListWords;
    std::uint32_t roots = 0, tried = 0, alone = 0, made = 0;
    const bool tries = question_.are_neighbors && !question_.trusts_floats;
    listed_ = 0;
    for (std::uint32_t first = 0; first < count; first += kBeamRays) {
      const std::uint32_t rest = count - first, here = rest < kBeamRays ? rest : kBeamRays;
      std::uint32_t left = (2u << (here - 1)) - 1;
      if (tries && alone <= kLoneRays + tried / kLoneShare) {
        left = group_rays(first, left, largest, beams, made, roots);
        tried += here;
        alone += count_bits(left);
        if (left == 0) continue;
      }
      for (std::uint32_t i = 0; i < kBeamRays; i += L::kCount) {
        alignas(64) std::uint32_t here_words[L::kCount];
        add_rays(setup, first + i, here_words);
        const std::uint32_t some = left >> i & L::kAllBits;
        L::compress(L::Int::load(here_words), some, words + listed_);
        listed_ += count_bits(some);
      }
    }
    for (std::uint32_t i = 0; i < made; ++i) words[listed_ + i] = beams[i];
    listed_ += made;
    return roots;
  }
  // Makes beams of up to kBeamRays neighbours. @param lanes  the rays, as bits. @param beams  of the batch, as words;
  // `made` of them so far. @returns the rays that are in none.
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t group_rays(std::uint32_t first, std::uint32_t lanes, float largest,
                                                          std::uint32_t* beams, std::uint32_t& made,
                                                          std::uint32_t& roots) {
    RayGroup& group = memory_.groups[first / kBeamRays];
    std::uint32_t rest = load_group<L>(memory_.rays + first, largest, group) & lanes, left = lanes & ~rest, parts = 0;
    work_.add(Work::kListBeam);
    const std::uint32_t first_beam = kGroupBeams * (first / kBeamRays);
    // All of them, or those beside the first, then beside the first of the others.
    for (bool are_all = true; count_bits(rest) >= kLeastGroup && parts < kGroupBeams;) {
      const std::uint32_t beam = first_beam + parts, ray = lowest_bit(rest);
      const std::uint32_t some = are_all ? rest : lanes_beside<L>(group, rest, ray, largest) | 1u << ray;
      std::uint32_t octant = 0, axis = kNoBeam;
      if (count_bits(some) >= kLeastGroup) {
        axis = make_group_beam<L>(group, some, largest, memory_.group_beams[beam], memory_.reaches[beam], octant);
      }
      const bool was_all = are_all;
      are_all = false;
      if (axis != kNoBeam) {
        beams[made] = beam_word(beam, axis, octant) | beam_mark(octant);
        ++made;
        ++parts;
        roots |= 1u << (kBeamRoot + octant);
      } else if (was_all) {
        continue;
      } else {
        left |= some;
      }
      rest &= ~some;
    }
    return left | rest;
  }
  // What tells a beam from rays among unsorted words: to wide lanes that it misses all other roots.
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t beam_mark([[maybe_unused]] std::uint32_t octant) {
    if constexpr (L::kCount > 4) return kMaskBits & ~(1u << (kBeamRoot + octant));
    return kIsBeam;
  }

  // Puts beams in the place of rays where neighbours make them. @returns how many words are left.
  GRIDIRON_OUTLINE std::uint32_t list_beams(std::uint32_t* words, std::uint32_t count, float largest,
                                            std::uint32_t* counts) {
    std::uint32_t listed = 0, tried = 0, made = 0;
    for (std::uint32_t first = 0; first < count; first += kBeamRays) {
      const std::uint32_t rest = count - first, here = rest < kBeamRays ? rest : kBeamRays;
      const std::uint32_t octant = octant_of(words[first]);
      std::uint32_t axis = kNoBeam;
      bool are_alike = true;
      for (std::uint32_t i = first; i < first + here; ++i) are_alike = are_alike && octant_of(words[i]) == octant;
      if (are_alike && tried - made < kVainBeams + tried / 4) {
        work_.add(Work::kListBeam);
        work_.charge_to(Work::kListBeam);
        axis = make_beam(memory_.rays + first, here, largest, memory_.beams.of[first / kBeamRays]);
        ++tried;
      }
      if (axis == kNoBeam) {
        for (std::uint32_t i = first; i < first + here; ++i, ++listed) words[listed] = words[i];
        continue;
      }
      counts[octant] -= here;
      words[listed] = beam_word(first / kBeamRays, axis, octant) | beam_mark(octant);
      ++listed;
      ++counts[kBeamRoot + octant];
      ++made;
    }
    work_.charge_to(Work::kListRay);
    return listed;
  }

  [[nodiscard]] static GRIDIRON_OUTLINE bool have_one_origin(const BatchRay* rays, std::uint32_t count) {
    using Quad = Lanes<4>;
    const auto place = Quad::Float::load(rays[0].origin);
    for (std::uint32_t i = 1; i < count; ++i) {
      const auto other = Quad::Float::load(rays[i].origin);
      if ((((other < place) | (other > place)).bits() & 7u) != 0) return false;
    }
    return true;
  }
  [[nodiscard]] const float* shared_origin() const { return share_origin() ? memory_.rays[0].origin : nullptr; }

  // Takes a list of the arena down the tree. What lies behind it is overwritten.
  [[nodiscard]] GRIDIRON_OUTLINE Status walk(std::uint32_t list, std::uint32_t count, bool are_beams) {
    std::uint32_t depth = 0;
    GRIDIRON_TRY(enter(memory_.levels[0], 0, list, count, are_beams));
    for (;;) {
      ListLevel& level = memory_.levels[depth];
      work_.charge_to(Work::kListChild);
      if (level.turn == level.child_count) {
        if (depth == 0) return Status::kOk;
        --depth;
        continue;
      }
      // At first those of a window, then one more for each that was taken.
      const std::uint32_t window = source_.window();
      std::uint32_t next = level.turn == 0 ? std::uint32_t{0} : level.turn + window - 1;
      for (; next < level.child_count && next < level.turn + window; ++next) {
        GRIDIRON_TRY(source_.ahead(level.children[next]));
      }
      work_.charge_to(Work::kListChild);
      const TreeChild child = level.children[level.turn];
      std::uint32_t place = 0;
      if constexpr (kHasGroups) place = level.place();
      const std::uint32_t selected = select(level, depth);
      if (selected == 0) continue;
      if (child.is_leaf()) {
        if constexpr (kHasGroups) {
          if (has_beams(depth)) {
            std::uint32_t* const beams = memory_.arena + level.end;
            GRIDIRON_TRY(visit_leaf_by_groups(child, memory_.child_boxes[depth], place, beams, selected,
                                              beams + step_up(selected)));
            continue;
          }
        }
        GRIDIRON_TRY(visit_leaf(child, memory_.arena + level.end, selected));
      } else {
        ++depth;
        GRIDIRON_TRY(enter(memory_.levels[depth], child.node_index(), level.end, selected, has_beams(depth - 1)));
      }
    }
  }

  // Lists the rays that meet the child whose turn it is: of those that are left of the level's, as many as there is
  // room for. Below the child's level each has a step of rays, so that there is always room for one.
  [[nodiscard]] std::uint32_t select(ListLevel& level, std::uint32_t depth) {
    work_.add(Work::kListChild);
    const std::uint32_t child = level.place();
    const std::uint32_t part = child / (kTreeWidth / kParts);
    const std::uint32_t below = (kMaxTreeDepth - 1 - depth) * kLevelWords;
    const std::uint32_t room = Memory::kArenaWords - level.end - below;
    const std::uint32_t* const list = memory_.arena + level.lists[part];
    std::uint32_t* const target = memory_.arena + level.end;
    // All of them, if they fit even where each meets the child, and all boxes below it. With d = depth and words W of a
    // step of rays at all parts of a level, 13 - d of W are free behind the level's lists: of the root's by
    // list_arena_words, and so 2 W here, and 13 - (d + 1) behind a child's lists, which take W less than the room.
    const std::uint32_t ray_count = level.ray_counts[part];
    std::uint32_t end = ray_count;
    if (!has_beams(depth) && (1 + kListParts<L>)*step_up(end - level.taken) + kLevelWords > room) [[unlikely]] {
      end = level.taken + (room / kLevelWords - 1) * kStep;
    }
    const std::uint32_t seen = end - level.taken;
    work_.add(Work::kListEntry, seen);
    work_.charge_to(Work::kListEntry);
    std::uint32_t count = take_marked<L>(list + level.taken, seen, child, target);
    work_.charge_to(Work::kListChild);
    level.taken = end;
    if (end == ray_count) {
      level.taken = 0;
      ++level.turn;
    }
    if (!has_beams(depth) && dead_count_ * kDeadShare > ray_count_) {
      // Rays that have their answer leave lists only once they are many: they meet no box any more.
      count = keep_living(target, count);
    }
    return count;
  }

  // Of what share of the batch: wide lanes look at as many rays at once.
  static constexpr std::uint32_t kDeadShare = L::kCount > 4 ? 20 : 5;
  [[nodiscard]] std::uint32_t keep_living(std::uint32_t* list, std::uint32_t count) const {
    if constexpr (L::kCount > 4) {
      return take_living<L>(memory_.rays, list, count);
    } else {
      std::uint32_t living = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t word = list[i];
        list[living] = word;
        living += ray_of(memory_.rays, word).has_hit() ? std::uint32_t{0} : std::uint32_t{1};
      }
      return living;
    }
  }

  // Finds which boxes of a node each ray of a list meets: surely all that hold a hit.
  [[nodiscard]] GRIDIRON_OUTLINE Status enter(ListLevel& level, std::uint32_t index, std::uint32_t list,
                                              std::uint32_t count, bool are_beams) {
    work_.charge_to(Work::kListNode);
    const TreeNode* node = nullptr;
    GRIDIRON_TRY(source_.node(index, node));
    work_.add(Work::kListNode);
    work_.charge_to(Work::kListNode);
    level.taken = 0;
    level.turn = 0;
    std::uint32_t open = 0;
    bool are_rays = !kHasBeams || !are_beams;
    if constexpr (kHasBeams) {
      const auto bit = std::uint32_t{1} << static_cast<std::uint32_t>(&level - memory_.levels);
      beam_levels_ &= ~bit;
      if (are_beams) {
        if constexpr (kHasGroups) {
          copy_boxes<L>(*node, memory_.child_boxes[&level - memory_.levels]);
          open = mark_groups<L>(*node, memory_.group_beams, memory_.reaches, memory_.arena + list, count, work_);
        } else {
          open = mark_beams<L>(*node, memory_.beams.of, memory_.arena + list, count, work_);
        }
        work_.charge_to(Work::kListNode);
        level.end = step_up(list + count);
        are_rays = !kHasGroups && has_leaf(*node, open);
        for (std::uint32_t part = 0; part < kParts; ++part) level.set_part(part, list, count);
        if (!are_rays) {
          beam_levels_ |= bit;
        } else {
          // Rays are tested one by one where leaves are: a beam meets more of them than its rays do.
          work_.charge_to(Work::kListEntry);
          count = list_beam_rays(memory_.beams.of, memory_.arena + list, count, memory_.rays, ray_count_,
                                 memory_.arena + level.end, work_);
          list = level.end;
        }
      }
    }
    if (are_rays) {
      open = mark(*node, list, count, level);
    }
    work_.charge_to(Work::kListNode);
    level.child_count = 0;
    level.places[0] = level.places[1] = 0;
    if (question_.any_hit) {
      // By turns first, without a branch for each child.
      const std::uint32_t order[2] = {static_cast<std::uint32_t>(node->order),
                                      static_cast<std::uint32_t>(node->order >> 32)};
      const auto child_at = [&order](std::uint32_t turn)
                                GRIDIRON_INLINE_LAMBDA { return order[turn / 8] >> 4 * (turn % 8) & 15; };
      std::uint32_t turns = 0;
      if constexpr (L::kCount > 4) {
        turns = turns_by_lanes(order, open);
      } else {
        for (std::uint32_t i = 0; i < node->child_count; ++i) turns |= (open >> child_at(i) & 1u) << i;
      }
      for (; turns != 0; turns &= turns - 1) add_child(level, *node, child_at(lowest_bit(turns)));
      return Status::kOk;
    }
    add_nearest_first(level, *node, open, octant_of(memory_.arena[list]));
    return Status::kOk;
  }

  // Bit i: the child in place i of an order is open. Eight places are a word of the order, 4 bits each.
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t turns_by_lanes(const std::uint32_t* order, std::uint32_t open) {
    using Int = typename L::Int;
    alignas(64) static constexpr std::uint32_t kShifts[kTreeWidth] = {0, 4, 8, 12, 16, 20, 24, 28,
                                                                      0, 4, 8, 12, 16, 20, 24, 28};
    std::uint32_t closed = 0;
    for (std::uint32_t base = 0; base < kTreeWidth; base += L::kCount) {
      const std::uint32_t first = order[base / 8], last = order[(base + L::kCount - 1) / 8];
      const Int words = L::select(L::mask_from_bits(0xFF), Int::splat(first), Int::splat(last));
      const Int children = (words >> Int::load(kShifts)) & Int::splat(15);
      closed |= (((Int::splat(open) >> children) & Int::splat(1)) < Int::splat(1)).bits() << base;
    }
    return ~closed & ((1u << kTreeWidth) - 1);
  }

  [[nodiscard]] bool has_beams(std::uint32_t depth) const {
    if constexpr (kHasBeams) return (beam_levels_ >> depth & 1u) != 0;
    return false;
  }

  // @returns whether one of some children is a leaf.
  [[nodiscard]] static bool has_leaf(const TreeNode& node, std::uint32_t children) {
    std::uint32_t bits = 0;
    for (std::uint32_t rest = children; rest != 0; rest &= rest - 1) bits |= node.children[lowest_bit(rest)].bits;
    return TreeChild{bits}.is_leaf();
  }

  static void add_child(ListLevel& level, const TreeNode& node, std::uint32_t child) {
    const std::uint32_t turn = level.child_count;
    level.children[turn] = node.children[child];
    level.places[turn / 8] |= child << 4 * (turn % 8);
    level.child_count = turn + 1;
  }

  // The open children in the order of their boxes' middles along the diagonal of an octant.
  static void add_nearest_first(ListLevel& level, const TreeNode& node, std::uint32_t open, std::uint32_t octant) {
    alignas(64) float keys[kTreeWidth];
    for (std::uint32_t base = 0; base < kTreeWidth; base += L::kCount) {
      Float sum(0.0f);
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const Float middle = Float::load(node.low[axis] + base) + Float::load(node.high[axis] + base);
        sum = (octant >> axis & 1u) != 0 ? sum - middle : sum + middle;
      }
      sum.store(keys + base);
    }
    for (std::uint32_t rest = open; rest != 0;) {
      std::uint32_t nearest = lowest_bit(rest);
      for (std::uint32_t others = rest & (rest - 1); others != 0; others &= others - 1) {
        const std::uint32_t child = lowest_bit(others);
        if (keys[child] < keys[nearest]) nearest = child;
      }
      add_child(level, node, nearest);
      rest &= ~(1u << nearest);
    }
  }

  [[nodiscard]] GRIDIRON_INLINE std::uint32_t mark(const TreeNode& node, std::uint32_t list, std::uint32_t count,
                                                   ListLevel& level) {
    if constexpr (kHasTerms) {
      if (wide_.uses_terms) {
        return mark_boxes<L, false>(node, &wide_.terms, nullptr, memory_.arena, list, count, level, work_);
      }
    }
    return mark_boxes<L, kHasBeams>(node, memory_.rays, shared_origin(), memory_.arena, list, count, level, work_);
  }

  std::uint32_t ray_count_ = 0;
  std::uint32_t beam_levels_ = 0;  // bit i: the lists of level i are of beams
  std::uint32_t listed_ = 0;       // words of the batch's rays and beams
};

}  // namespace gridiron
