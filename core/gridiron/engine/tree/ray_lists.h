// Lists of rays through the wide tree: a batch is filtered down the nodes, child by child. A node or leaf is looked at
// once for all rays of a list.
// DRAFT: nodes and records are read where they lie; unsure edges and distances are counted and decided by floats.
// Source: own; core/TREE.md. Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/tree_records.h>

#include <cstdint>

namespace gridiron {

/// Rays of a batch, SoA. A ray looks for hits with 0 < t <= its t.
template <std::uint32_t kRays>
struct RayBatch {
  alignas(64) float origin[3][kRays];
  alignas(64) float dir[3][kRays];
  alignas(64) float inverse[3][kRays];  ///< reciprocals of dir, finite
  alignas(64) float t[kRays];           ///< of closest hits: the nearest so far
  alignas(64) std::uint32_t id[kRays];  ///< of a hit so far, kNoTriangle before
};

/// Up to 16 triangles in lanes.
struct TriangleLanes {
  alignas(64) float v[3][kMaxTreeLeaf];       ///< the first corner
  alignas(64) float e1[3][kMaxTreeLeaf];      ///< from it to the second one
  alignas(64) float e2[3][kMaxTreeLeaf];      ///< from it to the third one
  alignas(64) float normal[3][kMaxTreeLeaf];  ///< e1 x e2
  alignas(64) float e1_size[kMaxTreeLeaf], e2_size[kMaxTreeLeaf], normal_size[kMaxTreeLeaf];  ///< sums of magnitudes
  std::uint32_t count;
};

template <class L, std::uint32_t kRays>
class RayLists {
 public:
  using Float = typename L::Float;
  using Batch = RayBatch<kRays>;
  std::uint64_t unsure = 0, node_rays = 0, leaf_rays = 0, nodes_seen = 0, leaves_seen = 0, most_words = 0;

  RayLists(const TreeNode* nodes, const VertexTriangle* records) : nodes_(nodes), records_(records) {}

  /// For each ray whether it hits anything: id is a triangle's then.
  void any_hit(Batch& batch, std::uint32_t count) {
    dead_ = 0;
    count_ = count;
    for (std::uint32_t i = 0; i < count; ++i) arena_[i] = static_cast<std::uint16_t>(i);
    walk<true>(batch, count);
  }

 private:
  struct Level {
    const TreeNode* node;
    std::uint16_t* list;
    std::uint16_t* masks;
    std::uint16_t* end;               ///< of the arena's used part
    std::uint32_t count, open, next;  ///< rays; children that some ray meets; place in the order
  };

  template <bool kAny>
  void walk(Batch& batch, std::uint32_t count) {
    Level levels[kMaxTreeDepth];
    std::uint32_t depth = 0;
    enter(batch, levels[0], nodes_, arena_, count);
    for (;;) {
      Level& level = levels[depth];
      if (level.open == 0) {
        if (depth == 0) return;
        --depth;
        continue;
      }
      std::uint32_t child = 0;
      do {
        child = static_cast<std::uint32_t>(level.node->order >> 4 * level.next++ & 15);
      } while ((level.open >> child & 1u) == 0);
      level.open &= ~(1u << child);
      std::uint32_t n = select(level, child, level.end);
      if (dead_ * 5 > count_) n = living(batch, level.end, n);
      if (n == 0) continue;
      const TreeChild below = level.node->children[child];
      if (below.is_leaf()) {
        visit_leaf<kAny>(batch, below, level.end, n);
      } else {
        ++depth;
        enter(batch, levels[depth], nodes_ + below.node_index(), level.end, n);
      }
    }
  }

  static std::uint32_t select(const Level& level, std::uint32_t child, std::uint16_t* to) {
    std::uint32_t n = 0;
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

  static std::uint32_t living(const Batch& batch, std::uint16_t* list, std::uint32_t count) {
    std::uint32_t n = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint16_t ray = list[i];
      list[n] = ray;
      n += batch.id[ray] == kNoTriangle ? 1u : 0u;
    }
    return n;
  }

  // Which boxes each ray of the list meets.
  void enter(const Batch& batch, Level& level, const TreeNode* node, std::uint16_t* list, std::uint32_t count) {
    ++nodes_seen;
    node_rays += count;
    level.node = node;
    level.list = list;
    level.masks = list + (count + 63) / 32 * 32;
    level.end = level.masks + (count + 63) / 32 * 32;
    most_words = most_words > static_cast<std::uint64_t>(level.end - arena_)
                     ? most_words
                     : static_cast<std::uint64_t>(level.end - arena_);
    level.count = count;
    level.next = 0;
    std::uint32_t open = 0;
    const std::uint32_t there = (2u << (node->child_count - 1)) - 1;
    for (std::uint32_t base = 0; base < kTreeWidth; base += L::kCount) {
      Float low[3], high[3];
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = Float::load(node->low[axis] + base);
        high[axis] = Float::load(node->high[axis] + base);
      }
      const std::uint32_t lanes = there >> base & L::kAllBits;
      if (lanes == 0) {
        for (std::uint32_t i = 0; base == 0 && i < count; ++i) level.masks[i] = 0;
        continue;
      }
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t ray = list[i];
        Float enter(0.0f), leave(batch.t[ray]);
        for (int axis = 0; axis < 3; ++axis) {
          const Float o(batch.origin[axis][ray]), r(batch.inverse[axis][ray]);
          const Float a = (low[axis] - o) * r, b = (high[axis] - o) * r;
          enter = L::max(enter, L::min(a, b));
          leave = L::min(leave, L::max(a, b));
        }
        const std::uint32_t met = (enter <= leave * Float(1.0f + 0x1p-20f)).bits() & lanes;
        level.masks[i] = static_cast<std::uint16_t>(base == 0 ? met : level.masks[i] | met << base);
        open |= met << base;
      }
    }
    level.open = open;
  }

  void set_up(TreeChild leaf) {
    triangles_.count = leaf.count();
    const VertexTriangle* record = records_ + leaf.first();
    for (std::uint32_t i = 0; i < leaf.count(); ++i, ++record) {
      for (int axis = 0; axis < 3; ++axis) {
        triangles_.v[axis][i] = record->v[0][axis];
        triangles_.e1[axis][i] = record->v[1][axis];
        triangles_.e2[axis][i] = record->v[2][axis];
      }
    }
    for (std::uint32_t base = 0; base < leaf.count(); base += L::kCount) {
      Float e1[3], e2[3], n[3], sizes[3];
      for (int axis = 0; axis < 3; ++axis) {
        const Float v = Float::load(triangles_.v[axis] + base);
        e1[axis] = Float::load(triangles_.e1[axis] + base) - v;
        e2[axis] = Float::load(triangles_.e2[axis] + base) - v;
        e1[axis].store(triangles_.e1[axis] + base);
        e2[axis].store(triangles_.e2[axis] + base);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const int j = axis == 2 ? 0 : axis + 1, k = j == 2 ? 0 : j + 1;
        const Float p = e1[j] * e2[k], q = e1[k] * e2[j];
        n[axis] = p - q;
        sizes[axis] = L::abs(p) + L::abs(q);
        n[axis].store(triangles_.normal[axis] + base);
      }
      (L::abs(e1[0]) + L::abs(e1[1]) + L::abs(e1[2])).store(triangles_.e1_size + base);
      (L::abs(e2[0]) + L::abs(e2[1]) + L::abs(e2[2])).store(triangles_.e2_size + base);
      (sizes[0] + sizes[1] + sizes[2]).store(triangles_.normal_size + base);
    }
  }

  template <bool kAny>
  void visit_leaf(Batch& batch, TreeChild leaf, const std::uint16_t* list, std::uint32_t count) {
    ++leaves_seen;
    leaf_rays += count;
    set_up(leaf);
    for (std::uint32_t base = 0; base < triangles_.count; base += L::kCount) {
      const std::uint32_t rest = triangles_.count - base;
      const std::uint32_t lanes = rest >= L::kCount ? L::kAllBits : (1u << rest) - 1;
      Float v[3], e1[3], e2[3], n[3];
      for (int axis = 0; axis < 3; ++axis) {
        v[axis] = Float::load(triangles_.v[axis] + base);
        e1[axis] = Float::load(triangles_.e1[axis] + base);
        e2[axis] = Float::load(triangles_.e2[axis] + base);
        n[axis] = Float::load(triangles_.normal[axis] + base);
      }
      const Float e1_size = Float::load(triangles_.e1_size + base), e2_size = Float::load(triangles_.e2_size + base),
                  n_size = Float::load(triangles_.normal_size + base);
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t ray = list[i];
        const Float d_x(batch.dir[0][ray]), d_y(batch.dir[1][ray]), d_z(batch.dir[2][ray]);
        const Float x = v[0] - Float(batch.origin[0][ray]), y = v[1] - Float(batch.origin[1][ray]),
                    z = v[2] - Float(batch.origin[2][ray]);
        const Float r_x = y * d_z - z * d_y, r_y = z * d_x - x * d_z, r_z = x * d_y - y * d_x;
        const Float denominator = d_x * n[0] + d_y * n[1] + d_z * n[2];
        const auto backwards = denominator < Float(0.0f);
        const Float first = L::flip_sign(backwards, r_x * e2[0] + r_y * e2[1] + r_z * e2[2]);
        const Float second = -L::flip_sign(backwards, r_x * e1[0] + r_y * e1[1] + r_z * e1[2]);
        const Float size = L::abs(denominator);
        const Float third = size - first - second;
        const Float far =
            (L::abs(x) + L::abs(y) + L::abs(z)) *
            Float(magnitude(batch.dir[0][ray]) + magnitude(batch.dir[1][ray]) + magnitude(batch.dir[2][ray]));
        const Float error = far * (e1_size + e2_size) * Float(0x1p-21f) + n_size * Float(0x1p-21f);
        const Float ahead = L::flip_sign(backwards, x * n[0] + y * n[1] + z * n[2]);
        const Float least = L::min(L::min(first, second), third);
        const Float t(batch.t[ray]);
        std::uint32_t hit = ((least >= Float(0.0f)) & (ahead > Float(0.0f)) & (ahead <= size * t)).bits() & lanes;
        const std::uint32_t open = ((L::abs(least) <= error) & (ahead <= size * t)).bits() & lanes;
        unsure += open != 0 ? 1 : 0;
        if (hit == 0) continue;
        if constexpr (kAny) {
          dead_ += batch.id[ray] == kNoTriangle ? 1u : 0u;
          batch.id[ray] = records_[leaf.first() + base + lowest_bit(hit)].triangle_id;
          batch.t[ray] = -1.0f;
        }
      }
    }
  }

  const TreeNode* nodes_;
  const VertexTriangle* records_;
  std::uint32_t dead_ = 0, count_ = 0;
  TriangleLanes triangles_;
  alignas(64) std::uint16_t arena_[kRays * 2 * (kMaxTreeDepth + 1) + 64 * 2 * kMaxTreeDepth];
};

}  // namespace gridiron
