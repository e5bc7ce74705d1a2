// Layout choice. SPDX-License-Identifier: Apache-2.0
#include "layout_choice.h"

#include <algorithm>
#include <string>

#include "accuracies.h"
#include "failure.h"
#include "scene_input.h"
#include "store_facts.h"

namespace gridiron::tool {
namespace {

using sim::StoreSize;

[[noreturn]] void usage_error(const std::string& message) {
  throw Failure(ExitCode::kUsage, message);
}

// The layout with a store: what was not asked for is the store's and the configuration's.
sim::LayoutChoice layout_with(const RenderArguments& render, StoreSize store) {
  const AskedLayout& asked = render.asked;
  // Effects out of 64 KB: all rays by walks, without packets.
  if (render.shading == Shading::kScene && store == StoreSize::k64KB) {
    return {store, asked.tile_width != 0 ? asked.tile_width : 8, asked.packet_width, true};
  }
  const std::uint32_t tile_width = asked.tile_width != 0 ? asked.tile_width : sim::usual_tile_width(store);
  // A packet is no wider than a tile.
  const std::uint32_t fitting = std::min(render.scene.configuration->packet_width, tile_width);
  return {store, tile_width, asked.packet_width != 0 ? asked.packet_width : fitting, render.shading == Shading::kScene};
}

std::string words_of_layout(const sim::LayoutChoice& layout) {
  if (layout.packet_width == 0) return "tiles " + std::to_string(layout.tile_width) + " pixels wide and no packets";
  return "tiles " + std::to_string(layout.tile_width) + " pixels wide and packets of " +
         std::to_string(layout.packet_width) + "x" + std::to_string(layout.packet_width);
}

// Why a layout has no kernel, and which ones of its store have.
[[noreturn]] void refuse_layout(const sim::LayoutChoice& layout) {
  const std::string store = "--store " + std::to_string(sim::arena_bytes(layout.store) >> 10);
  const std::string shading = layout.has_effects ? ", --shading scene" : "";
  if (sim::is_built(layout, sim::Mode::kChecked, 4)) {
    usage_error(store + shading + ": with " + words_of_layout(layout) +
                (layout.has_effects ? " --mode checked and instrumented are built for --lanes 4 only"
                                    : " it is built for --mode checked and --lanes 4 only"));
  }
  std::string list;
  for (const sim::LayoutChoice& built : built_layouts()) {
    if (built.store == layout.store && built.has_effects == layout.has_effects) {
      list += (list.empty() ? "" : "; ") + words_of_layout(built);
    }
  }
  if (list.empty())
    usage_error(store + shading + ": effects need a local store of 64 or 256 KB; --shading simple does without them");
  usage_error(store + shading + ": not built for " + words_of_layout(layout) + "; there are " + list);
}

void require_packet_in_tile(const sim::LayoutChoice& layout) {
  if (layout.packet_width <= layout.tile_width) return;
  usage_error("--packet: tiles are " + std::to_string(layout.tile_width) + " pixels wide");
}

void choose_store(RenderArguments& render) {
  require_room(*render.scene.machine, render.asked.store);
  const std::uint32_t room_bytes = render.scene.machine->local_store_bytes;
  sim::LayoutChoice layout = layout_with(render, render.asked.store.value_or(largest_store(*render.scene.machine)));
  const auto is_built = [&render](const sim::LayoutChoice& choice) {
    return sim::is_built(choice, render.mode, render.lanes);
  };
  if (!render.asked.store && !is_built(layout)) {
    for (const StoreSize store : sim::kStoreSizes) {
      const sim::LayoutChoice smaller = layout_with(render, store);
      if (sim::arena_bytes(store) <= room_bytes && is_built(smaller)) layout = smaller;
    }
  }
  require_packet_in_tile(layout);
  if (!is_built(layout)) refuse_layout(layout);
  render.store = layout.store;
  render.tile_width = layout.tile_width;
  render.packet_width = layout.packet_width;
}

void choose_depths(RenderArguments& render) {
  const Configuration& configuration = *render.scene.configuration;
  const StoreFacts facts = *find_store_facts(render.layout());
  render.depths = render.wanted_depths = render.asked.depths.value_or(configuration.depths);
  if (!render.asked.depths) {  // a name promises a way of rendering; how deep it goes is the store's to say
    render.depths.output = std::min(render.depths.output, facts.max_output_depth);
    render.depths.macro = std::min(render.depths.macro, facts.max_macro_depth);
    render.depths.triangle = std::min(render.depths.triangle, facts.max_triangle_depth);
    if (render.shading == Shading::kScene) render.depths.walks = std::min(render.depths.walks, facts.max_walks);
  }
  if (render.shading == Shading::kScene) render.scene.most_macro_width = facts.max_macro_width;
  const std::uint32_t macro_width =
      render.scene.macro_width.value_or(std::min(configuration.macro_width, render.scene.most_macro_width));
  if (render.depths.output > facts.max_output_depth || render.depths.macro > facts.max_macro_depth ||
      render.depths.triangle > facts.max_triangle_depth || macro_width > facts.max_macro_width) {
    const auto blocks = [](std::uint32_t depth, std::uint32_t width, std::uint32_t buffers) {
      return std::to_string(depth) + " cell blocks of macrocells of width " + std::to_string(width) + " and " +
             std::to_string(buffers) + " triangle buffers";
    };
    usage_error("--store " + std::to_string(facts.arena_bytes >> 10) +
                (render.shading == Shading::kScene ? ", --shading scene" : "") + ": holds at most " +
                blocks(facts.max_macro_depth, facts.max_macro_width, facts.max_triangle_depth) + "; " +
                blocks(render.depths.macro, macro_width, render.depths.triangle) + " are asked for");
  }
}

void require_effects_of(std::optional<Accuracy> accuracy) {
  if (!accuracy || accuracy_traits(*accuracy).has_scene_shading) return;
  usage_error("--accuracy " + std::string(accuracy_name(*accuracy)) +
              ": has no --shading scene; shadows and reflections need distances that hold");
}

// The layout that info tells of, built or not.
sim::LayoutChoice layout_with(const InfoArguments& info, StoreSize store, bool has_effects) {
  const std::uint32_t usual = info.scene.configuration->packet_width;
  if (has_effects && store == StoreSize::k64KB) return {store, 8, info.packet_width, true};
  if (has_effects) return {StoreSize::k256KB, 32, info.packet_width != 0 ? info.packet_width : usual, true};
  const std::uint32_t tile_width = sim::usual_tile_width(store);
  return {store, tile_width, info.packet_width != 0 ? info.packet_width : std::min(usual, tile_width)};
}

}  // namespace

void settle_layout(InfoArguments& info, bool has_effects) {
  const std::optional<StoreSize> asked = info.asked_store;
  if (has_effects) require_effects_of(info.accuracy);
  require_room(*info.scene.machine, asked);
  info.store = asked.value_or(largest_store(*info.scene.machine));
  const auto is_built = [&info, has_effects](StoreSize store) {
    return find_store_facts(layout_with(info, store, has_effects)).has_value();
  };
  if (!asked && !is_built(info.store)) {
    for (const StoreSize store : sim::kStoreSizes) {
      if (sim::arena_bytes(store) <= info.scene.machine->local_store_bytes && is_built(store)) info.store = store;
    }
  }
  (void)info_layout(info, has_effects);
}

sim::LayoutChoice info_layout(const InfoArguments& info, bool has_effects) {
  const sim::LayoutChoice layout = layout_with(info, info.store, has_effects);
  require_packet_in_tile(layout);
  if (!find_store_facts(layout)) refuse_layout(layout);
  require_distances(layout, info.has_depth);
  return layout;
}

void require_distances(const sim::LayoutChoice& layout, bool has_depth) {
  if (!has_depth || !layout.has_effects || layout.packet_width != 0) return;
  usage_error("--depth: a local store of 64 KB (--store 64) has no distances with --shading scene; 256 KB have them");
}

void require_room(const sim::MachineProfile& machine, std::optional<StoreSize> asked) {
  if (asked && sim::arena_bytes(*asked) > machine.local_store_bytes) {
    usage_error("--store: " + std::string(machine.name) + " has a local store of " +
                std::to_string(machine.local_store_bytes >> 10) + " KB");
  }
}

void settle_layout(RenderArguments& render) {
  if (render.shading == Shading::kScene) require_effects_of(render.accuracy);
  choose_store(render);
  require_distances(render.layout(), render.has_depth());
  choose_depths(render);
}

}  // namespace gridiron::tool
