// render that cannot: exit codes, words, and no file left behind. SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

TEST(RenderFailure, BadInputNamesFileAndLineOrByte) {
  const TemporaryFolder folder("text.ply", "ply\nformat ascii 1.0\nelement vertex many\n");
  folder.write("index.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n");
  folder.write_ply("whole.ply", make_sphere(8, 12, 1.0f));
  const std::string whole = read_file(folder.path("whole.ply"));
  folder.write("short.ply", whole.substr(0, whole.size() - 1));
  folder.write("empty.ply", "");
  folder.write("a.nff", "v\n");
  folder.write("a.txt", "ply\n");
  std::filesystem::create_directory(folder.path("folder.ply"));
  const struct {
    const char* input;
    std::string words;
  } cases[] = {
      {"missing.ply", "missing.ply: No such file or directory"},
      {"nowhere/bunny.ply", "nowhere/bunny.ply: No such file or directory; bunny.ply is a public scan"},
      {"conference.ply", "tools/fetch_scenes"},
      {"text.ply", "text.ply:3: "},
      {"index.ply", "index.ply:13: "},
      {"short.ply", "short.ply:byte " + std::to_string(whole.size() - 1) + ": "},
      {"empty.ply", "empty.ply: is empty; "},
      {"folder.ply", "folder.ply: is a folder; "},
      {"a.nff", "a.nff:1: the file ends inside 'v'"},
      {"a.txt", "a.txt:2: "},
  };
  for (const auto& input : cases) {
    expect_failure(folder, {"render", input.input, "-o", "out.png", "--depth", "d.pfm"}, 1, input.words);
    expect_failure(folder, {"info", input.input}, 1, input.words);
    expect_failure(folder, {"pack", input.input, "-o", "out.gri"}, 1, input.words);
  }
  expect_failure(folder, {"render", "empty.ply"}, 1,
                 "; expected a scene: a mesh (PLY, OBJ, STL, glTF), a text scene (NFF) or a packed scene (made by "
                 "'gridiron pack')\n");
  expect_failure(folder, {"pack", "empty.ply", "-o", "out.gri"}, 1,
                 "; pack takes a mesh (PLY, OBJ, STL, glTF) or a text scene (NFF)\n");
}

TEST(RenderFailure, ScenesWithoutATriangleToTrace) {
  const TemporaryFolder folder;
  TestMesh cloud = make_sphere(8, 12, 1.0f);
  cloud.triangles.clear();
  folder.write_ply("cloud.ply", cloud);
  folder.write("edges.ply",
               "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
               "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n0 1\n");
  expect_failure(folder, {"render", "edges.ply"}, 1, "edges.ply: no triangles: it holds 1 line\n");
  folder.write_ply("line.ply", make_triangle(Vec3(0), Vec3(1, 0, 0), Vec3(2, 0, 0)));
  expect_failure(folder, {"render", "cloud.ply"}, 1, "cloud.ply: no triangles: a point cloud of ");
  expect_failure(folder, {"render", "line.ply"}, 1, "line.ply: no triangle to trace: all 1 have zero area");
}

TEST(RenderFailure, ViewsBeyondFloatsNameTheScene) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  expect_failure(folder, {"render", "a.ply", "--size", "8x8", "--eye", "0,0,1e37", "--at", "0,0,0"}, 2,
                 "no camera can be made of it for a.ply; ");
}

TEST(RenderFailure, OutputsThatCannotBeWritten) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  std::filesystem::create_directory(folder.path("folder"));
  const Words scene = {"render", "a.ply", "--size", "8x8"};
  for (const char* option : {"-o", "--depth", "--ids", "--report", "--timeline"}) {
    for (const char* path : {"missing/x", "a.ply/x", "folder", "/proc/gridiron_test.pfm"}) {
      Words arguments = scene;
      if (std::string(option) != "-o") arguments.insert(arguments.end(), {"-o", "good.png"});
      arguments.insert(arguments.end(), {option, path});
      expect_failure(folder, arguments, 1, std::string(path) + ": cannot write");
    }
  }
  expect_failure(folder, {"render", "a.ply", "--size", "8x8", "-o", "good.png", "--report", "/dev/full"}, 1,
                 "/dev/full: cannot write: No space left on device");
  expect_failure(folder, {"pack", "a.ply", "-o", "missing/x.gri"}, 1, "missing/x.gri: cannot write");
}

TEST(RenderFailure, AFailureKeepsTheFilesOfAnEarlierRun) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  folder.write("out.png", "earlier");
  expect_failure(folder, {"render", "a.ply", "-o", "out.png", "--report", "/dev/full"}, 1, "/dev/full");
  EXPECT_EQ(read_file(folder.path("out.png")), "earlier");
}

TEST(RenderFailure, PicturesLargerThanTheMachine) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  expect_failure(folder, {"render", "a.ply", "--size", "16384x16384"}, 1, "a whole frame of 16384x16384 needs 1,073,7");
  // All the memory but what the simulator keeps; one tile is a part of the whole frame.
  const std::string words =
      "a whole frame of 8192x8192 needs 268,435,840 bytes of main memory; cell-ps3 has 268,431,360 for it";
  expect_failure(folder, {"render", "a.ply", "--size", "8192x8192"}, 1, words);
  expect_failure(folder, {"render", "a.ply", "--size", "8192x8192", "--tile", "0,0"}, 1, words);
}

TEST(RenderFailure, ViewsThatNoCameraHas) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  folder.write("bad.camera", "eye 1 2 3\nat 0 0\n");
  expect_failure(folder, {"render", "a.ply", "--eye", "1,2,3", "--at", "1,2,3"}, 2, "eye and at are the same point");
  expect_failure(folder, {"render", "a.ply", "--eye", "0,5,0", "--at", "0,0,0"}, 2, "up points along the view");
  expect_failure(folder, {"render", "a.ply", "--tile", "16,0"}, 2, "16 columns and 16 rows of tiles");
  expect_failure(folder, with_reference({"render", "a.ply", "--tile", "32,0"}), 2, "32 columns and 32 rows of tiles");
  expect_failure(folder, {"render", "a.ply", "--tile", "1,0", "--size", "9x9"}, 2, "has 1 column and 1 row of tiles");
  expect_failure(folder, {"render", "a.ply", "--camera", "bad.camera"}, 1, "bad.camera:2: ");
  expect_failure(folder, {"render", "a.ply", "--camera", "none.camera"}, 1, "none.camera: No such file");
}

TEST(RenderFailure, TheStoreMustHoldThePackedMacrocells) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  run(folder, with_reference({"pack", "a.ply", "-o", "a.gri", "--macro-width", "8"}));
  expect_failure(folder, with_reference({"render", "a.gri", "--store", "64"}), 1,
                 "a.gri: scene image that this local store");
}

TEST(RenderFailure, SignalsThatTheParentIgnoresStayIgnored) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  const ProgramResult result = run_shell(folder.folder(), R"sh(
mkfifo pipe
trap '' INT TERM HUP
"$GRIDIRON" render - --size 8x8 -o a.png --quiet < pipe &
exec 3> pipe
until [ -z "$(readlink /proc/$!/exe | grep bash)" ]; do sleep 0.01; done
sleep 0.3
kill -INT $!; kill -TERM $!; kill -HUP $!
cat a.ply >&3
exec 3>&-
wait $!)sh");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path("a.png")));
}

// Sends `signal` some time into a render that would last for most of a minute.
void expect_interrupt(int signal, std::chrono::milliseconds delay) {
  const TemporaryFolder folder("a.ply", make_torus(200, 100, 1.0f, 0.4f));
  folder.write("a.png", "earlier");
  RunningProgram program(folder.folder(), with_reference({"render", "a.ply", "-o", "a.png", "--report", "r.json",
                                                          "--size", "7000x7000", "--threads", "1", "--completion",
                                                          "random", "--packet", "4", "--no-culling", "--no-mailbox"}));
  program.wait_until_caught(signal);
  std::this_thread::sleep_for(delay);
  program.send(signal);
  const ProgramResult result = program.wait(std::chrono::minutes(1));  // it stops at the next tile
  EXPECT_EQ(result.exit_code, signal == SIGTERM ? 143 : 130) << result.err;
  EXPECT_EQ(result.err, "interrupted; no file was written\n");
  EXPECT_EQ(folder.names(), (Words{"a.ply", "a.png"}));
  EXPECT_EQ(read_file(folder.path("a.png")), "earlier");
}

TEST(RenderFailure, AnInterruptStopsBetweenTilesAndLeavesNothing) {
  expect_interrupt(SIGINT, std::chrono::milliseconds(300));
  expect_interrupt(SIGTERM, std::chrono::milliseconds(400));
}

// A named pipe whose other end is open where `is_open`, so that only the bytes are missing.
class Pipe {
 public:
  Pipe(const std::filesystem::path& path, bool is_open) {
    EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0) << path;
    if (is_open) descriptor_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  }
  ~Pipe() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

 private:
  int descriptor_ = -1;
};

TEST(RenderFailure, AnInterruptEndsTheWaitForAPipe) {
  const Words cases[] = {
      {"machines", "pipe.ply"},
      {"info", "pipe.ply"},
      {"render", "pipe.ply", "-o", "a.png"},
      {"render", "a.ply", "-o", "a.png", "--camera", "pipe.ply"},
      {"render", "a.ply", "-o", "a.png", "--machine", "pipe.ply"},
      {"render", "a.ply", "-o", "a.png", "--size", "256x256", "--depth", "pipe.ply"},  // more than a pipe holds
  };
  for (const Words& arguments : cases) {
    for (const bool is_open : {false, true}) {
      SCOPED_TRACE(arguments[0] + " " + arguments.back() + (is_open ? ", open" : ", not open"));
      const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
      const Pipe pipe(folder.path("pipe.ply"), is_open);
      RunningProgram program(folder.folder(), arguments);
      const int signal = is_open ? SIGTERM : SIGINT;
      program.wait_until_caught(signal);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));  // long enough to be at the pipe, most times
      program.send(signal);
      const ProgramResult result = program.wait(std::chrono::seconds(60));
      EXPECT_EQ(result.exit_code, is_open ? 143 : 130) << result.err;
      EXPECT_EQ(result.err, "interrupted; no file was written\n");
      EXPECT_EQ(folder.names(), (Words{"a.ply", "pipe.ply"}));
    }
  }
}

TEST(RenderFailure, AnInterruptAtAnyTimeLeavesAllOrNothing) {
  for (int step = 0; step < 8; ++step) {
    const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
    RunningProgram program(folder.folder(),
                           {"render", "a.ply", "-o", "a.png", "--report", "r.json", "--size", "256x256"});
    std::this_thread::sleep_for(std::chrono::milliseconds(7 * step));
    program.send(SIGINT);
    const ProgramResult result = program.wait();
    const Words expected = result.exit_code == 0 ? Words{"a.ply", "a.png", "r.json"} : Words{"a.ply"};
    EXPECT_EQ(folder.names(), expected) << "after " << 7 * step << " ms, exit code " << result.exit_code;
    // A signal before main has begun ends the process by itself.
    const bool ended_as_promised = result.exit_code == 0 || result.exit_code == 130 || result.exit_code == -SIGINT;
    EXPECT_TRUE(ended_as_promised) << result.exit_code;
  }
}

}  // namespace
}  // namespace gridiron::test
