// tools/boards/run_*, with a stand-in for the emulator: what they refuse, and what they leave behind.
// SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

/// A directory with a job, a firmware and an emulator that does what `words` say.
class Board {
 public:
  Board(const std::string& name, const std::string& emulator, const std::string& words) : name_(name) {
    scratch_.write("bin/" + emulator, "#!/bin/sh\n: > emulator.log\n" + words + "\n");
    std::filesystem::permissions(path("bin/" + emulator), std::filesystem::perms::owner_all);
    scratch_.write("bin/" + name + "_plain.elf", "firmware");
    scratch_.write("a.job", std::string(256, '\0'));
    scratch_.write("a.res", "of another run");
  }

  [[nodiscard]] std::filesystem::path path(const std::string& file) const { return scratch_.path() / file; }
  [[nodiscard]] std::string read(const std::string& file) const {
    return run_script("cat '" + path(file).string() + "'").output;
  }
  void write(const std::string& file, const std::string& text) const { scratch_.write(file, text); }
  [[nodiscard]] ScriptResult run(const std::string& words, const std::string& under = "") const {
    return run_script("cd '" + scratch_.path().string() + "' && PATH=\"$PWD/bin:$PATH\" " + under + " '" +
                      source_path("tools/boards/run_" + name_) + "' --build . " + words);
  }

 private:
  ScratchDirectory scratch_;
  std::string name_;
};

constexpr const char* kBoards[][2] = {
    {"sifive_u", "qemu-system-riscv64"}, {"zcu102", "qemu-system-aarch64"}, {"virt", "qemu-system-riscv64"},
    {"mps2", "qemu-system-arm"}};

void expect_refused(const ScriptResult& result, const std::string& words) {
  EXPECT_EQ(result.exit_code, 125) << result.output;
  EXPECT_NE(result.output.find(words), std::string::npos) << result.output;
}

TEST(BoardRuns, RefuseBeforeTheyRun) {
  for (const auto& [name, emulator] : kBoards) {
    SCOPED_TRACE(name);
    const Board board(name, emulator, "echo ran; printf new > result.bin");
    expect_refused(board.run("a.job -o a.job"), "a.job: the result would take its place");
    EXPECT_EQ(board.read("a.job"), std::string(256, '\0'));
    expect_refused(board.run("a.job -o none/a.res"), "none/a.res: no place for a file");
    expect_refused(board.run("a.job -o bin"), "bin: no place for a file");
    board.write("b.job", std::string(255, '\0'));
    expect_refused(board.run("b.job -o a.res"), "b.job: ends inside of its first record");
    expect_refused(board.run("c.job -o a.res"), "c.job: no such job");
    EXPECT_EQ(board.read("a.res"), "of another run");
    EXPECT_EQ(board.run("a.job -o a.res").exit_code, 0);
    EXPECT_EQ(board.read("a.res"), "new");
  }
}

// A job for eye rays through the tree, and one for effects, take images of their own.
TEST(BoardRuns, TakeTheImageThatTheJobIsFor) {
  const auto put = [](std::string& job, std::size_t place, char value) { job[place] = value; };
  for (const auto& [name, emulator] : kBoards) {
    SCOPED_TRACE(name);
    const Board board(name, emulator, "readlink firmware.elf > result.bin");
    for (const char* image : {"plain_tree", "effects", "effects_tree"}) {
      board.write("bin/" + std::string(name) + "_" + image + ".elf", "firmware");
    }
    std::string job(1024, '\0');
    put(job, 11, 1);  // base_address, below 4 GB
    put(job, 35, 1);  // frame_address
    put(job, 33, 1);  // 256 bytes further on
    const auto expect_image = [&](const std::string& image) {
      board.write("a.job", job);
      const ScriptResult result = board.run("a.job -o a.res");
      EXPECT_EQ(result.exit_code, 0) << result.output;
      EXPECT_NE(board.read("a.res").find("_" + image + ".elf"), std::string::npos) << board.read("a.res");
    };
    expect_image("plain");
    put(job, 256 + 36, 2);  // FrameHead::engine_id
    expect_image("plain_tree");
    put(job, 140, 1);  // effects
    expect_image("effects_tree");
    put(job, 256 + 36, 1);
    expect_image("effects");
    put(job, 34, 1);  // the record lies beyond the file: the firmware refuses it
    put(job, 140, 0);
    expect_image("plain");
  }
}

TEST(BoardRuns, LeaveNoResultOfAnotherRun) {
  for (const auto& [name, emulator] : kBoards) {
    SCOPED_TRACE(name);
    const Board board(name, emulator, "exit 2");
    EXPECT_EQ(board.run("a.job -o a.res").exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(board.path("a.res")));
  }
}

TEST(BoardRuns, TakeTheEmulatorWithThem) {
  for (const auto& [name, emulator] : kBoards) {
    SCOPED_TRACE(name);
    const Board board(name, emulator, "printf %s $$ > \"$PIDS/pid\"; exec sleep 60");
    for (const std::string signal : {"TERM", "INT", "HUP"}) {
      std::filesystem::remove(board.path("pid"));
      const std::string under = "PIDS=\"$PWD\" timeout --preserve-status --signal=" + signal + " 1";
      EXPECT_GE(board.run("a.job -o a.res", under).exit_code, 128) << signal;
      const std::string pid = board.read("pid");
      EXPECT_NE(run_script("for i in $(seq 50); do kill -0 " + pid + " || exit 1; sleep 0.1; done").exit_code, 0)
          << signal << ": the emulator runs on";
      run_script("kill " + pid);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
