// Three ranks write the files of one process, byte for byte. SPDX-License-Identifier: Apache-2.0
#include <set>
#include <sstream>

#include "mpi_run.h"

namespace gridiron::test {
namespace {

const std::string kScenes = GRIDIRON_SCENE_FILES;

class MpiFiles : public Mpi {
 protected:
  const TemporaryFolder folder_{"a.ply", make_torus(24, 16, 1.0f, 0.4f)};
};

// A picture with all its planes, the report with all its cycles, and the timeline: 12 tiles, the last row cut.
TEST_F(MpiFiles, OfAPicture) {
  const Words files = {"-o", "OUT/a.png", "--depth", "OUT/d.pfm", "--ids", "OUT/i.pfm", "--report", "OUT/r.json"};
  const Words common = Words{"render", "a.ply", "--size", "200x170", "--threads", "2"} + files;
  expect_same_files(folder_, common + Words{"--timeline", "OUT/t.json.txt"});
  expect_same_files(folder_, common + Words{"--configuration", "reference", "--repeat", "2"});
  expect_same_files(folder_, common + Words{"--mode", "plain"});
  // All ranks encode seven bands; four, the last of another rank than 0; two of three ranks two.
  for (const char* size : {"1600x1100", "1000x800", "600x600"}) {
    expect_same_files(folder_, {"render", "a.ply", "--size", size, "--mode", "plain", "-o", "OUT/a.png"});
  }
}

// Rays that wait lie in main memory too.
TEST_F(MpiFiles, OfAPictureWithEffects) {
  expect_same_files(folder_, {"render", kScenes + "/everything.nff", "--size", "70x40", "-o", "OUT/a.png", "--report",
                              "OUT/r.json"});
}

// Two nodes of two ranks: the scene goes from the first to the second, and lies once on each.
TEST_F(MpiFiles, OfTwoNodes) {
  expect_same_files(folder_, {"render", kScenes + "/everything.nff", "--size", "70x40", "-o", "OUT/a.png", "--report",
                              "OUT/r.json"}, {two_nodes_line(4)});
}

// 60 machines, and fewer than ranks.
TEST_F(MpiFiles, OfASweep) {
  const Words common = {"render", "a.ply", "--size", "200x170", "--threads", "2", "-o", "OUT/a.png"};
  const Words varied = {"--vary", "latency_cycles=0,50,100,200,300,500,700,1000,2000,5000", "--vary",
                        "core_count=1,2,3,4,6,8"};
  expect_same_files(folder_, common + varied + Words{"--sweep", "OUT/s.csv", "--sweep-plot", "OUT/s.svg", "--report",
                                                     "OUT/r.json"});
  expect_same_files(folder_, {"render", kScenes + "/everything.nff", "--size", "24x16", "-o", "OUT/a.png", "--vary",
                              "latency_cycles=100,400:0.98 5400:0.02", "--sweep", "OUT/s.csv"});
}

// Fewer tiles than ranks, a single tile of many, and a packed scene, which is not built.
TEST_F(MpiFiles, OfFewTiles) {
  expect_same_files(folder_, {"render", "a.ply", "--size", "16x16", "-o", "OUT/a.png", "--report", "OUT/r.json"});
  expect_same_files(folder_, {"render", "a.ply", "--size", "96x96", "--tile", "1,0", "-o", "OUT/a.png"});
  (void)run(folder_, {"pack", "a.ply", "-o", "a.scene"});
  expect_same_files(folder_, {"render", "a.scene", "--size", "96x96", "--repeat", "2", "-o", "OUT/a.png", "--report",
                              "OUT/r.json"});
}

TEST_F(MpiFiles, OfACameraThatMoves) {
  expect_same_files(folder_, {"animate", "a.ply", "-o", "OUT", "--turntable", "5", "--size", "40x40", "--timeline",
                              "OUT/t.txt"});
  expect_same_files(folder_, {"animate", kScenes + "/glass.nff", "-o", "OUT", "--turntable", "4", "--size", "24x24"});
}

TEST_F(MpiFiles, OfASeriesOfMeshes) {
  std::filesystem::create_directory(folder_.path("in"));
  for (int i = 0; i < 4; ++i) {
    folder_.write_ply("in/m" + std::to_string(i) + ".ply", moved(make_sphere(8, 10, 1.0f), 1.0f, Vec3(float(i), 0, 0)));
  }
  expect_same_files(folder_, {"animate", "in", "-o", "OUT", "--size", "40x40"});
}

// What any rank says of its frames is printed, and what is said of the first frame alone once.
TEST_F(MpiFiles, NotesAreThoseOfOneProcess) {
  Words files;
  for (int i = 0; i < 5; ++i) {
    files.push_back("s" + std::to_string(i) + ".nff");
    const char* second = i == 1 ? "p 3 0 0 0 1 1 1 3 3 3\n" : "";  // rank 1 has more to say of it than of s3
    folder_.write(files.back(), std::string("v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 40 40\n"
                                "l 4 4 4\nf 1 0 0 1 0 0 0 0\ns 0 0 0 1\np 3 0 0 0 1 1 1 2 2 2\n") + second);
  }
  const auto lines_of = [](const std::string& text) {
    std::multiset<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.insert(line);
    return lines;
  };
  const auto expect_same_notes = [&](const Words& words, std::size_t notes) {
    const ProgramResult alone = run(folder_, Words{"animate"} + words + Words{"-o", "alone"});
    const ProgramResult ranks = run_ranks(folder_, 3, Words{"animate"} + words + Words{"-o", "ranks"});
    ASSERT_EQ(ranks.exit_code, 0) << ranks.err;
    EXPECT_EQ(lines_of(alone.err).size(), notes) << alone.err;
    EXPECT_EQ(lines_of(ranks.err), lines_of(alone.err));
  };
  expect_same_notes(files + Words{"--size", "40x40"}, 6);
  expect_same_notes({files.front(), "--size", "40x40", "--turntable", "5"}, 1);
  Words meshes;
  for (const char* name : {"b.ply", "c.ply", "d.ply", "e.ply"}) {
    folder_.write(name, read_file(folder_.path("a.ply")));
    meshes.emplace_back(name);
  }
  expect_same_notes(meshes + Words{"--size", "40x40", "--configuration", "grid", "--store", "64"}, 1);
}

// What is complete stays, whichever frames those are.
TEST_F(MpiFiles, OfAnAnimationThatGoesOn) {
  const Words turn = {"animate", "a.ply", "-o", "out", "--turntable", "7", "--size", "40x40"};
  (void)run(folder_, turn);
  const std::map<std::string, std::string> whole = files_of(folder_.path("out"));
  for (const char* name : {"frame0001.png", "frame0004.png", "frame0005.png", "animation.csv"}) {
    std::filesystem::remove(folder_.path(std::string("out/") + name));
  }
  const ProgramResult result = run_ranks(folder_, 3, turn + Words{"--resume"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "out/animation.log: 4 of 7 pictures complete\n");
  EXPECT_EQ(files_of(folder_.path("out")), whole);
  EXPECT_EQ(run_ranks(folder_, 3, turn + Words{"--resume"}).exit_code, 0);
  EXPECT_EQ(files_of(folder_.path("out")), whole);
}

TEST_F(MpiFiles, OfAnExperiment) {
  std::filesystem::create_directory(folder_.path("none"));
  expect_same_files(folder_, {"experiment", "dynamic", "-o", "OUT", "--scenes", "none", "--size", "16x16", "--largest",
                              "6000"});
}

// What the scaling model is made from: the calls of each rank, with the bytes of its messages.
TEST_F(MpiFiles, OfCosts) {
  const ProgramResult result =
      run_ranks(folder_, 2, {"--costs", "costs", "render", "a.ply", "--size", "200x170", "-o", "a.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::map<std::string, std::vector<double>> bytes[2];  // by call
  for (int rank = 0; rank < 2; ++rank) {
    std::istringstream file(read_file(folder_.path("costs." + std::to_string(rank) + ".csv")));
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "call,bytes,before_seconds,seconds");
    double all_seconds = 0;
    while (std::getline(file, line)) {
      std::ranges::replace(line, ',', ' ');
      std::istringstream words(line);
      std::string call;
      double sent = 0, before = -1, seconds = -1;
      ASSERT_TRUE(words >> call >> sent >> before >> seconds) << line;
      EXPECT_GE(std::min(before, seconds), 0.0) << line;
      bytes[rank][call].push_back(sent);
      all_seconds += before + seconds;
    }
    EXPECT_GT(all_seconds, 0.0);
    EXPECT_EQ(bytes[rank]["end"].size(), 1u);
    EXPECT_EQ(bytes[rank]["share"], bytes[0]["share"]);
  }
  std::vector<double> taken;
  std::ranges::copy_if(bytes[0]["poll"], std::back_inserter(taken), [](double count) { return count > 0; });
  EXPECT_FALSE(taken.empty());
  EXPECT_EQ(taken, bytes[1]["tell"]);
}

TEST_F(MpiFiles, OtherCommandsAreThoseOfOneProcess) {
  const ProgramResult alone = run(folder_, {"info", "a.ply"});
  const ProgramResult ranks = run_ranks(folder_, 3, {"info", "a.ply"});
  EXPECT_EQ(ranks.exit_code, 0);
  EXPECT_EQ(ranks.out, alone.out);
  EXPECT_EQ(run_ranks(folder_, 2, {"--version"}).out, run(folder_, {"--version"}).out);
}

}  // namespace
}  // namespace gridiron::test
