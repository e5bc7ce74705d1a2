// Lists of rays through the wide tree: a batch is filtered down the nodes, child by child. A node or leaf is looked at
// once for all rays of a list. Every hit equals that of exact arithmetic, except with Accuracy::kFast.
// Source: own; core/TREE.md. Memory: ListMemory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/box_test.h>
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
#include <utility>

namespace gridiron {

/// @tparam Memory  ListMemory.
/// @tparam Source  where nodes and records are: ahead(child) has a child fetched that will be taken soon, node(index,
///                 node) and leaf(child, records) wait for it. What they give stays until the next call of either.
///                 triangle_of(id, triangle) fetches any triangle. All return a Status. window(): how many children
///                 are asked for at once, the one that is taken next among them.
template <class L, class Memory, class Source>
class RayLists {
 public:
  RayLists(Memory& memory, Source& source, WorkCounters& work) : memory_(memory), source_(source), work_(work) {}

  /// Answers the first `count` rays of the memory: id is a triangle's where a ray hits one. Directions and t of rays
  /// may be changed by powers of two.
  /// @param largest  |coordinate| of the tree's triangles.
  [[nodiscard]] GRIDIRON_OUTLINE Status trace(const RayQuestion& question, std::uint32_t count, float largest) {
    question_ = question;
    largest_ = largest;
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
  using Float = typename L::Float;
  // Where products round apart from sums, terms would have no bound.
  static constexpr bool kHasTerms = L::kRoundsOnce && Memory::kHasTerms;
  // Lists that a batch begins with: rays by octants, then beams. Of unsorted words, a bit says which.
  static constexpr std::uint32_t kBeamRoot = 8, kIsBeam = 1;
  static constexpr std::uint32_t kStep = kListStep<L>, kParts = kBoxParts<L>;
  static constexpr std::uint32_t kLevelWords = (1 + kListParts<L>)*kStep;
  // Wide lanes with memory for groups test their rays at once.
  static constexpr bool kHasGroups = L::kCount > 4 && Memory::kHasTerms&& Memory::kHasBeams;
  static constexpr bool kHasBeams = kHasGroups || (kUsesBeams<L> && Memory::kHasBeams);
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
  // Where all rays begin, if it is one place.
  [[nodiscard]] bool share_origin() const { return kHasBeams && shares_origin_; }
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
      [[maybe_unused]] const std::uint32_t place = level.place();
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
    return test_rays(records, leaf.count(), list, count);
  }
  // The triangles in lanes against the rays of a list.
  [[nodiscard]] GRIDIRON_INLINE Status test_rays(const VertexTriangle* records, std::uint32_t triangle_count,
                                                 const std::uint32_t* list, std::uint32_t count) {
    const Work leaf_kind = share_origin() ? Work::kListSharedLeaf : Work::kListLeaf;
    const Work group_kind = share_origin() ? Work::kListSharedGroup : Work::kListTriangleGroup;
    for (std::uint32_t base = 0; base < triangle_count; base += L::kCount) {
      const std::uint32_t rest = triangle_count - base;
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

  // A leaf's triangles against the rays of groups: one triangle in all lanes, or one ray, whichever are fewer.
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
    for (std::uint32_t i = 0; i < ray_count; ++i) {
      const std::uint32_t ray = ((rays[i] & kPlaceBits) >> kPlaceShift) / kRayQuads;
      memory_.rays[ray].dir_max = memory_.groups[ray / kBeamRays].dir_max[ray % kBeamRays];
    }
    GRIDIRON_TRY(test_rays(records, leaf.count(), rays, ray_count));
    if (hit_count_ == hits) return Status::kOk;
    for (std::uint32_t i = 0; i < met; ++i) {
      const std::uint32_t beam = beam_index(list[i]);
      memory_.reaches[beam] =
          group_reach<L>(memory_.groups[beam / kGroupBeams], memory_.group_beams[beam], beam_axis(list[i]));
    }
    return Status::kOk;
  }
  // First the pairs of a group and a triangle that wide bounds leave open for some rays, then these: each step without
  // a branch that depends on a pair.
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
  // What a triangle takes in lanes of rays, in what a ray takes in lanes of triangles.
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

  [[nodiscard]] GRIDIRON_INLINE std::uint32_t mark(const TreeNode& node, std::uint32_t list, std::uint32_t count,
                                                   ListLevel& level) {
    if constexpr (kHasTerms) {
      if (wide_.uses_terms) {
        return mark_boxes<L, false>(node, &wide_.terms, nullptr, memory_.arena, list, count, level, work_);
      }
    }
    return mark_boxes<L, kHasBeams>(node, memory_.rays, shared_origin(), memory_.arena, list, count, level, work_);
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
  std::uint32_t ray_count_ = 0, dead_count_ = 0;
  std::uint32_t beam_levels_ = 0;  // bit i: the lists of level i are of beams
  std::uint32_t listed_ = 0;       // words of the batch's rays and beams
  std::uint32_t hit_count_ = 0;    // hits that changed a ray
  float largest_ = 0.0f;
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
