// Inputs of every command: standard input, pipes, files whose names say nothing, and what is refused.
// SPDX-License-Identifier: Apache-2.0
#include "host_device.h"
#include "run_program.h"
#include "support/sanitizers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

constexpr const char* kTextScene =
    "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 0.01 resolution 24 16\nl 1 2 3\nf 1 0 0 1 0 0 0 0\ns 0 0 0 1\n";

// A folder with a scene of each kind, whose names say nothing of them.
class Inputs : public ::testing::Test {
 protected:
  Inputs() {
    folder_.write_ply("mesh", make_sphere(12, 16, 1.0f));
    folder_.write("text", kTextScene);
    expect_done("pack mesh -o packed");
    folder_.write("camera", "eye 0 0 4\nat 0 0 0\n");
    folder_.write("machine", "based_on cell-ps3\nname mine\ncore_count 3\n");
  }

  // Runs a line that must succeed. @returns what it printed.
  std::string expect_done(const std::string& arguments) {
    const ProgramResult result = run_shell(folder_.folder(), "\"$GRIDIRON\" " + arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments << "\n" << result.err;
    return result.out;
  }

  void expect_failure(const std::string& arguments, int code, const std::string& words) {
    const ProgramResult result = run_shell(folder_.folder(), "\"$GRIDIRON\" " + arguments);
    EXPECT_EQ(result.exit_code, code) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << arguments << "\n" << result.err << "lacks: " << words;
  }

  [[nodiscard]] std::string bytes_of(const std::string& name) const { return read_file(folder_.path(name)); }

  const TemporaryFolder folder_;
};

TEST_F(Inputs, EverySceneComesThroughEveryPipe) {
  const std::string options = " --size 24x16 --quiet";
  for (const std::string scene : {"mesh", "text", "packed"}) {
    expect_done("render " + scene + " -o file.png" + options);
    for (const std::string& input : {"- < " + scene, "/dev/stdin < " + scene, "- < <(cat " + scene + ")",
                                     "<(cat " + scene + ")", "/dev/fd/7 7< " + scene}) {
      expect_done("render -o pipe.png" + options + " " + input);
      EXPECT_EQ(bytes_of("pipe.png"), bytes_of("file.png")) << input;
    }
    const std::string info = expect_done("info --json " + scene);
    const std::string same = " | sed 's,\"/dev/stdin\",\"" + scene + "\",'";
    EXPECT_EQ(expect_done("info --json - < <(cat " + scene + ")" + same), info);
    expect_done("job " + scene + " -o file.job --base 0 --cores 2" + options);
    expect_done("job - -o pipe.job --base 0 --cores 2" + options + " < <(cat " + scene + ")");
    EXPECT_EQ(bytes_of("pipe.job"), bytes_of("file.job"));
  }
  for (const std::string scene : {"mesh", "text"}) {
    expect_done("pack " + scene + " -o file.gri");
    expect_done("pack - -o pipe.gri < <(cat " + scene + ")");
    EXPECT_EQ(bytes_of("pipe.gri"), bytes_of("file.gri"));
  }
}

TEST_F(Inputs, ATextSceneOfAPipeIsShadedAsAFileIs) {
  // The store and its tiles are those of effects, which only the content reveals.
  expect_done("render text --store 64 --tile-width 8 -o file.png --quiet");
  expect_done("render - --store 64 --tile-width 8 -o pipe.png --quiet < <(cat text)");
  EXPECT_EQ(bytes_of("pipe.png"), bytes_of("file.png"));
  expect_done("render - --tolerance 0.5 -o pipe.png --quiet < <(cat text)");
  expect_failure("render - --tolerance 0.5 < <(cat mesh)", 2, "--tolerance: applies to text scenes (NFF) only");
  expect_failure("render - --shading scene < <(cat mesh)", 2, "--shading scene: /dev/stdin has no lights");
  expect_failure("render - --store 128 < <(cat text)", 2, "--shading scene");
}

TEST_F(Inputs, CamerasMachinesJobsAndResultsComeThroughPipes) {
  const std::string options = " --size 24x16 --quiet";
  expect_done("render mesh --camera camera --machine machine -o file.png --report file.json" + options);
  expect_done("render <(cat mesh) --camera <(cat camera) --machine - -o pipe.png --report pipe.json" + options +
              " < <(cat machine)");
  EXPECT_EQ(bytes_of("pipe.png"), bytes_of("file.png"));
  EXPECT_NE(bytes_of("pipe.json").find("\"name\": \"mine\""), std::string::npos);
  EXPECT_EQ(expect_done("machines - < machine"), expect_done("machines machine"));

  expect_done("job mesh -o a.job --base 0x2000000 --cores 2" + options);
  folder_.write("a.res", render_on_host_device(bytes_of("a.job"), 2));
  expect_done("result a.job a.res -o file.png");
  expect_done("result - <(cat a.res) --compare -o pipe.png < <(cat a.job)");
  EXPECT_EQ(bytes_of("pipe.png"), bytes_of("file.png"));
  expect_done("result a.job - -o pipe.png < a.res");
}

TEST_F(Inputs, AnimationsReadPipesOnce) {
  folder_.write_ply("b.ply", make_sphere(8, 12, 1.0f));
  const std::string options = " --size 24x16 --quiet";
  expect_done("animate mesh b.ply -o files" + options);
  expect_done("animate - <(cat b.ply) -o pipes" + options + " < <(cat mesh)");
  EXPECT_EQ(bytes_of("pipes/frame0000.png"), bytes_of("files/mesh.png"));
  EXPECT_EQ(bytes_of("pipes/frame0001.png"), bytes_of("files/b.png"));
  expect_done("animate text -o files" + options);
  expect_done("animate <(cat text) -o pipes" + options);
  EXPECT_EQ(bytes_of("pipes/frame0000.png"), bytes_of("files/text.png"));
  expect_done("animate - --path <(printf 'frame 0\\neye 0 0 5\\nat 0 0 0\\n') -o pipes" + options + " < mesh");
  expect_failure("animate packed -o pipes", 1, "packed: is a packed scene; animate takes meshes (PLY, OBJ");
  expect_failure("animate - --path - -o pipes < mesh", 2, "--path and FRAMES both read");
}

TEST_F(Inputs, WithoutANamePicturesAreCalledPicture) {
  expect_done("render - --size 8x8 --quiet < mesh");
  EXPECT_TRUE(std::filesystem::exists(folder_.path("picture.png")));
}

TEST_F(Inputs, OneStreamServesOneInput) {
  expect_failure("render - --camera - < mesh", 2,
                 "INPUT and --camera both read /dev/stdin, which can be read only once");
  expect_failure("render mesh --camera /dev/stdin --machine - < camera", 2, "--camera and --machine both read");
  expect_failure("info - --machine - < mesh", 2, "INPUT and --machine both read");
  expect_failure("pack - --machine - -o a.gri < mesh", 2, "INPUT and --machine both read");
  expect_failure("animate - - -o frames < mesh", 2, "FRAMES and FRAMES both read");
  expect_failure("result - - < mesh", 2, "JOB and RESULT both read");
  expect_failure("render /dev/fd/7 --camera /dev/fd/8 7< <(cat mesh) 8<&7", 2, "INPUT and --camera both read");
}

TEST_F(Inputs, FilesOfATextInAPipeAreLookedForInTheCurrentFolder) {
  std::filesystem::create_directory(folder_.path("deep"));
  std::filesystem::copy_file(folder_.path("mesh"), folder_.path("deep/part.ply"));
  std::ofstream(folder_.path("deep/scene.nff")) << "b 0 0 0\n" << kTextScene << "m part.ply\n";
  expect_done("render deep/scene.nff -o file.png --quiet");
  expect_done("render -o \"$OLDPWD/pipe.png\" --quiet - < <(cat deep/scene.nff | sed s,part,deep/part,)");
  const ProgramResult inside =
      run_shell(folder_.folder(), "cd deep && \"$GRIDIRON\" render - -o ../pipe.png --quiet < scene.nff");
  EXPECT_EQ(inside.exit_code, 0) << inside.err;
  EXPECT_EQ(bytes_of("pipe.png"), bytes_of("file.png"));
  expect_failure("render - < deep/scene.nff", 1, "/dev/stdin:6: part.ply: No such file");
}

TEST_F(Inputs, OtherFilesAreNamedWithWhatIsReadInstead) {
  folder_.write("picture.ply", "\x89PNG\r\n\x1A\n");
  folder_.write("empty.gri", "");
  expect_failure("render picture.ply", 1,
                 "picture.ply: is a PNG picture; expected a scene: a mesh (PLY, OBJ, STL, glTF), a text scene (NFF)");
  expect_failure("render empty.gri", 1, "empty.gri: is empty; expected a scene");
  expect_failure("render - < /dev/null", 1, "/dev/stdin: is empty; expected a scene");
  expect_failure("render /dev/zero", 1, "/dev/zero: is of no known kind: it begins with '\\x00");
  expect_failure("render mesh --camera packed", 1, "packed: is a packed scene; expected a camera file");
  expect_failure("render mesh --machine packed", 1, "packed: is a packed scene; expected a machine file");
  expect_failure("render mesh --camera .", 1, ".: is a folder; expected a camera file");
  expect_failure("result . mesh", 1, ".: is a folder; expected a job");
  expect_failure("result mesh mesh", 1, "mesh: is a PLY mesh; expected a job");
}

// The sanitizers' own memory does not fit the limit.
TEST_F(Inputs, ShortageOfMemoryNamesTheFile) {
#if defined(GRIDIRON_TEST_SANITIZED)
  GTEST_SKIP() << "not under sanitizers";
#endif
  std::filesystem::resize_file(folder_.path("packed"), std::uintmax_t{1} << 30);
  std::filesystem::resize_file(folder_.path("mesh"), std::uintmax_t{1} << 30);
  const std::string limit = "ulimit -v 600000; ";
  for (const std::string arguments : {"render packed", "info mesh", "pack mesh -o a.gri"}) {
    const ProgramResult result = run_shell(folder_.folder(), limit + "\"$GRIDIRON\" " + arguments);
    EXPECT_EQ(result.exit_code, 1);
    const std::string file = arguments.find("packed") != std::string::npos ? "packed" : "mesh";
    EXPECT_EQ(result.err, file + ": this host has not enough memory to read it\n") << arguments;
  }
}

}  // namespace
}  // namespace gridiron::test
