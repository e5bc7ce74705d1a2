// AtomicFile: whole or not at all. SPDX-License-Identifier: Apache-2.0
#include "files/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include "base/failure.h"
#include "files/command_files.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using tool::AtomicFile;
using tool::ExitCode;
using tool::Failure;
using Names = std::vector<std::string>;

ExitCode code_of_opening(const std::filesystem::path& path) {
  try {
    AtomicFile file(path);
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find(path.string()), std::string::npos) << failure.what();
    return failure.code();
  }
  return ExitCode::kDone;
}

TEST(AtomicFile, AppearsAtCommitOnly) {
  const TemporaryFolder folder;
  AtomicFile file(folder.path("a.txt"));
  file.write("hel");
  file.write("lo");
  EXPECT_FALSE(std::filesystem::exists(folder.path("a.txt")));
  file.commit();
  EXPECT_EQ(folder.names(), Names{"a.txt"});
  EXPECT_EQ(read_file(folder.path("a.txt")), "hello");
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder.path("a.txt"));
    file.write("hello");
    const int nameless = ::open(folder.folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (nameless >= 0) ::close(nameless);
    EXPECT_EQ(folder.names().size(), nameless >= 0 ? 0u : 1u) << "a name only where the file system needs one";
    file.finish();
    ASSERT_EQ(folder.names().size(), 1u) << "the temporary file lies in the same folder";
    EXPECT_EQ(folder.names()[0].substr(0, 10), ".gridiron.");
  }
  EXPECT_EQ(folder.names(), Names{});
}

TEST(AtomicFile, KeepsTheOldFileUntilCommit) {
  const TemporaryFolder folder("a.txt", "old");
  { AtomicFile(folder.path("a.txt")).write("new"); }
  EXPECT_EQ(read_file(folder.path("a.txt")), "old");
  AtomicFile file(folder.path("a.txt"));
  file.write("new");
  file.commit();
  EXPECT_EQ(read_file(folder.path("a.txt")), "new");
}

TEST(AtomicFile, FollowsLinks) {
  const TemporaryFolder folder("target.txt", "old");
  std::filesystem::create_symlink("target.txt", folder.path("link.txt"));
  AtomicFile file(folder.path("link.txt"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.txt")));
  EXPECT_EQ(read_file(folder.path("target.txt")), "new");
}

TEST(AtomicFile, WritesThroughDevices) {
  AtomicFile file("/dev/null");
  EXPECT_TRUE(file.target().is_special);
  file.write("lost");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, TellsThatADeviceIsFull) {
  AtomicFile file("/dev/full");
  file.write("lost");
  EXPECT_THROW(file.commit(), Failure);
}

TEST(AtomicFile, RefusesPathsThatCannotBe) {
  const TemporaryFolder folder("file", "");
  EXPECT_EQ(code_of_opening(folder.path("missing") / "a.txt"), ExitCode::kBadInput);
  EXPECT_EQ(code_of_opening(folder.path("file") / "a.txt"), ExitCode::kBadInput);
  EXPECT_EQ(code_of_opening(folder.folder()), ExitCode::kBadInput);
  EXPECT_EQ(code_of_opening(folder.path("name_ends") / ""), ExitCode::kBadInput);
  EXPECT_EQ(folder.names(), Names{"file"});
}

TEST(AtomicFile, RefusesLinksThatLeadNowhere) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("b", folder.path("a"));
  std::filesystem::create_symlink("a", folder.path("b"));
  std::filesystem::create_symlink("missing/c", folder.path("c"));
  for (const char* name : {"a", "b", "c", "a/d"}) EXPECT_EQ(code_of_opening(folder.path(name)), ExitCode::kBadInput);
  EXPECT_EQ(folder.names(), (Names{"a", "b", "c"}));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("a")));
}

TEST(AtomicFile, TakesEveryNameThatAFileCanHave) {
  const TemporaryFolder folder;
  for (const std::size_t bytes : {1u, 240u, 248u, 249u, 254u, 255u}) {
    const std::string name(bytes, 'n');
    AtomicFile file(folder.path(name));
    file.write(name);
    file.commit();
    EXPECT_EQ(read_file(folder.path(name)), name);
  }
  EXPECT_EQ(code_of_opening(folder.path(std::string(256, 'n'))), ExitCode::kBadInput);
}

TEST(AtomicFile, AFileKeepsItsRights) {
  const TemporaryFolder folder;
  constexpr auto kPrivate = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
  std::filesystem::permissions(folder.write("a.txt", "old"), kPrivate);
  AtomicFile file(folder.path("a.txt"));
  file.commit();
  EXPECT_EQ(std::filesystem::status(folder.path("a.txt")).permissions(), kPrivate);
}

ExitCode code_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Failure& failure) {
    return failure.code();
  }
  return ExitCode::kDone;
}

// An output declared, then an input, and the other way round: under its name, a link to it and a second name of it.
TEST(CommandFiles, NoOutputIsAnInput) {
  const TemporaryFolder folder;
  const auto input = folder.write("in", "kept");
  std::filesystem::create_symlink("in", folder.path("link"));
  std::filesystem::create_hard_link(input, folder.path("twin"));
  for (const char* name : {"in", "link", "twin", "./in"}) {
    const std::vector<tool::Output> output = {{"-o", folder.folder() / name}};
    {
      const tool::CommandFiles files;
      tool::declare_outputs(output);
      EXPECT_EQ(code_of([&] { tool::note_input(input); }), ExitCode::kUsage) << name;
    }
    {
      const tool::CommandFiles files;
      tool::note_input(input);
      EXPECT_EQ(code_of([&] { tool::declare_outputs(output); }), ExitCode::kUsage) << name;
    }
  }
  const tool::CommandFiles files;  // knows nothing of those before
  EXPECT_EQ(code_of([&] { tool::declare_outputs({{"-o", input}}); }), ExitCode::kDone);
}

TEST(CommandFiles, NoOutputIsAnother) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("new", folder.path("link"));  // of what is not there yet
  const tool::CommandFiles files;
  tool::declare_outputs({{"-o", folder.path("new")}, {"--report", "/dev/null"}});
  EXPECT_EQ(code_of([&] { tool::declare_outputs({{"", folder.path("link")}}); }), ExitCode::kUsage);
  EXPECT_EQ(code_of([&] { tool::declare_outputs({{"", "/dev/null"}}); }), ExitCode::kDone);
}

// What happens to the names while a command works.
TEST(CommandFiles, WhatAnOutputBecameMeanwhile) {
  const TemporaryFolder folder;
  const auto input = folder.write("in", "kept");
  for (const char* became : {"a folder", "the input", "a link to the input", "a file"}) {
    std::filesystem::remove_all(folder.path("out"));
    const tool::CommandFiles files;
    tool::declare_outputs({{"-o", folder.path("first")}, {"-o", folder.path("out")}});
    tool::note_input(input);
    tool::AtomicFiles outputs;
    outputs.add(folder.path("first"), std::string_view("first"));
    outputs.add(folder.path("out"), std::string_view("new"));
    const std::string what = became;
    if (what == "a folder") std::filesystem::create_directory(folder.path("out"));
    if (what == "the input") std::filesystem::create_hard_link(input, folder.path("out"));
    if (what == "a link to the input") std::filesystem::create_symlink("in", folder.path("out"));
    if (what == "a file") folder.write("out", "another's");
    const bool is_fine = what == "a file";
    EXPECT_EQ(code_of([&] { outputs.commit(); }), is_fine ? ExitCode::kDone : ExitCode::kBadInput) << became;
    EXPECT_EQ(std::filesystem::exists(folder.path("first")), is_fine) << became << ": all or nothing";
    EXPECT_EQ(read_file(input), "kept");
  }
  EXPECT_EQ(read_file(folder.path("out")), "new");
}

TEST(AtomicFile, HasTheRightsOfAnyNewFile) {
  const TemporaryFolder folder;
  AtomicFile file(folder.path("a.txt"));
  file.commit();
  folder.write("b.txt", "");
  EXPECT_EQ(std::filesystem::status(folder.path("a.txt")).permissions(),
            std::filesystem::status(folder.path("b.txt")).permissions());
}

}  // namespace
}  // namespace gridiron::test
