// Ray walks: rays through the grid, several groups of up to 16 at once. Each walk waits for one transfer at a time;
// meanwhile the others continue. So waits are hidden without looking ahead.
// Memory: the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/exact_sum.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/grid/grid_store.h>
#include <gridiron/engine/grid/slice_walk.h>
#include <gridiron/engine/grid/triangle_run.h>
#include <gridiron/engine/grid/walk.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/intersect_rays.h>
#include <gridiron/ray/lattice_run.h>
#include <gridiron/ray/walk_rays.h>

#include <cstdint>

namespace gridiron {

/// Walks of one core.
///
/// @tparam Store  LocalStore: each walk has one of its cell_blocks and one of its triangles as buffers.
template <class L, class Store, Platform P>
class WalkDriver {
 public:
  using Layout = typename Store::Layout;
  using Bound = ShaftBound<L>;

  WalkDriver(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers) {}

  /// Traces the rays of all jobs, frame.walk_depth jobs at once.
  ///
  /// @param jobs  next(rays, purpose) makes the rays of the next job and returns how many, 0 at the end; finish(rays,
  ///              count, purpose) receives the answers: id is kNoTriangle without a hit. The order in which jobs finish
  ///              depends on the number of walks; the answers do not.
  template <class Jobs>
  [[nodiscard]] Status run(const RayQuestion& asked, Jobs& jobs) {
    surfaces_ = asked.surfaces;
    const Question question{asked.any_hit, asked.trusts_floats};
    const std::uint32_t walk_count = store_.frame.walk_depth;
    std::uint32_t under_way = 0;
    bool has_more = true;
    for (std::uint32_t i = 0; i < walk_count; ++i) walk_of(i).state = WalkState::kIdle;
    for (std::uint32_t i = 0;; i = i + 1 == walk_count ? 0 : i + 1) {
      store_.work.charge_to(Work::kWalkPass);
      Walk& walk = walk_of(i);
      if (walk.state == WalkState::kIdle) {
        if (has_more) has_more = start(walk, jobs);
        if (walk.state == WalkState::kIdle) {
          if (under_way == 0) return Status::kOk;
          continue;
        }
        ++under_way;
      }
      GRIDIRON_TRY(go_on(i, question));
      if (walk.state != WalkState::kDone) continue;
      jobs.finish(walk.rays, walk.ray_count, walk.purpose);
      store_.work.charge_to(Work::kWalkPass);
      --under_way;
      walk.state = WalkState::kIdle;
      // The next job begins at once, so that its first transfer travels while the others continue.
      if (!has_more) continue;
      has_more = start(walk, jobs);
      if (walk.state == WalkState::kIdle) continue;
      ++under_way;
      GRIDIRON_TRY(go_on(i, question));
    }
  }

 private:
  // The part of a RayQuestion that stays in registers.
  struct Question {
    bool any_hit;
    bool trusts_floats;
  };

  [[nodiscard]] Walk& walk_of(std::uint32_t i) { return store_.wave.engine.walks[i]; }

  template <class Jobs>
  [[nodiscard]] bool start(Walk& walk, Jobs& jobs) {
    walk.ray_count = jobs.next(walk.rays, walk.purpose);
    store_.work.charge_to(Work::kWalkPass);
    if (walk.ray_count == 0) return false;
    walk.waiting = walk.ray_count >= 32 ? ~0u : (1u << walk.ray_count) - 1u;
    walk.state = WalkState::kNextPass;
    return true;
  }

  // Advances a walk until it waits for a transfer, or is done.
  [[nodiscard]] GRIDIRON_OUTLINE Status go_on(std::uint32_t i, Question question) {
    Walk& walk = walk_of(i);
    for (;;) {
      switch (walk.state) {
        case WalkState::kIdle:
        case WalkState::kDone:
          return Status::kOk;
        case WalkState::kNextPass:
          store_.work.charge_to(Work::kWalkPass);
          walk.active = take_walk_pass<L>(store_.frame.engine.grid, walk.rays, walk.waiting, walk.shaft, store_.work);
          if (walk.active == 0) {
            walk.state = WalkState::kDone;
            return Status::kOk;
          }
          fill_words(walk.mailbox, kNoTriangle);
          walk.reach = walk.shaft.reach<L>();
          walk.macro_walk.begin(store_.frame.engine.grid, Bound{walk.shaft});
          walk.state = WalkState::kNextMacro;
          break;
        case WalkState::kNextMacro:
          GRIDIRON_TRY(find_macro_cell(i));
          if (walk.state == WalkState::kHasBlock) return Status::kOk;
          break;
        case WalkState::kHasBlock:
          store_.work.charge_to(Work::kMacroCellVisit);
          GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(kFirstMacroTag + i)));
          store_.work.add(Work::kMacroCellVisit);
          walk.cell_walk.begin(store_.frame.engine.grid, Bound{walk.shaft}, walk.visit);
          walk.cell.triangle_count = 0;
          walk.state = WalkState::kNextCell;
          break;
        case WalkState::kNextCell:
          GRIDIRON_TRY(find_run(i));
          if (walk.state == WalkState::kHasRun) return Status::kOk;
          break;
        case WalkState::kHasRun:
          GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(kFirstTriangleTag + i)));
          GRIDIRON_TRY(test_run(i, question));
          walk.state = walk.active == 0 ? WalkState::kNextPass : WalkState::kNextCell;
          break;
      }
    }
  }

  [[nodiscard]] Status find_macro_cell(std::uint32_t i) {
    Walk& walk = walk_of(i);
    WalkStep step = next_macro_cell(walk);
    while (step == WalkStep::kNeedsChunk) {
      GRIDIRON_TRY(fetch_chunk(store_, transfers_, walk.macro_walk.needed_chunk()));
      step = next_macro_cell(walk);
    }
    if (step == WalkStep::kDone) {
      walk.state = WalkState::kNextPass;
      return Status::kOk;
    }
    store_.work.charge_to(Work::kMacroCellVisit);
    const std::uint32_t block_bytes = store_.frame.engine.grid.cell_block_bytes;
    const MainAddress address{store_.frame.engine.cell_blocks_address + std::uint64_t{walk.visit.block} * block_bytes};
    walk.state = WalkState::kHasBlock;
    return transfers_.get(store_.engine.cell_blocks[i].bytes, address, block_bytes,
                          static_cast<std::uint8_t>(kFirstMacroTag + i));
  }

  [[nodiscard]] WalkStep next_macro_cell(Walk& walk) {
    return walk.macro_walk.next(Bound{walk.shaft}, store_.engine.table, walk.reach, true, walk.visit, store_.work);
  }

  // Starts the get of the next triangles, or leaves the macrocell.
  [[nodiscard]] Status find_run(std::uint32_t i) {
    Walk& walk = walk_of(i);
    const Slab entry{walk.cell.entry, walk.cell.entry};
    if (walk.cell.triangle_count != 0 && walk.shaft.beyond(entry, walk.reach)) walk.cell.triangle_count = 0;
    if (walk.cell.triangle_count == 0) {
      const std::byte* const block = store_.engine.cell_blocks[i].bytes;
      const auto next_cell = [&](const auto* cells) {
        return walk.cell_walk.next(Bound{walk.shaft}, cells, walk.reach, walk.cell, store_.work);
      };
      const bool found = is_on_lattice(store_.frame) ? next_cell(reinterpret_cast<const CellBound*>(block))
                                                     : next_cell(reinterpret_cast<const CellRecord*>(block));
      if (!found) {
        walk.state = WalkState::kNextMacro;
        return Status::kOk;
      }
      walk.touching =
          walk.shaft.rays_touching<L>(Slab{walk.cell.entry, walk.cell.exit}, walk.cell.u, walk.cell.v, store_.work);
      if (walk.touching == 0) {
        walk.cell.triangle_count = 0;
        return Status::kOk;
      }
    }
    store_.work.charge_to(Work::kCellVisit);
    constexpr std::uint32_t kRunTriangles = Layout::kTrianglesPerBuffer;
    const std::uint32_t count = walk.cell.triangle_count < kRunTriangles ? walk.cell.triangle_count : kRunTriangles;
    const RunPlace place = run_place(store_.frame, walk.cell.first_triangle, count);
    walk.run_count = count;
    walk.run_first_byte = place.first_byte;
    walk.cell.first_triangle += count;
    walk.cell.triangle_count -= count;
    walk.state = WalkState::kHasRun;
    return transfers_.get(store_.engine.triangles[i].bytes + (place.first_byte - place.slack), place.begin, place.bytes,
                          static_cast<std::uint8_t>(kFirstTriangleTag + i));
  }

  // Tests the run that has arrived against the rays that still look.
  [[nodiscard]] Status test_run(std::uint32_t i, Question question) {
    Walk& walk = walk_of(i);
    store_.work.add(Work::kTriangleBatch);
    store_.work.charge_to(Work::kTriangleBatch);
    std::byte* const buffer = store_.engine.triangles[i].bytes;
    const auto* triangles = reinterpret_cast<const VertexTriangle*>(buffer + walk.run_first_byte);
    if (is_on_lattice(store_.frame)) {
      store_.work.add(Work::kLatticeTriangle, walk.run_count);
      triangles = spread_lattice_run(store_.frame.engine.grid.lattice, buffer, walk.run_first_byte, walk.run_count);
    }
    bool has_changed = false;
    for (std::uint32_t index = 0; index < walk.run_count && walk.active != 0; ++index) {
      const VertexTriangle& triangle = triangles[index];
      const std::uint32_t slot = triangle.triangle_id % Walk::kMailboxSlots;
      store_.work.add(Work::kMailboxProbe);
      std::uint32_t wanted = walk.active & walk.touching;
      const std::uint32_t tested = walk.mailbox[slot] == triangle.triangle_id ? walk.tested[slot] : 0;
      walk.mailbox[slot] = triangle.triangle_id;
      walk.tested[slot] = tested | wanted;
      wanted &= ~tested;
      if (wanted == 0) continue;
      std::uint32_t settled = 0;
      std::uint32_t open = rays_near<L>(walk.rays, wanted, triangle, question.trusts_floats, settled, store_.work);
      if ((open | settled) == 0) continue;
      if (!question.any_hit) {
        open |= settled;
        settled = 0;
      }
      for (; open != 0; open &= open - 1) {
        const std::uint32_t ray = lowest_bit(open);
        const float t = ray_distance(walk.rays, ray, triangle, store_.work);
        if (!(t > 0.0f) || t > walk.rays.t[ray]) continue;
        if (question.any_hit) {
          settled |= 1u << ray;
          continue;
        }
        if (t == walk.rays.t[ray] && walk.rays.id[ray] != kNoTriangle) {
          bool is_first = false;
          GRIDIRON_TRY(comes_before(walk.rays, ray, triangle, is_first));
          if (!is_first) continue;
        }
        walk.rays.t[ray] = t;
        walk.rays.id[ray] = triangle.triangle_id;
        walk.shaft.shorten(ray, t);
        has_changed = true;
      }
      store_.work.charge_to(Work::kRayGroupTest);
      for (std::uint32_t rest = settled; rest != 0; rest &= rest - 1) {
        const std::uint32_t ray = lowest_bit(rest);
        walk.rays.id[ray] = triangle.triangle_id;
        walk.shaft.drop(ray);
        has_changed = true;
      }
      walk.active &= ~settled;
      store_.work.charge_to(Work::kTriangleBatch);
    }
    if (has_changed) walk.reach = walk.shaft.reach<L>();
    return Status::kOk;
  }

  // Decides between two triangles at the same rounded distance: the lower id, or with kExact the truly nearer one. The
  // earlier triangle is fetched for that, which is hardly ever needed.
  [[nodiscard]] GRIDIRON_RARE Status comes_before(const WalkRays& rays, std::uint32_t ray,
                                                  const VertexTriangle& triangle, bool& is_first) {
    is_first = triangle.triangle_id < rays.id[ray];
    if (store_.frame.accuracy != static_cast<std::uint32_t>(Accuracy::kExact)) return Status::kOk;
    const MainAddress address{surfaces_.value + std::uint64_t{rays.id[ray]} * sizeof(SurfaceRecord)};
    std::byte* const place = store_.wave.engine.surface_bytes + address.value % kPortableCongruenceBytes;
    GRIDIRON_TRY(transfers_.get(place, address, sizeof(SurfaceRecord), kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    const auto& surface = *reinterpret_cast<const SurfaceRecord*>(place);
    VertexTriangle other;
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) other.v[corner][axis] = surface.v[corner][axis];
    }
    if (in_one_plane(triangle, other)) return Status::kOk;
    if (surely_in_one_plane(triangle, other, store_.work)) return Status::kOk;
    store_.work.add(Work::kExactOrder);
    const float origin[3] = {rays.origin[0][ray], rays.origin[1][ray], rays.origin[2][ray]};
    const float dir[3] = {rays.dir[0][ray], rays.dir[1][ray], rays.dir[2][ray]};
    const int order = exact_distance_order(origin, dir, triangle.v, other.v);
    is_first = order < 0 || (order == 0 && is_first);
    return Status::kOk;
  }

  Store& store_;
  Transfers<P>& transfers_;
  MainAddress surfaces_{};
};

}  // namespace gridiron
