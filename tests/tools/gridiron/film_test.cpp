// animate --film: pictures go to ffmpeg in their order, and no film that is not whole stays.
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>

#include <chrono>
#include <thread>

#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

// A folder with a mesh, and with an ffmpeg of its own that does what a script says.
class Film : public ::testing::Test {
 protected:
  Film() { fs::create_directory(folder_.path("bin")); }

  // $film is its output.
  void write_ffmpeg(const std::string& script) {
    folder_.write("bin/ffmpeg", "#!/bin/bash\nfilm=${!#}; film=${film#file:}\n" + script + "\n");
    fs::permissions(folder_.path("bin/ffmpeg"), fs::perms::owner_all);
  }

  ProgramResult animate(const std::string& options, const std::string& path = "$PWD/bin:$PATH") {
    return run_shell(folder_.folder(), "PATH=\"" + path + "\" exec \"$GRIDIRON\" " + kTurn + options);
  }

  const std::string kTurn = "animate a.ply -o out --turntable 3 --size 24x16 ";
  const TemporaryFolder folder_{"a.ply", make_sphere(10, 14, 1.0f)};
};

TEST_F(Film, HasAllPicturesInOrder) {
  write_ffmpeg("cat > \"$film\"; printf '%s ' \"$@\" > words");
  EXPECT_EQ(animate("--film a.mp4 --fps 12.5").exit_code, 0);
  std::string pictures;
  for (const char* name : {"out/frame0000.png", "out/frame0001.png", "out/frame0002.png"}) {
    pictures += read_file(folder_.path(name));
  }
  EXPECT_EQ(read_file(folder_.path("a.mp4")), pictures);
  const std::string words = read_file(folder_.path("words"));
  EXPECT_NE(words.find("-framerate 12.5 "), std::string::npos) << words;
  EXPECT_NE(words.find("-f mp4 "), std::string::npos) << words;
  EXPECT_EQ(folder_.names(), (Words{"a.mp4", "a.ply", "bin", "out", "words"}));

  const ProgramResult later = animate("--film out/a.GIF --resume --quiet");
  EXPECT_EQ(later.exit_code, 0) << later.err;
  EXPECT_EQ(read_file(folder_.path("out/a.GIF")), pictures);
  EXPECT_NE(read_file(folder_.path("words")).find("-framerate 24 "), std::string::npos);
  EXPECT_NE(read_file(folder_.path("words")).find("-f gif "), std::string::npos);
}

TEST_F(Film, WithoutFfmpegNothingBegins) {
  const ProgramResult result = animate("--film a.mp4", "/nowhere::.");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(
      result.err,
      "a.mp4: cannot write: no folder of PATH has ffmpeg, which makes films of pictures; without --film there are "
      "the pictures alone\n");
  EXPECT_EQ(folder_.names(), (Words{"a.ply", "bin"}));
}

TEST_F(Film, AFailureKeepsPicturesTableAndTheEarlierFilm) {
  folder_.write("a.webm", "earlier");
  const std::pair<const char*, const char*> cases[] = {
      {"head -c 10 > \"$film\"; echo bad >&2; echo 'no such encoder' >&2; exit 3",
       "a.webm: cannot write: ffmpeg ended with exit code 3: 'no such encoder'\n"},
      {"exec 0<&-; exit 1", "a.webm: cannot write: ffmpeg ended with exit code 1\n"},
      {"cat > \"$film\"; kill -9 $$", "a.webm: cannot write: ffmpeg ended with signal 9\n"},
  };
  for (const auto& [script, words] : cases) {
    fs::remove_all(folder_.path("out"));
    write_ffmpeg(script);
    const ProgramResult result = animate("--film a.webm");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, words + std::string("5 files were written before that and are kept\n"));
    EXPECT_EQ(read_file(folder_.path("a.webm")), "earlier");
    EXPECT_TRUE(fs::exists(folder_.path("out/animation.csv")));
    EXPECT_EQ(folder_.names(), (Words{"a.ply", "a.webm", "bin", "out"}));
  }
}

TEST_F(Film, AnInterruptEndsFfmpegToo) {
  write_ffmpeg("echo $$ > process; echo half > \"$film\"; exec sleep 60");
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", (folder_.path("bin").string() + ":" + before).c_str(), 1);
  for (const int signal : {SIGINT, SIGKILL}) {
    RunningProgram program(folder_.folder(),
                           {"animate", "a.ply", "-o", "out", "--size", "24x16", "--film", "out/a.mp4"});
    const auto has_begun = [this] {
      return fs::exists(folder_.path("process")) && read_file(folder_.path("process")).find('\n') != std::string::npos;
    };
    for (int i = 0; i < 30'000 && !has_begun(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_TRUE(has_begun());
    program.send(signal);
    const ProgramResult result = program.wait(std::chrono::seconds(30));
    if (signal == SIGINT) {
      EXPECT_EQ(result.exit_code, 130);
      EXPECT_EQ(result.err, "interrupted; 4 files were written before that and are kept\n");
      std::vector<std::string> names;
      for (const auto& entry : fs::directory_iterator(folder_.path("out"))) {
        names.push_back(entry.path().filename().string());
      }
      std::ranges::sort(names);
      EXPECT_EQ(names, (Words{"a.png", "animation.csv", "animation.log", "animation.svg", "animation_passes.csv"}));
    }
    const int process = std::stoi(read_file(folder_.path("process")));
    const auto lives = [process] {  // it may be somebody's to wait for, as a zombie
      std::ifstream status("/proc/" + std::to_string(process) + "/stat");
      std::string text;
      std::getline(status, text);
      return !text.empty() && text.find(") Z ") == std::string::npos;
    };
    for (int i = 0; i < 2000 && lives(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    EXPECT_FALSE(lives());
    fs::remove(folder_.path("process"));
  }
  ::setenv("PATH", before.c_str(), 1);
}

TEST_F(Film, WhatCannotBeOneIsTold) {
  write_ffmpeg("cat > \"$film\"");
  fs::create_directory(folder_.path("a.mp4"));
  const std::pair<const char*, const char*> cases[] = {
      {"--film a.avi", "--film a.avi: the name of a film must end in .mp4, .webm or .gif"},
      {"--film -", "--film -: a film can only be a file"},
      {"--film /dev/null", "--film /dev/null: a film can only be a file"},
      {"--film a.mp4", "a.mp4: cannot write: it is a folder"},
      {"--film b.mp4 --fps 0", "'0' is not a number from 0.01 to 1000"},
      {"--fps 3", "--fps: is of --film"},
  };
  for (const auto& [options, words] : cases) {
    const ProgramResult result = animate(options);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err << "\nlacks: " << words;
    EXPECT_EQ(folder_.names(), (Words{"a.mp4", "a.ply", "bin"}));
  }
}

}  // namespace
}  // namespace gridiron::test
