// Counting of scene images: see grid_builder.h. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/triangle_formats.h>
#include <gridiron/build/build_step.h>
#include <gridiron/build/grid/cell_rows.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/build/grid/grid_resolution.h>
#include <gridiron/build/grid/image_layout.h>
#include <gridiron/build/lattice.h>
#include <gridiron/build/mesh_quads.h>
#include <gridiron/build/shared_parts.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/triangle_records.h>

#include <bit>

namespace gridiron {
namespace {

// --- The mesh, whatever the grid ----------------------------------------------------------------------------------

bool all_in_range(std::span<const Vec3> vertices) {
  enter_step<GridStep::kVertexCheck>();
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

// Checks of indices, zero areas, and the triangles that are kept: their tight bounds, and for a grid sums that bound
// their references.
struct KeptTriangles {
  std::uint64_t count = 0;
  Vec3 minimum{kFloatMax, kFloatMax, kFloatMax};
  Vec3 maximum{-kFloatMax, -kFloatMax, -kFloatMax};
  double extents[3] = {};  // of all triangles' boxes
  double areas[3] = {};    // of all triangles, projected along each axis
};

template <class Mesh>
Status survey(const Mesh& mesh, KeptTriangles& kept) {
  enter_step<kIsOnLattice<Mesh> ? GridStep::kLatticeBox : GridStep::kTriangleSurvey>();
  const std::uint64_t vertex_count = mesh.vertices.size();
  for (const UVec3& t : mesh.triangles) {
    if (t.x >= vertex_count || t.y >= vertex_count || t.z >= vertex_count) return Status::kBadIndex;
    const Vec3& a = mesh.vertices[t.x];
    const Vec3& b = mesh.vertices[t.y];
    const Vec3& c = mesh.vertices[t.z];
    if (has_zero_area(a, b, c)) continue;
    ++kept.count;
    Vec3 least, greatest;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = a[axis] < b[axis] ? a[axis] : b[axis];
      const float high = a[axis] < b[axis] ? b[axis] : a[axis];
      least[axis] = low < c[axis] ? low : c[axis];
      greatest[axis] = high > c[axis] ? high : c[axis];
      kept.minimum[axis] = least[axis] < kept.minimum[axis] ? least[axis] : kept.minimum[axis];
      kept.maximum[axis] = greatest[axis] > kept.maximum[axis] ? greatest[axis] : kept.maximum[axis];
    }
    double e1[3];
    double e2[3];
    for (int axis = 0; axis < 3; ++axis) {
      kept.extents[axis] += double{greatest[axis]} - double{least[axis]};
      e1[axis] = double{b[axis]} - double{a[axis]};
      e2[axis] = double{c[axis]} - double{a[axis]};
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int u = axis < 2 ? axis + 1 : 0;
      const int v = axis > 0 ? axis - 1 : 2;
      kept.areas[axis] += 0.5 * __builtin_fabs(e1[u] * e2[v] - e1[v] * e2[u]);
    }
  }
  return Status::kOk;
}

// The same for the tree alone, without the sums.
template <class Mesh>
Status survey_part_for_tree(const Mesh& mesh, KeptTriangles& kept) {
  enter_step<TreeStep::kTriangleSurvey>();
  const auto vertex_count = static_cast<std::int64_t>(mesh.vertices.size());
  QuadBox bounds;
  for (const UVec3& t : mesh.triangles) {
    CornerQuads corners;
    if (are_inner(mesh, t)) {
      corners = inner_corners_of(mesh, t);
    } else {
      if (!are_below(t, vertex_count)) return Status::kBadIndex;
      corners = corners_of(mesh, t);
    }
    if (corners.have_zero_area()) continue;
    ++kept.count;
    bounds.add(corners.a);
    bounds.add(corners.b);
    bounds.add(corners.c);
  }
  kept.minimum = vec3_of(bounds.low);
  kept.maximum = vec3_of(bounds.high);
  return Status::kOk;
}

// Shares of a mesh that is large enough.
template <class Mesh>
std::uint32_t shares_of(const Mesh& mesh, const WorkSharing& sharing) {
  return mesh.triangles.size() < kManyTreeTriangles ? std::uint32_t{1} : shares_for(sharing);
}

template <class Mesh>
Status survey_for_tree(const Mesh& mesh, const WorkSharing& sharing, KeptTriangles& kept) {
  Status statuses[kMostShares];
  KeptTriangles of[kMostShares];
  const std::uint32_t shares = shares_of(mesh, sharing);
  share(sharing, shares, [&](std::uint32_t i) {
    const Share part = share_of(mesh.triangles.size(), shares, i);
    statuses[i] = survey_part_for_tree(Mesh{mesh.vertices, mesh.triangles.subspan(part.begin, part.size())}, of[i]);
  });
  for (std::uint32_t i = 0; i < shares; ++i) {
    GRIDIRON_TRY(statuses[i]);
    kept.count += of[i].count;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = of[i].minimum[axis], high = of[i].maximum[axis];
      kept.minimum[axis] = low < kept.minimum[axis] ? low : kept.minimum[axis];
      kept.maximum[axis] = high > kept.maximum[axis] ? high : kept.maximum[axis];
    }
  }
  return Status::kOk;
}

// A lower bound of the references in a grid. A triangle touches a cell in each column under its projection, so at least
// as many as the projection's area. Its cells are connected by their faces, so if its box has x by y by z cells it
// touches at least x + y + z - 2 of them. Rounding: sums of 2^32 non-negative terms have an error of 2^-21 of
// themselves; an area of at most 2048^2 cells has one of 2^-28 of a cell if its terms cancel. The margins cover both.
std::uint64_t least_references(const KeptTriangles& kept, const GridRecord& grid) {
  double scale[3];
  double extents = 0.0;
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    scale[axis] = double{grid.cells_per_unit[axis]};
    extents += kept.extents[axis] * scale[axis];
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double area = kept.areas[axis] * scale[axis < 2 ? axis + 1 : 0] * scale[axis > 0 ? axis - 1 : 2];
    const double extent = kept.extents[axis] * scale[axis];
    most = area > most ? area : most;
    most = extent > most ? extent : most;
  }
  const auto count = static_cast<double>(kept.count);
  most = extents - 2.0 * count > most ? extents - 2.0 * count : most;
  const double least = most * (1.0 - 0x1p-18) - count * 0x1p-18;
  if (least >= 0x1p56) return std::uint64_t{1} << 56;  // so that their bytes are a number
  return least > count ? static_cast<std::uint64_t>(least) : kept.count;
}

constexpr std::uint64_t kStackMarks = 256;  // words

// A set of macrocells within a window of their linear order, a bit for each.
class MacroWindow {
 public:
  explicit MacroWindow(std::span<std::uint64_t> words) : words_(words) {}

  void move_to(std::uint64_t begin) {
    begin_ = begin;
    for (std::uint64_t& word : words_) word = 0;
  }
  [[nodiscard]] std::uint64_t begin() const { return begin_; }
  [[nodiscard]] std::uint64_t end() const { return begin_ + std::uint64_t{64} * words_.size(); }

  void insert(std::uint64_t macro_cell) {
    const std::uint64_t place = macro_cell - begin_;  // wraps below the window
    if (place / 64 < words_.size()) words_[static_cast<std::size_t>(place / 64)] |= std::uint64_t{1} << (place % 64);
  }
  [[nodiscard]] std::uint64_t size() const {
    std::uint64_t total = 0;
    for (const std::uint64_t word : words_) {
      total += count_bits(static_cast<std::uint32_t>(word)) + count_bits(static_cast<std::uint32_t>(word >> 32));
    }
    return total;
  }

 private:
  std::span<std::uint64_t> words_;
  std::uint64_t begin_ = 0;
};

// --- One grid -----------------------------------------------------------------------------------------------------

// One sweep over the triangles: marks the macrocells inside the window, and finds the start of the next window.
struct Sweep {
  std::uint64_t reference_count = 0;
  std::uint64_t row_count = 0;
  CellCuts cuts{};
  std::uint64_t next_begin = ~std::uint64_t{0};  // no macrocell between the window's end and this one is touched
};

// @returns whether there are at most most_references.
template <class Mesh>
bool sweep_window(const Mesh& mesh, const GridRecord& grid, std::uint64_t most_references, MacroWindow& window,
                  Sweep& sweep) {
  const CellSpace space = CellSpace::of(grid);
  const MacroMap macros(grid);
  const bool first_sweep = window.begin() == 0;
  for (const UVec3& t : mesh.triangles) {
    enter_step<kIsOnLattice<Mesh> ? GridStep::kLatticeBox : GridStep::kCellBox>();
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
    for_each_cell_row(box, sweep.cuts, [&](std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z) {
      enter_step<GridStep::kCellRow>();
      sweep.reference_count += static_cast<std::uint64_t>(x1 - x0 + 1);
      ++sweep.row_count;
      const std::uint64_t row = macros.row_index(y, z);
      const std::uint64_t last = row + macros.macro_of(x1);
      for (std::uint64_t macro_cell = row + macros.macro_of(x0); macro_cell <= last; ++macro_cell) {
        window.insert(macro_cell);
        if (macro_cell >= window.end() && macro_cell < sweep.next_begin) sweep.next_begin = macro_cell;
      }
    });
    if (sweep.reference_count > most_references) return false;
  }
  return true;
}

void add_cuts(const CellCuts& more, CellCuts& sum) {
  sum.square_count += more.square_count;
  sum.outline_count += more.outline_count;
  sum.slab_count += more.slab_count;
  sum.polygon_count += more.polygon_count;
  sum.polygon_row_count += more.polygon_row_count;
}

// The inputs of a count besides the grid, and its limits.
struct Request {
  const GridParameters& parameters;
  const EffectsRecord* effects;  // as counted; null: none
  std::uint64_t triangle_count;  // of the input
  std::uint64_t resolved_count;  // n of Eq. (1)
  std::uint64_t kept_count;      // triangles that have an area as they are stored
  std::uint64_t most_bytes;
  bool may_reduce;  // halves lambda until the image fits
  std::span<std::uint64_t> marks;
  const WorkSharing& sharing;
};

// Bytes of an image of the grid with these numbers of references and blocks.
std::uint64_t image_bytes_of(const Request& request, GridRecord grid, std::uint64_t references, std::uint64_t blocks) {
  grid.reference_count = static_cast<std::uint32_t>(references);
  grid.cell_block_count = static_cast<std::uint32_t>(blocks);
  return layout_of(grid, {request.effects, request.triangle_count, request.kept_count, request.parameters}).image_bytes;
}

// Bounds and format of the kept triangles. @param grid  so far: the lattice.
void describe(const GridParameters& parameters, const KeptTriangles& kept, GridRecord& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    grid.bounds_minimum[axis] = kept.minimum[axis] + 0.0f;  // no negative zero
    grid.bounds_maximum[axis] = kept.maximum[axis] + 0.0f;
  }
  grid.triangle_format = static_cast<std::uint32_t>(parameters.format);
  grid.triangle_bytes = triangle_bytes_of(parameters.format);
}

// Makes the grid over the kept triangles; references and blocks are counted later.
void make_grid(const Request& request, float lambda, GridRecord& grid) {
  const GridParameters& parameters = request.parameters;
  grid.lambda = lambda;
  grid.macro_width = parameters.macro_width;
  grid.cell_block_bytes = cell_block_bytes_of(parameters.format, parameters.macro_width);
  resolve_grid(request.resolved_count, grid);
}

// What a need has besides grid and steps.
template <class Mesh>
void add_other_needs(const Mesh& mesh, const Request& request, GridNeed& need) {
  need.dropped_triangle_count = static_cast<std::uint32_t>(mesh.triangles.size() - request.kept_count);
  const bool has_tree = request.effects != nullptr || request.parameters.has_tree;
  need.scratch_bytes = has_tree ? tree_scratch_bytes(request.triangle_count) : 0;
}

// Counts references and non-empty macrocells. The first sweep covers every triangle, the others those beyond its
// window. A bound of the references decides first whether they can fit at all.
// Errors: kMemoryTooSmall as soon as need.image_bytes is known to exceed the limit;
// kTooManyTriangles.
template <class Mesh>
Status count_grid(const Mesh& mesh, const Request& request, const KeptTriangles& kept, std::uint64_t most_bytes,
                  GridRecord grid, GridNeed& need) {
  const std::uint64_t empty_bytes = image_bytes_of(request, grid, 0, 1);
  const std::uint64_t left_bytes = most_bytes > empty_bytes ? most_bytes - empty_bytes : 0;
  const std::uint64_t fitting = left_bytes / grid.triangle_bytes + kLineBytes;  // a line more, for padding
  const std::uint64_t most_references = fitting < kMaxCount ? fitting : kMaxCount;
  const auto refuse = [&](std::uint64_t references) {
    need.image_bytes = empty_bytes + references * grid.triangle_bytes;
    return most_references < kMaxCount ? Status::kMemoryTooSmall : Status::kTooManyTriangles;
  };
  const std::uint64_t least = least_references(kept, grid);
  if (least > most_references) return refuse(least);
  std::uint64_t stack_marks[kStackMarks];
  const std::span<std::uint64_t> marks = request.marks.empty() ? stack_marks : request.marks;
  const std::uint64_t all_marks = (macro_cell_total(grid) + 63) / 64;
  MacroWindow window(marks.first(static_cast<std::size_t>(all_marks < marks.size() ? all_marks : marks.size())));
  std::uint64_t reference_count = 0;
  std::uint64_t block_count = 1;
  GridSteps steps{};
  for (std::uint64_t begin = 0; begin != ~std::uint64_t{0};) {
    Sweep sweep;
    enter_step<GridStep::kMacroWord>();
    window.move_to(begin);
    if (!sweep_window(mesh, grid, most_references, window, sweep)) {
      return refuse(least > sweep.reference_count ? least : sweep.reference_count);
    }
    if (begin == 0) {
      reference_count = sweep.reference_count;
      steps.row_count = sweep.row_count;
      steps.cuts = sweep.cuts;
    }
    ++steps.sweep_count;
    steps.swept_row_count += sweep.row_count;
    add_cuts(sweep.cuts, steps.swept_cuts);
    enter_step<GridStep::kMacroWord>();
    block_count += window.size();
    enter_step<GridStep::kBuildOnce>();
    begin = sweep.next_begin;
    if (block_count > kMaxCount) return Status::kTooManyTriangles;
    need.image_bytes = image_bytes_of(request, grid, reference_count, block_count);
    if (need.image_bytes > most_bytes) return Status::kMemoryTooSmall;
  }
  grid.reference_count = static_cast<std::uint32_t>(reference_count);
  grid.cell_block_count = static_cast<std::uint32_t>(block_count);

  need.grid = grid;
  need.steps = steps;
  add_other_needs(mesh, request, need);
  return Status::kOk;
}

// Without a grid the size follows from the numbers of triangles, and nothing makes it smaller.
template <class Mesh>
Status count_without_grid(const Mesh& mesh, const Request& request, GridRecord grid, GridNeed& need) {
  resolve_empty_grid(grid);
  need.image_bytes = image_bytes_of(request, grid, 0, 0);
  if (!request.may_reduce && need.image_bytes > request.most_bytes) return Status::kMemoryTooSmall;
  need.grid = grid;
  add_other_needs(mesh, request, need);
  return Status::kOk;
}

// Counts with the requested lambda, or halves it until the image fits.
template <class Mesh>
Status count_mesh(const Mesh& mesh, const Request& request, const KeptTriangles& kept, GridRecord grid,
                  GridNeed& need) {
  enter_step<GridStep::kBuildOnce>();
  if (kept.count == 0) return Status::kNoTriangles;
  describe(request.parameters, kept, grid);
  if (!request.parameters.has_grid) return count_without_grid(mesh, request, grid, need);
  float lambda = request.parameters.lambda;
  for (;;) {
    make_grid(request, lambda, grid);
    if (!request.may_reduce) return count_grid(mesh, request, kept, request.most_bytes, grid, need);
    const bool is_last = lambda <= kLeastLambda || has_one_cell(grid);
    const Status status = count_grid(mesh, request, kept, is_last ? kAnyImageBytes : request.most_bytes, grid, need);
    if (is_last || (status != Status::kMemoryTooSmall && status != Status::kTooManyTriangles)) return status;
    lambda = lambda * 0.5f > kLeastLambda ? lambda * 0.5f : kLeastLambda;
  }
}

Status count_geometry(const MeshView& mesh, Request request, GridNeed& need) {
  GridRecord grid{};
  KeptTriangles kept;
  const bool has_grid = request.parameters.has_grid;
  GRIDIRON_TRY(has_grid ? survey(mesh, kept) : survey_for_tree(mesh, request.sharing, kept));
  request.resolved_count = kept.count;
  request.kept_count = kept.count;
  if (request.parameters.format != TriangleFormat::kLattice) return count_mesh(mesh, request, kept, grid, need);
  // As many cells as without a lattice: it has fewer triangles left, not larger ones.
  enter_step<GridStep::kLatticeSurvey>();
  GRIDIRON_TRY(find_lattice(mesh, grid.lattice));
  const LatticeMesh moved{{mesh.vertices, grid.lattice}, mesh.triangles};
  KeptTriangles moved_kept;
  GRIDIRON_TRY(has_grid ? survey(moved, moved_kept) : survey_for_tree(moved, request.sharing, moved_kept));
  request.kept_count = moved_kept.count;
  return count_mesh(moved, request, moved_kept, grid, need);
}

Status count_within(const MeshView& mesh, Request request, const EffectsView* effects, GridNeed& need) {
  enter_step<GridStep::kBuildOnce>();
  GRIDIRON_TRY(check_parameters(request.parameters));
  const bool has_tree = effects != nullptr || request.parameters.has_tree;
  GRIDIRON_TRY(check_parts(request.parameters, has_tree));
  if (mesh.triangles.size() > kMaxCount || mesh.vertices.size() > kMaxCount) return Status::kTooManyTriangles;
  if (has_tree && mesh.triangles.size() > kMaxTreeTriangles) return Status::kTooManyTriangles;
  QuadBox vertices;
  if (!request.parameters.has_grid) enter_step<TreeStep::kVertexBound>();
  const bool are_right =
      request.parameters.has_grid ? all_in_range(mesh.vertices) : bound_points(mesh.vertices, vertices);
  if (!are_right) return Status::kBadVertex;
  EffectsRecord record{};
  if (effects != nullptr) {
    GRIDIRON_TRY(check_effects(mesh, *effects));
    record = count_effects(*effects);
    request.effects = &record;
  }
  GridNeed counted{};
  const Status status = count_geometry(mesh, request, counted);
  if (status == Status::kMemoryTooSmall) need.image_bytes = counted.image_bytes;
  GRIDIRON_TRY(status);
  if (effects != nullptr) GRIDIRON_TRY(check_reach(*effects, counted.grid));
  need = counted;
  return Status::kOk;
}

}  // namespace

Status count_scene_image(const MeshView& mesh, const GridParameters& parameters, GridNeed& need,
                         const EffectsView* effects, std::uint64_t most_image_bytes, std::span<std::uint64_t> marks,
                         const WorkSharing& sharing) {
  const Request request{parameters, nullptr, mesh.triangles.size(), 0, 0, most_image_bytes, false, marks, sharing};
  return count_within(mesh, request, effects, need);
}

Status fit_scene_image(const MeshView& mesh, const GridParameters& parameters, std::uint64_t most_image_bytes,
                       GridNeed& need, const EffectsView* effects, std::span<std::uint64_t> marks,
                       const WorkSharing& sharing) {
  const Request request{parameters, nullptr, mesh.triangles.size(), 0, 0, most_image_bytes, true, marks, sharing};
  return count_within(mesh, request, effects, need);
}

}  // namespace gridiron
