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
      {{}, {"--configuration", "grid"}},
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
      {{"render", "a.gri", "--accuracy", "paper"}, "with --format vertices; this needs --format projection"},
      {{"render", "a.gri", "--accuracy", "compact"}, "needs --format lattice"},
      {with_reference({"render", "a.gri", "--lambda", "2"}), "packed with lambda 4"},
      {with_reference({"render", "a.gri", "--macro-width", "4"}), "width 6"},
      {{"render", "a.gri", "--configuration", "best"},
       "packed without a tree; pack it with --configuration best, or take --configuration grid"},
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
