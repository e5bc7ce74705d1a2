// Scene image validation: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/check_value.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/build/grid/grid_resolution.h>
#include <gridiron/build/shared_check_value.h>
#include <gridiron/image/image_checker.h>
#include <gridiron/image/scene_image.h>

#include <bit>

namespace gridiron {
namespace {

// --- Grid ---------------------------------------------------------------------------------------------------------

bool same_float(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// A lattice whose values are all floats within the limits of coordinates, or none at all.
bool check_lattice(ImageChecker& checker, std::uint64_t base, const GridRecord& grid) {
  if (grid.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
    GRIDIRON_REQUIRE(is_no_lattice(grid.lattice), base, grid, lattice);
    return true;
  }
  GRIDIRON_REQUIRE(is_lattice_step(grid.lattice.step), base, grid, lattice.step);
  for (const float origin : grid.lattice.origin) {
    GRIDIRON_REQUIRE(is_lattice_origin(origin, grid.lattice.step), base, grid, lattice.origin);
  }
  return true;
}

bool same_cells(const GridRecord& a, const GridRecord& b) {
  bool same = true;
  for (int axis = 0; axis < 3; ++axis) {
    same = same && a.cell_count[axis] == b.cell_count[axis];
    same = same && same_float(a.cells_per_unit[axis], b.cells_per_unit[axis]);
  }
  return same;
}

// The grid that Eq. (1) gives over the bounds. With a lattice, n is the number of triangles of the original mesh, which
// the image does not store, so any number is accepted. More triangles never make fewer cells, so this finds the least
// number that makes as many.
GridRecord resolved_grid(const ImageHeader& header, const GridRecord& grid) {
  GridRecord expected = grid;
  const std::uint64_t kept = header.triangle_count - header.dropped_triangle_count;
  resolve_grid(kept, expected);
  if (grid.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kLattice) || same_cells(expected, grid)) {
    return expected;
  }
  std::uint64_t low = 0, high = header.triangle_count;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    resolve_grid(middle, expected);
    bool is_coarser = false;
    for (int axis = 0; axis < 3; ++axis) is_coarser = is_coarser || expected.cell_count[axis] < grid.cell_count[axis];
    if (is_coarser) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  resolve_grid(low, expected);
  return expected;
}

// Bounds, lambda and the number of triangles determine these fields; they must be what the builder would have stored.
bool check_resolution(ImageChecker& checker, std::uint64_t base, const ImageHeader& header, const GridRecord& grid) {
  const GridRecord expected = resolved_grid(header, grid);
  for (int axis = 0; axis < 3; ++axis) {
    GRIDIRON_REQUIRE(same_float(grid.minimum[axis], expected.minimum[axis]), base, grid, minimum);
    GRIDIRON_REQUIRE(grid.cell_count[axis] == expected.cell_count[axis], base, grid, cell_count);
    GRIDIRON_REQUIRE(same_float(grid.cells_per_unit[axis], expected.cells_per_unit[axis]), base, grid, cells_per_unit);
  }
  return true;
}

// The grid's rules that need more than integers.
bool check_grid(ImageChecker& checker, std::uint64_t base, const ImageHeader& header, const GridRecord& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    const float minimum = grid.minimum[axis];
    const float scale = grid.cells_per_unit[axis];
    const float low = grid.bounds_minimum[axis];
    const float high = grid.bounds_maximum[axis];
    GRIDIRON_REQUIRE(magnitude(minimum) <= kCoordinateLimit, base, grid, minimum);
    GRIDIRON_REQUIRE(scale >= kLeastCellsPerUnit && scale <= kGreatestCellsPerUnit, base, grid, cells_per_unit);
    GRIDIRON_REQUIRE(magnitude(low) <= kCoordinateLimit && low >= minimum && !is_negative_zero(low), base, grid,
                     bounds_minimum);
    const double extent = double{high} - double{minimum};
    const bool fits = extent * double{scale} <= static_cast<double>(grid.cell_count[axis]);
    GRIDIRON_REQUIRE(high <= kCoordinateLimit && high >= low && fits && !is_negative_zero(high), base, grid,
                     bounds_maximum);
  }
  if (!check_lattice(checker, base, grid)) return false;
  GRIDIRON_REQUIRE(grid.lambda >= kLeastLambda && grid.lambda <= kGreatestLambda, base, grid, lambda);
  return check_resolution(checker, base, header, grid);
}

// --- Cells and triangles ------------------------------------------------------------------------------------------

// The cell whose record, or bound and next bound, lies at `place`. Bounds that go down give more triangles than any
// image has.
CellRecord read_cell(ImageChecker& checker, bool is_bound, std::uint64_t place) {
  if (!is_bound) return checker.read<CellRecord>(place);
  const std::uint32_t first = checker.read<CellBound>(place).first_triangle;
  const std::uint32_t end = checker.read<CellBound>(place + sizeof(CellBound)).first_triangle;
  return {first, end >= first ? end - first : ~0u};
}

// Checks one block: cells inside the grid hold contiguous ranges of triangles, cells beyond its edge hold none.
bool check_block(ImageChecker& checker, const SceneImageView& view, std::uint64_t block,
                 const std::uint32_t macro_cell[3], std::uint64_t& running) {
  const GridRecord& grid = view.grid;
  const std::uint32_t width = grid.macro_width;
  const std::uint64_t begin = running;
  const bool is_bound = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  std::uint64_t base = view.cell_blocks_offset_bytes + block * grid.cell_block_bytes;
  for (std::uint32_t z = 0; z < width; ++z) {
    for (std::uint32_t y = 0; y < width; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        const CellRecord cell = read_cell(checker, is_bound, base);
        const bool inside = macro_cell[0] * width + x < grid.cell_count[0] &&
                            macro_cell[1] * width + y < grid.cell_count[1] &&
                            macro_cell[2] * width + z < grid.cell_count[2];
        GRIDIRON_REQUIRE(cell.first_triangle == running, base, cell, first_triangle);
        GRIDIRON_REQUIRE(cell.triangle_count <= grid.reference_count - running && (inside || cell.triangle_count == 0),
                         base, cell, triangle_count);
        running += cell.triangle_count;
        base += is_bound ? sizeof(CellBound) : sizeof(CellRecord);
      }
    }
  }
  const std::uint64_t block_base = view.cell_blocks_offset_bytes + block * grid.cell_block_bytes;
  if (!checker.require(running > begin, block_base, "cell.triangle_count")) return false;
  // After the last cell; with bounds, after the one that ends it.
  return check_padding(checker, base + (is_bound ? sizeof(CellBound) : 0), block_base + grid.cell_block_bytes);
}

// Checks the macro table against the blocks, and the blocks against the triangles.
bool check_cells(ImageChecker& checker, const Sections& sections, const SceneImageView& view) {
  const GridRecord& grid = view.grid;
  for (std::uint64_t offset = 0; offset < grid.cell_block_bytes; offset += sizeof(CellRecord)) {
    const std::uint64_t base = view.cell_blocks_offset_bytes + offset;
    const auto cell = checker.read<CellRecord>(base);
    GRIDIRON_REQUIRE(cell.first_triangle == 0, base, cell, first_triangle);
    GRIDIRON_REQUIRE(cell.triangle_count == 0, base, cell, triangle_count);
  }
  const std::uint64_t macro_cells = macro_cell_total(grid);
  const std::uint64_t entry_count = sections.entry(SectionKind::kMacroTable).element_count;
  std::uint64_t block = 1;
  std::uint64_t running = 0;
  for (std::uint64_t i = 0; i < entry_count; ++i) {
    const std::uint64_t base = view.macro_table_offset_bytes + i * sizeof(MacroTableEntry);
    const auto macro_table = checker.read<MacroTableEntry>(base);
    GRIDIRON_REQUIRE(macro_table.first_block == block, base, macro_table, first_block);
    for (std::uint32_t bit = 0; bit < 32 && macro_table.occupied >> bit != 0; ++bit) {
      if ((macro_table.occupied >> bit & 1u) == 0) continue;
      const std::uint64_t index = i * 32 + bit;
      GRIDIRON_REQUIRE(index < macro_cells && block < grid.cell_block_count, base, macro_table, occupied);
      const std::uint64_t row = index / grid.macro_cell_count[0];
      const std::uint32_t macro_cell[3] = {static_cast<std::uint32_t>(index % grid.macro_cell_count[0]),
                                           static_cast<std::uint32_t>(row % grid.macro_cell_count[1]),
                                           static_cast<std::uint32_t>(row / grid.macro_cell_count[1])};
      if (!check_block(checker, view, block, macro_cell, running)) return false;
      ++block;
    }
  }
  const std::uint64_t grid_base = sections.entry(SectionKind::kGrid).offset_bytes;
  GRIDIRON_REQUIRE(block == grid.cell_block_count, grid_base, grid, cell_block_count);
  GRIDIRON_REQUIRE(running == grid.reference_count && running >= 1, grid_base, grid, reference_count);
  return true;
}

// Checks the grid with its cells and triangles. Without one it completes the view: what the tree has in its place.
bool check_grid_part(ImageChecker& checker, const Sections& sections, SceneImageView& view) {
  if (view.has_grid) {
    const std::uint64_t base = sections.entry(SectionKind::kGrid).offset_bytes;
    return check_grid(checker, base, view.header, view.grid) && check_cells(checker, sections, view) &&
           check_geometry(checker, sections, view);
  }
  if (!check_tree_space(checker, view)) return false;
  const TreeRecord& tree = view.tree;
  GridRecord& grid = view.grid;
  grid.triangle_format = tree.triangle_format;
  grid.triangle_bytes = tree.triangle_bytes;
  grid.lattice = tree.lattice;
  for (int axis = 0; axis < 3; ++axis) {
    grid.bounds_minimum[axis] = tree.bounds_minimum[axis];
    grid.bounds_maximum[axis] = tree.bounds_maximum[axis];
  }
  resolve_empty_grid(grid);
  return true;
}

// --- Padding ------------------------------------------------------------------------------------------------------

// Checks the bytes in no section, and those after the elements of the known ones.
bool check_gaps(ImageChecker& checker, const ImageHeader& header, const Sections& sections) {
  const std::uint64_t table_begin = header.section_table_offset_bytes;
  const std::uint64_t table_end = table_begin + std::uint64_t{header.section_count} * sizeof(SectionEntry);
  for (std::uint64_t at = sizeof(ImageHeader); at < header.image_bytes;) {
    std::uint64_t begin = header.image_bytes, end = header.image_bytes;  // of what lies next
    const auto take = [&](std::uint64_t other_begin, std::uint64_t other_end) {
      if (other_begin < at || other_begin >= begin || other_begin == other_end) return;
      begin = other_begin;
      end = other_end;
    };
    take(table_begin, table_end);
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
      const auto entry = checker.read<SectionEntry>(table_begin + i * sizeof(SectionEntry));
      take(entry.offset_bytes, entry.offset_bytes + entry.section_bytes);
    }
    if (!check_padding(checker, at, begin)) return false;
    at = end;
  }
  for (std::uint32_t i = 0; i < Sections::kKnownCount; ++i) {
    if (!sections.found[i]) continue;
    const SectionEntry& entry = sections.entries[i];
    const std::uint64_t end = entry.offset_bytes + entry.section_bytes;
    if (!check_padding(checker, entry.offset_bytes + entry.element_bytes * entry.element_count, end)) return false;
  }
  return true;
}

}  // namespace

Status open_scene_image(std::span<const std::byte> image, SceneImageView& view, SceneImageError& error,
                        const WorkSharing& sharing) {
  error = SceneImageError{};
  ImageChecker checker(image, error, sharing);
  ImageHead head;
  const bool is_aligned = reinterpret_cast<std::uintptr_t>(image.data()) % kLineBytes == 0;
  if (!checker.require(is_aligned, 0, "image") || !check_image_head(checker, image.size(), head)) {
    return Status::kBadImage;
  }
  SceneImageView opened = view_of(head);
  if (!check_grid_part(checker, head.sections, opened) || !check_effect_sections(checker, opened) ||
      !check_tree(checker, opened) || !check_gaps(checker, opened.header, head.sections)) {
    return Status::kBadImage;
  }
  view = opened;
  return Status::kOk;
}

std::uint64_t scene_image_check_value(std::span<const std::byte> image, const WorkSharing& sharing) {
  constexpr std::size_t kGroup = CheckValue::kGroupBytes;
  static_assert(sizeof(ImageHeader) == kGroup);
  if (image.size() < kGroup) return 0;
  std::byte header[kGroup];
  __builtin_memcpy(header, image.data(), kGroup);
  __builtin_memset(header + offsetof(ImageHeader, check_value), 0, sizeof(ImageHeader::check_value));
  ImageCheckValue check;
  check.add(header);
  add_shared(check, image.subspan(kGroup), sharing);
  return check.value();
}

}  // namespace gridiron
