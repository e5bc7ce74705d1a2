// Layout choice. SPDX-License-Identifier: Apache-2.0
#include "layout_choice.h"

#include <gridiron/sim/view_bound.h>

#include <algorithm>
#include <string>

#include "accuracies.h"
#include "base/failure.h"
#include "machine_file.h"
#include "store_facts.h"

namespace gridiron::tool {
namespace {

using sim::StoreSize;

std::string words_of_layout(const sim::LayoutChoice& layout) {
  if (layout.packet_width == 0) return "tiles " + std::to_string(layout.tile_width) + " pixels wide and no packets";
  return "tiles " + std::to_string(layout.tile_width) + " pixels wide and packets of " +
         std::to_string(layout.packet_width) + "x" + std::to_string(layout.packet_width);
}

// Reports that a layout has no kernel, and which ones of its store have.
[[noreturn]] void refuse_layout(const sim::LayoutChoice& layout, const Configuration& configuration) {
  const std::string store = "--store " + std::to_string(sim::arena_bytes(layout.store) >> 10);
  const std::string shading = layout.has_effects ? ", --shading scene" : "";
  if (sim::is_built(layout, sim::Mode::kPlain, 4)) {
    std::string lanes;
    for (const std::uint32_t count : {1u, 4u, 8u, 16u}) {
      if (sim::is_built(layout, sim::Mode::kPlain, count)) lanes += (lanes.empty() ? "" : ", ") + std::to_string(count);
    }
    usage_error("--lanes: " + store + shading + " with " + words_of_layout(layout) + " is built for --lanes " + lanes +
                (layout.has_effects ? ", of which --mode checked and instrumented have 4"
                                    : ", of which --mode instrumented has 4"));
  }
  if (sim::is_built(layout, sim::Mode::kChecked, 4)) {
    usage_error(store + shading + ": with " + words_of_layout(layout) +
                " it is built for --mode checked and --lanes 4 only");
  }
  std::string list;
  for (const sim::LayoutChoice& built : built_layouts()) {
    const bool is_near = built.store == layout.store && built.has_effects == layout.has_effects;
    if (is_near && (configuration.has_grid() || built.packet_width == 0)) {
      list += (list.empty() ? "" : "; ") + words_of_layout(built);
    }
  }
  if (list.empty() && layout.has_effects)
    usage_error(store + shading + ": effects need a local store of 64 or 256 KB; --shading simple does without them");
  usage_error(store + shading + ": not built for " + words_of_layout(layout) + "; there are " + list +
              (configuration.has_grid() ? "" : "; --configuration grid has other tiles, and packets"));
}

}  // namespace

sim::LayoutChoice layout_with(const LayoutRequest& asked, const Configuration& configuration, StoreSize store,
                              bool has_effects) {
  // Effects with 64 KB: all rays by lists, without packets.
  if (has_effects && store == StoreSize::k64KB) {
    return {store, asked.tile_width.value_or(8), asked.packet_width.value_or(0), true};
  }
  // Eye rays through the tree, without packets.
  if (!configuration.has_grid() && !has_effects) {
    return {store, asked.tile_width.value_or(tree_tile_width(store)), asked.packet_width.value_or(0)};
  }
  const std::uint32_t tile_width = asked.tile_width.value_or(sim::usual_tile_width(store));
  // A packet is no wider than a tile.
  const std::uint32_t fitting = std::min(configuration.packet_width, tile_width);
  return {store, tile_width, asked.packet_width.value_or(fitting), has_effects};
}

StoreSize choose_store(const sim::MachineProfile& machine, std::optional<StoreSize> asked,
                       const std::function<bool(StoreSize)>& is_built) {
  const auto has_room = [&machine](StoreSize store) { return sim::arena_bytes(store) <= machine.local_store_bytes; };
  if (asked && !has_room(*asked)) {
    usage_error("--store: " + std::string(machine.name) + " has a local store of " +
                std::to_string(machine.local_store_bytes >> 10) + " KB");
  }
  StoreSize chosen = asked.value_or(largest_store(machine));
  if (asked || is_built(chosen)) return chosen;
  for (const StoreSize store : sim::kEveryStoreSize) {
    if (store == StoreSize::k16KB) continue;  // without a grid and effects: only where it is all there is, or asked for
    if (has_room(store) && is_built(store)) chosen = store;
  }
  return chosen;
}

bool has_best_kernel(const sim::MachineProfile& machine, std::optional<StoreSize> asked, bool has_effects,
                     const std::function<bool(const sim::LayoutChoice&)>& is_built) {
  const auto has_kernel = [&](StoreSize store) {
    return is_built(layout_with({}, default_configuration({}), store, has_effects));
  };
  return has_kernel(choose_store(machine, asked, has_kernel));
}

void require_grid_for(const Configuration& configuration, std::span<const GridOption> options, const char* projection) {
  if (configuration.has_grid()) return;
  const std::string name = "configuration " + std::string(configuration.name);
  for (const GridOption& option : options) {
    if (!option.is_given) continue;
    usage_error(std::string(option.name) + ": " + name +
                " has no grid and no packets; --configuration grid, reference and deep have");
  }
  if (projection != nullptr) {
    usage_error(std::string(projection) + ": " + name +
                " has no triangles for it; --configuration reference and grid have");
  }
}

void require_built(const sim::LayoutChoice& layout, const Configuration& configuration, bool is_built) {
  if (layout.packet_width > layout.tile_width) {
    usage_error("--packet: tiles are " + std::to_string(layout.tile_width) + " pixels wide");
  }
  if (!is_built) refuse_layout(layout, configuration);
}

void require_distances(const sim::LayoutChoice& layout, bool has_depth) {
  if (!has_depth || !layout.has_effects || layout.store != StoreSize::k64KB) return;
  usage_error("--depth: --shading scene has no distances with " + words_of_layout(layout) +
              ", which are those of a 64 KB store; --store 256 without --tile-width and --packet has them");
}

void require_view_bound(const char* option, EngineId engine, const sim::LayoutChoice& layout, Accuracy accuracy,
                        bool has_depth) {
  FrameHead head{};
  head.engine_id = static_cast<std::uint32_t>(engine);
  head.tile_width = layout.tile_width;
  head.accuracy = static_cast<std::uint32_t>(accuracy);
  head.shading = static_cast<std::uint32_t>(layout.has_effects ? Shading::kScene : Shading::kSimple);
  head.depth_address = has_depth ? 1 : 0;
  if (sim::has_view_bound(head, layout.store)) return;
  const char* const reason = layout.has_effects          ? "--shading scene"
                             : engine != EngineId::kTree ? "a configuration other than best"
                             : has_depth                 ? "--depth"
                             : accuracy == Accuracy::kCompact
                                 ? "--accuracy compact"
                                 : "a local store or tiles of another size than the default";
  usage_error(std::string(option) + ": tiles have no bound for a view with " + reason);
}

void require_effects_of(std::optional<Accuracy> accuracy) {
  if (!accuracy || accuracy_traits(*accuracy).has_scene_shading) return;
  usage_error("--accuracy " + std::string(accuracy_name(*accuracy)) +
              ": has no --shading scene; shadows and reflections need distances that hold");
}

}  // namespace gridiron::tool
