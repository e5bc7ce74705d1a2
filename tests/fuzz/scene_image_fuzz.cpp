// Fuzzes the scene image loader: any bytes, as they are and with the check value made right. What the loader accepts is
// read the way the kernel reads it, under the sanitizers. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "core/build/grid/line_buffer.h"
#include "core/build/tree/tree_scene.h"
#include "core/image/effects_oracle.h"
#include "core/image/tree_oracle.h"
#include "core/scene/test_effects.h"

namespace gridiron::test {
namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "accepted an image in which %s\n", what);
  std::abort();
}

template <class Record>
Record read(std::span<const std::byte> bytes, std::uint64_t offset) {
  require(offset <= bytes.size() && sizeof(Record) <= bytes.size() - offset, "a record lies outside");
  Record record;
  std::memcpy(&record, bytes.data() + offset, sizeof(Record));
  return record;
}

// Every macrocell, block, cell and triangle; every record of effects; the tree along every path.
void read_all(std::span<const std::byte> bytes, const SceneImageView& view) {
  const GridRecord& grid = view.grid;
  require(view.has_grid || view.has_tree, "nothing can be traced");
  const std::uint64_t macro_cells =
      view.has_grid ? std::uint64_t{grid.macro_cell_count[0]} * grid.macro_cell_count[1] * grid.macro_cell_count[2] : 0;
  const std::uint64_t cells = std::uint64_t{grid.macro_width} * grid.macro_width * grid.macro_width;
  std::uint64_t references = 0;
  for (std::uint64_t macro_cell = 0; macro_cell < macro_cells; ++macro_cell) {
    const auto entry =
        read<MacroTableEntry>(bytes, view.macro_table_offset_bytes + macro_cell / 32 * sizeof(MacroTableEntry));
    const std::uint32_t bit = 1u << (macro_cell % 32);
    if ((entry.occupied & bit) == 0) continue;
    const std::uint64_t block =
        std::uint64_t{entry.first_block} + static_cast<std::uint32_t>(std::popcount(entry.occupied & (bit - 1)));
    require(block >= 1 && block < grid.cell_block_count, "a block does not exist");
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
      const std::uint64_t base = view.cell_blocks_offset_bytes + block * grid.cell_block_bytes;
      CellRecord record;
      if (grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
        const auto bound = [&](std::uint64_t i) {
          return read<CellBound>(bytes, base + i * sizeof(CellBound)).first_triangle;
        };
        record = {bound(cell), bound(cell + 1) - bound(cell)};
      } else {
        record = read<CellRecord>(bytes, base + cell * sizeof(CellRecord));
      }
      for (std::uint64_t i = 0; i < record.triangle_count; ++i) {
        const std::uint64_t place = record.first_triangle + i;
        const auto triangle_id = read<std::uint32_t>(
            bytes, view.triangles_offset_bytes + (place + 1) * grid.triangle_bytes - sizeof(std::uint32_t));
        require(triangle_id < view.header.triangle_count, "a triangle does not exist");
        ++references;
      }
    }
  }
  require(references == grid.reference_count, "references are miscounted");
  const std::span<const std::byte> image = bytes.first(static_cast<std::size_t>(view.header.image_bytes));
  const char* const broken = broken_effects(image, view);
  require(broken == nullptr, broken);
  const char* const broken_nodes = broken_tree(image, view);
  require(broken_nodes == nullptr, broken_nodes);
}

// A valid image, where it fits. @returns its size, else 0.
std::size_t write_image(std::uint8_t* data, std::size_t max_size, const MeshView& mesh,
                        const GridParameters& parameters, const EffectsView* effects) {
  GridNeed need{};
  if (count_scene_image(mesh, parameters, need, effects) != Status::kOk) return 0;
  LineBuffer image(static_cast<std::size_t>(need.image_bytes));
  std::vector<std::uint64_t> scratch(static_cast<std::size_t>((need.scratch_bytes + 7) / 8));
  const Status status =
      build_scene_image(mesh, parameters, need, image.bytes(), std::as_writable_bytes(std::span(scratch)), effects);
  if (status != Status::kOk) std::abort();
  ImageHeader header;
  std::memcpy(&header, image.bytes().data(), sizeof(header));
  const auto bytes = static_cast<std::size_t>(header.image_bytes);
  if (bytes > max_size) return 0;
  std::memcpy(data, image.bytes().data(), bytes);
  return bytes;
}

// A scene with effects; bits of the seed leave optional parts out.
std::size_t write_image_with_effects(std::uint8_t* data, std::size_t max_size, unsigned seed) {
  TestEffects scene = all_effects(seed % 4);
  if ((seed & 4) != 0) scene.lights.clear();
  if ((seed & 8) != 0) scene.triangle_materials.assign(scene.triangles.size(), 0);
  if ((seed & 8) != 0) scene.triangle_normals.clear();
  if ((seed & 16) != 0) scene.settings.occlusion_samples = 0;
  if ((seed & 32) != 0) scene.settings.recursion_depth = 1;
  const TriangleFormat format = (seed & 64) != 0 ? TriangleFormat::kVertices : TriangleFormat::kLattice;
  const EffectsView view = scene.view();
  const GridParameters parameters{
      .lambda = 2.0f, .macro_width = 1 + (seed >> 8) % 3, .format = format, .has_grid = (seed & 128) != 0};
  return write_image(data, max_size, scene.mesh(), parameters, &view);
}

// A scene without lights, or without effects, whose tree has several nodes, with a grid or without.
std::size_t write_image_with_nodes(std::uint8_t* data, std::size_t max_size, unsigned seed) {
  const TestEffects scene = tree_scene(1 + seed % 32);
  const TriangleFormat format = (seed & 64) != 0 ? TriangleFormat::kVertices : TriangleFormat::kLattice;
  const EffectsView view = scene.view();
  const GridParameters parameters{.lambda = 1e-6f,
                                  .macro_width = 1,
                                  .format = format,
                                  .leaf_triangles = 1 + (seed >> 8) % 2,
                                  .has_tree = true,
                                  .has_grid = (seed & 128) != 0};
  return write_image(data, max_size, scene.mesh(), parameters, (seed & 512) != 0 ? &view : nullptr);
}

// Changes one word of the sections of effects and tree to what floats, counts and offsets are worst at, or by one bit:
// blind changes meet grid and cells, which refuse nearly all. @returns whether there are any.
bool change_effects(std::span<std::byte> bytes, unsigned seed) {
  if (bytes.size() < 2 * kLineBytes) return false;
  ImageHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::uint64_t table = header.section_table_offset_bytes;
  SectionEntry found{};
  std::uint32_t pick = seed % 10;
  for (std::uint32_t i = 0; i < header.section_count && i < kMaxSectionCount; ++i) {
    SectionEntry entry;
    if (table + (i + 1) * sizeof(entry) > bytes.size()) break;
    std::memcpy(&entry, bytes.data() + table + i * sizeof(entry), sizeof(entry));
    const bool of_effects = entry.kind >= static_cast<std::uint32_t>(SectionKind::kEffects) &&
                            entry.kind < static_cast<std::uint32_t>(SectionKind::kEnd);
    const bool inside = entry.section_bytes >= 4 && entry.offset_bytes <= bytes.size() &&
                        entry.section_bytes <= bytes.size() - entry.offset_bytes;
    if (!of_effects || !inside) continue;
    found = entry;
    if (pick-- == 0) break;
  }
  if (found.section_bytes == 0) return false;
  const std::uint32_t worst[] = {0u, 1u, 0x7F800000u, 0x7FC00000u, 0xFFFFFFFFu, 0x7F7FFFFFu, 0x80000000u, 0x3F800001u};
  const std::uint64_t words = found.section_bytes / 4;
  std::byte* const place = bytes.data() + found.offset_bytes + (seed >> 8) % words * 4;
  std::uint32_t word;
  std::memcpy(&word, place, sizeof(word));
  word = seed % 2 == 0 ? worst[seed / 2 % 8] : word ^ (1u << (seed / 2 % 32));
  std::memcpy(place, &word, sizeof(word));
  return true;
}

// A valid image of a few triangles, so that the search needs no seeds. @returns its size, 0 where it does not fit.
std::size_t write_valid_image(std::uint8_t* data, std::size_t max_size, unsigned seed) {
  const std::uint32_t triangle_count = 1 + seed % 5;
  Vec3 vertices[15];
  UVec3 triangles[5];
  std::uint32_t state = seed;
  for (Vec3& vertex : vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      state = state * 1664525u + 1013904223u;
      vertex[axis] = static_cast<float>(state >> 16) / 4096.0f;
    }
  }
  for (std::uint32_t i = 0; i < triangle_count; ++i) triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
  const MeshView mesh{vertices, {triangles, triangle_count}};
  const GridParameters parameters{2.0f, 1 + (seed >> 8) % kMaxMacroWidth,
                                  (seed >> 16) % 2 == 0 ? TriangleFormat::kVertices : TriangleFormat::kProjection};
  return write_image(data, max_size, mesh, parameters, nullptr);
}

void open(std::span<const std::byte> bytes) {
  SceneImageView view{};
  SceneImageError error;
  if (open_scene_image(bytes, view, error) == Status::kOk) {
    read_all(bytes, view);
  } else {
    require(error.field[0] != '\0' && error.byte_offset <= bytes.size(), "the error names no place");
  }
}

}  // namespace
}  // namespace gridiron::test

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  if (size < sizeof(gridiron::ImageHeader) || seed % 64 == 0) {
    using gridiron::test::write_image_with_effects, gridiron::test::write_image_with_nodes,
        gridiron::test::write_valid_image;
    const auto write = seed / 64 % 2 == 0    ? write_valid_image
                       : seed / 128 % 2 == 0 ? write_image_with_effects
                                             : write_image_with_nodes;
    const std::size_t valid = write(data, max_size, seed / 256);
    if (valid != 0) return valid;
  }
  if (seed % 4 == 1 && gridiron::test::change_effects(std::as_writable_bytes(std::span(data, size)), seed / 4)) {
    return size;
  }
  return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridiron;
  // A right size and check value at first, so that the search starts behind them; then the bytes as they came.
  const std::size_t whole = size / kLineBytes * kLineBytes;
  test::LineBuffer repaired(whole);
  if (whole != 0) {
    std::memcpy(repaired.bytes().data(), data, whole);
    ImageHeader header;
    std::memcpy(&header, repaired.bytes().data(), sizeof(header));
    header.image_bytes = whole;
    std::memcpy(repaired.bytes().data(), &header, sizeof(header));
    header.check_value = scene_image_check_value(repaired.bytes());
    std::memcpy(repaired.bytes().data(), &header, sizeof(header));
    test::open(repaired.bytes());
  }
  test::LineBuffer as_is(size);
  if (size != 0) std::memcpy(as_is.bytes().data(), data, size);
  test::open(as_is.bytes());
  return 0;
}
