// Builds a scene image for a test and reads it the way the kernel does.
// Memory: owns the image. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>

#include "core/build/grid/line_buffer.h"
#include "support/test_headers.h"

namespace gridiron::test {

template <class Record>
Record read_record(std::span<const std::byte> bytes, std::uint64_t offset) {
  Record record{};
  EXPECT_LE(offset + sizeof(Record), bytes.size());
  if (offset + sizeof(Record) <= bytes.size()) std::memcpy(&record, bytes.data() + offset, sizeof(Record));
  return record;
}

/// Calls visit(x, y, z) for every cell of a grid: x fastest, then y, then z.
template <class Visit>
void for_each_cell(const GridRecord& grid, Visit&& visit) {
  for (std::uint32_t z = 0; z < grid.cell_count[2]; ++z) {
    for (std::uint32_t y = 0; y < grid.cell_count[1]; ++y) {
      for (std::uint32_t x = 0; x < grid.cell_count[0]; ++x) visit(x, y, z);
    }
  }
}

/// An image, its view, and the triangle ids of every cell (x fastest, then y, then z), in their stored order.
struct BuiltImage {
  GridNeed need{};
  LineBuffer image;
  SceneImageView view{};
  std::vector<std::vector<std::uint32_t>> cells;

  [[nodiscard]] const std::vector<std::uint32_t>& cell(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return cells[(std::size_t{z} * view.grid.cell_count[1] + y) * view.grid.cell_count[0] + x];
  }
};

/// Ids of every cell, by macro table, block and cell record. Every read is checked against the bytes' end.
inline std::vector<std::vector<std::uint32_t>> read_cells(std::span<const std::byte> bytes,
                                                          const SceneImageView& view) {
  const GridRecord& grid = view.grid;
  const std::uint32_t m = grid.macro_width;
  std::vector<std::vector<std::uint32_t>> cells(std::size_t{grid.cell_count[0]} * grid.cell_count[1] *
                                                grid.cell_count[2]);
  std::size_t index = 0;
  for_each_cell(grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::vector<std::uint32_t>& ids = cells[index++];
    const std::uint64_t macro =
        (std::uint64_t{z / m} * grid.macro_cell_count[1] + y / m) * grid.macro_cell_count[0] + x / m;
    const auto entry =
        read_record<MacroTableEntry>(bytes, view.macro_table_offset_bytes + macro / 32 * sizeof(MacroTableEntry));
    const std::uint32_t bit = 1u << (macro % 32);
    if ((entry.occupied & bit) == 0) return;
    const std::uint64_t block =
        std::uint64_t{entry.first_block} + static_cast<std::uint32_t>(std::popcount(entry.occupied & (bit - 1)));
    const std::uint32_t local = ((z % m) * m + y % m) * m + x % m;
    const std::uint64_t base = view.cell_blocks_offset_bytes + block * grid.cell_block_bytes;
    CellRecord record;
    if (grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
      const auto bound = [&](std::uint32_t i) {
        return read_record<CellBound>(bytes, base + i * sizeof(CellBound)).first_triangle;
      };
      record = {bound(local), bound(local + 1) - bound(local)};
    } else {
      record = read_record<CellRecord>(bytes, base + local * sizeof(CellRecord));
    }
    for (std::uint32_t i = 0; i < record.triangle_count; ++i) {
      const std::uint64_t place = std::uint64_t{record.first_triangle} + i;
      // Every record ends with its id.
      ids.push_back(read_record<std::uint32_t>(
          bytes, view.triangles_offset_bytes + (place + 1) * grid.triangle_bytes - sizeof(std::uint32_t)));
    }
  });
  return cells;
}

/// Counts, builds in exactly the counted memory, opens and reads. `image` is then as long as its header says. Failures
/// are reported to GoogleTest.
inline BuiltImage build_image(const MeshView& mesh, const GridParameters& parameters = {},
                              std::byte fill = std::byte{0xCD}, const EffectsView* effects = nullptr) {
  BuiltImage built;
  EXPECT_EQ(count_scene_image(mesh, parameters, built.need, effects), Status::kOk);
  if (::testing::Test::HasFailure()) return built;
  built.image = LineBuffer(static_cast<std::size_t>(built.need.image_bytes), fill);
  std::vector<std::uint64_t> scratch(static_cast<std::size_t>((built.need.scratch_bytes + 7) / 8));
  EXPECT_EQ(build_scene_image(mesh, parameters, built.need, built.image.bytes(),
                              std::as_writable_bytes(std::span(scratch)), effects),
            Status::kOk);
  SceneImageError error;
  EXPECT_EQ(open_scene_image(built.image.bytes(), built.view, error), Status::kOk)
      << error.field << " at byte " << error.byte_offset;
  if (::testing::Test::HasFailure()) return built;
  EXPECT_LE(built.view.header.image_bytes, built.need.image_bytes);
  EXPECT_TRUE(effects != nullptr || parameters.has_tree || built.view.header.image_bytes == built.need.image_bytes);
  built.image.shrink(static_cast<std::size_t>(built.view.header.image_bytes));
  EXPECT_EQ(built.view.has_grid, parameters.has_grid);
  EXPECT_EQ(built.view.has_tree, effects != nullptr || parameters.has_tree);
  if (built.view.has_grid) built.cells = read_cells(built.image.bytes(), built.view);
  return built;
}

}  // namespace gridiron::test
