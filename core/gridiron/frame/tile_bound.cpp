// Tile bound: see the header. Names of loops and counters are those of the kernel's folders.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/frame/tile_bound.h>

namespace gridiron {
namespace {

/// A count that stays at 2^64 - 1 once it has reached it.
struct Count {
  std::uint64_t value = 0;

  constexpr Count() = default;
  constexpr Count(std::uint64_t n) : value(n) {}  // NOLINT: counts are written as numbers

  friend constexpr Count operator+(Count a, Count b) {
    std::uint64_t sum = 0;
    return __builtin_add_overflow(a.value, b.value, &sum) ? Count{~std::uint64_t{0}} : Count{sum};
  }
  friend constexpr Count operator*(Count a, Count b) {
    std::uint64_t product = 0;
    return __builtin_mul_overflow(a.value, b.value, &product) ? Count{~std::uint64_t{0}} : Count{product};
  }
};

Count smaller(Count a, Count b) {
  return a.value < b.value ? a : b;
}
Count larger(Count a, Count b) {
  return a.value > b.value ? a : b;
}
std::uint64_t parts(std::uint64_t count, std::uint64_t each) {
  return count / each + (count % each != 0 ? 1 : 0);
}

// Commands of a transfer wherever it begins, a multiple of `step`: a first piece up to a boundary, and the rest.
std::uint64_t pieces_of(std::uint64_t bytes, std::uint64_t step) {
  return bytes <= step ? 1 : 1 + parts(bytes - step, kPortableBoundaryBytes);
}

constexpr std::uint64_t kSubpacketRays = 16;
// Every ray joins a pass of its own steepest axis and sign. One whose direction rounding has made zero goes alone; a
// camera has at most one, as directions are further apart than their roundings.
constexpr std::uint64_t kAxesAndSigns = 6;

class Sum {
 public:
  Sum(const TileScene& scene, const TileLayout& layout, const TileFrame& frame)
      : scene_(scene), layout_(layout), frame_(frame) {}

  [[nodiscard]] TileBound bound() {
    const bool has_effects = frame_.shading == Shading::kScene;
    const std::uint32_t asked = has_effects ? scene_.effects.samples_per_pixel : 1;
    const std::uint64_t samples = asked != 0 ? asked : 1;
    add(Work::kTileStart, 1);
    if (layout_.packet_width != 0) add_packets(samples);
    if (has_effects) add_effects(samples);
    add_output();
    // A command that finds the queue full waits for one more tag.
    if (needs_room()) waits_ = waits_ + gets_ + puts_;
    add(Work::kGetIssue, gets_);
    add(Work::kPutIssue, puts_);
    add(Work::kWait, waits_);
    TileBound bound;
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) bound.work[kind] = work_[kind].value;
    bound.get_bytes = get_bytes_.value;
    bound.put_bytes = put_bytes_.value;
    return bound;
  }

 private:
  [[nodiscard]] bool uses(std::uint32_t technique) const { return (frame_.techniques & technique) != 0; }
  [[nodiscard]] bool is_paper() const { return frame_.accuracy == Accuracy::kPaper; }
  [[nodiscard]] bool is_fast() const { return frame_.accuracy == Accuracy::kFast; }
  [[nodiscard]] bool is_exact() const { return frame_.accuracy == Accuracy::kExact; }
  [[nodiscard]] bool is_compact() const { return frame_.accuracy == Accuracy::kCompact; }
  [[nodiscard]] std::uint64_t groups(std::uint64_t count) const { return parts(count, layout_.lanes); }

  void add(WorkId kind, Count amount) {
    Count& sum = work_[kind.number()];
    sum = sum + amount;
  }
  // Transfers that are waited for one by one.
  void add_gets(Count transfers, std::uint64_t pieces, Count bytes) {
    gets_ = gets_ + transfers * pieces;
    waits_ = waits_ + transfers;
    get_bytes_ = get_bytes_ + bytes;
  }

  // What `passes` passes through the whole grid visit and fetch, for packets. A transfer has one
  // command, and one more for each boundary inside it. Blocks are contiguous and fetched once in a pass, so each
  // boundary of their section is inside at most one of them; the same holds for runs. Empty macrocells share a block.
  void add_traversal(Count passes, bool skips_empty) {
    const std::uint64_t visits = skips_empty ? scene_.occupied_macro_cells : scene_.macro_cells;
    const std::uint64_t empty_visits = visits - scene_.occupied_macro_cells;
    add(GridWork::kMacroSliceStep, passes * scene_.macro_slices);
    add(GridWork::kMacroCellStep, passes * scene_.macro_cells);
    // A row has a cell at least, and is gone on with after each visit and each line of the table.
    add(GridWork::kMacroRow, passes * (Count{scene_.macro_cells} * (has_table() ? 1 : 2) + visits));
    add(GridWork::kMacroCellVisit, passes * visits);
    add(GridWork::kSliceStep, passes * (skips_empty ? scene_.occupied_slices : scene_.slices));
    add(is_compact() ? GridWork::kCellBoundStep : GridWork::kCellStep,
        passes * (skips_empty ? scene_.occupied_cells : scene_.cells));
    add(GridWork::kCellRow, passes * (Count{skips_empty ? scene_.occupied_cells : scene_.cells} + scene_.filled_cells));
    add(GridWork::kCellVisit, passes * scene_.filled_cells);
    add(GridWork::kTriangleBatch, passes * scene_.runs);
    if (is_compact()) add(Work::kLatticeTriangle, passes * scene_.references);

    const std::uint64_t block_bytes = scene_.cell_block_bytes;
    const Count block_gets = scene_.occupied_macro_cells +
                             parts(scene_.occupied_macro_cells * block_bytes, kPortableBoundaryBytes) +
                             empty_visits * pieces_of(block_bytes, kLineBytes);
    const std::uint64_t run_bytes =
        is_compact() ? scene_.references * sizeof(LatticeTriangle) : scene_.references * kTriangleRecordBytes;
    const Count run_gets = scene_.runs + parts(run_bytes, kPortableBoundaryBytes);
    // Runs of lattice triangles are widened to whole granules at both ends.
    const Count widened_bytes = is_compact() ? scene_.runs * std::uint64_t{kPortableGranuleBytes} : 0;
    gets_ = gets_ + passes * (block_gets + run_gets);
    waits_ = waits_ + passes * (Count{visits} + scene_.runs);
    get_bytes_ = get_bytes_ + passes * (Count{visits} * block_bytes + run_bytes + widened_bytes);
    // If the table is fetched in lines, each macrocell may need its line.
    if (!has_table()) add_gets(passes * scene_.macro_cells, 1, passes * scene_.macro_cells * kLineBytes);
  }
  [[nodiscard]] bool has_table() const {
    constexpr std::uint64_t kCellsOfLine = 32 * kLineBytes / sizeof(MacroTableEntry);
    return parts(scene_.macro_cells, kCellsOfLine) <= layout_.resident_macro_cells / kCellsOfLine;
  }

  // Packets of every sample. Rounds: rays whose nearest hit the estimates leave open are traced again, and with exact
  // distances those that are still open once more, each alone.
  void add_packets(std::uint64_t samples) {
    const std::uint64_t packets_across = layout_.tile_width / layout_.packet_width;
    const std::uint64_t packets = packets_across * packets_across * samples;
    const std::uint64_t rays = std::uint64_t{layout_.packet_width} * layout_.packet_width;
    const std::uint64_t subpackets = rays / kSubpacketRays;
    const std::uint64_t squares = subpackets < 4 ? 1 : subpackets / 4;
    const std::uint64_t rounds = is_paper() || is_fast() ? 1 : 2;
    const Count passes = Count{packets} * (kAxesAndSigns * rounds + (is_exact() ? rays : 0)) + samples * rounds;
    add(Work::kRayPacket, packets);
    if (subpackets >= 16) add(Work::kPixelProjection, packets);
    add(Work::kRayGenerated, Count{packets} * groups(rays));
    const std::uint64_t rounds_and_ties = rounds + (is_exact() ? 1 : 0);
    add(Work::kRecentSlot, Count{packets} * rounds_and_ties * layout_.recent_triangles);
    // Each round begins with a look for unsure rays and ends with one for rays of another pass.
    const std::uint64_t set_words = parts(rays, 32);
    add(Work::kRaySetWord, Count{set_words} * (Count{packets} * 7 + passes));
    add(GridWork::kMailboxGroup, (Count{packets} * 2 + passes * 2) * (layout_.mailbox_slots / 4));
    add(GridWork::kPassSlope, passes * squares);
    add(GridWork::kPacketStart, passes);
    if (rays >= 64) add(GridWork::kPassSquare, passes * squares);
    add(GridWork::kPassGroup, passes * groups(rays));
    add_traversal(passes, uses(kUseEmptySkip));
    add_packet_culling(passes, subpackets, squares);

    // A ray is in one pass of each round, so pairs of rays and references are counted by rounds. Groups and whole
    // subpackets with a ray in a pass are at most as many as the rays, or all of every pass.
    const Count ray_rounds = Count{packets} * rays * rounds_and_ties;
    const Count group_rounds = smaller(passes * groups(rays), ray_rounds);
    const Count pairs = ray_rounds * scene_.references;
    const Count group_pairs = group_rounds * scene_.references;
    const Count tests = passes * scene_.references;
    if (uses(kUseMailbox)) add(GridWork::kMailboxProbe, tests);
    if (uses(kUseCornerCulling)) add(is_paper() ? Work::kCullTestPaper : Work::kCullTest, tests);
    if (is_paper()) {
      add(Work::kGroupTestPaper, group_pairs);
      add(Work::kHitGroupPaper, group_pairs);
    } else {
      add(Work::kTriangleSetup, tests);
      add(Work::kTriangleTest, tests);
      if (subpackets > 4) add(Work::kSubpacketPick, tests * subpackets);
      const bool picks_rows = uses(kUseSubpackets);
      add(picks_rows ? Work::kRowVisit : Work::kSubpacketVisit, tests * subpackets);
      add(picks_rows ? Work::kRowSkip : Work::kGroupSkip, tests * groups(rays));
      if (!picks_rows || subpackets < 16) add(Work::kListedTriangle, tests);
      add(picks_rows ? Work::kRowTest : Work::kGroupTestStandard, group_pairs);
      add(picks_rows ? Work::kRowInsideTest : Work::kInsideTest, group_pairs);
      add(Work::kHitGroup, group_pairs);
      add(Work::kOpenHitGroup, group_pairs);
      add(Work::kSettledGroup, group_pairs);
      for (const Work kind : {Work::kHitSubpacket, Work::kTakenSubpacket}) {
        add(kind, Count{packets} * subpackets * rounds * scene_.references);
      }
      add(Work::kEstimateSetup, smaller(tests, group_pairs));
      if (frame_.shading == Shading::kSimple) {
        add(Work::kNormalSetup, smaller(tests, group_pairs));
        add(Work::kFacingGroup, group_pairs);
      }
      // The side of the triangle that the eye is on; then three edges a pair, if floats leave them open.
      const Count signs = tests + (is_fast() ? Count{} : pairs * 3);
      // Distances of both triangles of a pair; for ties also whether three corners lie in the other's plane.
      const Count ties = is_exact() ? pairs : Count{};
      add(Work::kDoubleSign, signs + ties * 3);
      add(Work::kExactSign, signs + ties * 3);
      if (!is_fast()) {
        add(Work::kHitSetup, tests + pairs + ties * 2);
        add(Work::kHitHalf, pairs * 2 + ties);
        add(Work::kExactDistance, pairs * 2);
        add(Work::kExactOrder, ties);
      }
    }

    const std::uint64_t packet_groups = packets * groups(rays);
    if (frame_.shading == Shading::kSimple) add(Work::kShadedSimpleGroup, packet_groups);
    if (frame_.shading == Shading::kNone) add(Work::kShadedGroup, packet_groups);
    add(Work::kIdGroup, packet_groups);
    if (frame_.has_depth) add(Work::kDepthGroup, packet_groups / samples);
    // At the picture's edge the planes are cleared.
    const std::uint64_t planes = 1u + (frame_.has_depth ? 1u : 0u) + (frame_.shading == Shading::kSimple ? 1u : 0u);
    add(Work::kIdGroup, planes * (tile_pixels() / 4));
  }

  // Squares and subpackets tested against cells and triangles, and how far each still looks.
  void add_packet_culling(Count passes, std::uint64_t subpackets, std::uint64_t squares) {
    const std::uint64_t measured =
        subpackets < 4 ? groups(kSubpacketRays) : squares * groups(4 * kSubpacketRays) + (squares > 1 ? 1 : 0);
    const Count reach = Count{measured} * (Count{1} + scene_.runs);
    if (uses(kUseSubpackets)) {
      if (squares >= 4) {
        add(GridWork::kReachTest,
            passes * (Count{squares / 4} * scene_.filled_cells + Count{squares / 4 + squares} * scene_.runs));
        add(GridWork::kFootprintGroup, passes * (Count{groups(squares)} * scene_.filled_cells));
      } else {
        add(GridWork::kReachTest, passes * (Count{groups(subpackets)} * scene_.runs));
      }
      if (!is_paper()) {
        const Count tests = passes * scene_.references;
        if (subpackets >= 16) add(Work::kPixelBoxGroup, passes * scene_.run_groups);
        if (subpackets >= 16) add(Work::kOpenTriangle, tests);
        add(Work::kSlopeSetup, tests);
        add(Work::kSubpacketSetup, tests);
        const std::uint64_t quarters = squares == 16 && layout_.lanes == 4 ? 1 : 0;
        const std::uint64_t of_squares = squares > 1 ? quarters + groups(squares) : 0;
        if (subpackets >= 4) add(Work::kSubpacketGroup, tests * (squares + of_squares));
        if (layout_.lanes == 4) add(Work::kRowGroup, tests * subpackets);
      }
    }
    add(GridWork::kReachGroup, passes * reach);
  }

  // The secondary rays of the eye rays of every sample.
  void add_effects(std::uint64_t samples) {
    const EffectsRecord& effects = scene_.effects;
    const auto calls_for = [&](std::uint32_t bits) { return (effects.called_for & bits) != 0; };
    const std::uint64_t pixels = tile_pixels();
    if (layout_.packet_width == 0) add(Work::kIdGroup, pixels / 4);  // ids cleared at the picture's edge
    const Count eye_rays = Count{pixels} * samples;
    // A hit casts a reflected ray and, of glass, a refracted one.
    const std::uint64_t branches = calls_for(kRefraction) ? 2 : calls_for(kReflection) ? 1 : 0;
    Count hits_that_cast, level = eye_rays;
    for (std::uint32_t depth = 1; depth < effects.recursion_depth && depth < kMaxRecursionDepth; ++depth) {
      hits_that_cast = hits_that_cast + level;
      level = level * branches;
    }
    const Count queued = hits_that_cast * branches;
    const Count rays = eye_rays + queued;
    const Count to_lights = rays * scene_.light_samples;
    const Count into_the_open = rays * effects.occlusion_samples;
    add(Work::kWaveRay, rays);
    add(Work::kQueuedRay, queued);
    if (branches != 0) add(Work::kMirrorRay, hits_that_cast);
    if (calls_for(kRefraction)) add(Work::kRefractedRay, hits_that_cast);
    add(Work::kSurfacePoint, rays);
    add(Work::kDoubleSign, rays);  // on which side of its triangle a ray that grazes it began
    add(Work::kExactSign, rays);
    if (calls_for(kSmoothNormals)) add(Work::kSmoothNormal, rays);
    if (calls_for(kVertexColors)) add(Work::kVertexColor, rays);
    if (calls_for(kAreaLights | kAmbientOcclusion)) add(Work::kJitterSeed, rays);
    if (calls_for(kEnvironment)) add(Work::kEnvironmentLookup, rays);
    if (effects.has_shadows != 0) add(Work::kShadowRay, to_lights);
    if (calls_for(kAreaLights)) add(Work::kAreaPlace, to_lights);
    add(Work::kLightSample, to_lights);
    if (calls_for(kHighlights)) add(Work::kHighlight, to_lights);
    add(Work::kOcclusionRay, into_the_open);
    add(Work::kColorAdded, larger(rays, to_lights + into_the_open));  // a ray that hits nothing adds one colour
    add(Work::kColorGroup, pixels / 4);
    if (effects.levels == static_cast<std::uint32_t>(ColorLevels::kSrgb)) add(Work::kSrgbLevel, 3 * pixels);

    Count listed = queued + into_the_open;
    if (effects.has_shadows != 0) listed = listed + to_lights;
    if (layout_.packet_width == 0) listed = listed + eye_rays;
    add_lists(listed, effects.has_shadows != 0 && layout_.has_beams != 0 ? to_lights : Count{});
    add_records(rays, queued, samples * parts(pixels, layout_.wave_rays));
  }

  // Lists: a ray is in the list of a node or leaf once at most, and a list has one ray or beam at least. Each child is
  // asked for ahead and taken, and may have been evicted in between; the root is asked for once a batch. @param shared
  // of these, rays that may be traced as rays of one origin.
  void add_lists(Count rays, Count shared) {
    const Count nodes = rays * scene_.nodes, leaves = rays * scene_.leaves, triangles = rays * scene_.tree_triangles;
    const Count children = nodes + leaves, groups = rays * scene_.leaf_groups;
    add(Work::kListRay, rays);
    add(Work::kListNode, nodes);
    add(Work::kListRayNode, nodes);
    // Narrow lanes make a list for each quad of boxes first.
    const Count quads = layout_.lanes <= kTreeWidth / 4 ? nodes * (kTreeWidth / 4) : Count{};
    add(Work::kListBoxQuad, quads);
    add(Work::kListRun, nodes + quads);
    add(Work::kListChild, children);
    add(Work::kListEntry, children + quads);
    if (layout_.has_beams != 0) {
      add(Work::kListBeam, rays);
      add(Work::kListBeamNode, nodes);
      add(Work::kListEntry, nodes);  // their rays, listed where leaves are
      add(Work::kListSharedBox, shared * scene_.nodes * (layout_.lanes <= kTreeWidth / 4 ? 1 + kTreeWidth / 4 : 1));
      add(Work::kListSharedLeaf, shared * scene_.leaves);
      add(Work::kListSharedGroup, shared * scene_.leaf_groups);
    }
    add(Work::kListLeaf, leaves);
    add(Work::kListTriangleGroup, groups);
    add(Work::kListCandidate, groups);
    const Count ties = is_exact() ? triangles : Count{};
    add(Work::kRayDistance, triangles);
    add(Work::kDoubleSign, triangles * 3 + ties * 3);
    add(Work::kExactSign, triangles * 3 + ties * 3);
    add(Work::kExactDistance, triangles);
    add(Work::kExactOrder, ties);
    const std::uint64_t record = is_compact() ? sizeof(LatticeTriangle) : sizeof(VertexTriangle);
    if (is_compact()) add(Work::kLatticeTriangle, triangles * 2);
    add_gets(nodes * 2 + rays, pieces_of(sizeof(TreeNode), kLineBytes), (nodes * 2 + rays) * sizeof(TreeNode));
    // Runs of lattice triangles are widened to whole granules at both ends.
    const std::uint64_t widened = is_compact() ? 2 * kPortableGranuleBytes : 0;
    add_gets(leaves * 2, pieces_of(scene_.leaf_triangles * record + widened, kPortableGranuleBytes),
             triangles * (2 * record) + leaves * (2 * widened));
    // For a tie the other triangle is fetched.
    add_gets(ties, kPiecesOfRecord, ties * sizeof(SurfaceRecord));
  }

  // Surfaces, normals, materials, environment and lights that hits need; rays that wait in main memory.
  void add_records(Count rays, Count queued, std::uint64_t eye_waves) {
    const EffectsRecord& effects = scene_.effects;
    const auto calls_for = [&](std::uint32_t bits) { return (effects.called_for & bits) != 0; };
    add_gets(rays, kPiecesOfRecord, rays * sizeof(SurfaceRecord));
    if (calls_for(kSmoothNormals)) add_gets(rays, kPiecesOfRecord, rays * sizeof(NormalRecord));
    if (calls_for(kEnvironment)) add_gets(rays, kPiecesOfRecord, rays * sizeof(EnvironmentBlock));
    if (effects.material_count > layout_.material_slots) {
      const Count lookups = rays * (calls_for(kSmoothNormals) ? 2 : 1);
      add_gets(lookups, kPiecesOfRecord, lookups * sizeof(MaterialRecord));
    }
    if (effects.light_count > layout_.light_slots) {
      const Count waves = Count{eye_waves} + queued;  // a wave of queued rays has one at least
      add_gets(waves * parts(effects.light_count, layout_.light_slots), kPiecesOfRecord,
               waves * (std::uint64_t{effects.light_count} * sizeof(LightRecord)));
    }
    // Between two blocks that leave, a block of rays was pushed; each block comes back once.
    const std::uint64_t block_rays = layout_.wave_rays / 2;
    const Count blocks = queued.value / block_rays;
    const Count block_bytes = blocks * (block_rays * sizeof(QueuedRay));
    add_gets(blocks, pieces_of(block_rays * sizeof(QueuedRay), kPortableGranuleBytes), block_bytes);
    puts_ = puts_ + blocks * pieces_of(block_rays * sizeof(QueuedRay), kPortableGranuleBytes);
    waits_ = waits_ + blocks;
    put_bytes_ = put_bytes_ + block_bytes;
  }

  // The wait for the output buffer, and the planes' puts, which may be waited for.
  void add_output() {
    puts_ = puts_ + output_commands();
    put_bytes_ = put_bytes_ + std::uint64_t{planes()} * plane_bytes();
    waits_ = waits_ + 2;
    if (output_commands() > frame_.queue_depth) waits_ = waits_ + output_commands();
  }
  [[nodiscard]] std::uint64_t planes() const { return 1u + (frame_.has_depth ? 1u : 0u) + (frame_.has_ids ? 1u : 0u); }
  [[nodiscard]] std::uint64_t tile_pixels() const { return std::uint64_t{layout_.tile_width} * layout_.tile_width; }
  [[nodiscard]] std::uint64_t plane_bytes() const { return tile_pixels() * 4; }
  [[nodiscard]] std::uint64_t output_commands() const {
    return planes() * (parts(plane_bytes(), kPortableBoundaryBytes) + 1);
  }

  // Whether gets can find the queue full: what may be pending at once against the places that leaving tiles do not use.
  [[nodiscard]] bool needs_room() const {
    const std::uint64_t block = pieces_of(scene_.cell_block_bytes, kLineBytes);
    const std::uint64_t run =
        pieces_of(std::uint64_t{layout_.triangles_per_buffer} * kTriangleRecordBytes, kPortableGranuleBytes);
    const bool has_effects = frame_.shading == Shading::kScene;
    const std::uint64_t of_packets =
        layout_.packet_width == 0 ? 0 : frame_.macro_depth * block + frame_.triangle_depth * run;
    // Children that were asked for stay under way where their rays are found to need them no more.
    const std::uint64_t of_lists = has_effects ? std::uint64_t{layout_.tree_slots} * kPiecesOfRecord : 0;
    const std::uint64_t at_once = pieces_of(kMostWaveRays / 2 * sizeof(QueuedRay), kPortableGranuleBytes);
    const std::uint64_t pending = larger(of_packets, of_lists).value + at_once;
    std::uint64_t room = frame_.queue_depth;
    if (frame_.output_depth != 1) {
      const std::uint64_t leaving = frame_.output_depth * output_commands();
      const std::uint64_t rest = leaving < room ? room - leaving : 0;
      room = smaller(room, larger(rest, std::uint64_t{kLeastInputCommands})).value;
    }
    return pending > room;
  }

  static constexpr std::uint64_t kPiecesOfRecord = 2;  ///< shorter than a boundary's distance, anywhere

  const TileScene& scene_;
  const TileLayout& layout_;
  const TileFrame& frame_;
  Count work_[kWorkKindCount];
  Count gets_, puts_, waits_, get_bytes_, put_bytes_;
};

// Cells of an axis that macrocell `index` has.
std::uint32_t extent_of(const GridRecord& grid, int axis, std::uint32_t index) {
  const std::uint32_t rest = grid.cell_count[axis] - index * grid.macro_width;
  return rest < grid.macro_width ? rest : grid.macro_width;
}

}  // namespace

TileScene count_tile_scene(std::span<const std::byte> image, const SceneImageView& view, const TileLayout& layout) {
  const GridRecord grid = view.has_grid ? view.grid : GridRecord{};
  const std::uint32_t* const macro = grid.macro_cell_count;
  TileScene scene{};
  scene.macro_cells = std::uint64_t{macro[0]} * macro[1] * macro[2];
  scene.cells = std::uint64_t{grid.cell_count[0]} * grid.cell_count[1] * grid.cell_count[2];
  scene.references = grid.reference_count;
  scene.cell_block_bytes = grid.cell_block_bytes;
  std::uint64_t occupied_slices[3] = {};
  for (int axis = 0; axis < 3; ++axis) {
    scene.macro_slices = macro[axis] > scene.macro_slices ? macro[axis] : scene.macro_slices;
    const std::uint64_t slices = std::uint64_t{macro[(axis + 1) % 3]} * macro[(axis + 2) % 3] * grid.cell_count[axis];
    scene.slices = slices > scene.slices ? slices : scene.slices;
  }
  const auto* const table = reinterpret_cast<const MacroTableEntry*>(image.data() + view.macro_table_offset_bytes);
  const bool is_on_lattice = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  const std::uint32_t block_cells = grid.macro_width * grid.macro_width * grid.macro_width;
  std::uint64_t index = 0;
  for (std::uint32_t z = 0; z < macro[2]; ++z) {
    for (std::uint32_t y = 0; y < macro[1]; ++y) {
      for (std::uint32_t x = 0; x < macro[0]; ++x, ++index) {
        const MacroTableEntry& entry = table[index / 32];
        const std::uint32_t bit = static_cast<std::uint32_t>(index % 32);
        if ((entry.occupied >> bit & 1u) == 0) continue;
        const std::uint64_t block = entry.first_block + count_bits(entry.occupied & ((1u << bit) - 1u));
        const std::byte* const bytes =
            image.data() + view.cell_blocks_offset_bytes + block * std::uint64_t{grid.cell_block_bytes};
        const std::uint32_t extent[3] = {extent_of(grid, 0, x), extent_of(grid, 1, y), extent_of(grid, 2, z)};
        ++scene.occupied_macro_cells;
        scene.occupied_cells += std::uint64_t{extent[0]} * extent[1] * extent[2];
        for (int axis = 0; axis < 3; ++axis) occupied_slices[axis] += extent[axis];
        std::uint32_t macro_triangles = 0;
        for (std::uint32_t cell = 0; cell < block_cells; ++cell) {
          const auto* const bounds = reinterpret_cast<const CellBound*>(bytes);
          const std::uint32_t count = is_on_lattice ? bounds[cell + 1].first_triangle - bounds[cell].first_triangle
                                                    : reinterpret_cast<const CellRecord*>(bytes)[cell].triangle_count;
          if (count == 0) continue;
          const std::uint32_t run = layout.packet_width != 0 ? layout.triangles_per_buffer : count;
          const std::uint32_t whole = count / run, rest = count % run;
          ++scene.filled_cells;
          scene.runs += whole + (rest != 0 ? 1 : 0);
          scene.run_groups += whole * parts(run, layout.lanes) + parts(rest, layout.lanes);
          macro_triangles += count;
          if (count > scene.most_cell_triangles) scene.most_cell_triangles = count;
        }
        if (macro_triangles > scene.most_macro_triangles) scene.most_macro_triangles = macro_triangles;
      }
    }
  }
  for (const std::uint64_t slices : occupied_slices) {
    scene.occupied_slices = slices > scene.occupied_slices ? slices : scene.occupied_slices;
  }
  if (!view.has_effects) return scene;
  scene.effects = view.effects;
  const auto* const lights = reinterpret_cast<const LightRecord*>(image.data() + view.effects.lights_offset_bytes);
  for (std::uint32_t i = 0; i < view.effects.light_count; ++i) {
    scene.light_samples += lights[i].samples == 0 ? 1 : lights[i].samples;
  }
  const TreeRecord& tree = view.tree;
  scene.nodes = tree.node_count;
  scene.tree_triangles = tree.triangle_count;
  scene.leaf_triangles = tree.leaf_triangles;
  const auto* const nodes = reinterpret_cast<const TreeNode*>(image.data() + tree.nodes_offset_bytes);
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    for (std::uint32_t child = 0; child < nodes[i].child_count; ++child) {
      const TreeChild& below = nodes[i].children[child];
      if (!below.is_leaf()) continue;
      ++scene.leaves;
      scene.leaf_groups += parts(below.count(), layout.lanes);
    }
  }
  return scene;
}

TileBound worst_tile(const TileScene& scene, const TileLayout& layout, const TileFrame& frame) {
  return Sum(scene, layout, frame).bound();
}

}  // namespace gridiron
