// Lists of rays through the wide tree: a batch is filtered down the nodes, child by child. A node or leaf is looked at
// once for all rays of a list. Every decision equals that of exact arithmetic, as in ray/intersect_rays.h.
// DRAFT: nodes and records are read where they lie, not fetched.
// Source: own; core/TREE.md. Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/intersect_rays.h>
#include <gridiron/ray/walk_rays.h>

#include <cstdint>
#include <utility>

namespace gridiron {

/// 16 rays of a batch.
struct alignas(64) ListRays : WalkRays {
  alignas(64) float inverse[3][kWalkRays];  ///< reciprocals of dir; of a component below 2^-80 of dir_max its sign x
                                            ///< 2^80 / dir_max
};

/// A ray in a list: its place in words from the first group.
inline constexpr std::uint32_t kListGroupWords = sizeof(ListRays) / 4;
inline constexpr std::uint32_t kMaxListRays = 65536 / kListGroupWords * kWalkRays;

/// Fills what the lists need besides origin, dir and t.
template <class L>
GRIDIRON_INLINE void set_up_list_rays(ListRays& rays) {
  using Float = typename L::Float;
  for (std::uint32_t base = 0; base < kWalkRays; base += L::kCount) {
    const Float x = Float::load(rays.dir[0] + base), y = Float::load(rays.dir[1] + base),
                z = Float::load(rays.dir[2] + base);
    const Float most = L::max(L::max(L::abs(x), L::abs(y)), L::abs(z));
    most.store(rays.dir_max + base);
    const Float least = most * Float(0x1p-80f);
    for (const auto& [dir, inverse] : {std::pair{x, rays.inverse[0]}, {y, rays.inverse[1]}, {z, rays.inverse[2]}}) {
      const Float away = L::select(L::abs(dir) < least, L::select(dir < Float(0.0f), -least, least), dir);
      (Float(1.0f) / away).store(inverse + base);
    }
  }
}

/// Up to 16 triangles in lanes.
struct TriangleLanes {
  alignas(64) float v[3][kMaxTreeLeaf];         ///< the first corner
  alignas(64) float e1[3][kMaxTreeLeaf];        ///< from it to the second one
  alignas(64) float e2[3][kMaxTreeLeaf];        ///< from it to the third one
  alignas(64) float normal[3][kMaxTreeLeaf];    ///< e1 x e2
  alignas(64) float edge_size[kMaxTreeLeaf];    ///< sum of the magnitudes of both edges' components
  alignas(64) float normal_size[kMaxTreeLeaf];  ///< of the normal's products
};

template <class L, std::uint32_t kRays>
class RayLists {
 public:
  using Float = typename L::Float;
  static_assert(kRays <= kMaxListRays && kRays % kWalkRays == 0);
  struct Counts {
    std::uint64_t nodes, leaves, node_rays, leaf_rays, unsure, distances;
  };
  Counts counts{};

  RayLists(const TreeNode* nodes, const VertexTriangle* records, WorkCounters& work)
      : nodes_(nodes), records_(records), work_(work) {}

  /// Answers rays: id is a triangle's where a ray hits one.
  void trace(ListRays* rays, std::uint32_t count, bool any_hit) {
    rays_ = rays;
    words_ = reinterpret_cast<float*>(rays);
    count_ = count;
    dead_ = 0;
    if (any_hit) {
      std::uint32_t n = 0;
      for (std::uint32_t i = 0; i < count; ++i) arena_[n++] = entry_of(i);
      walk<true>(n, 0);
      return;
    }
    // Rays that run alike along all axes go together, and meet the children front to back.
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      std::uint32_t n = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const float* const ray = words_ + entry_of(i);
        arena_[n] = entry_of(i);
        n += ((ray[kDir] < 0 ? 1u : 0u) | (ray[kDir + 16] < 0 ? 2u : 0u) | (ray[kDir + 32] < 0 ? 4u : 0u)) == octant;
      }
      if (n != 0) walk<false>(n, octant);
    }
  }

 private:
  static constexpr std::uint32_t kOrigin = 0, kDir = 48, kT = 96, kDirMax = 112, kId = 128, kInverse = 160;
  static_assert(offsetof(ListRays, dir) == 4 * kDir && offsetof(ListRays, t) == 4 * kT &&
                offsetof(ListRays, dir_max) == 4 * kDirMax && offsetof(ListRays, id) == 4 * kId &&
                offsetof(ListRays, inverse) == 4 * kInverse);
  [[nodiscard]] static std::uint16_t entry_of(std::uint32_t ray) {
    return static_cast<std::uint16_t>(ray / kWalkRays * kListGroupWords + ray % kWalkRays);
  }

  struct Level {
    std::uint64_t order;
    TreeChild children[kTreeWidth];
    std::uint16_t *list, *masks, *end;  ///< end: of the arena's used part
    std::uint32_t count, open;          ///< rays; children that some ray meets
  };

  template <bool kAny>
  void walk(std::uint32_t count, std::uint32_t octant) {
    Level levels[kMaxTreeDepth];
    std::uint32_t depth = 0;
    enter<kAny>(levels[0], nodes_[0], arena_, count, octant);
    for (;;) {
      Level& level = levels[depth];
      if (level.open == 0) {
        if (depth == 0) return;
        --depth;
        continue;
      }
      std::uint32_t child = 0;
      do {
        child = static_cast<std::uint32_t>(level.order & 15);
        level.order >>= 4;
      } while ((level.open >> child & 1u) == 0);
      level.open &= ~(1u << child);
      std::uint32_t n = select(level, child);
      if (kAny && dead_ * 5 > count_) n = living(level.end, n);
      if (n == 0) continue;
      const TreeChild below = level.children[child];
      if (below.is_leaf()) {
        visit_leaf<kAny>(below, level.end, n);
      } else {
        ++depth;
        enter<kAny>(levels[depth], nodes_[below.node_index()], level.end, n, octant);
      }
    }
  }

  static std::uint32_t select(const Level& level, std::uint32_t child) {
    std::uint32_t n = 0;
    std::uint16_t* const to = level.end;
#if defined(__AVX512VBMI2__)
    if constexpr (L::kCount == 16) {
      const __m512i bit = _mm512_set1_epi16(static_cast<short>(1u << child));
      for (std::uint32_t i = 0; i < level.count; i += 32) {
        __mmask32 m = _mm512_test_epi16_mask(_mm512_loadu_si512(level.masks + i), bit);
        if (level.count - i < 32) m &= (1u << (level.count - i)) - 1;
        _mm512_storeu_si512(to + n, _mm512_maskz_compress_epi16(m, _mm512_loadu_si512(level.list + i)));
        n += static_cast<std::uint32_t>(__builtin_popcount(m));
      }
      return n;
    }
#endif
    for (std::uint32_t i = 0; i < level.count; ++i) {
      to[n] = level.list[i];
      n += level.masks[i] >> child & 1u;
    }
    return n;
  }

  [[nodiscard]] bool is_dead(std::uint16_t entry) const {
    return reinterpret_cast<const std::uint32_t*>(words_)[entry + kId] != kNoTriangle;
  }
  std::uint32_t living(std::uint16_t* list, std::uint32_t count) const {
    std::uint32_t n = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint16_t entry = list[i];
      list[n] = entry;
      n += is_dead(entry) ? 0u : 1u;
    }
    return n;
  }

  // Which boxes each ray of the list meets: surely all that hold a hit, see core/TREE.md.
  template <bool kAny>
  GRIDIRON_OUTLINE void enter(Level& level, const TreeNode& node, std::uint16_t* list, std::uint32_t count,
                              std::uint32_t octant) {
    ++counts.nodes;
    counts.node_rays += count;
    level.list = list;
    level.masks = list + (count + 63) / 32 * 32;
    level.end = level.masks + (count + 63) / 32 * 32;
    level.count = count;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) level.children[i] = node.children[i];
    std::uint32_t open = 0;
    const std::uint32_t there = (2u << (node.child_count - 1)) - 1;
    for (std::uint32_t base = 0; base < node.child_count; base += L::kCount) {
      Float near[3], far[3];
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_backwards = !kAny && (octant >> axis & 1u) != 0;
        near[axis] = Float::load((is_backwards ? node.high : node.low)[axis] + base);
        far[axis] = Float::load((is_backwards ? node.low : node.high)[axis] + base);
      }
      const std::uint32_t lanes = there >> base & L::kAllBits;
      for (std::uint32_t i = 0; i < count; ++i) {
        const float* const ray = words_ + list[i];
        Float first(0.0f), last(ray[kT]);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          const Float o(ray[kOrigin + 16 * axis]), r(ray[kInverse + 16 * axis]);
          const Float a = (near[axis] - o) * r, b = (far[axis] - o) * r;
          first = L::max(first, kAny ? L::min(a, b) : a);
          last = L::min(last, kAny ? L::max(a, b) : b);
        }
        const std::uint32_t met = (first <= last * Float(1.0f + 0x1p-19f)).bits() & lanes;
        level.masks[i] = static_cast<std::uint16_t>(base == 0 ? met : level.masks[i] | met << base);
        open |= met << base;
      }
    }
    level.open = open;
    level.order = node.order;
    if (!kAny) level.order = order_along(node, octant, open);
  }

  // Children in the order of their centres along the octant's diagonal.
  static std::uint64_t order_along(const TreeNode& node, std::uint32_t octant, std::uint32_t open) {
    alignas(64) float keys[kTreeWidth];
    for (std::uint32_t base = 0; base < kTreeWidth; base += L::kCount) {
      Float sum(0.0f);
      for (int axis = 0; axis < 3; ++axis) {
        const Float middle = Float::load(node.low[axis] + base) + Float::load(node.high[axis] + base);
        sum = (octant >> axis & 1u) != 0 ? sum - middle : sum + middle;
      }
      sum.store(keys + base);
    }
    std::uint32_t sorted[kTreeWidth], count = 0;
    for (; open != 0; open &= open - 1) {
      const std::uint32_t child = lowest_bit(open);
      std::uint32_t place = count++;
      for (; place > 0 && keys[sorted[place - 1]] > keys[child]; --place) sorted[place] = sorted[place - 1];
      sorted[place] = child;
    }
    std::uint64_t order = 0;
    for (std::uint32_t i = 0; i < count; ++i) order |= std::uint64_t{sorted[i]} << 4 * i;
    return order;
  }

  // Word w of records base, base + 1 and so on in the lanes of words[w]; behind the last one it again.
  GRIDIRON_INLINE void load_records(TreeChild leaf, std::uint32_t base, Float (&words)[12]) const {
    static_assert(sizeof(VertexTriangle) == 48);
    const float* places[4][L::kCount / 4];
    for (std::uint32_t i = 0; i < L::kCount; ++i) {
      const std::uint32_t place = base + i < leaf.count() ? base + i : leaf.count() - 1;
      places[i % 4][i / 4] = records_[leaf.first() + place].v[0];
    }
    for (int part = 0; part < 3; ++part) {
      Float rows[4];
      for (int i = 0; i < 4; ++i) {
        rows[i] = L::load_quads(places[i]);
        for (const float*& place : places[i]) place += 4;
      }
      const Float low_01 = L::template shuffle_quads<0, 4, 1, 5>(rows[0], rows[1]),
                  high_01 = L::template shuffle_quads<2, 6, 3, 7>(rows[0], rows[1]),
                  low_23 = L::template shuffle_quads<0, 4, 1, 5>(rows[2], rows[3]),
                  high_23 = L::template shuffle_quads<2, 6, 3, 7>(rows[2], rows[3]);
      words[4 * part] = L::template shuffle_quads<0, 1, 4, 5>(low_01, low_23);
      words[4 * part + 1] = L::template shuffle_quads<2, 3, 6, 7>(low_01, low_23);
      words[4 * part + 2] = L::template shuffle_quads<0, 1, 4, 5>(high_01, high_23);
      words[4 * part + 3] = L::template shuffle_quads<2, 3, 6, 7>(high_01, high_23);
    }
  }

  GRIDIRON_OUTLINE void set_up(TreeChild leaf) {
    for (std::uint32_t base = 0; base < leaf.count(); base += L::kCount) {
      Float corners[12];  // words of a record: nine coordinates, three more
      load_records(leaf, base, corners);
      Float e1[3], e2[3], sizes(0.0f), edges(0.0f);
      for (int axis = 0; axis < 3; ++axis) {
        const Float v = corners[axis];
        e1[axis] = corners[3 + axis] - v;
        e2[axis] = corners[6 + axis] - v;
        v.store(triangles_.v[axis] + base);
        e1[axis].store(triangles_.e1[axis] + base);
        e2[axis].store(triangles_.e2[axis] + base);
        edges = edges + (L::abs(e1[axis]) + L::abs(e2[axis]));
      }
      for (int axis = 0; axis < 3; ++axis) {
        const int j = axis == 2 ? 0 : axis + 1, k = j == 2 ? 0 : j + 1;
        const Float p = e1[j] * e2[k], q = e1[k] * e2[j];
        (p - q).store(triangles_.normal[axis] + base);
        sizes = sizes + (L::abs(p) + L::abs(q));
      }
      edges.store(triangles_.edge_size + base);
      sizes.store(triangles_.normal_size + base);
    }
  }

  // With e = 2^-23, the largest relative error of an operation in any rounding mode, X, D, E the sums of magnitudes of
  // the components of corner - origin, direction and edge: products of three carry 4 e by their factors, 3 e by their
  // own products and differences, and two sums 2 e, together less than 10 e X D E. The normal's products have 3 e, its
  // components 4 e, their product with the direction and its sums 7 e. The third side is the difference of these: less
  // than 2 e of both more. 14 e with what computing the bound loses.
  template <bool kAny>
  GRIDIRON_OUTLINE void visit_leaf(TreeChild leaf, const std::uint16_t* list, std::uint32_t count) {
    constexpr float kError = 14.0f * 0x1p-23f;
    ++counts.leaves;
    counts.leaf_rays += count;
    set_up(leaf);
    for (std::uint32_t base = 0; base < leaf.count(); base += L::kCount) {
      const std::uint32_t rest = leaf.count() - base;
      const std::uint32_t lanes = rest >= L::kCount ? L::kAllBits : (1u << rest) - 1;
      Float v[3], e1[3], e2[3], n[3];
      for (int axis = 0; axis < 3; ++axis) {
        v[axis] = Float::load(triangles_.v[axis] + base);
        e1[axis] = Float::load(triangles_.e1[axis] + base);
        e2[axis] = Float::load(triangles_.e2[axis] + base);
        n[axis] = Float::load(triangles_.normal[axis] + base);
      }
      const Float edge_error = Float::load(triangles_.edge_size + base) * Float(kError);
      const Float normal_error = Float::load(triangles_.normal_size + base) * Float(kError);
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint16_t entry = list[i];
        const float* const ray = words_ + entry;
        const Float d_x(ray[kDir]), d_y(ray[kDir + 16]), d_z(ray[kDir + 32]);
        const Float x = v[0] - Float(ray[kOrigin]), y = v[1] - Float(ray[kOrigin + 16]),
                    z = v[2] - Float(ray[kOrigin + 32]);
        const Float r_x = y * d_z - z * d_y, r_y = z * d_x - x * d_z, r_z = x * d_y - y * d_x;
        const Float denominator = d_x * n[0] + d_y * n[1] + d_z * n[2];
        const auto backwards = denominator < Float(0.0f);
        const Float first = L::flip_sign(backwards, r_x * e2[0] + r_y * e2[1] + r_z * e2[2]);
        const Float second = L::flip_sign(backwards, r_x * e1[0] + r_y * e1[1] + r_z * e1[2]);
        const Float size = L::abs(denominator);
        const Float third = size - first + second;
        const Float far = L::abs(x) + L::abs(y) + L::abs(z);
        const Float span(ray[kDirMax] * 3.0f);
        const Float sides = far * edge_error * span, turn = normal_error * span,
                    tiny(ray[kDirMax] * 0x1p-100f + 0x1p-100f);
        const Float error = sides + turn + tiny;
        const Float least = L::min(L::min(first, -second), third);
        const std::uint32_t outside = (least < -error).bits();
        std::uint32_t inside = (least > error).bits() & lanes;
        std::uint32_t unsure = lanes & ~(outside | inside);
        if ((inside | unsure) == 0) continue;
        // Where along the ray.
        const Float ahead = L::flip_sign(backwards, x * n[0] + y * n[1] + z * n[2]);
        const Float limit = size * Float(ray[kT]);
        const Float ahead_error = far * normal_error + tiny;
        const Float limit_error = (turn + tiny) * Float(ray[kT]) + limit * Float(0x1p-20f) + ahead_error;
        const std::uint32_t sign_known = (size > turn + tiny).bits();
        const std::uint32_t in_front = (ahead > ahead_error).bits() & sign_known;
        const std::uint32_t behind = (ahead < -ahead_error).bits() & sign_known;
        const std::uint32_t beyond = (ahead - limit > limit_error).bits() & sign_known;
        const std::uint32_t within = (limit - ahead > limit_error).bits() & in_front;
        inside &= ~(behind | beyond);
        unsure &= ~(behind | beyond);
        if ((inside | unsure) == 0) continue;
        decide<kAny>(entry, leaf.first() + base, inside, unsure, within);
      }
    }
  }

  // A ray of no length meets no box any more.
  void kill(ListRays& rays, std::uint32_t ray, std::uint32_t id) {
    rays.id[ray] = id;
    rays.t[ray] = -1.0f;
    ++dead_;
  }

  // Decides the triangles that floats leave to one ray.
  template <bool kAny>
  GRIDIRON_OUTLINE void decide(std::uint16_t entry, std::uint32_t first, std::uint32_t inside, std::uint32_t unsure,
                               std::uint32_t within) {
    ListRays& rays = rays_[entry / kListGroupWords];
    const std::uint32_t ray = entry % kListGroupWords;
    if (kAny && is_dead(entry)) return;
    for (std::uint32_t rest = kAny && (inside & within) != 0 ? inside & within : inside | unsure; rest != 0;
         rest &= rest - 1) {
      const std::uint32_t lane = lowest_bit(rest);
      const VertexTriangle& triangle = records_[first + lane];
      if ((inside >> lane & 1u) == 0) {
        ++counts.unsure;
        if (!passes_through(rays, ray, triangle, 0, 0, work_)) continue;
      }
      if (kAny && ((inside & within) >> lane & 1u) != 0) return kill(rays, ray, triangle.triangle_id);
      ++counts.distances;
      const float t = ray_distance(rays, ray, triangle, work_);
      if (!(t > 0.0f) || t > rays.t[ray]) continue;
      if (!kAny && t == rays.t[ray] && rays.id[ray] < triangle.triangle_id) continue;
      if (kAny) return kill(rays, ray, triangle.triangle_id);
      rays.id[ray] = triangle.triangle_id;
      rays.t[ray] = t;
    }
  }

  const TreeNode* nodes_;
  const VertexTriangle* records_;
  WorkCounters& work_;
  ListRays* rays_ = nullptr;
  float* words_ = nullptr;
  std::uint32_t dead_ = 0, count_ = 0;
  TriangleLanes triangles_;
  alignas(64) std::uint16_t arena_[kRays * 2 * (kMaxTreeDepth + 1) + 64 * 2 * kMaxTreeDepth];
};

}  // namespace gridiron
