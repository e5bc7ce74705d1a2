// Checks of triangles against the cells that hold them: see image_checker.h. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/build/grid/cell_rows.h>
#include <gridiron/build/grid/image_layout.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/image/image_checker.h>

namespace gridiron {
namespace {

constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

// Finds and compares the records of an image whose macro table, blocks and ids are right.
class Records {
 public:
  Records(const ImageChecker& checker, const SceneImageView& view)
      : checker_(checker),
        view_(view),
        triangles_(checker.image().data() + view.triangles_offset_bytes),
        triangle_bytes_(view.grid.triangle_bytes),
        macros_(view.grid),
        is_lattice_(view.grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice)) {}

  [[nodiscard]] std::uint64_t place_of(std::uint64_t reference) const {
    return view_.triangles_offset_bytes + reference * triangle_bytes_;
  }
  [[nodiscard]] std::uint32_t id_of(std::uint64_t reference) const {
    return read<std::uint32_t>(record_of(reference + 1) - sizeof(std::uint32_t));
  }
  [[nodiscard]] bool are_equal(std::uint64_t a, std::uint64_t b) const {
    static_assert(sizeof(LatticeTriangle) == sizeof(Piece) && sizeof(VertexTriangle) == 2 * sizeof(Piece));
    const std::byte* const record = record_of(a);
    const std::byte* const other = record_of(b);
    std::uint64_t differ = 0;
    for (std::size_t begin = 0; begin < triangle_bytes_; begin += sizeof(Piece)) {
      const auto piece = read<Piece>(record + begin), other_piece = read<Piece>(other + begin);
      for (int i = 0; i < 3; ++i) differ |= piece.at[i] ^ other_piece.at[i];
    }
    return differ == 0;
  }

  // The corner of a record that stores corners.
  [[nodiscard]] Vec3 corner(std::uint64_t reference, int number) const {
    const std::byte* const record = record_of(reference);
    if (!is_lattice_) {
      const auto v = read<Corner>(record + static_cast<std::size_t>(number) * sizeof(Corner));
      return {v.at[0], v.at[1], v.at[2]};
    }
    const auto v = read<Places>(record + static_cast<std::size_t>(number) * sizeof(Places));
    const Lattice& lattice = view_.grid.lattice;
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = static_cast<float>(v.at[axis]) * lattice.step + lattice.origin[axis];
    }
    return point;
  }

  // References of a cell; first = end in an empty one.
  struct Range {
    std::uint64_t first, end;
  };
  // @param block  of an occupied macrocell, from the image's first byte. @param number  of the cell in it.
  [[nodiscard]] Range cell_of_block(std::uint64_t block, std::uint64_t number) const {
    if (is_lattice_) {
      const std::uint64_t place = block + number * sizeof(CellBound);
      return {checker_.read<CellBound>(place).first_triangle,
              checker_.read<CellBound>(place + sizeof(CellBound)).first_triangle};
    }
    const auto record = checker_.read<CellRecord>(block + number * sizeof(CellRecord));
    return {record.first_triangle, std::uint64_t{record.first_triangle} + record.triangle_count};
  }
  [[nodiscard]] Range cell(std::int32_t x, std::int32_t y, std::int32_t z) {
    const std::uint64_t macro_cell = macros_.row_index(y, z) + macros_.macro_of(x);
    if (macro_cell != last_macro_cell_) {  // neighbours are mostly looked up after each other
      last_macro_cell_ = macro_cell;
      last_block_ = block_of(macro_cell);
    }
    if (last_block_ == kNowhere) return {0, 0};
    const auto local = [&](std::int32_t at) {
      return static_cast<std::uint32_t>(at) - macros_.macro_of(at) * macros_.width;
    };
    const std::uint32_t number = (local(z) * macros_.width + local(y)) * macros_.width + local(x);
    return cell_of_block(last_block_, number);
  }

  // The triangle's record in [range.first, range.end), or kNowhere. Ids ascend; range.first becomes the first record
  // whose id is not less. Steps from the front double, so that near records are found in few steps.
  [[nodiscard]] std::uint64_t find(Range& range, std::uint32_t id) const {
    for (int i = 0; i < 8 && range.first < range.end; ++i) {
      const std::uint32_t at = id_of(range.first);
      if (at >= id) return at == id ? range.first : kNowhere;
      ++range.first;
    }
    std::uint64_t end = range.end;
    for (std::uint64_t step = 1; range.first < end; step *= 2) {
      const std::uint64_t probe = range.first + step - 1 < end ? range.first + step - 1 : end - 1;
      if (id_of(probe) < id) {
        range.first = probe + 1;
      } else {
        end = probe;
        break;
      }
    }
    while (range.first < end) {
      const std::uint64_t middle = range.first + (end - range.first) / 2;
      if (id_of(middle) < id) {
        range.first = middle + 1;
      } else {
        end = middle;
      }
    }
    return range.first < range.end && id_of(range.first) == id ? range.first : kNowhere;
  }

 private:
  // The macrocell's block, from the image's first byte, or kNowhere.
  [[nodiscard]] std::uint64_t block_of(std::uint64_t macro_cell) const {
    const auto entry =
        checker_.read<MacroTableEntry>(view_.macro_table_offset_bytes + macro_cell / 32 * sizeof(MacroTableEntry));
    const std::uint32_t bit = 1u << (macro_cell % 32);
    if ((entry.occupied & bit) == 0) return kNowhere;
    const std::uint64_t block = std::uint64_t{entry.first_block} + count_bits(entry.occupied & (bit - 1));
    return view_.cell_blocks_offset_bytes + block * view_.grid.cell_block_bytes;
  }

  [[nodiscard]] const std::byte* record_of(std::uint64_t reference) const {
    return triangles_ + reference * triangle_bytes_;
  }
  template <class Value>
  [[nodiscard]] static Value read(const std::byte* place) {
    Value value;
    __builtin_memcpy(&value, place, sizeof(Value));
    return value;
  }

  struct Piece {  // of a record, which has one of them or two
    std::uint64_t at[3];
  };
  struct Corner {
    float at[3];
  };
  struct Places {
    std::uint16_t at[3];
  };
  const ImageChecker& checker_;
  const SceneImageView& view_;
  const std::byte* triangles_;
  std::uint64_t triangle_bytes_;
  MacroMap macros_;
  bool is_lattice_;
  std::uint64_t last_macro_cell_ = kNowhere;
  std::uint64_t last_block_ = kNowhere;
};

// Looks up the triangles of one cell in the others, by ascending ids. In the surrounding cells every search begins
// where the last one ended.
class Search {
 public:
  explicit Search(Records& records) : records_(records) {}

  void move_to(const std::int32_t cell[3]) {
    if (cell[0] == cell_[0] && cell[1] == cell_[1] && cell[2] == cell_[2]) return;
    for (int axis = 0; axis < 3; ++axis) cell_[axis] = cell[axis];
    for (bool& is_known : is_known_) is_known = false;
  }

  // The triangle's record in a cell inside the grid, or kNowhere.
  [[nodiscard]] std::uint64_t find(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t id) {
    const auto dx = static_cast<std::uint32_t>(x - cell_[0] + 1);
    const auto dy = static_cast<std::uint32_t>(y - cell_[1] + 1);
    const auto dz = static_cast<std::uint32_t>(z - cell_[2] + 1);
    if (dx > 2 || dy > 2 || dz > 2) {
      Records::Range range = records_.cell(x, y, z);
      return records_.find(range, id);
    }
    const std::uint32_t place = (dz * 3 + dy) * 3 + dx;
    if (!is_known_[place]) {
      is_known_[place] = true;
      ranges_[place] = records_.cell(x, y, z);
    }
    return records_.find(ranges_[place], id);
  }

 private:
  Records& records_;
  std::int32_t cell_[3] = {-1, -1, -1};
  bool is_known_[27] = {};
  Records::Range ranges_[27] = {};
};

// Sums over the records of all triangles; each triangle is counted once, in the cell of its first corner.
struct Totals {
  std::uint64_t triangle_count = 0;
  std::uint64_t reference_count = 0;
  std::uint64_t id_sum = 0;
  Vec3 minimum{kFloatMax, kFloatMax, kFloatMax};
  Vec3 maximum{-kFloatMax, -kFloatMax, -kFloatMax};
};

bool lies_inside(const GridRecord& grid, const Vec3& corner) {
  bool inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    inside &= corner[axis] >= grid.bounds_minimum[axis] && corner[axis] <= grid.bounds_maximum[axis];
  }
  return inside;
}

// Checks one reference in its cell. In the cell of the triangle's first corner it looks up the triangle's other
// records, in every cell that the builder would put them into: each must be there, with the same bytes. The sum of the
// records that were found reveals a record that no triangle has looked up.
bool check_reference(ImageChecker& checker, const Records& records, Search& search, const SceneImageView& view,
                     const CellSpace& space, const std::int32_t cell[3], std::uint64_t reference, Totals& totals) {
  const std::uint64_t place = records.place_of(reference);
  const Vec3 a = records.corner(reference, 0);
  if (!checker.require(lies_inside(view.grid, a), place, "triangle.v")) return false;
  std::int32_t elsewhere = 0;  // one branch, hard to predict, not three
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::int32_t>((double{a[axis]} - space.minimum[axis]) * space.cells_per_unit[axis]);
    elsewhere |= (at < space.last_cell[axis] ? at : space.last_cell[axis]) ^ cell[axis];
  }
  if (elsewhere != 0) return true;
  const Vec3 b = records.corner(reference, 1);
  const Vec3 c = records.corner(reference, 2);
  const bool is_kept = lies_inside(view.grid, b) && lies_inside(view.grid, c) && !has_zero_area(a, b, c);
  if (!checker.require(is_kept, place, "triangle.v")) return false;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float at : {a[axis], b[axis], c[axis]}) {
      totals.minimum[axis] = at < totals.minimum[axis] ? at : totals.minimum[axis];
      totals.maximum[axis] = at > totals.maximum[axis] ? at : totals.maximum[axis];
    }
  }
  const std::uint32_t id = records.id_of(reference);
  ++totals.triangle_count;
  totals.id_sum += id;
  const CellBox box = CellBox::of(space, a, b, c);
  if (box.has_one_cell()) {
    ++totals.reference_count;
    return true;
  }
  search.move_to(cell);
  std::uint64_t wrong = kNowhere;  // the record to blame
  bool good = true;
  for_each_cell_row(box, [&](std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z) {
    for (std::int32_t x = x0; good && x <= x1; ++x) {
      ++totals.reference_count;
      if (x == cell[0] && y == cell[1] && z == cell[2]) continue;
      const std::uint64_t copy = search.find(x, y, z, id);
      good = copy != kNowhere && records.are_equal(copy, reference);
      if (!good) wrong = copy != kNowhere ? copy : reference;
    }
  });
  return checker.require(good, good ? 0 : records.place_of(wrong), "triangle.v");
}

// A projection does not store where its triangle ends. If a neighbour of its cell holds the triangle too, both records
// must have the same bytes; a triangle's cells are connected by their faces, so all its records are compared.
bool check_projection(ImageChecker& checker, const Records& records, Search& search, const std::int32_t cell[3],
                      std::uint64_t reference) {
  search.move_to(cell);
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] == 0) continue;
    const auto before = [&](int other) { return cell[other] - (other == axis ? 1 : 0); };
    const std::uint64_t copy = search.find(before(0), before(1), before(2), records.id_of(reference));
    const bool good = copy == kNowhere || records.are_equal(copy, reference);
    if (!checker.require(good, records.place_of(reference), "triangle.n_u")) return false;
  }
  return true;
}

// Triangle records [first, end) of one cell: finite, known ids, ascending.
bool check_triangles(ImageChecker& checker, const SceneImageView& view, std::uint64_t first, std::uint64_t end) {
  const bool projection = view.grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kProjection);
  const bool lattice = view.grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  std::uint64_t least_id = 0;
  for (std::uint64_t i = first; i < end; ++i) {
    const std::uint64_t base = view.triangles_offset_bytes + i * view.grid.triangle_bytes;
    std::uint32_t id = 0;
    if (projection) {
      const auto triangle = checker.read<ProjectionTriangle>(base);
      const float values[9] = {triangle.n_u, triangle.n_v, triangle.n_d, triangle.b_u, triangle.b_v,
                               triangle.b_d, triangle.c_u, triangle.c_v, triangle.c_d};
      GRIDIRON_REQUIRE(finite_fields(values, 9), base, triangle, n_u);
      constexpr float kGreatestSlope = 0x1.000002p0f;  // 1, or the next float where a builder rounds upwards
      const bool are_slopes =
          __builtin_fabsf(triangle.n_u) <= kGreatestSlope && __builtin_fabsf(triangle.n_v) <= kGreatestSlope;
      GRIDIRON_REQUIRE(are_slopes, base, triangle, n_u);
      GRIDIRON_REQUIRE(triangle.axis_k < 3, base, triangle, axis_k);
      GRIDIRON_REQUIRE(triangle.reserved == 0, base, triangle, reserved);
      id = triangle.triangle_id;
    } else if (lattice) {
      const auto triangle = checker.read<LatticeTriangle>(base);
      GRIDIRON_REQUIRE(triangle.reserved == 0, base, triangle, reserved);
      id = triangle.triangle_id;
    } else {
      const auto triangle = checker.read<VertexTriangle>(base);
      bool finite = true;
      for (const auto& corner : triangle.v) finite = finite && finite_fields(corner, 3);
      GRIDIRON_REQUIRE(finite, base, triangle, v);
      GRIDIRON_REQUIRE(all_zero(triangle.reserved, 2), base, triangle, reserved);
      id = triangle.triangle_id;
    }
    const std::uint64_t id_place = base + view.grid.triangle_bytes - sizeof(id);
    if (!checker.require(id >= least_id && id < view.header.triangle_count, id_place, "triangle.triangle_id")) {
      return false;
    }
    least_id = std::uint64_t{id} + 1;
  }
  return true;
}

// Checks the records of each cell, then calls body(cell, reference) for every reference, until it returns false.
template <class Body>
bool for_each_reference(ImageChecker& checker, const SceneImageView& view, const Records& records, Body&& body) {
  const GridRecord& grid = view.grid;
  const std::uint64_t macro_cells = macro_cell_total(grid);
  const auto width = static_cast<std::int32_t>(grid.macro_width);
  std::uint64_t block = view.cell_blocks_offset_bytes;
  MacroTableEntry entry{};
  for (std::uint64_t index = 0; index < macro_cells; ++index) {
    if (index % 32 == 0) {
      entry = checker.read<MacroTableEntry>(view.macro_table_offset_bytes + index / 32 * sizeof(MacroTableEntry));
    }
    if ((entry.occupied >> (index % 32) & 1u) == 0) continue;
    block += grid.cell_block_bytes;
    const std::uint64_t row = index / grid.macro_cell_count[0];
    const std::int32_t first[3] = {static_cast<std::int32_t>(index % grid.macro_cell_count[0]) * width,
                                   static_cast<std::int32_t>(row % grid.macro_cell_count[1]) * width,
                                   static_cast<std::int32_t>(row / grid.macro_cell_count[1]) * width};
    std::uint64_t number = 0;
    std::int32_t cell[3];
    for (cell[2] = first[2]; cell[2] < first[2] + width; ++cell[2]) {
      for (cell[1] = first[1]; cell[1] < first[1] + width; ++cell[1]) {
        for (cell[0] = first[0]; cell[0] < first[0] + width; ++cell[0]) {
          const Records::Range range = records.cell_of_block(block, number++);  // empty beyond the grid's edge
          if (!check_triangles(checker, view, range.first, range.end)) return false;
          for (std::uint64_t reference = range.first; reference < range.end; ++reference) {
            if (!body(cell, reference)) return false;
          }
        }
      }
    }
  }
  return true;
}

}  // namespace

bool check_geometry(ImageChecker& checker, const Sections& sections, const SceneImageView& view) {
  const GridRecord& grid = view.grid;
  Records records(checker, view);
  Search search(records);
  if (grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kProjection)) {
    return for_each_reference(checker, view, records, [&](const std::int32_t cell[3], std::uint64_t reference) {
      return check_projection(checker, records, search, cell, reference);
    });
  }
  const CellSpace space = CellSpace::of(grid);
  Totals totals;
  const bool all_good =
      for_each_reference(checker, view, records, [&](const std::int32_t cell[3], std::uint64_t reference) {
        return check_reference(checker, records, search, view, space, cell, reference, totals);
      });
  if (!all_good) return false;

  const std::uint64_t base = sections.entry(SectionKind::kGrid).offset_bytes;
  GRIDIRON_REQUIRE(totals.reference_count == grid.reference_count, base, grid, reference_count);
  for (int axis = 0; axis < 3; ++axis) {
    GRIDIRON_REQUIRE(totals.minimum[axis] == grid.bounds_minimum[axis], base, grid, bounds_minimum);
    GRIDIRON_REQUIRE(totals.maximum[axis] == grid.bounds_maximum[axis], base, grid, bounds_maximum);
  }
  const ImageHeader& header = view.header;
  const std::uint64_t count = header.triangle_count;
  const std::uint64_t dropped = header.dropped_triangle_count;
  GRIDIRON_REQUIRE(totals.triangle_count == count - dropped, 0, header, dropped_triangle_count);
  // Every id occurs once: if no triangle was dropped, their sum must be that of all ids.
  return checker.require(dropped != 0 || totals.id_sum == count * (count - 1) / 2, view.triangles_offset_bytes,
                         "triangle.triangle_id");
}

}  // namespace gridiron
