// Image structures. SPDX-License-Identifier: Apache-2.0
#include "image_structures.h"

#include <gridiron/base/math.h>
#include <gridiron/build/effects/effect_sections.h>

#include "base/words.h"
#include "gridiron/device/configurations.h"

namespace gridiron::tool {
namespace {

std::uint64_t section_bytes(std::uint64_t element_bytes, std::uint64_t element_count) {
  return round_up<std::uint64_t>(element_bytes * element_count, kLineBytes);
}

// The configurations whose eye rays read what the engine reads.
std::string configurations_of(EngineId engine) {
  std::string names;
  for (const Configuration& configuration : configurations()) {
    if (engine_of(configuration) != engine) continue;
    names += (names.empty() ? "" : ", ") + std::string(configuration.name);
  }
  return " (--configuration " + names + ")";
}

}  // namespace

std::uint64_t bytes_of_grid(const GridRecord& grid) {
  return section_bytes(sizeof(GridRecord), 1) +
         section_bytes(sizeof(MacroTableEntry), (macro_cell_total(grid) + 31) / 32) +
         section_bytes(grid.cell_block_bytes, grid.cell_block_count) +
         section_bytes(grid.triangle_bytes, grid.reference_count);
}

StructureBytes structures_of(const SceneImageView& view) {
  StructureBytes bytes;
  if (view.has_grid) bytes.grid = bytes_of_grid(view.grid);
  if (view.has_tree) {
    bytes.tree = sizeof(TreeRecord);
    for_each_tree_part(view.tree, [&bytes](const CountedPart& part) {
      bytes.tree += section_bytes(part.element_bytes, part.element_count);
      return true;
    });
  }
  if (view.has_effects) bytes.effects = place_effect_sections(view.effects, view.header.triangle_count, 0).end_bytes;
  return bytes;
}

std::string words_of_structures(const StructureBytes& bytes) {
  std::string words;
  const auto add = [&words](const char* name, std::uint64_t count, const std::string& readers) {
    if (count != 0) words += (words.empty() ? "" : ", ") + std::string(name) + " " + words_of_bytes(count) + readers;
  };
  add("grid", bytes.grid, configurations_of(EngineId::kGrid));
  add("tree", bytes.tree, configurations_of(EngineId::kTree));
  add("effects", bytes.effects, "");
  return words;
}

}  // namespace gridiron::tool
