// Grid builder: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/check_value.h>
#include <gridiron/base/triangle_formats.h>
#include <gridiron/grid/cell_rows.h>
#include <gridiron/grid/effect_sections.h>
#include <gridiron/grid/grid_builder.h>
#include <gridiron/grid/lattice.h>
#include <gridiron/grid/triangle_records.h>

#include <bit>

namespace gridiron {
namespace {

constexpr std::uint64_t kMaxCount = 0xFFFFFFFFu;
constexpr std::uint32_t kSectionCount = 4;  // of geometry
constexpr float kLeastLambda = 1e-6f;
constexpr float kGreatestLambda = 1e6f;

// --- Eq. (1) ----------------------------------------------------------------------------------------------------

// Both roots: Newton's iteration from a guess that is right to 6 % (the exponent divided, the mantissa bits carried
// along); four steps square that to below 2^-53, the fifth settles rounding. x > 0, normal, far from the ends of
// double.
double square_root(double x) {
  double root = std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + (std::uint64_t{1023} << 52)) / 2);
  for (int i = 0; i < 5; ++i) root = 0.5 * (root + x / root);
  return root;
}

double cube_root(double x) {
  double root = std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + (std::uint64_t{2046} << 52)) / 3);
  for (int i = 0; i < 5; ++i) root = (2.0 * root + x / (root * root)) / 3.0;
  return root;
}

// N_axis = L_axis * (lambda n / product of L)^(1 / dimensions). An axis that would get less than one cell gets one and
// leaves the equation, which is applied again to the others.
void solve_resolution(const double extent[3], double wanted_cells, std::uint32_t cell_count[3]) {
  bool open[3];
  for (int axis = 0; axis < 3; ++axis) {
    open[axis] = extent[axis] > 0.0;
    cell_count[axis] = 1;
  }
  for (int round = 0; round < 3; ++round) {
    int dimensions = 0;
    double volume = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!open[axis]) continue;
      ++dimensions;
      volume *= extent[axis];
    }
    if (dimensions == 0) return;
    const double density = wanted_cells / volume;
    const double per_unit = dimensions == 3 ? cube_root(density) : dimensions == 2 ? square_root(density) : density;
    bool closed_one = false;
    for (int axis = 0; axis < 3; ++axis) {
      if (!open[axis]) continue;
      const double cells = extent[axis] * per_unit;
      if (cells < 1.0) {
        open[axis] = false;
        closed_one = true;
        cell_count[axis] = 1;
      } else {
        cell_count[axis] = cells < double{kMaxCellsPerAxis} ? static_cast<std::uint32_t>(cells) : kMaxCellsPerAxis;
      }
    }
    if (!closed_one) return;
  }
}

// Cells per unit as a float, such that (maximum - minimum) * result <= cell_count as real numbers: the quotient has
// three roundings of 2^-53 at most, taken back by the factor, and the conversion to float goes down. More than
// `greatest` are not given: the cells of an axis become fewer, none of them unused.
float cells_per_unit_of(double extent, float greatest, std::uint32_t& cell_count) {
  if (!(extent > 0.0)) return 1.0f;
  const double quotient = static_cast<double>(cell_count) / extent * (1.0 - 0x1p-50);
  if (quotient >= double{greatest}) {
    const double cells = extent * double{greatest} + 1.0;
    if (cells < static_cast<double>(cell_count)) cell_count = static_cast<std::uint32_t>(cells);
    return greatest;
  }
  const float nearest = static_cast<float>(quotient);
  if (double{nearest} <= quotient) return nearest;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearest) - 1);
}

// --- Layout -----------------------------------------------------------------------------------------------------

// Where everything lies; all of it follows from the counts.
struct ImageLayout {
  std::uint64_t section_table_offset, grid_offset, macro_table_offset, cell_blocks_offset, triangles_offset;
  std::uint64_t macro_table_entries;
  std::uint32_t section_count;
  EffectSections effects;  // from the end of the triangles to the end of the image
  std::uint64_t image_bytes;
};

std::uint64_t macro_cell_total(const GridRecord& grid) {
  return std::uint64_t{grid.macro_cell_count[0]} * grid.macro_cell_count[1] * grid.macro_cell_count[2];
}

// @param effects  as counted; null: none.
ImageLayout layout_of(const GridRecord& grid, const EffectsRecord* effects, std::uint64_t triangle_count) {
  constexpr std::uint64_t kLine = kLineBytes;
  ImageLayout layout{};
  layout.macro_table_entries = (macro_cell_total(grid) + 31) / 32;
  layout.section_table_offset = round_up<std::uint64_t>(sizeof(ImageHeader), kLine);
  layout.section_count = kSectionCount + (effects != nullptr ? effect_section_count(*effects) : 0);
  layout.grid_offset = round_up(layout.section_table_offset + layout.section_count * sizeof(SectionEntry), kLine);
  layout.macro_table_offset = round_up(layout.grid_offset + sizeof(GridRecord), kLine);
  layout.cell_blocks_offset =
      round_up(layout.macro_table_offset + layout.macro_table_entries * sizeof(MacroTableEntry), kLine);
  layout.triangles_offset =
      round_up(layout.cell_blocks_offset + std::uint64_t{grid.cell_block_count} * grid.cell_block_bytes, kLine);
  const std::uint64_t triangles_end =
      round_up(layout.triangles_offset + std::uint64_t{grid.reference_count} * grid.triangle_bytes, kLine);
  layout.effects.begin_bytes = triangles_end;
  layout.effects.end_bytes = triangles_end;
  if (effects != nullptr) {
    layout.effects = place_effect_sections(*effects, static_cast<std::uint32_t>(triangle_count), triangles_end);
  }
  layout.image_bytes = layout.effects.end_bytes;
  return layout;
}

// --- Macrocells -------------------------------------------------------------------------------------------------

// Division of a cell coordinate by the macro width, as a multiplication: with r = ceil(2^16 / m), x r / 2^16 exceeds
// x / m by less than x / 2^16 <= 2047 / 65536 < 1 / m, too little to reach the next integer.
struct MacroMap {
  std::uint32_t reciprocal;
  std::uint32_t width;
  std::uint64_t count_x;
  std::uint64_t count_y;

  explicit MacroMap(const GridRecord& grid)
      : reciprocal((65536u + grid.macro_width - 1) / grid.macro_width),
        width(grid.macro_width),
        count_x(grid.macro_cell_count[0]),
        count_y(grid.macro_cell_count[1]) {}

  [[nodiscard]] std::uint32_t macro_of(std::int32_t cell) const {
    return (static_cast<std::uint32_t>(cell) * reciprocal) >> 16;
  }
  [[nodiscard]] std::uint64_t row_index(std::int32_t y, std::int32_t z) const {
    return (macro_of(z) * count_y + macro_of(y)) * count_x;
  }
};

// Linear macrocell index in the high bits, cell within the macrocell (less than 8^3) in the low nine.
constexpr std::uint32_t kCellBits = 9;
static_assert(kMaxMacroWidth * kMaxMacroWidth * kMaxMacroWidth <= (1u << kCellBits));

std::uint32_t bit_count(std::uint32_t bits) {
  bits -= (bits >> 1) & 0x55555555u;
  bits = (bits & 0x33333333u) + ((bits >> 2) & 0x33333333u);
  bits = (bits + (bits >> 4)) & 0x0F0F0F0Fu;
  return (bits * 0x01010101u) >> 24;
}

// --- Counting ---------------------------------------------------------------------------------------------------

Status check_parameters(const GridParameters& parameters) {
  const bool lambda_ok = parameters.lambda >= kLeastLambda && parameters.lambda <= kGreatestLambda;
  const bool width_ok = parameters.macro_width >= 1 && parameters.macro_width <= kMaxMacroWidth;
  const bool format_ok = parameters.format == TriangleFormat::kVertices ||
                         parameters.format == TriangleFormat::kProjection ||
                         parameters.format == TriangleFormat::kLattice;
  return lambda_ok && width_ok && format_ok ? Status::kOk : Status::kBadParameter;
}

bool all_in_range(std::span<const Vec3> vertices) {
  constexpr std::uint32_t kLimit = std::bit_cast<std::uint32_t>(kCoordinateLimit);  // bits grow with the magnitude
  std::uint32_t outside = 0;
  for (const Vec3& v : vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      outside |= (std::bit_cast<std::uint32_t>(v[axis]) & 0x7FFFFFFFu) > kLimit ? 1u : 0u;
    }
  }
  return outside == 0;
}

// A mesh below is a MeshView, or a LatticeMesh of one: the triangles as they will be stored.

// Indices, zero areas, and the tight bounds of the triangles that are kept.
struct KeptTriangles {
  std::uint64_t count = 0;
  Vec3 minimum{kFloatMax, kFloatMax, kFloatMax};
  Vec3 maximum{-kFloatMax, -kFloatMax, -kFloatMax};
};

template <class Mesh>
Status survey(const Mesh& mesh, KeptTriangles& kept) {
  const std::uint64_t vertex_count = mesh.vertices.size();
  for (const UVec3& t : mesh.triangles) {
    if (t.x >= vertex_count || t.y >= vertex_count || t.z >= vertex_count) return Status::kBadIndex;
    const Vec3& a = mesh.vertices[t.x];
    const Vec3& b = mesh.vertices[t.y];
    const Vec3& c = mesh.vertices[t.z];
    if (has_zero_area(a, b, c)) continue;
    ++kept.count;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = a[axis] < b[axis] ? a[axis] : b[axis];
      const float high = a[axis] < b[axis] ? b[axis] : a[axis];
      const float least = low < c[axis] ? low : c[axis];
      const float greatest = high > c[axis] ? high : c[axis];
      kept.minimum[axis] = least < kept.minimum[axis] ? least : kept.minimum[axis];
      kept.maximum[axis] = greatest > kept.maximum[axis] ? greatest : kept.maximum[axis];
    }
  }
  return Status::kOk;
}

// A set of macrocells within a window of their linear order that fits the stack.
class MacroWindow {
 public:
  static constexpr std::uint64_t kMacroCells = 16384;

  void move_to(std::uint64_t begin) {
    begin_ = begin;
    for (std::uint64_t& word : words_) word = 0;
  }
  [[nodiscard]] std::uint64_t begin() const { return begin_; }
  [[nodiscard]] std::uint64_t end() const { return begin_ + kMacroCells; }

  void insert(std::uint64_t macro_cell) {
    const std::uint64_t place = macro_cell - begin_;  // wraps below the window
    if (place < kMacroCells) words_[place / 64] |= std::uint64_t{1} << (place % 64);
  }
  [[nodiscard]] std::uint64_t size() const {
    std::uint64_t total = 0;
    for (const std::uint64_t word : words_) {
      total += bit_count(static_cast<std::uint32_t>(word)) + bit_count(static_cast<std::uint32_t>(word >> 32));
    }
    return total;
  }

 private:
  std::uint64_t begin_ = 0;
  std::uint64_t words_[kMacroCells / 64] = {};
};

// One sweep over the triangles: marks the macrocells inside the window, and finds where the next one has to begin.
struct Sweep {
  std::uint64_t reference_count = 0;
  std::uint64_t row_count = 0;
  std::uint64_t next_begin = ~std::uint64_t{0};  // no macrocell between the window's end and this one is touched
};

template <class Mesh>
Status sweep_window(const Mesh& mesh, const GridRecord& grid, MacroWindow& window, Sweep& sweep) {
  const CellSpace space = CellSpace::of(grid);
  const MacroMap macros(grid);
  const bool first_sweep = window.begin() == 0;
  for (const UVec3& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t.x];
    const Vec3& b = mesh.vertices[t.y];
    const Vec3& c = mesh.vertices[t.z];
    if (has_zero_area(a, b, c)) continue;
    const CellBox box = CellBox::of(space, a, b, c);
    if (!first_sweep) {
      const std::uint64_t least = macros.row_index(box.first[1], box.first[2]) + macros.macro_of(box.first[0]);
      const std::uint64_t greatest = macros.row_index(box.last[1], box.last[2]) + macros.macro_of(box.last[0]);
      if (greatest < window.begin()) continue;
      if (least >= window.end()) {
        sweep.next_begin = least < sweep.next_begin ? least : sweep.next_begin;
        continue;
      }
    }
    for_each_cell_row(box, [&](std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z) {
      sweep.reference_count += static_cast<std::uint64_t>(x1 - x0 + 1);
      ++sweep.row_count;
      const std::uint64_t row = macros.row_index(y, z);
      const std::uint64_t last = row + macros.macro_of(x1);
      for (std::uint64_t macro_cell = row + macros.macro_of(x0); macro_cell <= last; ++macro_cell) {
        window.insert(macro_cell);
        if (macro_cell >= window.end() && macro_cell < sweep.next_begin) sweep.next_begin = macro_cell;
      }
    });
    if (sweep.reference_count > kMaxCount) return Status::kTooManyTriangles;
  }
  return Status::kOk;
}

// --- Building ---------------------------------------------------------------------------------------------------

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
void write_directory(const Mesh& mesh, const GridNeed& need, const ImageLayout& layout, std::byte* image) {
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
  const SectionEntry sections[kSectionCount] = {
      section(SectionKind::kGrid, sizeof(GridRecord), 1, layout.grid_offset, layout.macro_table_offset),
      section(SectionKind::kMacroTable, sizeof(MacroTableEntry), layout.macro_table_entries, layout.macro_table_offset,
              layout.cell_blocks_offset),
      section(SectionKind::kCellBlocks, grid.cell_block_bytes, grid.cell_block_count, layout.cell_blocks_offset,
              layout.triangles_offset),
      section(SectionKind::kTriangles, grid.triangle_bytes, grid.reference_count, layout.triangles_offset,
              layout.effects.begin_bytes)};
  store(image, layout.section_table_offset, sections);
  for (std::uint32_t i = 0; i < layout.effects.section_count; ++i) {
    store(image, layout.section_table_offset + (kSectionCount + i) * sizeof(SectionEntry), layout.effects.entries[i]);
  }
  store(image, layout.grid_offset, grid);
}

// The lists of references before they become triangle records. They lie in the triangle section itself, which has room
// for w words per reference, 12 or 6: keys in words [0, 2 n), ids in [2 n, 3 n), ids by cell in [(w - 1) n, w n).
// Writing record i over words [w i, w i + w) never reaches the ids by cell that are still to be read, word
// (w - 1) n + i + 1 and later.
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
// Errors: kBadParameter where there are more or fewer than counted.
template <class Mesh>
Status list_references(const Mesh& mesh, const GridRecord& grid, const ReferenceLists& lists,
                       MacroTableEntry* macro_table) {
  const CellSpace space = CellSpace::of(grid);
  const MacroMap macros(grid);
  const std::uint64_t limit = grid.reference_count;
  std::uint64_t count = 0;
  std::uint32_t triangle_id = 0;
  for (const UVec3& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t.x];
    const Vec3& b = mesh.vertices[t.y];
    const Vec3& c = mesh.vertices[t.z];
    const std::uint32_t id = triangle_id++;
    if (has_zero_area(a, b, c)) continue;
    for_each_cell_row(CellBox::of(space, a, b, c),
                      [&](std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z) {
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

// Gives every non-empty macrocell its block. @returns how many blocks there are, the empty one included.
std::uint64_t number_blocks(MacroTableEntry* macro_table, std::uint64_t entry_count) {
  std::uint64_t block = 1;
  for (std::uint64_t i = 0; i < entry_count; ++i) {
    macro_table[i].first_block = static_cast<std::uint32_t>(block);
    block += bit_count(macro_table[i].occupied);
  }
  return block;
}

// Turns the keys into indices of cells: that many, of cell_bytes each, from the start of block 0.
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
      first_cell = (std::uint64_t{entry.first_block} + bit_count(below)) * cells_per_block;
      last_macro_cell = macro_cell;
    }
    lists.keys[i] = first_cell + (lists.keys[i] & ((1u << kCellBits) - 1));
  }
}

// Counting sort of the references by the order of cells in the blocks; stable, so ids ascend within a cell.
void sort_references(const GridRecord& grid, const ReferenceLists& lists, const MacroTableEntry* macro_table,
                     CellRecord* cells) {
  const std::uint64_t count = grid.reference_count;
  const std::uint64_t records_per_block = grid.cell_block_bytes / sizeof(CellRecord);
  const std::uint64_t cells_per_block = std::uint64_t{grid.macro_width} * grid.macro_width * grid.macro_width;
  find_cells(grid, lists, macro_table, sizeof(CellRecord));
  for (std::uint64_t i = 0; i < count; ++i) ++cells[lists.keys[i]].triangle_count;

  // Counts become first triangles.
  std::uint32_t running = 0;
  for (std::uint64_t block = 1; block < grid.cell_block_count; ++block) {
    for (std::uint64_t cell = 0; cell < cells_per_block; ++cell) {
      CellRecord& record = cells[block * records_per_block + cell];
      record.first_triangle = running;
      running += record.triangle_count;
      record.triangle_count = 0;
    }
  }

  // Each reference goes to the next free place of its cell, whose count grows back.
  for (std::uint64_t i = 0; i < count; ++i) {
    CellRecord& record = cells[lists.keys[i]];
    lists.ids_by_cell[record.first_triangle + record.triangle_count++] = lists.ids[i];
  }
}

// The same where cells are known by their bounds. A cell's references are counted in the bound behind it, which then
// says where the cell's next reference goes, and in the end where the cell ends.
void sort_references(const GridRecord& grid, const ReferenceLists& lists, const MacroTableEntry* macro_table,
                     CellBound* bounds) {
  const std::uint64_t count = grid.reference_count;
  const std::uint64_t bounds_per_block = grid.cell_block_bytes / sizeof(CellBound);
  const std::uint64_t cells_per_block = std::uint64_t{grid.macro_width} * grid.macro_width * grid.macro_width;
  find_cells(grid, lists, macro_table, sizeof(CellBound));
  CellBound* const ends = bounds + 1;
  for (std::uint64_t i = 0; i < count; ++i) ++ends[lists.keys[i]].first_triangle;
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

// Writes the triangle records front to back and adds them to the check value while they are near.
template <class Mesh>
void write_triangles(const Mesh& mesh, const GridRecord& grid, const std::uint32_t* ids_by_cell, std::byte* triangles,
                     CheckValue& check) {
  constexpr std::uint64_t kPieceRecords = 256;  // a multiple of kGroupBytes in bytes
  static_assert(kPieceRecords * sizeof(LatticeTriangle) % CheckValue::kGroupBytes == 0);
  const bool projection = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kProjection);
  const bool lattice = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  const std::uint64_t triangle_bytes = grid.triangle_bytes;
  std::uint64_t checked_bytes = 0;
  for (std::uint64_t i = 0; i < grid.reference_count; ++i) {
    const std::uint32_t id = ids_by_cell[i];
    const UVec3& t = mesh.triangles[id];
    const Vec3& a = mesh.vertices[t.x];
    const Vec3& b = mesh.vertices[t.y];
    const Vec3& c = mesh.vertices[t.z];
    if (projection) {
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
      const std::uint64_t end = (i + 1) * triangle_bytes;
      check.add({triangles + checked_bytes, static_cast<std::size_t>(end - checked_bytes)});
      checked_bytes = end;
    }
  }
  const std::uint64_t end = grid.reference_count * triangle_bytes;
  const std::uint64_t padded_end = round_up<std::uint64_t>(end, kLineBytes);
  clear(triangles, end, padded_end);
  check.add({triangles + checked_bytes, static_cast<std::size_t>(padded_end - checked_bytes)});
}

// Counts what a mesh will need. @param resolved_count  n of Eq. (1). @param grid  so far: the lattice.
template <class Mesh>
Status count_image(const Mesh& mesh, const GridParameters& parameters, const KeptTriangles& kept,
                   std::uint64_t resolved_count, GridRecord grid, GridNeed& need) {
  if (kept.count == 0) return Status::kNoTriangles;

  // The grid: Eq. (1) over the bounds of what is kept.
  double extent[3];
  for (int axis = 0; axis < 3; ++axis) {
    grid.bounds_minimum[axis] = kept.minimum[axis] + 0.0f;  // no negative zero
    grid.bounds_maximum[axis] = kept.maximum[axis] + 0.0f;
    grid.minimum[axis] = grid.bounds_minimum[axis];
    extent[axis] = double{kept.maximum[axis]} - double{kept.minimum[axis]};
  }
  solve_resolution(extent, double{parameters.lambda} * static_cast<double>(resolved_count), grid.cell_count);
  const std::uint32_t width = parameters.macro_width;
  // An axis of one cell is scaled like the others: a mesh that is almost flat leaves most of that cell empty.
  float greatest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.cell_count[axis] == 1) continue;
    grid.cells_per_unit[axis] = cells_per_unit_of(extent[axis], kGreatestCellsPerUnit, grid.cell_count[axis]);
    greatest = grid.cells_per_unit[axis] > greatest ? grid.cells_per_unit[axis] : greatest;
  }
  if (greatest == 0.0f) greatest = kGreatestCellsPerUnit;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.cells_per_unit[axis] == 0.0f) {
      grid.cells_per_unit[axis] = cells_per_unit_of(extent[axis], greatest, grid.cell_count[axis]);
    }
    grid.macro_cell_count[axis] = (grid.cell_count[axis] + width - 1) / width;
  }
  grid.macro_width = width;
  grid.cell_block_bytes = cell_block_bytes_of(parameters.format, width);
  grid.triangle_format = static_cast<std::uint32_t>(parameters.format);
  grid.triangle_bytes = triangle_bytes_of(parameters.format);
  grid.lambda = parameters.lambda;

  // References and non-empty macrocells; the first sweep meets every triangle, the others those beyond its window.
  MacroWindow window;
  std::uint64_t reference_count = 0;
  std::uint64_t block_count = 1;
  GridSteps steps{};
  for (std::uint64_t begin = 0; begin != ~std::uint64_t{0};) {
    Sweep sweep;
    window.move_to(begin);
    GRIDIRON_TRY(sweep_window(mesh, grid, window, sweep));
    if (begin == 0) {
      reference_count = sweep.reference_count;
      steps.row_count = sweep.row_count;
    }
    ++steps.sweep_count;
    steps.swept_row_count += sweep.row_count;
    block_count += window.size();
    begin = sweep.next_begin;
  }
  if (block_count > kMaxCount) return Status::kTooManyTriangles;
  grid.reference_count = static_cast<std::uint32_t>(reference_count);
  grid.cell_block_count = static_cast<std::uint32_t>(block_count);

  need.grid = grid;
  need.dropped_triangle_count = static_cast<std::uint32_t>(mesh.triangles.size() - kept.count);
  need.image_bytes = layout_of(grid, nullptr, mesh.triangles.size()).image_bytes;
  need.scratch_bytes = 0;
  need.steps = steps;
  return Status::kOk;
}

// Writes all of the image but the sections of effects, and adds it to the check value.
// Errors: kBadParameter where the mesh is not the one that was counted.
template <class Mesh>
Status write_image(const Mesh& mesh, const GridNeed& need, const ImageLayout& layout, std::byte* bytes,
                   CheckValue& check) {
  const GridRecord& grid = need.grid;
  std::byte* const triangles = bytes + layout.triangles_offset;
  write_directory(mesh, need, layout, bytes);
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

  check.add({bytes, static_cast<std::size_t>(layout.triangles_offset)});
  write_triangles(mesh, grid, lists.ids_by_cell, triangles, check);
  return Status::kOk;
}

Status count_geometry(const MeshView& mesh, const GridParameters& parameters, GridNeed& need) {
  GridRecord grid{};
  KeptTriangles kept;
  GRIDIRON_TRY(survey(mesh, kept));
  if (parameters.format != TriangleFormat::kLattice) {
    return count_image(mesh, parameters, kept, kept.count, grid, need);
  }
  // As many cells as without a lattice: fewer triangles are left on it, not larger ones.
  GRIDIRON_TRY(find_lattice(mesh, grid.lattice));
  const LatticeMesh moved{{mesh.vertices, grid.lattice}, mesh.triangles};
  KeptTriangles moved_kept;
  GRIDIRON_TRY(survey(moved, moved_kept));
  return count_image(moved, parameters, moved_kept, kept.count, grid, need);
}

// Surfaces are told by their vertices, which a projection has not.
bool may_have_effects(const GridParameters& parameters) { return parameters.format != TriangleFormat::kProjection; }

}  // namespace

Status count_scene_image(const MeshView& mesh, const GridParameters& parameters, GridNeed& need,
                         const EffectsView* effects) {
  GRIDIRON_TRY(check_parameters(parameters));
  if (effects != nullptr && !may_have_effects(parameters)) return Status::kBadParameter;
  if (mesh.triangles.size() > kMaxCount || mesh.vertices.size() > kMaxCount) return Status::kTooManyTriangles;
  if (!all_in_range(mesh.vertices)) return Status::kBadVertex;
  if (effects == nullptr) return count_geometry(mesh, parameters, need);

  GRIDIRON_TRY(check_effects(mesh, *effects));
  GridNeed counted{};
  GRIDIRON_TRY(count_geometry(mesh, parameters, counted));
  GRIDIRON_TRY(check_reach(*effects, counted.grid));
  const EffectsRecord record = count_effects(*effects);
  counted.image_bytes = layout_of(counted.grid, &record, mesh.triangles.size()).image_bytes;
  need = counted;
  return Status::kOk;
}

Status build_scene_image(const MeshView& mesh, const GridParameters& parameters, const GridNeed& need,
                         std::span<std::byte> image, std::span<std::byte> scratch, const EffectsView* effects) {
  GRIDIRON_TRY(check_parameters(parameters));
  const GridRecord& grid = need.grid;
  EffectsRecord record{};
  if (effects != nullptr) {
    if (!may_have_effects(parameters) || check_effects(mesh, *effects) != Status::kOk) return Status::kBadParameter;
    record = count_effects(*effects);
  }
  const ImageLayout layout = layout_of(grid, effects != nullptr ? &record : nullptr, mesh.triangles.size());
  const bool need_ok = grid.lambda == parameters.lambda && grid.macro_width == parameters.macro_width &&
                       grid.triangle_format == static_cast<std::uint32_t>(parameters.format) &&
                       grid.triangle_bytes == triangle_bytes_of(parameters.format) &&
                       need.image_bytes == layout.image_bytes && need.dropped_triangle_count < mesh.triangles.size() &&
                       mesh.triangles.size() <= kMaxCount && mesh.vertices.size() <= kMaxCount;
  if (!need_ok || reinterpret_cast<std::uintptr_t>(image.data()) % kLineBytes != 0) return Status::kBadParameter;
  if (image.size() < need.image_bytes || scratch.size() < need.scratch_bytes) return Status::kMemoryTooSmall;

  CheckValue check;
  if (parameters.format != TriangleFormat::kLattice) {
    GRIDIRON_TRY(write_image(mesh, need, layout, image.data(), check));
  } else {
    if (!(grid.lattice.step >= kLeastLatticeStep)) return Status::kBadParameter;
    const LatticeMesh moved{{mesh.vertices, grid.lattice}, mesh.triangles};
    GRIDIRON_TRY(write_image(moved, need, layout, image.data(), check));
  }
  if (effects != nullptr) {
    write_effect_sections(mesh, *effects, grid, layout.effects, image.data());
    const std::uint64_t bytes = layout.effects.end_bytes - layout.effects.begin_bytes;
    check.add({image.data() + layout.effects.begin_bytes, static_cast<std::size_t>(bytes)});
  }
  store(image.data(), offsetof(ImageHeader, check_value), check.value());
  return Status::kOk;
}

}  // namespace gridiron
