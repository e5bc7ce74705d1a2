// Images without a grid: the tree alone, with effects or without, in less memory. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>

#include "core/build/tree/tree_image.h"
#include "core/image/tree_oracle.h"

namespace gridiron::test {
namespace {

constexpr TriangleFormat kFormats[] = {TriangleFormat::kVertices, TriangleFormat::kLattice};

GridParameters tree_alone(TriangleFormat format = TriangleFormat::kVertices) {
  return {.format = format, .leaf_triangles = 4, .has_tree = true, .has_grid = false};
}

std::vector<SectionEntry> entries_of(const BuiltImage& built) {
  std::vector<SectionEntry> entries;
  const ImageHeader& header = built.view.header;
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    entries.push_back(
        read_record<SectionEntry>(built.image.bytes(), header.section_table_offset_bytes + i * sizeof(SectionEntry)));
  }
  return entries;
}

std::span<const std::byte> section_of(const BuiltImage& built, const SectionEntry& entry) {
  return std::span<const std::byte>(built.image.bytes()).subspan(entry.offset_bytes, entry.section_bytes);
}

bool is_of_grid(const SectionEntry& entry) {
  return entry.kind <= 4;
}

// Builds the image with and without a grid. The sections that both have are the same bytes but for offsets.
void expect_alike(const MeshView& mesh, TriangleFormat format, const EffectsView* effects) {
  GridParameters with_grid = tree_alone(format);
  with_grid.has_grid = true;
  const BuiltImage both = build_image(mesh, with_grid, std::byte{0xCD}, effects);
  const BuiltImage alone = build_image(mesh, tree_alone(format), std::byte{0xCD}, effects);
  ASSERT_FALSE(::testing::Test::HasFailure());
  EXPECT_STREQ(broken_tree(alone.image.bytes(), alone.view), nullptr);
  std::vector<SectionEntry> wanted = entries_of(both);
  std::uint64_t grid_bytes = 0;
  for (const SectionEntry& entry : wanted) grid_bytes += is_of_grid(entry) ? entry.section_bytes : 0;
  std::erase_if(wanted, is_of_grid);
  const std::vector<SectionEntry> entries = entries_of(alone);
  ASSERT_EQ(entries.size(), wanted.size());
  ASSERT_EQ(both.view.header.section_count, wanted.size() + 4);
  std::uint64_t next = 128 + (entries.size() * sizeof(SectionEntry) + 127) / 128 * 128;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i].kind, wanted[i].kind);
    EXPECT_EQ(entries[i].offset_bytes, next) << "without gaps";
    EXPECT_EQ(entries[i].element_count, wanted[i].element_count);
    next += entries[i].section_bytes;
    const bool has_offsets = entries[i].kind == static_cast<std::uint32_t>(SectionKind::kTree) ||
                             entries[i].kind == static_cast<std::uint32_t>(SectionKind::kEffects);
    EXPECT_TRUE(has_offsets || std::ranges::equal(section_of(alone, entries[i]), section_of(both, wanted[i])))
        << "kind " << entries[i].kind;
  }
  EXPECT_EQ(next, alone.view.header.image_bytes);
  TreeRecord tree = both.view.tree;
  tree.nodes_offset_bytes = alone.view.tree.nodes_offset_bytes;
  tree.triangles_offset_bytes = alone.view.tree.triangles_offset_bytes;
  EXPECT_EQ(std::memcmp(&tree, &alone.view.tree, sizeof tree), 0);
  EXPECT_EQ(alone.view.effects.called_for, both.view.effects.called_for);
  EXPECT_EQ(alone.view.header.dropped_triangle_count, both.view.header.dropped_triangle_count);

  const std::uint64_t table_bytes = entries_of(both)[0].offset_bytes - entries[0].offset_bytes;
  EXPECT_EQ(both.view.header.image_bytes - alone.view.header.image_bytes, grid_bytes + table_bytes);
  EXPECT_EQ(both.need.image_bytes - alone.need.image_bytes, grid_bytes + table_bytes);
  EXPECT_EQ(alone.need.scratch_bytes, tree_scratch_bytes(mesh.triangles.size()));
}

TEST(TreeAlone, HasTheSectionsOfAnImageWithAGridButForTheGrid) {
  for (const TriangleFormat format : kFormats) {
    expect_alike(tree_scene(300).mesh(), format, nullptr);
    const TestEffects scenes[] = {tree_scene(300), all_effects()};
    for (const TestEffects& scene : scenes) {
      const EffectsView view = scene.view();
      expect_alike(scene.mesh(), format, &view);
    }
  }
}

// A view without a grid says so; what it has in its place is one cell that holds nothing.
TEST(TreeAlone, ViewsHaveAnEmptyGridOfTheTree) {
  for (const TriangleFormat format : kFormats) {
    const BuiltImage built = build_image(tree_scene(100).mesh(), tree_alone(format));
    ASSERT_FALSE(HasFailure());
    const SceneImageView& view = built.view;
    EXPECT_FALSE(view.has_grid);
    EXPECT_TRUE(view.has_tree);
    EXPECT_EQ(view.macro_table_offset_bytes + view.cell_blocks_offset_bytes + view.triangles_offset_bytes, 0u);
    EXPECT_EQ(view.grid.reference_count + view.grid.cell_block_count, 0u);
    EXPECT_EQ(view.grid.triangle_format, static_cast<std::uint32_t>(format));
    EXPECT_EQ(std::memcmp(&view.grid.lattice, &view.tree.lattice, sizeof(Lattice)), 0);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(view.grid.cell_count[axis], 1u);
      EXPECT_EQ(view.grid.bounds_minimum[axis], view.tree.bounds_minimum[axis]);
      EXPECT_EQ(view.grid.bounds_maximum[axis], view.tree.bounds_maximum[axis]);
    }
    EXPECT_EQ(std::memcmp(&view.grid, &built.need.grid, sizeof(GridRecord)), 0) << "as it was counted";
  }
}

TEST(TreeAlone, NeedsNothingOfAGrid) {
  const TestEffects scene = tree_scene(500);
  GridParameters parameters = tree_alone();
  GridNeed need{}, finer{}, fitting{};
  ASSERT_EQ(count_scene_image(scene.mesh(), parameters, need), Status::kOk);
  EXPECT_EQ(need.steps.sweep_count, 0u);
  EXPECT_EQ(need.steps.row_count + need.steps.swept_row_count, 0u);
  parameters.lambda = 1e6f;
  parameters.macro_width = 8;
  ASSERT_EQ(count_scene_image(scene.mesh(), parameters, finer), Status::kOk);
  EXPECT_EQ(std::memcmp(&need.grid, &finer.grid, sizeof(GridRecord)), 0);
  EXPECT_EQ(need.image_bytes, finer.image_bytes);
  ASSERT_EQ(fit_scene_image(scene.mesh(), parameters, need.image_bytes, fitting), Status::kOk);
  EXPECT_EQ(fitting.image_bytes, need.image_bytes);
  // A line for the header, one for the table, then the tree.
  const std::uint64_t kept = scene.triangles.size() - need.dropped_triangle_count;
  EXPECT_EQ(need.image_bytes, 3 * 128 + (48 * kept + 127) / 128 * 128 + 512 * most_tree_nodes(kept, 4));
}

TEST(TreeAlone, EachByteLessIsRefused) {
  const TestEffects scene = tree_scene(2000);
  const EffectsView view = scene.view();
  for (const EffectsView* effects : {&view, static_cast<const EffectsView*>(nullptr)}) {
    const GridParameters parameters = tree_alone();
    GridNeed need{}, less{};
    ASSERT_EQ(count_scene_image(scene.mesh(), parameters, need, effects), Status::kOk);
    EXPECT_EQ(count_scene_image(scene.mesh(), parameters, less, effects, need.image_bytes), Status::kOk);
    EXPECT_EQ(count_scene_image(scene.mesh(), parameters, less, effects, need.image_bytes - 1),
              Status::kMemoryTooSmall);
    EXPECT_EQ(less.image_bytes, need.image_bytes);
    less = {};
    EXPECT_EQ(fit_scene_image(scene.mesh(), parameters, need.image_bytes - 1, less, effects), Status::kOk);
    EXPECT_EQ(less.image_bytes, need.image_bytes) << "nothing makes it smaller";

    LineBuffer image(need.image_bytes + 4096, std::byte{0xAB});
    std::vector<std::uint64_t> words(need.scratch_bytes / 8);
    const std::span<std::byte> scratch = std::as_writable_bytes(std::span(words));
    const auto status = [&](std::uint64_t image_bytes, std::uint64_t scratch_bytes) {
      return build_scene_image(scene.mesh(), parameters, need, image.bytes().first(image_bytes),
                               scratch.first(scratch_bytes), effects);
    };
    EXPECT_EQ(status(need.image_bytes - 1, need.scratch_bytes), Status::kMemoryTooSmall);
    EXPECT_EQ(status(need.image_bytes, need.scratch_bytes - 1), Status::kMemoryTooSmall);
    EXPECT_TRUE(std::ranges::all_of(image.bytes(), [](std::byte byte) { return byte == std::byte{0xAB}; }));
    EXPECT_EQ(status(need.image_bytes, need.scratch_bytes), Status::kOk);
    for (std::uint64_t i = need.image_bytes; i < image.bytes().size(); ++i) {
      ASSERT_EQ(image.bytes()[i], std::byte{0xAB}) << "written behind the image";
    }
  }
}

// --- Errors -------------------------------------------------------------------------------------------------------

TEST(TreeAloneErrors, AnImageHoldsAGridOrATree) {
  const TestEffects scene = tree_scene(20);
  const EffectsView view = scene.view();
  GridParameters parameters = tree_alone();
  parameters.has_tree = false;
  GridNeed need{};
  EXPECT_EQ(count_scene_image(scene.mesh(), parameters, need), Status::kBadParameter);
  EXPECT_EQ(fit_scene_image(scene.mesh(), parameters, kAnyImageBytes, need), Status::kBadParameter);
  EXPECT_EQ(build_scene_image(scene.mesh(), parameters, need, {}, {}), Status::kBadParameter);
  EXPECT_EQ(count_scene_image(scene.mesh(), parameters, need, &view), Status::kOk) << "effects have a tree";
  parameters = tree_alone(TriangleFormat::kProjection);
  EXPECT_EQ(count_scene_image(scene.mesh(), parameters, need), Status::kBadParameter);
}

// What was counted with a grid is not built without, nor the other way round.
TEST(TreeAloneErrors, ANeedIsOfTheSameParts) {
  const TestEffects scene = tree_scene(100);
  const GridParameters alone = tree_alone();
  GridParameters both = alone;
  both.has_grid = true;
  for (const bool is_counted_alone : {true, false}) {
    GridNeed need{};
    ASSERT_EQ(count_scene_image(scene.mesh(), is_counted_alone ? alone : both, need), Status::kOk);
    need.grid.lambda = both.lambda;
    need.grid.macro_width = both.macro_width;
    LineBuffer image(need.image_bytes + 65536);
    std::vector<std::uint64_t> words(need.scratch_bytes / 8);
    EXPECT_EQ(build_scene_image(scene.mesh(), is_counted_alone ? both : alone, need, image.bytes(),
                                std::as_writable_bytes(std::span(words))),
              Status::kBadParameter);
  }
}

TEST(TreeAloneErrors, AnotherMeshThanTheCountedOne) {
  TestEffects scene = tree_scene(100);
  GridNeed need{};
  ASSERT_EQ(count_scene_image(scene.mesh(), tree_alone(), need), Status::kOk);
  LineBuffer image(need.image_bytes);
  std::vector<std::uint64_t> words(need.scratch_bytes / 8);
  const auto status = [&] {
    return build_scene_image(scene.mesh(), tree_alone(), need, image.bytes(), std::as_writable_bytes(std::span(words)));
  };
  EXPECT_EQ(status(), Status::kOk);
  const Vec3 corner = scene.vertices[0];
  scene.vertices[0] = scene.vertices[1];
  EXPECT_EQ(status(), Status::kBadParameter) << "one more has no area";
  scene.vertices[0] = corner + Vec3(9, 0, 0);
  EXPECT_EQ(status(), Status::kBadParameter) << "beyond the bounds that were counted";
}

// Lights and rays of ambient occlusion have the limits that they have in a grid of one cell.
TEST(TreeAloneErrors, LightsAreInReach) {
  TestEffects scene = tree_scene(40);
  for (Vec3& vertex : scene.vertices) vertex = 0x1p-90f * vertex;
  scene.lights.resize(1);
  scene.lights[0].color = {1, 1, 1};
  GridParameters one_cell = tree_alone();
  one_cell.has_grid = true;
  one_cell.lambda = 1e-6f;
  int refused = 0, taken = 0;
  for (int exponent = 0; exponent < 60; ++exponent) {
    const float far = std::ldexp(1.0f, exponent);
    for (const bool is_light : {true, false}) {
      scene.lights[0].corner = is_light ? Vec3(far, 0, 0) : Vec3(0, 0, 0);
      scene.settings.occlusion_samples = is_light ? 0 : 4;
      scene.settings.occlusion_radius = is_light ? 0.0f : far;
      const EffectsView view = scene.view();
      GridNeed need{}, wanted{};
      const Status status = count_scene_image(scene.mesh(), tree_alone(), need, &view);
      ASSERT_EQ(status, count_scene_image(scene.mesh(), one_cell, wanted, &view)) << exponent;
      (status == Status::kOk ? taken : refused) += 1;
      if (status == Status::kOk) {
        (void)build_image(scene.mesh(), tree_alone(), std::byte{0xCD}, &view);
        EXPECT_EQ(wanted.grid.cell_count[0] * wanted.grid.cell_count[1] * wanted.grid.cell_count[2], 1u);
        ASSERT_FALSE(HasFailure()) << exponent;
      } else {
        EXPECT_EQ(status, Status::kBadEffects);
      }
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(taken, 10);
}

}  // namespace
}  // namespace gridiron::test
