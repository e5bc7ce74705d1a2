// AtomicFile: whole or not at all. SPDX-License-Identifier: Apache-2.0
#include "gridiron/atomic_file.h"

#include <gtest/gtest.h>

#include "gridiron/failure.h"
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
    EXPECT_EQ(folder.names().size(), 1u) << "the temporary file lies in the same folder";
  }
  EXPECT_EQ(folder.names(), Names{});
}

TEST(AtomicFile, KeepsTheOldFileUntilCommit) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  { AtomicFile(folder.path("a.txt")).write("new"); }
  EXPECT_EQ(read_file(folder.path("a.txt")), "old");
  AtomicFile file(folder.path("a.txt"));
  file.write("new");
  file.commit();
  EXPECT_EQ(read_file(folder.path("a.txt")), "new");
}

TEST(AtomicFile, FollowsLinks) {
  const TemporaryFolder folder;
  folder.write("target.txt", "old");
  std::filesystem::create_symlink("target.txt", folder.path("link.txt"));
  AtomicFile file(folder.path("link.txt"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.txt")));
  EXPECT_EQ(read_file(folder.path("target.txt")), "new");
}

TEST(AtomicFile, WritesThroughDevices) {
  AtomicFile file("/dev/null");
  EXPECT_TRUE(file.is_special());
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
  const TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_EQ(code_of_opening(folder.path("missing") / "a.txt"), ExitCode::kBadInput);
  EXPECT_EQ(code_of_opening(folder.path("file") / "a.txt"), ExitCode::kBadInput);
  EXPECT_EQ(code_of_opening(folder.folder()), ExitCode::kBadInput);
  EXPECT_EQ(code_of_opening(folder.path("name_ends") / ""), ExitCode::kBadInput);
  EXPECT_EQ(folder.names(), Names{"file"});
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
