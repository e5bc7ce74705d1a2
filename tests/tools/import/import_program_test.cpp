// Models and the whole program: the picture of a model is that of its PLY; commands, notes and errors.
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>

#include <nlohmann/json.hpp>

#include "gltf_writer.h"
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
  for (const Words& command :
       {Words{"render", "a.obj", "-o", "a.png", "--size", "8x8"}, Words{"pack", "a.obj", "-o", "a.gri"},
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
  folder.write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  expect_failure(folder, {"render", "lines.obj"}, 1, "lines.obj: no triangles: it holds 1 line\n");
  folder.write("wide.obj", std::string("\xFF\xFEv\0 \0", 6));
  expect_failure(folder, {"render", "wide.obj"}, 1, "wide.obj: is UTF-16 text; save it as UTF-8; expected a scene: ");
}

// The place of a triangle tells which animation is shown.
TEST(ImportProgram, AnimateShowsTheAnimationThatIsNamed) {
  GltfWriter writer;
  (void)writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  (void)writer.add_floats({0, 1}, "SCALAR", 1);
  (void)writer.add_floats({0, 0, 0, 1, 0, 0}, "VEC3", 3);
  (void)writer.add_floats({0, 0, 0, -1, 0, 0}, "VEC3", 3);
  const auto animation = [](const std::string& name, int output) {
    return "{\"name\":\"" + name +
           "\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}]," +
           "\"samplers\":[{\"input\":1,\"output\":" + std::to_string(output) + "}]}";
  };
  const TemporaryFolder folder(
      "a.gltf", writer.text("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{"
                            "\"attributes\":{\"POSITION\":0}}]}],\"animations\":[" +
                            animation("right", 2) + "," + animation("left", 3) + "]"));
  const auto last_picture = [&](const Words& clip) {
    const ProgramResult result = run(folder, Words{"animate", "a.gltf", "-o", "out", "--animation", "2", "--size",
                                                   "32x16", "--eye", "0,0,4", "--at", "0,0,0"} +
                                                 clip);
    EXPECT_NE(result.err.find("a.gltf: ignored: 1 animation\n"), std::string::npos) << result.err;
    return read_file(folder.path("out/frame0001.png"));
  };
  const std::string right = last_picture({}), left = last_picture({"--clip", "left"});
  EXPECT_NE(right, left);
  EXPECT_EQ(last_picture({"--clip", "2"}), left);
  EXPECT_EQ(last_picture({"--clip", "1"}), right);
  const Words animate = {"animate", "a.gltf", "-o", "out"};
  expect_failure(folder, animate + Words{"--animation", "2", "--clip", "3"}, 1,
                 "a.gltf: has 2 animations, 1 'right' and 2 'left'; none is '3'");
  expect_failure(folder, animate + Words{"--clip", "1"}, 2, "--clip: is of --animation");
  folder.write("still.obj", obj_text(make_box({0, 0, 0}, {1, 1, 1})));
  expect_failure(folder, {"animate", "still.obj", "-o", "out", "--animation", "2"}, 1,
                 "still.obj: has no animation, which --animation shows");
  const ProgramResult info = run(folder, {"info", "a.gltf"});
  EXPECT_NE(info.out.find("animations     2: 'right' 1 s and 'left' 1 s\n"), std::string::npos) << info.out;
}

TEST(ImportProgram, InfoTellsWhatAMeshHolds) {
  using Json = nlohmann::json;
  const TestMesh box = make_box({0, 0, 0}, {1, 1, 1});
  const TemporaryFolder folder(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty "
      "uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 0 255 0\n0 1 0 0 0 1 0 0 255\n3 0 1 2\n");
  folder.write_ply("plain.ply", box);
  folder.write("a.gltf", gltf_text(box, {.material = "\"name\":\"one\"", .more = ",\"cameras\":[]"}));
  folder.write("scene.nff",
               "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\nl 5 5 5\nf 1 1 1 1 0 0 0 "
               "0\np 3\n0 0 0\n1 0 0\n0 1 0\n");
  const auto model = [&](const std::string& name) {
    const ProgramResult result = run(folder, {"info", name, "--json"});
    return Json::parse(result.out, nullptr, false)["model"];
  };
  EXPECT_EQ(model("a.ply"), Json::parse(R"({"format": "PLY", "reader": null, "meshes": 1, "materials": 0, "textures": 0,
    "normals": true, "colors": true, "unit_metres": null, "up": null, "animations": [], "ignored": []})"));
  EXPECT_EQ(model("plain.ply")["normals"], false);
  const Json gltf = model("a.gltf");
  EXPECT_EQ(gltf["format"], "glTF");
  EXPECT_EQ(gltf["reader"].get<std::string>().substr(0, 7), "Assimp ");
  EXPECT_EQ(gltf["materials"], 1);
  EXPECT_EQ(gltf["unit_metres"], 1.0);
  EXPECT_EQ(gltf["up"], "y");
  EXPECT_TRUE(model("scene.nff").is_null());
  // Words: a PLY is worth a line for what a frame without a look does not show.
  EXPECT_NE(run(folder, {"info", "a.ply"}).out.find("\nmodel          PLY, normals, colours\n"), std::string::npos);
  EXPECT_EQ(run(folder, {"info", "plain.ply"}).out.find("\nmodel "), std::string::npos);
  const Words picture = {"-o", "a.png", "--size", "8x8"};
  EXPECT_EQ(run(folder, Words{"render", "a.ply"} + picture).err, "a.ply: PLY, 1 triangle, normals, colours\n");
  EXPECT_EQ(run(folder, Words{"render", "plain.ply"} + picture).err, "");
}

// Someone else's arguments do not make the child a danger.
TEST(ImportProgram, TheChildRefusesOtherParents) {
  const TemporaryFolder folder("a.obj", "v 0 0 0\n");
  for (const char* arguments : {"", "a", "a obj 1 1 1 rest", "a obj 1 1 1 rest 1", "a obj x y z rest 1"}) {
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
  const pid_t child = program.stop_child();
  ASSERT_GT(child, 0);
  program.send(SIGINT);
  const ProgramResult result = program.wait(std::chrono::minutes(1));
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
  EXPECT_NE(::kill(child, 0), 0) << "the child is left";
}

}  // namespace
}  // namespace gridiron::test
