// Scene input: which grid a mesh gets in a given main memory. SPDX-License-Identifier: Apache-2.0
#include "gridiron/scene/scene_input.h"

#include "failure_of.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

class SceneInputTest : public ::testing::Test {
 protected:
  SceneInputTest() {
    const TestMesh mesh = make_sphere(40, 60, 1.0f);
    request_.input = folder_.write_ply("sphere.ply", mesh);
    request_.machine = tool::find_machine("cell-ps3");
    request_.configuration = tool::find_configuration("reference");
    input_ = tool::read_scene_input(request_.input);
  }

  [[nodiscard]] tool::GridChoice choose(std::uint64_t budget_bytes) const {
    return tool::choose_grid(input_, std::get<tool::Mesh>(input_.content), request_, {.budget_bytes = budget_bytes});
  }

  const TemporaryFolder folder_;
  tool::SceneRequest request_;
  tool::SceneInput input_;
};

TEST_F(SceneInputTest, KeepsTheWantedLambdaWhereItFits) {
  const tool::GridChoice roomy = choose(std::uint64_t{1} << 30);
  EXPECT_EQ(roomy.parameters.lambda, 4.0f);
  EXPECT_FALSE(roomy.is_reduced());
  const tool::GridChoice exact = choose(roomy.need.image_bytes);
  EXPECT_TRUE(exact.fits());
  EXPECT_FALSE(exact.is_reduced());
}

TEST_F(SceneInputTest, HalvesLambdaUntilItFits) {
  const std::uint64_t budget_bytes = choose(std::uint64_t{1} << 30).need.image_bytes - 1;
  const tool::GridChoice choice = choose(budget_bytes);
  EXPECT_TRUE(choice.fits());
  EXPECT_TRUE(choice.is_reduced());
  EXPECT_EQ(choice.wanted_lambda, 4.0f);
  EXPECT_LE(choice.need.image_bytes, budget_bytes);
  // The first halving that fits, not a later one.
  tool::SceneRequest twice = request_;
  twice.lambda = choice.parameters.lambda * 2;
  const tool::GridChoice before =
      tool::choose_grid(input_, std::get<tool::Mesh>(input_.content), twice, {.budget_bytes = budget_bytes});
  EXPECT_FALSE(before.fits());
}

TEST_F(SceneInputTest, SaysSoWhereNothingFits) {
  const tool::GridChoice choice = choose(10'000);
  EXPECT_FALSE(choice.fits());
  EXPECT_THROW(tool::require_fit(choice, request_, input_), tool::Failure);
}

TEST_F(SceneInputTest, GoesDownToOneCell) {
  // Triangles that all fill the box: every one is in most cells, so only few cells fit, and far fewer than at 1/64.
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {1, 1, 1}};
  for (int i = 0; i < 20000; ++i) mesh.triangles.emplace_back(i % 2, 1 + i % 2, 2 + i % 2);
  request_.input = folder_.write_ply("pile.ply", mesh);
  input_ = tool::read_scene_input(request_.input);
  const tool::GridChoice choice = choose(std::uint64_t{1} << 20);
  EXPECT_TRUE(choice.fits());
  EXPECT_LT(choice.parameters.lambda, 1.0f / 64.0f);
}

TEST_F(SceneInputTest, HalvesLambdaWhereReferencesOutgrowTheirCounts) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  for (int i = 0; i < 2100; ++i) mesh.triangles.emplace_back(i % 2, 1 + i % 2, 2 + i % 2);
  request_.input = folder_.write_ply("sheet.ply", mesh);
  input_ = tool::read_scene_input(request_.input);
  request_.lambda = 3000.0f;
  const std::string words = failure_of([&] { return choose(std::uint64_t{1} << 30); });
  EXPECT_NE(words.find("sheet.ply: the scene needs more than 1"), std::string::npos) << words;
  EXPECT_NE(words.find(" GB at lambda 3000; cell-ps3 has 1.0 GB for it"), std::string::npos) << words;
  EXPECT_NE(words.find("; a smaller --lambda needs less"), std::string::npos) << words;
  request_.lambda.reset();
  tool::Configuration fine = *request_.configuration;
  fine.lambda = 3000.0f;
  request_.configuration = &fine;
  const tool::GridChoice choice = choose(std::uint64_t{1} << 30);
  EXPECT_TRUE(choice.fits());
  EXPECT_TRUE(choice.is_reduced());
}

TEST_F(SceneInputTest, NeverChangesALambdaOfTheCommandLine) {
  request_.lambda = 4.0f;
  const std::uint64_t need_bytes = choose(std::uint64_t{1} << 30).need.image_bytes;
  const tool::GridChoice choice = choose(need_bytes - 1);
  EXPECT_FALSE(choice.fits());
  EXPECT_EQ(choice.parameters.lambda, 4.0f);
}

TEST_F(SceneInputTest, BudgetLeavesRoomForThePicture) {
  const sim::MachineProfile& machine = *request_.machine;
  const std::uint64_t small = tool::image_budget_bytes(machine, 1, 1, 1);
  EXPECT_EQ(small, tool::image_budget_bytes(machine, 1024, 1024, 3)) << "pack and render agree";
  EXPECT_EQ(small - tool::image_budget_bytes(machine, 2048, 1024, 3), std::uint64_t{3} * 4 * 1024 * 1024);
  EXPECT_EQ(small, tool::image_budget_bytes(machine, 1024, 1024, 3, 64));
  EXPECT_EQ(tool::image_budget_bytes(machine, 2048, 1056, 3, 32) - tool::image_budget_bytes(machine, 2048, 1056, 3, 64),
            std::uint64_t{3} * 4 * 2048 * 32)
      << "whole tiles are counted";
  EXPECT_THROW((void)tool::image_budget_bytes(machine, 16384, 16384, 1), tool::Failure);
}

TEST_F(SceneInputTest, ASmallMemoryKeepsHalfOfItselfForThePicture) {
  sim::MachineProfile small = *request_.machine;
  small.main_memory_bytes = 1 << 20;
  const std::uint64_t budget_bytes = tool::image_budget_bytes(small, 128, 128, 1);
  EXPECT_NEAR(static_cast<double>(budget_bytes), 0.5 * (1 << 20), 4096);
  EXPECT_EQ(budget_bytes, tool::image_budget_bytes(small, 1, 1, 1)) << "pack and render agree";
  EXPECT_LT(tool::image_budget_bytes(small, 448, 448, 1), budget_bytes) << "a picture of more than half";
  EXPECT_THROW((void)tool::image_budget_bytes(small, 512, 512, 1), tool::Failure);
  // The message names the shortage and the reserved memory.
  request_.machine = std::make_shared<sim::MachineProfile>(small);
  request_.lambda = 64.0f;
  const std::string words = failure_of([&] { tool::require_fit(choose(budget_bytes), request_, input_); });
  EXPECT_NE(words.find("of its 1.0 MB of main memory 51"), std::string::npos) << words;
  EXPECT_NE(words.find("KB are kept for pictures"), std::string::npos) << words;
}

}  // namespace
}  // namespace gridiron::test
