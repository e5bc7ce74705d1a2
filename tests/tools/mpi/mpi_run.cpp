// Runs gridiron_mpi. SPDX-License-Identifier: Apache-2.0
#include "mpi_run.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#ifndef GRIDIRON_MPIEXEC
#define GRIDIRON_MPIEXEC ""
#define GRIDIRON_MPI_PROGRAM ""
#define GRIDIRON_MPI_OTHER ""
#define GRIDIRON_MPI_TWO_NODES ""
#define GRIDIRON_MPI_LARGE_MESSAGES ""
#endif

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

const std::string kAtMost = "timeout -k 5 300 env ";  // an mpirun that hangs is a failure

// Processors are few here, and the test may run as root in a container.
std::string mpirun_line(int ranks, const char* program) {
  return std::string("OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 '") + GRIDIRON_MPIEXEC +
         "' --oversubscribe --bind-to none -n " + std::to_string(ranks) + " '" + program + "'";
}

// Without what names the host, in a report.
std::string comparable(const std::string& name, const std::string& bytes) {
  if (!name.ends_with(".json")) return bytes;
  nlohmann::ordered_json report = nlohmann::ordered_json::parse(bytes);
  EXPECT_TRUE(report.contains("host")) << name;
  report.erase("host");
  return report.dump(1);
}

std::string joined(const Words& words, const std::string& out) {
  std::string line;
  for (std::string word : words) {
    if (word == "OUT") word = out;
    if (word.starts_with("OUT/")) word.replace(0, 3, out);
    line += " '" + word + "'";
  }
  return line;
}

}  // namespace

void Mpi::SetUp() {
  if (*GRIDIRON_MPIEXEC == '\0') GTEST_SKIP() << "built without MPI (GRIDIRON_WITH_MPI)";
  if (!fs::exists(GRIDIRON_MPIEXEC)) GTEST_SKIP() << "no " << GRIDIRON_MPIEXEC;
  // Where a container forbids what mpirun needs, no program starts.
  const TemporaryFolder folder;
  const ProgramResult probe = run_shell(folder.folder(), kAtMost + mpirun_line(1, "true"));
  if (probe.exit_code != 0) GTEST_SKIP() << "mpirun starts nothing here: " << probe.err;
}

void MpiFull::SetUp() {
  if (std::getenv("GRIDIRON_TEST_MPI_FULL") == nullptr) GTEST_SKIP() << "of the label full";
  Mpi::SetUp();
}

std::string ranks_line(int ranks) {
  return mpirun_line(ranks, GRIDIRON_MPI_PROGRAM);
}

std::string other_line(int ranks) {
  return "-n " + std::to_string(ranks) + " '" + GRIDIRON_MPI_OTHER + "'";
}

std::string two_nodes_line(int ranks) {
  return mpirun_line(ranks, GRIDIRON_MPI_TWO_NODES);
}

std::string large_messages_line() {
  return mpirun_line(2, GRIDIRON_MPI_LARGE_MESSAGES);
}

ProgramResult run_ranks(const TemporaryFolder& folder, int ranks, const Words& arguments) {
  return run_shell(folder.folder(), kAtMost + ranks_line(ranks) + joined(arguments, "OUT"));
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    files[entry.path().filename().string()] = read_file(entry.path());
  }
  return files;
}

void expect_same_files(const TemporaryFolder& folder, const Words& arguments, const Words& lines) {
  SCOPED_TRACE(testing::PrintToString(arguments));
  const auto files_by = [&](const std::string& line, const char* out) {
    fs::remove_all(folder.path(out));
    fs::create_directory(folder.path(out));
    const ProgramResult result = run_shell(folder.folder(), line + joined(arguments, out));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return files_of(folder.path(out));
  };
  const auto names_of = [](const std::map<std::string, std::string>& files) {
    Words names;
    for (const auto& [name, bytes] : files) names.push_back(name);
    return names;
  };
  const std::map<std::string, std::string> expected = files_by("\"$GRIDIRON\"", "alone");
  ASSERT_FALSE(expected.empty());
  for (const std::string& line : lines) {
    SCOPED_TRACE(line);
    const std::map<std::string, std::string> got = files_by(kAtMost + line, "ranks");
    ASSERT_EQ(names_of(got), names_of(expected));
    for (const auto& [name, bytes] : expected) {
      if (name.starts_with("host_")) continue;
      EXPECT_TRUE(comparable(name, got.at(name)) == comparable(name, bytes)) << name << " differs";
    }
  }
}

}  // namespace gridiron::test
