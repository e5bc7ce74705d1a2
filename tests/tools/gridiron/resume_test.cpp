// animate --resume: goes on after complete pictures, gives the bytes of one command, and refuses what has changed.
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>

#include <chrono>
#include <thread>

#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

using Files = std::map<std::string, std::string>;

Files files_of(const fs::path& folder) {
  Files files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    files[entry.path().filename().string()] = read_file(entry.path());
  }
  return files;
}

void write_files(const TemporaryFolder& folder, const std::string& name, const Files& files) {
  fs::remove_all(folder.path(name));
  fs::create_directory(folder.path(name));
  for (const auto& [file, bytes] : files) folder.write(name + "/" + file, bytes);
}

const Words kTurn = {"animate", "a.ply", "-o", "out", "--turntable", "4", "--size", "24x16"};
const Words kResume = {"--resume"};

class Resume : public ::testing::Test {
 protected:
  Resume() {
    (void)run(folder_, kTurn);
    whole_ = files_of(folder_.path("out"));
    EXPECT_EQ(whole_.size(), 7u);
  }

  void expect_resumed(const Words& command, const std::string& kept) {
    const ProgramResult result = run(folder_, command + kResume);
    EXPECT_EQ(result.err, "out/animation.log: " + kept + " pictures complete\n");
    EXPECT_EQ(files_of(folder_.path("out")), whole_);
  }

  void expect_refused(const Words& command, const std::string& words) {
    const Files before = files_of(folder_.path("out"));
    expect_failure(folder_, command + kResume, 1, words);
    EXPECT_EQ(files_of(folder_.path("out")), before);
  }

  const TemporaryFolder folder_{"a.ply", make_sphere(10, 14, 1.0f)};
  Files whole_;
};

// The log ends anywhere, and pictures after it are missing, halves of an older one, or whole.
TEST_F(Resume, GivesTheBytesOfOneCommandWhereverItEnded) {
  const std::string log = whole_.at("animation.log");
  std::vector<std::size_t> ends;  // of the lines of frames
  for (std::size_t place = log.find("\nframe "); place != std::string::npos; place = log.find('\n', place + 1)) {
    ends.push_back(place + 1);
  }
  ASSERT_EQ(ends.size(), 5u);
  for (std::size_t kept = 0; kept <= 4; ++kept) {
    for (const std::size_t more : {std::size_t{0}, std::size_t{9}, std::size_t{40}}) {
      if (kept == 4 && more != 0) continue;
      SCOPED_TRACE(std::to_string(kept) + " frames and " + std::to_string(more) + " bytes");
      Files files = whole_;
      files.at("animation.log") = log.substr(0, ends[kept] + more);
      files.erase("animation.csv");
      if (kept < 4) files.at("frame000" + std::to_string(kept) + ".png").resize(30);
      if (kept < 3) files.erase("frame0003.png");
      write_files(folder_, "out", files);
      expect_resumed(kTurn, std::to_string(kept) + " of 4");
    }
  }
}

TEST_F(Resume, APictureThatChangedIsRenderedAgain) {
  folder_.write("out/frame0001.png", whole_.at("frame0000.png"));
  const ProgramResult result = run(folder_, kTurn + kResume);
  EXPECT_EQ(result.err, "out/animation.log: 3 of 4 pictures complete\n");
  EXPECT_EQ(files_of(folder_.path("out")), whole_);  // the lines of the log too are in order
  EXPECT_EQ(run(folder_, kTurn + kResume).err, "out/animation.log: 4 of 4 pictures complete\n");
}

TEST_F(Resume, WithoutALogItBegins) {
  fs::remove_all(folder_.path("out"));
  expect_resumed(kTurn, "0 of 4");
}

TEST_F(Resume, OptionsWithoutInfluenceMayChange) {
  fs::remove(folder_.path("out/frame0003.png"));
  expect_resumed(kTurn + Words{"--threads", "1"}, "3 of 4");
  const ProgramResult result = run(folder_, kTurn + kResume + Words{"--quiet"});
  EXPECT_EQ(result.err + result.out, "");
}

TEST_F(Resume, RefusesOtherOptions) {
  const std::string anew = "; without --resume the animation begins anew\n";
  const Words other_size = {"animate", "a.ply", "-o", "out", "--turntable", "4", "--size", "16x16"};
  expect_refused(other_size, "out/animation.log:4: cannot be resumed: --size was '24x16' and is '16x16' now" + anew);
  expect_refused(kTurn + Words{"--accuracy", "exact"},
                 "out/animation.log:1: cannot be resumed: --accuracy was not given");
  expect_refused({"animate", "a.ply", "-o", "out", "--turntable", "4"},
                 "--size was '24x16' and is not given now" + anew);
  expect_refused(kTurn + Words{"--machine", "cell-2006"}, "--machine was 'cell-ps3 ");
  folder_.write("a.machine", "based_on cell-ps3\nname cell-ps3\nlatency_cycles 900\n");
  expect_refused(kTurn + Words{"--machine", "a.machine"}, "--machine was 'cell-ps3 ");
  folder_.write("a.camera", "eye 0 0 6\nat 0 0 0\n");
  expect_refused(kTurn + Words{"--camera", "a.camera"},
                 "animation.log:6: cannot be resumed: frame 0 has another view now");
}

TEST_F(Resume, RefusesAnotherMesh) {
  folder_.write_ply("a.ply", make_sphere(10, 14, 1.1f));
  expect_refused(kTurn, "out/animation.log:6: cannot be resumed: frame 0: a.ply has changed, or a file that it names");
}

TEST_F(Resume, RefusesWhatIsNoLog) {
  const std::string log = whole_.at("animation.log");
  const std::pair<std::string, const char*> cases[] = {
      {"", "animation.log:1: cannot be resumed: it is no log"},
      {"frames\n", "animation.log:1: cannot be resumed: it is no log"},
      {"gridiron animation 0.0.1\n" + log.substr(log.find('\n') + 1), "it is of version 0.0.1, this is "},
      {log + "frame 4 1 2 3 4 5 6 7 8 9\n",
       "animation.log:10: cannot be resumed: 'frame 4 1 2 3 4 5 6 7 8 9' is no line"},
      {log + "frame x 1 2 3 4 - - - 8 9 1\n", "is no line of its log"},
      {log + "frame 4 1 2 3 4 - - - 8 9 1\n", "frame 4 was one of it; now there are 4 frames"},
  };
  for (const auto& [text, words] : cases) {
    folder_.write("out/animation.log", text);
    expect_refused(kTurn, words);
  }
}

TEST_F(Resume, ASeriesKnowsTheFilesOfItsScenes) {
  folder_.write("a.nff", "l 3 5 4\nf 1 1 1 1 0 0 0 0\nm a.ply\n");
  folder_.write("b.nff", "l 3 5 4\nf 1 1 1 1 0 0 0 0\ns 1 0 0 1\n");
  const Words series = {"animate", "a.nff", "b.nff", "-o", "out", "--size", "24x16"};
  fs::remove_all(folder_.path("out"));
  (void)run(folder_, series);
  whole_ = files_of(folder_.path("out"));
  fs::remove(folder_.path("out/b.png"));
  expect_resumed(series, "1 of 2");
  const Words backwards = {"animate", "b.nff", "a.nff", "-o", "out", "--size", "24x16"};
  expect_refused(backwards, "frame 0: b.nff has changed, or a file that it names");
  folder_.write_ply("a.ply", make_sphere(8, 12, 1.0f));
  expect_refused(series, "frame 0: a.nff has changed, or a file that it names");
}

TEST_F(Resume, GoesOnAfterSignals) {
  const Words long_turn = {"animate", "a.ply", "-o", "out", "--turntable", "8", "--size", "200x200", "--threads", "1"};
  fs::remove_all(folder_.path("out"));
  (void)run(folder_, long_turn);
  whole_ = files_of(folder_.path("out"));
  fs::remove_all(folder_.path("out"));
  std::size_t pictures = 0;
  for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
    RunningProgram program(folder_.folder(), long_turn + kResume);
    program.wait_until_caught(SIGINT);
    const auto count = [this] {
      std::error_code error;
      std::size_t found = 0;
      for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path("out"), error)) {
        found += entry.path().extension() == ".png" && entry.path().filename().string()[0] != '.' ? 1u : 0u;
      }
      return found;
    };
    for (int i = 0; i < 60'000 && count() <= pictures; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_GT(count(), pictures) << "it did not go on";
    program.send(signal);
    (void)program.wait(std::chrono::seconds(60));
    pictures = count();
    for (const auto& [name, bytes] : files_of(folder_.path("out"))) {
      if (name.ends_with(".png")) {
        EXPECT_EQ(bytes, whole_.at(name)) << name;
      }
      if (name[0] == '.') fs::remove(folder_.path("out/" + name));  // SIGKILL may leave it
    }
  }
  (void)run(folder_, long_turn + kResume);
  EXPECT_EQ(files_of(folder_.path("out")), whole_);
}

}  // namespace
}  // namespace gridiron::test
