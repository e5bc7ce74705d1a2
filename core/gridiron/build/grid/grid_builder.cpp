// Grid builder: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/check_value.h>
#include <gridiron/base/triangle_formats.h>
#include <gridiron/build/build_step.h>
#include <gridiron/build/effects/effect_sections.h>
#include <gridiron/build/grid/cell_rows.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/build/grid/image_layout.h>
#include <gridiron/build/lattice.h>
#include <gridiron/build/shared_check_value.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/tree/tree_sections.h>
#include <gridiron/build/triangle_records.h>

namespace gridiron {
namespace {

template <class Record>
void store(std::byte* image, std::uint64_t offset, const Record& record) {
  __builtin_memcpy(image + offset, &record, sizeof(Record));
}

void clear(std::byte* image, std::uint64_t begin, std::uint64_t end) {
  __builtin_memset(image + begin, 0, static_cast<std::size_t>(end - begin));
}

SectionEntry section(SectionKind kind, std::uint64_t element_bytes, std::uint64_t element_count, std::uint64_t begin,
                     std::uint64_t end) {
  return {static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(element_bytes), begin, element_count,
          end - begin};
}

template <class Mesh>
void write_directory(const Mesh& mesh, const GridNeed& need, bool has_grid, const ImageLayout& layout,
                     std::byte* image) {
  const GridRecord& grid = need.grid;
  clear(image, 0, layout.cell_blocks_offset);
  ImageHeader header{};
  header.magic = kImageMagic;
  header.version = kImageVersion;
  header.image_bytes = layout.image_bytes;
  header.section_count = layout.section_count;
  header.section_table_offset_bytes = static_cast<std::uint32_t>(layout.section_table_offset);
  header.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
  header.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
  header.dropped_triangle_count = need.dropped_triangle_count;
  store(image, 0, header);
  std::uint64_t entry_at = layout.section_table_offset;
  const auto append_entry = [&](const SectionEntry& entry) {
    store(image, entry_at, entry);
    entry_at += sizeof entry;
  };
  if (has_grid) {
    store(image, layout.grid_offset, grid);
    append_entry(section(SectionKind::kGrid, sizeof(GridRecord), 1, layout.grid_offset, layout.macro_table_offset));
    append_entry(section(SectionKind::kMacroTable, sizeof(MacroTableEntry), layout.macro_table_entries,
                         layout.macro_table_offset, layout.cell_blocks_offset));
    append_entry(section(SectionKind::kCellBlocks, grid.cell_block_bytes, grid.cell_block_count,
                         layout.cell_blocks_offset, layout.triangles_offset));
    append_entry(section(SectionKind::kTriangles, grid.triangle_bytes, grid.reference_count, layout.triangles_offset,
                         layout.effects.begin_bytes));
  }
  for (std::uint32_t i = 0; i < layout.effects.section_count; ++i) append_entry(layout.effects.entries[i]);
  for (std::uint32_t i = 0; i < layout.tree.section_count; ++i) append_entry(layout.tree.entries[i]);
}

// The lists of references before they become triangle records. They lie in the triangle section itself, which has w
// words per reference, 12 or 6: keys in words [0, 2 n), ids in [2 n, 3 n), ids by cell in [(w - 1) n, w n). Writing
// record i over words [w i, w i + w) never reaches the ids by cell that are still to be read, word (w - 1) n + i + 1
// and later.
struct ReferenceLists {
  std::uint64_t* keys;
  std::uint32_t* ids;
  std::uint32_t* ids_by_cell;

  ReferenceLists(std::byte* triangles, std::uint64_t count, std::uint32_t triangle_bytes)
      : keys(reinterpret_cast<std::uint64_t*>(triangles)),
        ids(reinterpret_cast<std::uint32_t*>(triangles + 8 * count)),
        ids_by_cell(reinterpret_cast<std::uint32_t*>(triangles + (triangle_bytes - 4) * count)) {}
};

// Lists (cell, triangle) for every reference, by ascending triangle, and marks the macrocells.
// Errors: kBadParameter if the number differs from the count.
template <class Mesh>
Status list_references(const Mesh& mesh, const GridRecord& grid, const ReferenceLists& lists,
                       MacroTableEntry* macro_table) {
  const CellSpace space = CellSpace::of(grid);
  const MacroMap macros(grid);
  const std::uint64_t limit = grid.reference_count;
  std::uint64_t count = 0;
  std::uint32_t triangle_id = 0;
  CellCuts cuts{};  // as counted
  for (const UVec3& t : mesh.triangles) {
    enter_step<kIsOnLattice<Mesh> ? GridStep::kLatticeBox : GridStep::kCellBox>();
    const Vec3& a = mesh.vertices[t.x];
    const Vec3& b = mesh.vertices[t.y];
    const Vec3& c = mesh.vertices[t.z];
    const std::uint32_t id = triangle_id++;
    if (has_zero_area(a, b, c)) continue;
    for_each_cell_row(CellBox::of(space, a, b, c), cuts,
                      [&](std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z) {
                        enter_step<GridStep::kCellRow>();
                        if (count + static_cast<std::uint64_t>(x1 - x0 + 1) > limit) {
                          count = limit + 1;
                          return;
                        }
                        const std::uint32_t width = macros.width;
                        const std::uint32_t local_y = static_cast<std::uint32_t>(y) - macros.macro_of(y) * width;
                        const std::uint32_t local_z = static_cast<std::uint32_t>(z) - macros.macro_of(z) * width;
                        const std::uint32_t local_row = (local_z * width + local_y) * width;
                        const std::uint32_t macro_x = macros.macro_of(x0);
                        std::uint64_t macro_cell = macros.row_index(y, z) + macro_x;
                        std::uint32_t local_x = static_cast<std::uint32_t>(x0) - macro_x * width;
                        macro_table[macro_cell / 32].occupied |= 1u << (macro_cell % 32);
                        enter_step<GridStep::kReferenceInsert>();
                        for (std::int32_t x = x0;; ++x) {
                          lists.keys[count] = (macro_cell << kCellBits) | (local_row + local_x);
                          lists.ids[count] = id;
                          ++count;
                          if (x == x1) break;
                          if (++local_x == width) {
                            local_x = 0;
                            ++macro_cell;
                            macro_table[macro_cell / 32].occupied |= 1u << (macro_cell % 32);
                          }
                        }
                      });
    if (count > limit) return Status::kBadParameter;
  }
  return count == limit ? Status::kOk : Status::kBadParameter;
}

// Gives every non-empty macrocell its block. @returns the number of blocks, including the empty one.
std::uint64_t number_blocks(MacroTableEntry* macro_table, std::uint64_t entry_count) {
  enter_step<GridStep::kMacroWord>();
  std::uint64_t block = 1;
  for (std::uint64_t i = 0; i < entry_count; ++i) {
    macro_table[i].first_block = static_cast<std::uint32_t>(block);
    block += count_bits(macro_table[i].occupied);
  }
  return block;
}

// Turns the keys into indices of cells of cell_bytes each, counted from the start of block 0.
void find_cells(const GridRecord& grid, const ReferenceLists& lists, const MacroTableEntry* macro_table,
                std::uint64_t cell_bytes) {
  const std::uint64_t cells_per_block = grid.cell_block_bytes / cell_bytes;  // with those that fill it up
  std::uint64_t last_macro_cell = ~std::uint64_t{0};
  std::uint64_t first_cell = 0;
  for (std::uint64_t i = 0; i < grid.reference_count; ++i) {
    const std::uint64_t macro_cell = lists.keys[i] >> kCellBits;
    if (macro_cell != last_macro_cell) {
      const MacroTableEntry& entry = macro_table[macro_cell / 32];
      const std::uint32_t below = entry.occupied & ((1u << (macro_cell % 32)) - 1);
      first_cell = (std::uint64_t{entry.first_block} + count_bits(below)) * cells_per_block;
      last_macro_cell = macro_cell;
    }
    lists.keys[i] = first_cell + (lists.keys[i] & ((1u << kCellBits) - 1));
  }
}

// Counting sort of the references by the order of cells in the blocks; stable, so ids ascend within a cell.
void sort_references(const GridRecord& grid, const ReferenceLists& lists, const MacroTableEntry* macro_table,
                     CellRecord* cells) {
  enter_step<GridStep::kReferenceSort>();
  const std::uint64_t count = grid.reference_count;
  const std::uint64_t records_per_block = grid.cell_block_bytes / sizeof(CellRecord);
  const std::uint64_t cells_per_block = std::uint64_t{grid.macro_width} * grid.macro_width * grid.macro_width;
  find_cells(grid, lists, macro_table, sizeof(CellRecord));
  for (std::uint64_t i = 0; i < count; ++i) ++cells[lists.keys[i]].triangle_count;

  // Turns counts into first triangles.
  enter_step<GridStep::kCellSum>();
  std::uint32_t running = 0;
  for (std::uint64_t block = 1; block < grid.cell_block_count; ++block) {
    for (std::uint64_t cell = 0; cell < cells_per_block; ++cell) {
      CellRecord& record = cells[block * records_per_block + cell];
      record.first_triangle = running;
      running += record.triangle_count;
      record.triangle_count = 0;
    }
  }

  enter_step<GridStep::kReferenceSort>();
  // Puts each reference into the next free place of its cell; the cell's count grows back.
  for (std::uint64_t i = 0; i < count; ++i) {
    CellRecord& record = cells[lists.keys[i]];
    lists.ids_by_cell[record.first_triangle + record.triangle_count++] = lists.ids[i];
  }
}

// The same for cells that are stored as bounds. A cell's references are counted in the bound behind it, which then
// holds the place of the cell's next reference, and at last the end of the cell.
void sort_references(const GridRecord& grid, const ReferenceLists& lists, const MacroTableEntry* macro_table,
                     CellBound* bounds) {
  enter_step<GridStep::kLatticeSort>();
  const std::uint64_t count = grid.reference_count;
  const std::uint64_t bounds_per_block = grid.cell_block_bytes / sizeof(CellBound);
  const std::uint64_t cells_per_block = std::uint64_t{grid.macro_width} * grid.macro_width * grid.macro_width;
  find_cells(grid, lists, macro_table, sizeof(CellBound));
  CellBound* const ends = bounds + 1;
  for (std::uint64_t i = 0; i < count; ++i) ++ends[lists.keys[i]].first_triangle;
  enter_step<GridStep::kLatticeCellSum>();
  std::uint32_t running = 0;
  for (std::uint64_t block = 1; block < grid.cell_block_count; ++block) {
    bounds[block * bounds_per_block].first_triangle = running;
    for (std::uint64_t cell = 0; cell < cells_per_block; ++cell) {
      CellBound& end = ends[block * bounds_per_block + cell];
      const std::uint32_t begin = running;
      running += end.first_triangle;
      end.first_triangle = begin;
    }
  }
  enter_step<GridStep::kLatticeSort>();
  for (std::uint64_t i = 0; i < count; ++i) {
    lists.ids_by_cell[ends[lists.keys[i]].first_triangle++] = lists.ids[i];
  }
}

LatticeTriangle lattice_triangle(const Lattice& lattice, const Vec3& a, const Vec3& b, const Vec3& c,
                                 std::uint32_t id) {
  LatticeTriangle record{};
  const LatticePoint corners[3] = {lattice_point(lattice, a), lattice_point(lattice, b), lattice_point(lattice, c)};
  for (int corner = 0; corner < 3; ++corner) {
    for (int axis = 0; axis < 3; ++axis) record.v[corner][axis] = corners[corner].place[axis];
  }
  record.triangle_id = id;
  return record;
}

// Writes the triangle records front to back and adds them to the check value while they are in the cache.
template <class Mesh>
void write_triangles(const Mesh& mesh, const GridRecord& grid, const std::uint32_t* ids_by_cell, std::byte* triangles,
                     ImageCheckValue& check) {
  constexpr std::uint64_t kPieceRecords = 256;  // a multiple of kGroupBytes in bytes
  static_assert(kPieceRecords * sizeof(LatticeTriangle) % CheckValue::kGroupBytes == 0);
  const bool projection = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kProjection);
  const bool lattice = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  const std::uint64_t triangle_bytes = grid.triangle_bytes;
  std::uint64_t checked_bytes = 0;
  for (std::uint64_t i = 0; i < grid.reference_count; ++i) {
    enter_step<kIsOnLattice<Mesh> ? GridStep::kLatticeWrite : GridStep::kTriangleWrite>();
    const std::uint32_t id = ids_by_cell[i];
    const UVec3& t = mesh.triangles[id];
    const Vec3& a = mesh.vertices[t.x];
    const Vec3& b = mesh.vertices[t.y];
    const Vec3& c = mesh.vertices[t.z];
    if (projection) {
      enter_step<GridStep::kProjectionSetup>();
      ProjectionTriangle record;
      make_projection_triangle(a, b, c, id, record);
      store(triangles, i * triangle_bytes, record);
    } else if (lattice) {
      store(triangles, i * triangle_bytes, lattice_triangle(grid.lattice, a, b, c, id));
    } else {
      const VertexTriangle record{{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}, {0, 0}, id};
      store(triangles, i * triangle_bytes, record);
    }
    if ((i + 1) % kPieceRecords == 0) {
      enter_step<GridStep::kCheckedLine>();
      const std::uint64_t end = (i + 1) * triangle_bytes;
      check.add({triangles + checked_bytes, static_cast<std::size_t>(end - checked_bytes)});
      checked_bytes = end;
    }
  }
  enter_step<GridStep::kCheckedLine>();
  const std::uint64_t end = grid.reference_count * triangle_bytes;
  const std::uint64_t padded_end = round_up<std::uint64_t>(end, kLineBytes);
  clear(triangles, end, padded_end);
  check.add({triangles + checked_bytes, static_cast<std::size_t>(padded_end - checked_bytes)});
}

// Writes the grid's cells and triangles, and adds what stands before their end to the check value.
// Errors: kBadParameter if the mesh is not the one that was counted.
template <class Mesh>
Status write_grid(const Mesh& mesh, const GridRecord& grid, const ImageLayout& layout, std::byte* bytes,
                  ImageCheckValue& check) {
  std::byte* const triangles = bytes + layout.triangles_offset;
  enter_step<GridStep::kClearedLine>();
  clear(bytes, layout.cell_blocks_offset, layout.triangles_offset);
  auto* const macro_table = reinterpret_cast<MacroTableEntry*>(bytes + layout.macro_table_offset);
  std::byte* const cells = bytes + layout.cell_blocks_offset;

  const ReferenceLists lists(triangles, grid.reference_count, grid.triangle_bytes);
  GRIDIRON_TRY(list_references(mesh, grid, lists, macro_table));
  if (number_blocks(macro_table, layout.macro_table_entries) != grid.cell_block_count) return Status::kBadParameter;
  if (grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
    sort_references(grid, lists, macro_table, reinterpret_cast<CellBound*>(cells));
  } else {
    sort_references(grid, lists, macro_table, reinterpret_cast<CellRecord*>(cells));
  }

  enter_step<GridStep::kClearedLine>();
  check.add({bytes, static_cast<std::size_t>(layout.triangles_offset)});
  write_triangles(mesh, grid, lists.ids_by_cell, triangles, check);
  return Status::kOk;
}

bool are_bounds_of(const GridRecord& grid, const TreeRecord& tree) {
  bool same = true;
  for (int axis = 0; axis < 3; ++axis) {
    same = same && grid.bounds_minimum[axis] == tree.bounds_minimum[axis] &&
           grid.bounds_maximum[axis] == tree.bounds_maximum[axis];
  }
  return same;
}

// Writes the image without the sections of effects, and adds what stands before them to the check value.
// @param layout  image_bytes and the number of nodes become those of the image that is written.
// Errors: kBadParameter if the mesh is not the one that was counted.
template <class Mesh>
Status write_image(const Mesh& mesh, const GridNeed& need, bool has_grid, std::span<std::byte> scratch,
                   ImageLayout& layout, std::byte* bytes, ImageCheckValue& check, const WorkSharing& sharing) {
  // The directory says how many nodes the tree has, so the tree comes first.
  if (layout.tree.section_count != 0) {
    GRIDIRON_TRY(write_tree_sections(mesh, scratch, layout.tree, bytes, sharing));
    layout.image_bytes = layout.tree.end_bytes;
  }
  write_directory(mesh, need, has_grid, layout, bytes);
  if (has_grid) return write_grid(mesh, need.grid, layout, bytes, check);
  if (!are_bounds_of(need.grid, layout.tree.record)) return Status::kBadParameter;
  check.add({bytes, static_cast<std::size_t>(layout.effects.begin_bytes)});
  return Status::kOk;
}

// Whether the grid is one that counting with these parameters gives, by what the builder relies on.
bool is_counted_with(const GridParameters& parameters, const GridRecord& grid) {
  if (grid.triangle_format != static_cast<std::uint32_t>(parameters.format) ||
      grid.triangle_bytes != triangle_bytes_of(parameters.format)) {
    return false;
  }
  if (!parameters.has_grid) return grid.reference_count == 0 && grid.cell_block_count == 0;
  return grid.lambda == parameters.lambda && grid.macro_width == parameters.macro_width;
}

}  // namespace

Status build_scene_image(const MeshView& mesh, const GridParameters& parameters, const GridNeed& need,
                         std::span<std::byte> image, std::span<std::byte> scratch, const EffectsView* effects,
                         const WorkSharing& sharing) {
  enter_step<GridStep::kBuildOnce>();
  GRIDIRON_TRY(check_parameters(parameters));
  const GridRecord& grid = need.grid;
  EffectsRecord record{};
  const bool has_tree = effects != nullptr || parameters.has_tree;
  GRIDIRON_TRY(check_parts(parameters, has_tree));
  if (effects != nullptr) {
    if (check_effects(mesh, *effects) != Status::kOk) return Status::kBadParameter;
    record = count_effects(*effects);
  }
  const std::uint64_t triangle_count = mesh.triangles.size();
  if (need.dropped_triangle_count >= triangle_count) return Status::kBadParameter;
  ImageLayout layout = layout_of(grid, {effects != nullptr ? &record : nullptr, triangle_count,
                                        triangle_count - need.dropped_triangle_count, parameters});
  const std::uint64_t scratch_bytes = has_tree ? tree_scratch_bytes(triangle_count) : 0;
  const bool need_ok = is_counted_with(parameters, grid) && need.image_bytes == layout.image_bytes &&
                       need.scratch_bytes == scratch_bytes && triangle_count <= kMaxCount &&
                       mesh.vertices.size() <= kMaxCount;
  if (!need_ok || reinterpret_cast<std::uintptr_t>(image.data()) % kLineBytes != 0) return Status::kBadParameter;
  if (image.size() < need.image_bytes || scratch.size() < need.scratch_bytes) return Status::kMemoryTooSmall;

  ImageCheckValue check;
  if (parameters.format != TriangleFormat::kLattice) {
    GRIDIRON_TRY(write_image(mesh, need, parameters.has_grid, scratch, layout, image.data(), check, sharing));
  } else {
    if (!(grid.lattice.step >= kLeastLatticeStep)) return Status::kBadParameter;
    const LatticeMesh moved{{mesh.vertices, grid.lattice}, mesh.triangles};
    GRIDIRON_TRY(write_image(moved, need, parameters.has_grid, scratch, layout, image.data(), check, sharing));
  }
  if (effects != nullptr) {
    write_effect_sections(mesh, *effects, grid, layout.effects, image.data());
    link_surfaces(layout.tree, layout.effects.record, image.data());
  }
  if (has_tree) {
    enter_step<TreeStep::kCheckedLine>();
    const std::uint64_t bytes = layout.tree.end_bytes - layout.effects.begin_bytes;
    add_shared(check, {image.data() + layout.effects.begin_bytes, static_cast<std::size_t>(bytes)}, sharing);
  }
  enter_step<GridStep::kBuildOnce>();
  store(image.data(), offsetof(ImageHeader, check_value), check.value());
  return Status::kOk;
}

}  // namespace gridiron
