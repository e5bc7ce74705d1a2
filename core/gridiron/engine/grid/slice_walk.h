// Slice walk: the macrocells that a packet's frustum touches, macro slice by macro slice, and the cells inside each.
// Resumable state machines: they return what they need next, and the caller fetches it.
// Source: Cho, Kim, Han 2012, sections 3.2 and 4.1; Wald, Ize, Kensler, Knoll, Parker 2006, section 3.3.
// Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/engine/grid/macro_table.h>

#include <cstdint>

namespace gridiron {

/// A macrocell to visit: its block in main memory and the cells it covers (inclusive, clipped to the grid).
struct MacroVisit {
  std::uint32_t block;
  std::int32_t k_first, k_last, u_first, u_last, v_first, v_last;
};

/// A non-empty cell to test.
struct CellVisit {
  std::uint32_t first_triangle, triangle_count;
  float entry, exit;  ///< march distances at which its slice begins and ends
  std::int32_t u, v;
};

/// Answer of MacroWalk::next().
enum class WalkStep : std::uint8_t {
  kFound,       ///< the visit is filled
  kNeedsChunk,  ///< fetch table chunk `needed_chunk()`, then call again
  kDone,        ///< nothing is left
};

/// Walks macro slices front to back and, inside each, the macrocells of the frustum's rectangle.
///
/// Bound: at most macro_cell_count_k slices and as many steps as there are macrocells.
class MacroWalk {
 public:
  template <class Bound>
  void begin(const GridRecord& grid, const Bound& frustum) {
    const auto macro_count = [&](std::uint32_t axis) { return static_cast<std::int32_t>(grid.macro_cell_count[axis]); };
    macro_width_ = static_cast<std::int32_t>(grid.macro_width);
    macro_per_cell_ = 1.0f / static_cast<float>(macro_width_);
    macro_count_k_ = macro_count(frustum.axis_k);
    const std::uint32_t stride[3] = {1, grid.macro_cell_count[0], grid.macro_cell_count[0] * grid.macro_cell_count[1]};
    stride_k_ = stride[frustum.axis_k];
    stride_u_ = stride[frustum.axis_u];
    stride_v_ = stride[frustum.axis_v];
    step_ = 0;
    v_ = 0;
    v_last_ = -1;
    u_ = 0;
    u_last_ = -1;
  }

  /// @param reach  march distance beyond which no ray needs to look. @param skip_empty  whether to skip empty
  ///               macrocells. @tparam Bound  Frustum, or one of its interface.
  template <class Bound, class Table>
  [[nodiscard]] WalkStep next(const Bound& frustum, const Table& table, float reach, bool skip_empty, MacroVisit& visit,
                              WorkCounters& work) {
    for (;;) {
      // 1. The rest of the current macro slice.
      for (; v_ <= v_last_; ++v_, u_ = u_first_) {
        work.add(GridWork::kMacroRow);
        for (; u_ <= u_last_; ++u_) {
          work.charge_to(GridWork::kMacroCellStep);
          const std::uint32_t cell = static_cast<std::uint32_t>(k_) * stride_k_ +
                                     static_cast<std::uint32_t>(u_) * stride_u_ +
                                     static_cast<std::uint32_t>(v_) * stride_v_;
          if (!table.holds(cell)) {
            needed_chunk_ = Table::chunk_of(cell);
            return WalkStep::kNeedsChunk;
          }
          work.add(GridWork::kMacroCellStep);
          const bool is_occupied = table.is_occupied(cell);
          if (!is_occupied && skip_empty) continue;
          work.charge_to(GridWork::kMacroCellVisit);
          visit.block = is_occupied ? table.block_of(cell) : std::uint32_t{0};  // the empty block
          visit.k_first = slice_first_;
          visit.k_last = slice_last_;
          visit.u_first = u_ * macro_width_;
          visit.u_last = smaller(visit.u_first + macro_width_, frustum.cells_u) - 1;
          visit.v_first = v_ * macro_width_;
          visit.v_last = smaller(visit.v_first + macro_width_, frustum.cells_v) - 1;
          ++u_;
          return WalkStep::kFound;
        }
        work.charge_to(GridWork::kMacroRow);
      }
      // 2. The next macro slice.
      work.charge_to(GridWork::kMacroSliceStep);
      if (step_ == macro_count_k_) return WalkStep::kDone;
      k_ = frustum.reverse ? macro_count_k_ - 1 - step_ : step_;
      ++step_;
      slice_first_ = k_ * macro_width_;
      slice_last_ = smaller(slice_first_ + macro_width_, frustum.cells_k) - 1;
      const Slab slab = frustum.slab_of(slice_first_, slice_last_);
      if (frustum.behind(slab)) continue;
      if (frustum.beyond(slab, reach)) {
        step_ = macro_count_k_;
        return WalkStep::kDone;
      }
      work.add(GridWork::kMacroSliceStep);
      const CellRect rect = frustum.rect_of(slab, work);
      work.charge_to(GridWork::kMacroSliceStep);
      if (rect.empty()) continue;
      u_first_ = macro_of(rect.u_first);
      u_last_ = macro_of(rect.u_last);
      v_ = macro_of(rect.v_first);
      v_last_ = macro_of(rect.v_last);
      u_ = u_first_;
    }
  }

  [[nodiscard]] std::uint32_t needed_chunk() const { return needed_chunk_; }

 private:
  static GRIDIRON_INLINE std::int32_t smaller(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
  /// cell / macro_width without a division; exact, because (c + 1/2) / m is at least 1/16 away from every integer.
  [[nodiscard]] GRIDIRON_INLINE std::int32_t macro_of(std::int32_t cell) const {
    return static_cast<std::int32_t>((static_cast<float>(cell) + 0.5f) * macro_per_cell_);
  }

  std::int32_t macro_width_, macro_count_k_;
  float macro_per_cell_;
  std::uint32_t stride_k_, stride_u_, stride_v_;
  std::int32_t step_, k_, slice_first_, slice_last_;
  std::int32_t u_, u_first_, u_last_, v_, v_last_;
  std::uint32_t needed_chunk_;
};

/// Number of triangles in a cell of a block; counts the look-up as work.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t triangle_count_of(const CellRecord* cell) {
  return cell->triangle_count;
}
[[nodiscard]] GRIDIRON_INLINE std::uint32_t triangle_count_of(const CellBound* cell) {
  return cell[1].first_triangle - cell[0].first_triangle;
}
[[nodiscard]] GRIDIRON_INLINE constexpr GridWork step_kind_of(const CellRecord*) {
  return GridWork::kCellStep;
}
[[nodiscard]] GRIDIRON_INLINE constexpr GridWork step_kind_of(const CellBound*) {
  return GridWork::kCellBoundStep;
}

/// Walks the slices of one macrocell front to back and the non-empty cells of the frustum's rectangle in each.
///
/// Bound: m slices, m^3 cells.
class CellWalk {
 public:
  template <class Bound>
  void begin(const GridRecord& grid, const Bound& frustum, const MacroVisit& visit) {
    visit_ = visit;
    const std::int32_t m = static_cast<std::int32_t>(grid.macro_width);
    const std::int32_t stride[3] = {1, m, m * m};
    stride_k_ = stride[frustum.axis_k];
    stride_u_ = stride[frustum.axis_u];
    stride_v_ = stride[frustum.axis_v];
    step_ = 0;
    v_ = 0;
    v_last_ = -1;
    u_ = 0;
    u_last_ = -1;
  }

  /// @tparam Cell  CellRecord or CellBound. @param cells  the macrocell's block. @returns false when no cell is left.
  template <class Bound, class Cell>
  [[nodiscard]] bool next(const Bound& frustum, const Cell* cells, float reach, CellVisit& found, WorkCounters& work) {
    const std::int32_t slice_count = visit_.k_last - visit_.k_first + 1;
    for (;;) {
      for (; v_ <= v_last_; ++v_, u_ = u_first_) {
        work.add(GridWork::kCellRow);
        for (; u_ <= u_last_; ++u_) {
          work.add(step_kind_of(cells));
          const Cell* const cell =
              cells + (row_ + (u_ - visit_.u_first) * stride_u_ + (v_ - visit_.v_first) * stride_v_);
          const std::uint32_t triangle_count = triangle_count_of(cell);
          if (triangle_count == 0) continue;
          work.add(GridWork::kCellVisit);
          found = {cell->first_triangle, triangle_count, slab_.entry, slab_.exit, u_, v_};
          ++u_;
          return true;
        }
        work.charge_to(GridWork::kCellRow);
      }
      work.charge_to(GridWork::kSliceStep);
      if (step_ == slice_count) return false;
      const std::int32_t k = frustum.reverse ? visit_.k_last - step_ : visit_.k_first + step_;
      ++step_;
      const Slab slab = frustum.slab_of(k, k);
      if (frustum.behind(slab)) continue;
      if (frustum.beyond(slab, reach)) {
        step_ = slice_count;
        return false;
      }
      work.add(GridWork::kSliceStep);
      const CellRect rect = frustum.rect_of(slab, work);
      work.charge_to(GridWork::kSliceStep);
      u_first_ = rect.u_first > visit_.u_first ? rect.u_first : visit_.u_first;
      u_last_ = rect.u_last < visit_.u_last ? rect.u_last : visit_.u_last;
      v_ = rect.v_first > visit_.v_first ? rect.v_first : visit_.v_first;
      v_last_ = rect.v_last < visit_.v_last ? rect.v_last : visit_.v_last;
      u_ = u_first_;
      row_ = (k - visit_.k_first) * stride_k_;
      slab_ = slab;
    }
  }

 private:
  MacroVisit visit_;
  std::int32_t stride_k_, stride_u_, stride_v_;
  std::int32_t step_, row_;
  std::int32_t u_, u_first_, u_last_, v_, v_last_;
  Slab slab_;
};

}  // namespace gridiron
