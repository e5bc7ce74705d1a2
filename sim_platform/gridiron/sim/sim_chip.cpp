// The simulated chip: checks the frame's ranges, picks the kernel that was compiled for the options, and runs it.
// Memory: owns local stores for the time of the frame. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/frame_rules.h>
#include <gridiron/base/image_rules.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/sim/compiled_layouts.h>
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/plain_core.h>
#include <gridiron/sim/render_entry.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/store/local_store.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <new>

namespace gridiron::sim {

namespace {

template <class... Layouts>
consteval bool fit_arenas(LayoutList<Layouts...>) {
  return (kFitsArena<Layouts> && ...);
}
template <class... Layouts>
consteval bool have_all_effects(LayoutList<Layouts...>) {
  return ((Layouts::kEffects == kAllEffects) && ...);
}
static_assert(have_all_effects(EffectLayouts{}), "no frame ends with kMissingEffect, so results need not name effects");
static_assert(fit_arenas(CommonLayouts{}) && fit_arenas(SweepLayouts{}) && fit_arenas(EffectLayouts{}));

template <class Core>
using RenderEntry = Status (*)(LayoutChoice, std::byte*, Core&, MainAddress, SpillRegion);

/// The list of compiled_layouts.h that contains a layout, which decides the build of the kernel.
enum class LayoutGroup : std::uint8_t { kCommon, kSweep, kEffects, kNone };

[[nodiscard]] LayoutGroup group_of(const LayoutChoice& layout) {
  const auto ignore = []<class Layout>() {};
  if (visit_layout(CommonLayouts{}, layout, ignore)) return LayoutGroup::kCommon;
  if (visit_layout(SweepLayouts{}, layout, ignore)) return LayoutGroup::kSweep;
  if (visit_layout(EffectLayouts{}, layout, ignore)) return LayoutGroup::kEffects;
  return LayoutGroup::kNone;
}

[[nodiscard]] bool host_runs_lanes(std::uint32_t lanes) {
#if defined(GRIDIRON_SIM_WIDE_LANES)
  const bool has_avx2 =
      __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
  if (lanes == 8) return has_avx2;
  if (lanes == 16) {
    return has_avx2 && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
           __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
  }
#endif
  return lanes == 1 || lanes == 4;
}

/// @returns null if this host cannot run the build for these options.
[[nodiscard]] RenderEntry<SimCore> checked_entry(const ChipOptions& options, LayoutGroup group) {
  if (!host_runs_lanes(options.lanes)) return nullptr;
  if (group == LayoutGroup::kSweep) return gridiron_sim_render_checked_sweep_lanes4;
  const bool has_effects = group == LayoutGroup::kEffects;
  if (options.mode == Mode::kInstrumented) {
#if defined(GRIDIRON_SIM_INSTRUMENTED)
    return has_effects ? gridiron_sim_render_instrumented_effects_lanes4 : gridiron_sim_render_instrumented_lanes4;
#else
    return nullptr;
#endif
  }
  if (has_effects) return gridiron_sim_render_checked_effects_lanes4;
  if (options.lanes == 1) return gridiron_sim_render_checked_lanes1;
#if defined(GRIDIRON_SIM_WIDE_LANES)
  if (options.lanes == 8) return gridiron_sim_render_checked_lanes8;
  if (options.lanes == 16) return gridiron_sim_render_checked_lanes16;
#endif
  return gridiron_sim_render_checked_lanes4;
}

[[nodiscard]] RenderEntry<PlainCore> plain_entry(const ChipOptions& options, LayoutGroup group) {
  if (!host_runs_lanes(options.lanes)) return nullptr;
  const bool has_effects = group == LayoutGroup::kEffects;
  if (options.lanes == 1) return gridiron_sim_render_plain_lanes1;
#if defined(GRIDIRON_SIM_WIDE_LANES)
  if (options.lanes == 8)
    return has_effects ? gridiron_sim_render_plain_effects_lanes8 : gridiron_sim_render_plain_lanes8;
  if (options.lanes == 16) {
    return has_effects ? gridiron_sim_render_plain_effects_lanes16 : gridiron_sim_render_plain_lanes16;
  }
#endif
  return has_effects ? gridiron_sim_render_plain_effects_lanes4 : gridiron_sim_render_plain_lanes4;
}

/// Reads records of main memory.
struct RecordReader {
  SimMemory& memory;

  template <class Record>
  [[nodiscard]] bool read(Record& record, std::uint64_t address) const {
    const std::span<std::byte> bytes = memory.bytes_at(MainAddress{address}, sizeof record);
    if (!bytes.empty()) std::memcpy(&record, bytes.data(), sizeof record);
    return !bytes.empty();
  }
};

/// Whether a part of an image lies in it. Images and their sections consist of whole lines, so cores may read whole
/// lines.
[[nodiscard]] bool lies_in_image(const ImageHeader& image, const CountedPart& part) {
  const std::uint64_t bytes = round_up<std::uint64_t>(part.element_count * part.element_bytes, kLineBytes);
  return part.offset_bytes <= image.image_bytes && bytes <= image.image_bytes - part.offset_bytes;
}

/// Whether the image of a frame with a tree, and the tree, lie in memory. The image's header says how many bytes there
/// are.
[[nodiscard]] bool is_tree_in_memory(SimMemory& memory, const FrameRecord& frame, ImageHeader& image) {
  const RecordReader reader{memory};
  TreeRecord tree;
  if (!reader.read(tree, frame.tree_address) || !reader.read(image, frame.image_address) ||
      image.magic != kImageMagic || memory.bytes_at(MainAddress{frame.image_address}, image.image_bytes).empty()) {
    return false;
  }
  return check_tree_counts(AnyFault{}, 0, tree) &&
         for_each_tree_part(tree, [&image](const CountedPart& part) { return lies_in_image(image, part); });
}

/// Whether everything that a frame with effects names lies in memory. The image's header says how many surfaces there
/// are.
[[nodiscard]] bool are_effects_in_memory(SimMemory& memory, const FrameRecord& frame) {
  EffectsRecord effects;
  ImageHeader image;
  if (!RecordReader{memory}.read(effects, frame.effects_address) || !is_tree_in_memory(memory, frame, image)) {
    return false;
  }
  return check_effect_counts(AnyFault{}, 0, effects) &&
         for_each_effect_part(effects, image.triangle_count,
                              [&image](const CountedPart& part) { return lies_in_image(image, part); });
}

[[nodiscard]] bool is_scene_shaded(const FrameRecord& frame) {
  return frame.shading == static_cast<std::uint32_t>(Shading::kScene);
}

/// Whether everything that the grid's part of a frame names lies in memory.
[[nodiscard]] bool is_grid_in_memory(SimMemory& memory, const FrameRecord& frame) {
  const auto lies_in_memory = [&](std::uint64_t begin, std::uint64_t byte_count) {
    return byte_count == 0 || !memory.bytes_at(MainAddress{begin}, byte_count).empty();
  };
  const GridRecord& grid = frame.engine.grid;
  std::uint64_t macro_cells = 1;
  for (const std::uint32_t count : grid.macro_cell_count) {
    if (count > kMaxCellsPerAxis) return false;
    macro_cells *= count;
  }
  // The table is read in whole lines.
  const std::uint64_t table_bytes =
      round_up<std::uint64_t>((macro_cells + 31) / 32 * sizeof(MacroTableEntry), kLineBytes);
  return lies_in_memory(frame.engine.macro_table_address, table_bytes) &&
         lies_in_memory(frame.engine.cell_blocks_address,
                        std::uint64_t{grid.cell_block_count} * grid.cell_block_bytes) &&
         lies_in_memory(frame.engine.triangles_address, std::uint64_t{grid.reference_count} * grid.triangle_bytes);
}

/// Reads the frame record and checks that everything it names lies in memory: the plain mode believes it.
[[nodiscard]] Status describe_frame(SimMemory& memory, MainAddress address, FrameRecord& frame, FrameShape& shape) {
  const std::span<std::byte> bytes = memory.bytes_at(address, sizeof(FrameRecord));
  if (bytes.empty() || address.value % kLineBytes != 0) return Status::kBadFrame;
  std::memcpy(&frame, bytes.data(), sizeof frame);

  GRIDIRON_TRY(find_picture_fault<AnyLayout>(frame).status);
  shape.engine = core_engine(frame.engine_id);
  if (shape.engine == nullptr) return Status::kBadFrame;
  shape.tile_count = frame.tiles_x * frame.tiles_y;
  shape.output_depth = frame.output_depth;
  shape.is_picture = true;

  const std::uint64_t plane_bytes = std::uint64_t{shape.tile_count} * frame.tile_width * frame.tile_width * 4;
  for (const std::uint64_t plane : {frame.color_address, frame.depth_address, frame.id_address}) {
    if (plane == 0) continue;
    if (memory.bytes_at(MainAddress{plane}, plane_bytes).empty()) return Status::kBadFrame;
    shape.writable.push_back({plane, plane + plane_bytes});
  }
  std::sort(shape.writable.begin(), shape.writable.end(),
            [](const MainRange& a, const MainRange& b) { return a.begin < b.begin; });

  if (is_scene_shaded(frame) && !are_effects_in_memory(memory, frame)) return Status::kBadFrame;
  if (shape.engine == &kGridEngine) return is_grid_in_memory(memory, frame) ? Status::kOk : Status::kBadFrame;
  GRIDIRON_TRY(find_tree_fault<AnyLayout>(frame).status);
  ImageHeader image;
  return is_tree_in_memory(memory, frame, image) ? Status::kOk : Status::kBadFrame;
}

/// As render_frame. Errors: throws shortages of the host, and whatever options.progress throws.
[[nodiscard]] ChipResult render_on_host(SimMemory& memory, MainAddress frame, const ChipOptions& asked) {
  ChipResult result;
  const auto refuse = [&](Status status) {
    result.status = status;
    return result;
  };
  FrameRecord record;
  FrameShape shape(kGridEngine);
  const Status described = describe_frame(memory, frame, record, shape);
  if (described != Status::kOk) return refuse(described);
  const bool has_effects = is_scene_shaded(record);
  ChipOptions options = asked;
  if (!has_effects) options.spill = {};
  const LayoutChoice layout = {options.store, record.tile_width, options.packet_width, has_effects};
  if (!is_built(layout, options.mode, options.lanes)) return refuse(Status::kUnsupportedFrame);
  shape.arena_bytes = arena_bytes(options.store);
  const bool uses_host_layout = options.mode == Mode::kPlain && options.lanes > 4;
  const auto take_data_bytes = [&shape, uses_host_layout]<class Layout>() {
    using OnHost = typename decltype(used_layout<Layout, true, 16>())::type;
    shape.data_bytes = uses_host_layout ? sizeof(LocalStore<OnHost>) : sizeof(LocalStore<Layout>);
    if (uses_host_layout) shape.arena_bytes = OnHost::kArenaBytes;
  };
  visit_layout(CommonLayouts{}, layout, take_data_bytes);
  visit_layout(SweepLayouts{}, layout, take_data_bytes);
  visit_layout(EffectLayouts{}, layout, take_data_bytes);
  const LayoutGroup group = group_of(layout);
  if (!are_limits_valid(options.limits) || options.threads == 0 ||
      !is_spill_valid(memory, options.spill, options.threads, shape.writable) ||
      !are_tiles_valid(options.only_tiles, shape.tile_count)) {
    return refuse(Status::kBadParameter);
  }
  const auto given = static_cast<std::uint32_t>(options.only_tiles.size());
  options.threads = std::min(options.threads, given != 0 ? given : shape.tile_count);  // the others would find none

  if (options.mode == Mode::kPlain) {
    const RenderEntry<PlainCore> entry = plain_entry(options, group);
    if (entry == nullptr) return refuse(Status::kUnsupportedFrame);
    return run_plain_cores(memory, shape, options, [&](PlainCore& core, std::span<std::byte> data) {
      return entry(layout, data.data(), core, frame, core.spill());
    });
  }
  const RenderEntry<SimCore> entry = checked_entry(options, group);
  if (entry == nullptr) return refuse(Status::kUnsupportedFrame);
  return run_cores(memory, shape, options, [&](SimCore& core, std::span<std::byte> data) {
    const SpillRegion spill = core.spill();
    if (options.mode == Mode::kInstrumented) {
      const SimCore::AccessScope scope(core, __builtin_frame_address(0));
      return entry(layout, data.data(), core, frame, spill);
    }
    return entry(layout, data.data(), core, frame, spill);
  });
}

}  // namespace

ChipResult ended_by(HostShortage shortage) {
  ChipResult result;
  result.status = Status::kAborted;
  result.host_shortage = shortage;
  return result;
}

ChipResult render_frame(SimMemory& memory, MainAddress frame, const ChipOptions& options) {
  try {
    return render_on_host(memory, frame, options);
  } catch (const std::bad_alloc&) {
    return ended_by(HostShortage::kMemory);
  }
}

bool is_built(const LayoutChoice& layout, Mode mode, std::uint32_t lanes) {
  const LayoutGroup group = group_of(layout);
  if (group == LayoutGroup::kNone) return false;
  if (group == LayoutGroup::kSweep) return mode == Mode::kChecked && lanes == 4;
  if (group == LayoutGroup::kEffects && mode == Mode::kChecked) return lanes == 4;
  if (mode == Mode::kInstrumented) return has_instrumented_mode() && lanes == 4;
  if (lanes == 1) return visit_layout(OneLaneLayouts{}, layout, []<class Layout>() {});
  std::uint32_t most = 16;
  visit_layout(CommonLayouts{}, layout, [&most]<class Layout>() { most = most_lanes<Layout>(); });
  if (lanes > most) return false;
#if defined(GRIDIRON_SIM_WIDE_LANES)
  if (lanes == 8 || lanes == 16) return true;
#endif
  return lanes == 4;
}

std::uint32_t widest_lanes() {
  for (const std::uint32_t lanes : {16u, 8u}) {
    if (host_runs_lanes(lanes)) return lanes;
  }
  return 4;
}

bool has_instrumented_mode() {
#if defined(GRIDIRON_SIM_INSTRUMENTED)
  return true;
#else
  return false;
#endif
}

}  // namespace gridiron::sim
