// The experiment as a program: a tiny one, on generated scenes. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "../gridiron/run_program.h"
#include "../gridiron/temporary_folder.h"
#include "markup.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> tiny(const std::string& output, const std::string& threads) {
  // The folder itself holds no scans, so that GRIDIRON_SCENES does not matter.
  return {"experiment", "paper",     "-o",   output,      "--scenes", ".",      "--size",
          "64x48",      "--largest", "6000", "--threads", threads,    "--quiet"};
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

TEST(Experiment, FilesDoNotDependOnThreads) {
  const TemporaryFolder folder;
  for (const char* threads : {"1", "3"}) {
    const ProgramResult result = run_program(folder.folder(), tiny(std::string("out") + threads, threads));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
  }
  const std::set<std::string> names = names_in(folder.path("out1"));
  EXPECT_EQ(names, names_in(folder.path("out3")));
  int compared = 0;
  for (const std::string& name : names) {
    if (name.starts_with("host_")) continue;
    EXPECT_TRUE(read_file(folder.path("out1") / name) == read_file(folder.path("out3") / name)) << name;
    ++compared;
  }
  EXPECT_GE(compared, 35);
  EXPECT_EQ(names.count("host_fig7.csv"), 1u);

  // The page names every file and nothing else; every plot is well formed, every table has rows of one length.
  std::set<std::string> linked = {"index.html"};
  for (const MarkupElement& element : parse_markup(read_file(folder.path("out1") / "index.html"))) {
    for (const char* key : {"href", "src"}) {
      const auto found = element.attributes.find(key);
      if (found != element.attributes.end() && found->second.front() != '#') linked.insert(found->second);
    }
  }
  EXPECT_EQ(linked, names);
  for (const std::string& name : names) {
    const std::string content = read_file(folder.path("out1") / name);
    if (name.ends_with(".svg")) {
      SCOPED_TRACE(name);
      EXPECT_FALSE(parse_markup(content).empty());
    } else if (name.ends_with(".csv")) {
      EXPECT_GE(std::ranges::count(content, '\n'), 2) << name << " has no rows";
    }
  }
  EXPECT_NE(read_file(folder.path("out1") / "index.html").find("bunny.ply was not found"), std::string::npos);
}

TEST(Experiment, MistakesAreTold) {
  const TemporaryFolder folder;
  folder.write("file", "no folder");
  struct Case {
    std::vector<std::string> arguments;
    int exit_code;
    const char* words;
  };
  const Case cases[] = {
      {{"experiment"}, 2, "NAME"},
      {{"experiment", "paper"}, 2, "--output"},
      {{"experiment", "accuracy", "-o", "out"}, 2, "expected paper"},
      {{"experiment", "paper", "-o", "out", "--threads", "0"}, 2, "1 to 256"},
      {{"experiment", "paper", "-o", "out", "--largest", "10"}, 2, "6000"},
      {{"experiment", "paper", "-o", "out", "--size", "64"}, 2, "WxH"},
      {{"experiment", "paper", "-o", "out", "--scenes", "nowhere"}, 1, "nowhere: no such folder"},
      {{"experiment", "paper", "-o", "no/such/out"}, 1, "no/such/out"},
      {{"experiment", "paper", "-o", "file"}, 1, "file"},
  };
  for (const Case& mistake : cases) {
    const ProgramResult result = run_program(folder.folder(), mistake.arguments);
    EXPECT_EQ(result.exit_code, mistake.exit_code) << result.err;
    EXPECT_NE(result.err.find(mistake.words), std::string::npos) << result.err;
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

TEST(Experiment, AWrongScanLeavesNothing) {
  const TemporaryFolder folder;
  folder.write("bunny.ply", "ply\nformat ascii 1.0\nnonsense\n");
  const ProgramResult result = run_program(folder.folder(), tiny("out", "1"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("bunny.ply:3"), std::string::npos) << result.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"bunny.ply"});
}

TEST(Experiment, AnInterruptLeavesNothing) {
  const TemporaryFolder folder;
  RunningProgram program(folder.folder(), {"experiment", "paper", "-o", "out", "--scenes", ".", "--threads", "2"});
  while (!fs::exists(folder.path("out"))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace gridiron::test
