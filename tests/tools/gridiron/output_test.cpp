// Outputs of the program: nothing is lost, and pipes are outputs too. SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

// Runs a line of the shell in the folder, $G being the program. Standard output and error are the files out and err.
int run_line(const TemporaryFolder& folder, const std::string& line) {
  const std::string command =
      "cd '" + folder.folder().string() + "' && G='" GRIDIRON_PROGRAM "'; { " + line + "; } > out 2> err < /dev/null";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(Output, NeverTakesThePlaceOfAnInput) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path("c"));
  const TestMesh ball = make_sphere(6, 8, 1.0f);
  const auto first = folder.write_ply("c/1.ply", ball);
  folder.write_ply("c/2.ply", ball);
  folder.write_ply("bunny.ply", ball);
  folder.write("v.camera", "eye 0 0 5\nat 0 0 0\n");
  folder.write("m.machine", "based_on cell-ps3\n");
  const std::string whole = read_file(first);
  const struct {
    const char *link, *target;
    Words arguments;
    const char* words;
    bool is_hard = false;
  } cases[] = {
      {"c/2.png", "1.ply", {"animate", "c", "-o", "c"}, "c/2.png: is the input 'c/1.ply'"},
      {"c/2.png", "1.ply", {"animate", "c", "-o", "c", "--eye", "0,0,5", "--at", "0,0,0"}, "c/2.png: is the input"},
      {"c/2.png", "c/1.ply", {"animate", "c", "-o", "c"}, "c/2.png: is the input 'c/1.ply'", true},
      {"c/1.png", "1.ply", {"animate", "c", "-o", "c"}, "c/1.png: is the input 'c/1.ply'"},
      {"c/animation.csv", "../v.camera", {"animate", "c", "-o", "c", "--camera", "v.camera"}, "'v.camera'"},
      {"c/animation.csv", "../m.machine", {"animate", "c", "-o", "c", "--machine", "m.machine"}, "'m.machine'"},
      {"c/1.png", "new.png", {"animate", "c", "-o", "c"}, "c/1.png and c/new.png are the same file"},
      {"c/1.png", "2.png", {"animate", "c", "-o", "c"}, "c/1.png and c/2.png are the same file"},
      {"c/index.html", "../bunny.ply", {"experiment", "paper", "-o", "c", "--scenes", "."}, "'./bunny.ply'"},
      {"c/prices.csv", "../bunny.ply", {"experiment", "accuracy", "-o", "c", "--scenes", "."}, "'./bunny.ply'"},
      {"c/prices.csv", "index.html", {"experiment", "accuracy", "-o", "c"}, "c/prices.csv"},
      {"l.png", "v.camera", {"render", "bunny.ply", "-o", "l.png", "--camera", "v.camera"}, "'v.camera'"},
  };
  for (const auto& each : cases) {
    Words arguments = each.arguments;
    const fs::path link = folder.path(each.link);
    if (std::string(each.words).find("new.png") != std::string::npos) {
      folder.write_ply("c/new.ply", ball);
    }
    if (each.is_hard) {
      fs::create_hard_link(folder.path(each.target), link);
    } else {
      fs::create_symlink(each.target, link);
    }
    expect_failure(folder, arguments, 2, each.words);
    EXPECT_EQ(read_file(first), whole);
    EXPECT_EQ(read_file(folder.path("bunny.ply")), whole);
    EXPECT_EQ(read_file(folder.path("v.camera")), "eye 0 0 5\nat 0 0 0\n");
    EXPECT_FALSE(fs::exists(folder.path("c/animation.csv")) && each.link != std::string("c/animation.csv"));
    fs::remove(link);
    fs::remove(folder.path("c/new.ply"));
  }
}

TEST(Output, IsStandardOutputAsBytesOfTheFile) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  const std::string render = "\"$G\" render a.ply --size 40x24 ";
  ASSERT_EQ(run_line(folder, render + "-o a.png --depth d.pfm --report r.json"), 0) << read_file(folder.path("err"));
  const std::string png = read_file(folder.path("a.png"));
  EXPECT_EQ(png.substr(1, 3), "PNG");
  for (const char* way : {"-o -", "-o /dev/stdout", "-o /dev/fd/1"}) {
    for (const char* end : {"", " | cat", " > file; cat file"}) {
      EXPECT_EQ(run_line(folder, render + way + end), 0) << way << end;
      EXPECT_EQ(read_file(folder.path("out")), png) << way << end;
      const std::string words = read_file(folder.path("err"));
      EXPECT_NE(words.find("cell-ps3, 6 cores: "), std::string::npos) << words;
      const std::string name = std::string(way) == "-o -" ? "standard output" : std::string(way).substr(3);
      EXPECT_EQ(words.find(name + ": 40x24, hash "), 0u) << words;
    }
  }
  EXPECT_EQ(run_line(folder, render + "-o b.png --depth - --quiet"), 0);
  EXPECT_EQ(read_file(folder.path("out")), read_file(folder.path("d.pfm")));
  EXPECT_EQ(read_file(folder.path("err")), "");
  EXPECT_EQ(run_line(folder, "echo before > file; " + render + "-o - --quiet >> file; cat file"), 0);
  EXPECT_EQ(read_file(folder.path("out")), "before\n" + png);
  EXPECT_EQ(run_line(folder, render + "-o /dev/fd/7 --depth - --quiet 7> seven.png"), 0);
  EXPECT_EQ(read_file(folder.path("seven.png")), png);
  EXPECT_EQ(run_line(folder, "mkfifo p; cat p > q & " + render + "-o p; wait"), 0);
  EXPECT_EQ(read_file(folder.path("q")), png);
  EXPECT_EQ(
      run_line(folder, "exec bash -c '\"$0\" render a.ply --size 40x24 -o >(cat > s; kill $$) & sleep 60' \"$G\""),
      -SIGTERM);
  EXPECT_EQ(read_file(folder.path("s")), png);
  for (const char* other : {"pack a.ply -o", "job a.ply --base 0 -o"}) {
    EXPECT_EQ(run_line(folder, std::string("\"$G\" ") + other + " x && \"$G\" " + other + " - | cmp - x"), 0) << other;
  }
}

TEST(Output, StandardOutputThatCannotTakeItIsTold) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  const std::string render = "\"$G\" render a.ply --size 8x8 ";
  const struct {
    std::string line;
    int exit_code;
    const char* words;
  } cases[] = {
      {render + "-o - >&-", 1, "standard output: cannot write: it is not open for writing"},
      {render + "-o - > /dev/full", 1, "standard output: cannot write: No space left on device"},
      {render + "-o a.png > /dev/full", 1,
       "standard output: cannot write: No space left on device\n1 file was written"},
      {render + "-o a.png >&-", 1, "standard output: cannot write"},
      {"{ sleep 0.2; " + render + "-o -; echo $? >&2; } | true", 0, "Broken pipe\n1\n"},
      {render + "-o /dev/fd/9", 1, "/dev/fd/9: cannot write: Bad file descriptor"},
      {render + "-o /dev/fd/0", 1, "/dev/fd/0: cannot write: it is not open for writing"},
      {render + "-o - --depth /dev/fd/3 3>&-", 1, "/dev/fd/3: cannot write: Bad file descriptor"},
      {"\"$G\" machines > /dev/full", 1, "standard output: cannot write: No space left on device"},
  };
  for (const auto& each : cases) {
    EXPECT_EQ(run_line(folder, each.line), each.exit_code) << each.line;
    const std::string words = read_file(folder.path("err"));
    EXPECT_NE(words.find(each.words), std::string::npos) << words << "\nlacks: " << each.words;
    fs::remove(folder.path("out"));
    fs::remove(folder.path("err"));
    const bool keeps = each.line.find("a.png") != std::string::npos;
    EXPECT_EQ(folder.names(), (keeps ? Words{"a.ply", "a.png"} : Words{"a.ply"})) << each.line;
    if (keeps) {
      EXPECT_EQ(read_file(folder.path("a.png")).substr(1, 3), "PNG");
    }
    fs::remove(folder.path("a.png"));
  }
}

TEST(Output, NoPictureGoesToATerminal) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) GTEST_SKIP() << "no terminals here";
  const std::string name = ::ptsname(terminal), render = "\"$G\" render a.ply --size 8x8 ";
  for (const std::string& way : {render + "-o - > " + name, render + "-o " + name, render + "-o a.png --ids " + name,
                                 "\"$G\" pack a.ply -o - > " + name}) {
    EXPECT_EQ(run_line(folder, way), 2) << way;
    EXPECT_NE(read_file(folder.path("err")).find("is a terminal, which cannot show it"), std::string::npos) << way;
  }
  EXPECT_EQ(run_line(folder, render + "-o a.png --report - > " + name), 0) << read_file(folder.path("err"));
  ::close(terminal);
}

TEST(Output, AFileThatOutgrowsItsLimitIsLeftOut) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  folder.write("a.png", "earlier");
  EXPECT_EQ(run_line(folder, "ulimit -f 4; \"$G\" render a.ply --size 64x64 -o a.png --depth d.pfm"), 1);
  EXPECT_EQ(read_file(folder.path("err")), "d.pfm: cannot write: File too large\n");
  EXPECT_EQ(folder.names(), (Words{"a.ply", "a.png", "err", "out"}));
  EXPECT_EQ(read_file(folder.path("a.png")), "earlier");
}

TEST(Output, LinksInALoopAreAnErrorAndStay) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  fs::create_symlink("b.png", folder.path("a.png"));
  fs::create_symlink("a.png", folder.path("b.png"));
  const ProgramResult result = run_program(folder.folder(), {"render", "a.ply", "--size", "8x8", "-o", "a.png"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "a.png: cannot write: Too many levels of symbolic links\n");
  EXPECT_TRUE(fs::is_symlink(folder.path("a.png")));
}

TEST(Output, AnInterruptedAnimationTellsWhatIsKept) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  ASSERT_EQ(::mkfifo(folder.path("b.ply").c_str(), 0600), 0);  // the second frame waits for ever
  const Words view = {"--eye", "0,0,5", "--at", "0,0,0"};
  for (const int signal : {SIGTERM, SIGHUP}) {
    RunningProgram program(folder.folder(), {"animate", "a.ply", "b.ply", "-o", "out", "--size", "8x8", view[0],
                                             view[1], view[2], view[3]});
    while (!fs::exists(folder.path("out/a.png"))) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    program.send(signal);
    const ProgramResult result = program.wait(std::chrono::seconds(60));
    EXPECT_EQ(result.exit_code, 128 + signal) << result.err;
    EXPECT_EQ(result.err, "interrupted; 1 file was written before that and is kept\n");
    EXPECT_FALSE(fs::exists(folder.path("out/animation.csv")));
    fs::remove_all(folder.path("out"));
  }
  folder.write("c.ply", "ply\nformat ascii 1.0\nelement vertex many\n");
  const ProgramResult result = run_program(
      folder.folder(), {"animate", "a.ply", "c.ply", "-o", "out", "--size", "8x8", view[0], view[1], view[2], view[3]});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("\n1 file was written before that and is kept\n"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace gridiron::test
