// The command line: what is refused, with which exit code and words. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Words = std::vector<std::string>;

TEST(Usage, MistakesExitWithTwoAndSayWhy) {
  struct Case {
    Words arguments;
    const char* words;
  };
  const Case cases[] = {
      {{}, "subcommand"},
      {{"paint"}, "paint"},
      {{"experiment", "paper"}, "--output"},
      {{"render"}, "INPUT"},
      {{"render", "a.ply", "b.ply"}, "b.ply"},
      {{"render", "a.ply", "--colour"}, "--colour"},
      {{"render", "a.ply", "--size", "640"}, "WxH"},
      {{"render", "a.ply", "--size", "0x10"}, "WxH"},
      {{"render", "a.ply", "--size", "16385x10"}, "16384"},
      {{"render", "a.ply", "--eye", "1,2"}, "x,y,z"},
      {{"render", "a.ply", "--eye", "1,2,nan"}, "x,y,z"},
      {{"render", "a.ply", "--fov", "180"}, "180"},
      {{"render", "a.ply", "--cores", "0"}, "1 to 1024"},
      {{"render", "a.ply", "--threads", "-1"}, "1 to 256"},
      {{"render", "a.ply", "--machine", ""}, "a machine's name or file"},
      {{"render", "a.ply", "--configuration", "fastest"}, "reference|deep"},
      {{"render", "a.ply", "--buffering", "triple"}, "single|double"},
      {{"render", "a.ply", "--accuracy", "exactly"}, "paper|fast|standard|exact|compact"},
      {{"render", "a.ply", "--shading", "full"}, "none|simple|scene"},
      {{"render", "a.ply", "--shading", "scene"}, "a mesh has no lights and materials"},
      {{"render", "a.ply", "--tolerance", "0.1"}, "text scenes (.nff) alone"},
      {{"info", "a.gri", "--tolerance", "0.1"}, "text scenes (.nff) alone"},
      {{"pack", "a.ply", "--tolerance", "0.1", "-o", "b.gri"}, "text scenes (.nff) alone"},
      {{"render", "a.nff", "--tolerance", "0"}, "above 0"},
      {{"render", "a.nff", "--tolerance", "inf"}, "above 0"},
      {{"render", "a.nff", "--accuracy", "paper"}, "--accuracy paper: has no --shading scene"},
      {{"render", "a.nff", "--shading", "scene", "--packet", "16"}, "--shading scene"},
      {{"render", "a.nff", "--store", "128"}, "--shading scene"},
      {{"render", "a.nff", "--tile-width", "16"}, "--shading scene"},
      {{"render", "a.nff", "--macro-width", "7"}, "--shading scene"},
      {{"animate", "a.ply"}, "--output"},
      {{"animate", "-o", "frames"}, "FRAMES"},
      {{"animate", "a.ply", "-o", "frames", "--shading", "scene"}, "a mesh has no lights and materials"},
      {{"animate", "a.ply", "-o", "frames", "--mode", "plain"}, "--mode"},
      {{"render", "a.ply", "--lanes", "5"}, "4|8|16"},
      {{"render", "a.ply", "--store", "96"}, "64|128|256|512"},
      {{"render", "a.ply", "--store", "512"}, "cell-ps3 has a local store of 256 KB"},
      {{"render", "a.ply", "--tile-width", "24"}, "8|16|32|64"},
      {{"render", "a.ply", "--store", "128", "--mode", "plain"}, "--mode checked and --lanes 4 only"},
      {{"render", "a.ply", "--store", "64", "--tile-width", "64"}, "not built for tiles 64 pixels wide"},
      {{"render", "a.ply", "--store", "128", "--packet", "4"}, "there are tiles 32 pixels wide and packets of 8x8"},
      {{"render", "a.ply", "--tile-width", "8", "--packet", "32"}, "8 pixels wide"},
      {{"render", "a.ply", "--packet", "64"}, "4|8|16|32"},
      {{"render", "a.ply", "--packet", "32", "--store", "64"}, "16 pixels wide"},
      {{"render", "a.ply", "--mode", "fast"}, "checked|plain|instrumented"},
      {{"render", "a.ply", "--completion", "never"}, "early|late|random"},
      {{"render", "a.ply", "--seed", "1"}, "--completion random"},
      {{"render", "a.ply", "--completion", "random", "--seed", "-1"}, "digits"},
      {{"render", "a.ply", "--lambda", "0"}, "1e-6"},
      {{"render", "a.ply", "--macro-width", "9"}, "1 to 8"},
      {{"render", "a.ply", "--tile", "3"}, "X,Y"},
      {{"render", "a.ply", "--mode", "plain", "--report", "r.json"}, "plain"},
      {{"render", "a.ply", "--tile", "0,0", "--timeline", "t.json"}, "--tile"},
      {{"render", "a.ply", "--store", "64", "--macro-width", "8"}, "width 8"},
      {{"render", "a.ply", "-o", "x", "--report", "./x"}, "-o and --report name the same file"},
      {{"render", "a.ply", "-o", ".//a.ply"}, "INPUT and -o name the same file"},
      {{"render", "a.ply", "--camera", "v.camera", "--depth", "v.camera"}, "--camera and --depth name the same file"},
      {{"info"}, "INPUT"},
      {{"info", "a.ply", "--store", "512"}, "cell-ps3 has a local store of 256 KB"},
      {{"info", "a.ply", "--accuracy", "exactly"}, "paper|fast|standard|exact|compact"},
      {{"info", "a.ply", "--accuracy", "exact", "--format", "projection"}, "--accuracy exact: reads --format vertices"},
      {{"info", "a.nff", "--accuracy", "paper"}, "--accuracy paper: has no --shading scene"},
      {{"info", "a.ply", "--packet", "64"}, "4|8|16|32"},
      {{"info", "a.ply", "--packet", "32", "--store", "64"}, "16 pixels wide"},
      {{"info", "a.ply", "--packet", "4", "--store", "128"}, "there are tiles 32 pixels wide and packets of 8x8"},
      {{"info", "a.nff", "--packet", "16"}, "--shading scene"},
      {{"info", "a.nff", "--packet", "8", "--store", "64"}, "no packets"},
      {{"info", "a.nff", "--depth", "--store", "64"}, "no distances out of a store of 64 KB"},
      {{"pack", "a.ply"}, "--output"},
      {{"pack", "a.ply", "-o", "a.ply"}, "INPUT and -o name the same file"},
      {{"pack", "a.ply", "-o", "a.gri", "--format", "floats"}, "vertices|projection|lattice"},
      {{"machines", "cell-ps3", "cell-2006"}, "cell-2006"},
  };
  const TemporaryFolder folder;
  for (const Case& mistake : cases) {
    const ProgramResult result = run_program(folder.folder(), mistake.arguments);
    std::string line;
    for (const std::string& word : mistake.arguments) line += " " + word;
    EXPECT_EQ(result.exit_code, 2) << line << "\n" << result.err;
    EXPECT_NE(result.err.find(mistake.words), std::string::npos) << line << "\n" << result.err;
    EXPECT_EQ(result.out, "") << line;
  }
  EXPECT_EQ(folder.names(), Words{});
}

TEST(Usage, NamesOfOneFileAreSeenThroughLinks) {
  const TemporaryFolder folder;
  const auto machine = folder.write("my.machine", "based_on cell-ps3\n");
  const auto mesh = folder.write("a.ply", "ply\n");
  std::filesystem::create_symlink("a.ply", folder.folder() / "link.gri");
  std::filesystem::create_symlink("nowhere", folder.folder() / "dangling");
  const Words cases[] = {
      {"pack", "a.ply", "-o", "link.gri"},
      {"render", "link.gri", "-o", mesh.string()},
      {"render", "a.ply", "--machine", "my.machine", "--report", machine.string()},
      {"render", "a.ply", "--ids", "dangling", "--depth", "nowhere"},
  };
  for (const Words& arguments : cases) {
    const ProgramResult result = run_program(folder.folder(), arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("name the same file"), std::string::npos) << result.err;
  }
  // A device takes any number of outputs.
  const ProgramResult result =
      run_program(folder.folder(), {"render", "a.ply", "-o", "/dev/null", "--report", "/dev/null"});
  EXPECT_EQ(result.err.find("name the same file"), std::string::npos) << result.err;
}

TEST(Usage, HelpAndVersionAreAnswers) {
  const TemporaryFolder folder;
  for (const Words& arguments : {Words{"--help"}, {"render", "--help"}, {"info", "-h"}, {"pack", "--help"}}) {
    const ProgramResult result = run_program(folder.folder(), arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments.front();
    EXPECT_NE(result.out.find("--help"), std::string::npos) << arguments.front();
  }
  const ProgramResult version = run_program(folder.folder(), {"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.find("gridiron "), 0u);
}

// One experiment measures this host: there the number of threads is part of what is measured.
TEST(Usage, HelpTellsWhatThreadsChange) {
  const TemporaryFolder folder;
  const std::string render = run_program(folder.folder(), {"render", "--help"}).out;
  EXPECT_NE(render.find("no result depends on it"), std::string::npos) << render;
  const std::string experiment = run_program(folder.folder(), {"experiment", "--help"}).out;
  EXPECT_EQ(experiment.find("no result depends on it"), std::string::npos) << experiment;
  EXPECT_NE(experiment.find("host_*.csv"), std::string::npos) << experiment;
  EXPECT_NE(experiment.find("minutes"), std::string::npos) << experiment;
}

TEST(Usage, MachinesAreListed) {
  const TemporaryFolder folder;
  EXPECT_NE(run_program(folder.folder(), {"machines"}).out.find("cell-ps3-2gb"), std::string::npos);
  const ProgramResult result = run_program(folder.folder(), {"machines", "--json"});
  ASSERT_EQ(result.exit_code, 0);
  const auto document = nlohmann::json::parse(result.out);
  EXPECT_EQ(document["version"], 2);
  const auto& first = document["machines"][0];
  EXPECT_EQ(first["name"], "cell-ps3");
  EXPECT_EQ(first["core_count"], 6) << "the word of machine files";
  EXPECT_EQ(first["clock_hz"], 3.2e9);
  EXPECT_EQ(first["main_memory_bytes"], 256u << 20);
  EXPECT_TRUE(first["work_cycles"]["group_test_standard"].is_number());
}

TEST(Usage, AFullStandardOutputIsAnError) {
  const TemporaryFolder folder;
  std::string command = GRIDIRON_PROGRAM;
  command += " machines > /dev/full 2> /dev/null";
  const int status = std::system(command.c_str());
  EXPECT_NE(status, 0);
}

}  // namespace
}  // namespace gridiron::test
