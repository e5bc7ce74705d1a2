// pack: scene images. SPDX-License-Identifier: Apache-2.0
#include "base/words.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

// "hash 0123456789abcdef" of the program's first line.
std::string hash_of(const ProgramResult& result) {
  const std::size_t place = result.out.find("hash ");
  return place == std::string::npos ? "" : result.out.substr(place, 21);
}

TEST(Pack, RendersTheSamePictureAsTheMesh) {
  const TemporaryFolder folder;
  TestMesh mesh = make_torus(40, 24, 1.0f, 0.4f);
  mesh.append(make_triangle(Vec3(0, 0, 0), Vec3(50, 0, 0), Vec3(100, 0, 0)));
  folder.write_ply("a.ply", mesh);
  const struct {
    Words pack, render;
  } cases[] = {
      {{}, {}},
      {{"--format", "projection"}, {"--accuracy", "paper"}},
      {{"--format", "lattice"}, {"--accuracy", "compact"}},
      {{}, {"--accuracy", "exact"}},
      {{"--format", "vertices"}, {"--accuracy", "fast"}},
      {{"--lambda", "1", "--macro-width", "4", "--configuration", "grid"}, {}},
      {{"--configuration", "reference"}, {}},
      {{"--configuration", "grid"}, {"--configuration", "grid"}},
  };
  for (const auto& choice : cases) {
    run(folder, Words{"pack", "a.ply", "-o", "a.gri"} + choice.pack);
    const auto rendered_hash = [&](const char* input) {
      return hash_of(run(folder, Words{"render", input, "--size", "96x64"} + choice.render));
    };
    const std::string hash = rendered_hash("a.gri");
    EXPECT_EQ(hash, rendered_hash("a.ply"));
    EXPECT_EQ(hash.size(), 21u);
  }
}

// An image holds what the eye rays of its configuration read, and says so; another configuration is told how to get it.
TEST(Pack, ImagesHoldWhatTheirConfigurationReads) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  folder.write("a.nff",
               "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 64 64\n"
               "l 2 3 4\nf 1 0.5 0.2 0.8 0.2 10 0 1\ns 0 0 0 1\n");
  for (const std::string scene : {"a.ply", "a.nff"}) {
    const std::string image = scene + ".gri", other = scene + "2.gri";
    const ProgramResult packed = run(folder, {"pack", scene, "-o", image, "--configuration", "best"});
    EXPECT_NE(packed.out.find("\nholds: tree "), std::string::npos) << packed.out;
    EXPECT_EQ(packed.out.find("lambda"), std::string::npos) << packed.out;
    const ProgramResult with_grid = run(folder, {"pack", scene, "-o", other, "--configuration", "grid"});
    EXPECT_NE(with_grid.out.find("\nholds: grid "), std::string::npos) << with_grid.out;
    EXPECT_LT(read_file(folder.path(image)).size(), read_file(folder.path(other)).size());

    const auto rendered_hash = [&](const std::string& input, const char* configuration) {
      return hash_of(run(folder, {"render", input, "--size", "96x64", "--configuration", configuration}));
    };
    EXPECT_EQ(rendered_hash(image, "best"), rendered_hash(other, "grid"));
    if (scene == "a.ply") {  // an image has no view of its own
      EXPECT_EQ(rendered_hash(image, "best"), rendered_hash(scene, "best"));
    }
    for (const char* configuration : {"reference", "grid"}) {
      const ProgramResult result = run_program(folder.folder(), {"render", image, "--configuration", configuration});
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_EQ(result.err.find(image + ": holds tree "), 0u) << result.err;
      EXPECT_NE(result.err.find("but no grid, which --configuration " + std::string(configuration) +
                                " reads here; pack it with --configuration " + configuration + "\n"),
                std::string::npos)
          << result.err;
    }
    const std::string info = run(folder, {"info", image}).out;
    EXPECT_NE(info.find("\nholds          tree "), std::string::npos) << info;
    EXPECT_EQ(info.find("\ngrid "), std::string::npos) << info;
    EXPECT_EQ(info.find("\nmacrocells "), std::string::npos) << info;
  }
  expect_failure(folder, {"render", "a.ply2.gri", "--configuration", "best"}, 1,
                 "but no tree, which --configuration best");
  EXPECT_EQ(run_program(folder.folder(), {"render", "a.nff2.gri", "--configuration", "best"}).exit_code, 0)
      << "effects have a tree";
  // With effects a 64 KB store takes frames of the grid, whatever the configuration.
  expect_failure(folder, {"render", "a.nff.gri", "--configuration", "best", "--store", "64", "--shading", "scene"}, 1,
                 "pack it with --machine of a chip with such stores");
  folder.write("small.machine", "based_on cell-ps3\nlocal_store_bytes 65536\n");
  run(folder, {"pack", "a.nff", "-o", "small.gri", "--machine", "small.machine"});
  run(folder, {"render", "small.gri", "--machine", "small.machine", "--size", "16x16"});
  for (const Words& option : {Words{"--lambda", "2"}, {"--macro-width", "4"}}) {
    expect_failure(folder, Words{"render", "a.ply", "--configuration", "best"} + option, 2, "has no grid");
    expect_failure(folder, Words{"render", "a.ply.gri", "--configuration", "best"} + option, 2, "has no grid");
  }
  expect_failure(folder, {"pack", "a.ply", "-o", "b.gri", "--configuration", "best", "--format", "projection"}, 2,
                 "--format projection: configuration best has no triangles for it");
}

// Lights and ground are made for a view, which pack prints: an image has none.
TEST(Pack, KeepsALook) {
  const TemporaryFolder folder("a.ply", make_torus(24, 16, 1.0f, 0.4f));
  for (const Words& look : {Words{"--look", "studio", "--ao", "2"},
                            Words{"--color", "red", "--up", "z", "--from", "left", "--fov", "50"}}) {
    const ProgramResult packed = run(folder, Words{"pack", "a.ply", "-o", "a.gri"} + look);
    const std::string opening = "\nseen as render shows its look: ";
    const std::size_t place = packed.out.find(opening);
    ASSERT_NE(place, std::string::npos) << packed.out;
    std::istringstream line(packed.out.substr(place + opening.size()));
    Words view;
    for (std::string word; line >> word;) view.push_back(word);
    const std::string hash = hash_of(run(folder, Words{"render", "a.ply", "--size", "32x32"} + look));
    EXPECT_EQ(hash.size(), 21u);
    EXPECT_EQ(hash_of(run(folder, Words{"render", "a.gri", "--size", "32x32"} + view)), hash);
  }
  expect_failure(folder, {"pack", "a.ply", "-o", "b.gri", "--fov", "50"}, 2, "place the lights of a look");
  expect_failure(folder, {"pack", "a.ply", "-o", "b.gri", "--look", "studio", "--format", "projection"}, 2,
                 "--format projection is for a mesh alone; lights and materials need triangles as vertices");
}

TEST(Pack, SaysWhatItDoesNotKeep) {
  const TemporaryFolder folder("a.ply",
                               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                               "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                               "0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n3 0 1 2\n");
  const std::string note = "a.ply: not packed: colours; --look studio or a part of it packs them\n";
  EXPECT_NE(run_program(folder.folder(), {"pack", "a.ply", "-o", "a.gri"}).err.find(note), std::string::npos);
  EXPECT_EQ(run_program(folder.folder(), {"pack", "a.ply", "-o", "a.gri", "--ao", "1"}).err.find("not packed"),
            std::string::npos);
}

TEST(Pack, IsTheSameBytesEveryTime) {
  const TemporaryFolder folder("a.ply", make_random_soup(300, 0.2f, 7));
  run(folder, {"pack", "a.ply", "-o", "a.gri"});
  run(folder, {"pack", "a.ply", "-o", "b.gri"});
  EXPECT_EQ(read_file(folder.path("a.gri")), read_file(folder.path("b.gri")));
}

TEST(Pack, ImagesAreUsedAsTheyWerePacked) {
  const TemporaryFolder folder("a.ply", make_sphere(12, 16, 1.0f));
  run(folder, with_reference({"pack", "a.ply", "-o", "a.gri"}));
  const struct {
    Words arguments;
    const char* words;
  } cases[] = {
      {{"render", "a.gri", "--accuracy", "paper"},
       "which --accuracy fast, standard, exact read; this needs --format projection"},
      {{"render", "a.gri", "--accuracy", "compact"}, "needs --format lattice"},
      {with_reference({"render", "a.gri", "--lambda", "2"}), "packed with lambda 4"},
      {with_reference({"render", "a.gri", "--macro-width", "4"}), "width 6"},
      {{"render", "a.gri", "--configuration", "best"},
       "but no tree, which --configuration best reads here; pack it with --configuration best"},
      {{"pack", "a.gri", "-o", "b.gri"}, "already"},
  };
  for (const auto& mistake : cases) expect_failure(folder, mistake.arguments, 1, mistake.words);
}

TEST(Pack, DamagedImagesAreNamedWithTheirByte) {
  const TemporaryFolder folder("a.ply", make_sphere(12, 16, 1.0f));
  run(folder, {"pack", "a.ply", "-o", "a.gri"});
  const std::string image = read_file(folder.path("a.gri"));
  std::string flipped = image;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
  for (const std::string& damaged : {image.substr(0, 40), image.substr(0, image.size() - 128), flipped}) {
    folder.write("b.gri", damaged);
    for (const Words& command : {Words{"render", "b.gri"}, {"info", "b.gri"}}) {
      const ProgramResult result = run_program(folder.folder(), command);
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_EQ(result.err.find("b.gri:byte "), 0u) << result.err;
    }
  }
  EXPECT_EQ(folder.names(), (Words{"a.gri", "a.ply", "b.gri"}));
  for (const auto& [bytes, wanted] : {std::pair(std::size_t{40}, std::string("header has 64")),
                                      {std::size_t{128}, "image has " + tool::words_of_count(image.size())}}) {
    folder.write("b.gri", image.substr(0, bytes));
    const std::string words = run_program(folder.folder(), {"render", "b.gri"}).err;
    EXPECT_NE(words.find(": there are " + std::to_string(bytes) + " bytes, the " + wanted + "\n"), std::string::npos)
        << words;
  }
  folder.write("b.gri", "GDRX" + image.substr(4));
  const std::string words = run_program(folder.folder(), {"render", "b.gri"}).err;
  EXPECT_EQ(words.find("b.gri: is of no known kind: it begins with 'GDRX"), 0u) << words;
}

}  // namespace
}  // namespace gridiron::test
