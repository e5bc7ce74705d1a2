// Models and the whole program: the picture of a model is that of its PLY; commands, notes and errors.
// SPDX-License-Identifier: Apache-2.0
#include "model_files.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

TEST(ImportProgram, PicturesAreThoseOfThePly) {
  const TestMesh mesh = rounded(make_torus(24, 16, 1.0f, 0.4f));
  const TemporaryFolder folder("a.ply", mesh);
  const Words options = {"--size", "64x48", "--quiet", "--mode", "plain"};
  const auto picture = [&](const std::string& name) {
    (void)run(folder, Words{"render", name, "-o", "picture.png"} + options);
    return read_file(folder.path("picture.png"));
  };
  const std::string expected = picture("a.ply");
  folder.write("a.obj", obj_text(mesh));
  folder.write("a.stl", stl_text(mesh));
  folder.write("b.stl", stl_bytes(mesh));
  folder.write("a.gltf", gltf_text(mesh));
  folder.write("a.glb", glb_bytes(mesh));
  for (const char* name : {"a.obj", "a.stl", "b.stl", "a.gltf", "a.glb"}) EXPECT_EQ(picture(name), expected) << name;
  const ProgramResult piped = run_shell(folder.folder(), "\"$GRIDIRON\" render - -o picture.png --size 64x48 --mode "
                                                         "plain --quiet < a.glb");
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_EQ(read_file(folder.path("picture.png")), expected);
  EXPECT_EQ(piped.err, "");
}

TEST(ImportProgram, CommandsTellWhatWasRead) {
  const TestMesh box = make_box({0, 0, 0}, {1, 1, 1});
  const TemporaryFolder folder("a.obj", obj_text(box) + "l 1 2\n");
  for (const Words& command : {Words{"render", "a.obj", "-o", "a.png", "--size", "8x8"},
                               Words{"pack", "a.obj", "-o", "a.gri"},
                               Words{"job", "a.obj", "-o", "a.job", "--base", "0x80000000", "--size", "8x8"}}) {
    const ProgramResult result = run(folder, command);
    EXPECT_NE(result.err.find("a.obj: OBJ, 1 mesh, 12 triangles; read with Assimp"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("a.obj: ignored: 1 line\n"), std::string::npos) << result.err;
    EXPECT_EQ(run(folder, command + Words{"--quiet"}).err, "");
  }
  // What a file holds is part of what info prints.
  const ProgramResult info = run(folder, {"info", "a.obj"});
  EXPECT_EQ(info.err, "");
  EXPECT_NE(info.out.find("model          OBJ, 1 mesh; read with Assimp"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("ignored        1 line\n"), std::string::npos) << info.out;
  folder.write("b.obj", obj_text(moved(box, 2.0f)));
  (void)run(folder, {"animate", "a.obj", "b.obj", "-o", "frames", "--size", "8x8", "--quiet"});
  EXPECT_TRUE(std::filesystem::exists(folder.path("frames/b.png")));
}

TEST(ImportProgram, ErrorsNameTheFile) {
  const TemporaryFolder folder("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  expect_failure(folder, {"render", "a.obj"}, 1, "a.obj: Assimp cannot read it: ");
  expect_failure(folder, {"render", "lost.obj"}, 1, "lost.obj: No such file");
  expect_failure(folder, {"render", "a.obj", "--import-memory", "0"}, 2, "is not a whole number above 0");
  folder.write("b.obj", "v 0 0 0\n");
  expect_failure(folder, {"render", "b.obj"}, 1, "b.obj: ");
}

// Someone else's arguments do not make the child a danger.
TEST(ImportProgram, TheChildRefusesOtherParents) {
  const TemporaryFolder folder("a.obj", "v 0 0 0\n");
  for (const char* arguments : {"", "a", "a obj 1 1 1 rest", "a obj x y z rest"}) {
    const ProgramResult result =
        run_shell(folder.folder(),
                  std::string("\"$GRIDIRON\" read-model-as-child ") + arguments + " < a.obj | head -c 0");
    EXPECT_EQ(result.out, "");
  }
}

TEST(ImportProgram, InterruptsEndTheChildToo) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 800000; ++i) text += "f 1 2 3\n";
  const TemporaryFolder folder("slow.obj", text);
  RunningProgram program(folder.folder(), {"info", "slow.obj"});
  program.wait_until_caught(SIGINT);
  ::usleep(300000);
  program.send(SIGINT);
  const ProgramResult result = program.wait(std::chrono::seconds(5));
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace gridiron::test
