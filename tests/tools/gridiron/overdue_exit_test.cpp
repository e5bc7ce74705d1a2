// Overdue exit: a program that never looks at the flag ends all the same, and leaves nothing half done.
// SPDX-License-Identifier: Apache-2.0
#include "files/overdue_exit.h"

#include <unistd.h>

#include <thread>

#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Words = std::vector<std::string>;

constexpr int kExitCode = 130;
constexpr auto kLongerThanPatience = std::chrono::milliseconds(600);

/// A call that looks at no flag. Returns after a minute, for the test to fail.
void be_busy() {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < end) {
  }
}

void make_file(const std::filesystem::path& path) {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == nullptr || std::fclose(file) != 0) ::_exit(99);
}

TEST(OverdueExit, RemovesWhatMustNotStay) {
  const TemporaryFolder folder;
  const auto program = [&folder] {
    tool::begin_overdue_exit();
    tool::note_written_files(0);  // other tests of this process wrote some
    tool::Leftover made, gone, out, file;
    {
      const tool::Undivided step;
      std::filesystem::create_directory(folder.path("out"));
      out.remember(folder.path("out"));
      make_file(folder.path("out/.temporary"));
      file.remember(folder.path("out/.temporary"));
      make_file(folder.path("kept"));
      made.remember(folder.path("kept"));
      made.forget();
      gone.remember(folder.path("never made"));
    }
    tool::expect_exit(kExitCode);
    be_busy();
    ::_exit(0);
  };
  EXPECT_EXIT(program(), testing::ExitedWithCode(kExitCode), "interrupted; no file was written\n$");
  EXPECT_EQ(folder.names(), Words{"kept"});
}

TEST(OverdueExit, WaitsForWhatIsUndivided) {
  const TemporaryFolder folder;
  const auto program = [&folder] {
    tool::begin_overdue_exit();
    std::thread busy(be_busy);
    busy.detach();
    {
      const tool::Undivided step;
      const tool::Undivided inner;
      make_file(folder.path("first"));
      tool::note_written_files(1);
      tool::expect_exit(kExitCode);
      std::this_thread::sleep_for(kLongerThanPatience);
      make_file(folder.path("second"));
      tool::note_written_files(2);
    }
    be_busy();
    ::_exit(0);
  };
  EXPECT_EXIT(program(), testing::ExitedWithCode(kExitCode),
              "interrupted; 2 files were written before that and are kept\n$");
  EXPECT_EQ(folder.names(), (Words{"first", "second"}));
}

TEST(OverdueExit, ComesTooLateOnceAllIsWrittenOrSaid) {
  const auto written = [] {
    tool::begin_overdue_exit();
    {
      const tool::Undivided step;
      tool::outputs_are_complete();
    }
    tool::expect_exit(kExitCode);
    std::this_thread::sleep_for(kLongerThanPatience);
    ::_exit(0);
  };
  EXPECT_EXIT(written(), testing::ExitedWithCode(0), "^$");
  const auto said = [] {
    tool::begin_overdue_exit();
    tool::expect_exit(kExitCode);
    tool::say_last_words("a.ply: is no mesh\n");
    std::this_thread::sleep_for(kLongerThanPatience);
    ::_exit(1);
  };
  EXPECT_EXIT(said(), testing::ExitedWithCode(1), "^a.ply: is no mesh\n$");
}

TEST(OverdueExit, ASecondSignalDoesNotPutItOff) {
  const auto program = [] {
    tool::begin_overdue_exit();
    tool::note_written_files(0);
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < end) tool::expect_exit(kExitCode);
    ::_exit(0);
  };
  EXPECT_EXIT(program(), testing::ExitedWithCode(kExitCode), "interrupted; no file was written");
}

}  // namespace
}  // namespace gridiron::test
