// Text scenes through the whole program: views, tolerance, near plane, effects, wrong ones.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/effect_records.h>

#include <nlohmann/json.hpp>

#include "run_program.h"
#include "scene_makers/procedural.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kBall =
    "v from 1 2 6 at 0.1 0 0 up 0 1 0.1 angle 30 hither 0 resolution 40 24\n"
    "l 3 5 4\nf 0.9 0.5 0.3 0.7 0.3 40 0 0\ns 0 0 0 1\n";

const std::filesystem::path kSceneFolder = GRIDIRON_SCENE_FILES;

// "40x24, hash 0123456789abcdef": size and pixels of the picture.
std::string picture_of(const ProgramResult& result) {
  const std::size_t place = result.out.find(": ");
  return result.out.substr(place + 2, result.out.find('\n') - place - 2);
}

Json info_json(const TemporaryFolder& folder, const Words& arguments) {
  return Json::parse(run(folder, Words{"info"} + arguments + Words{"--json"}).out, nullptr, false);
}

TEST(TextScene, BringsViewAndSize) {
  const TemporaryFolder folder("ball.ply", make_sphere(12, 16, 1.0f));
  folder.write("a.nff",
               "v from 1 2 6 at 0.1 0 0 up 0 1 0.1 angle 30 hither 0 resolution 40 24\n"
               "f 1 1 1 1 0 0 0 0 m ball.ply\n");
  const Words view = {"--eye", "1,2,6", "--at", "0.1,0,0", "--up", "0,1,0.1", "--fov", "30", "--size", "40x24"};
  const std::string mesh = picture_of(run(folder, Words{"render", "ball.ply"} + view));
  EXPECT_EQ(mesh.substr(0, 7), "40x24, ");
  EXPECT_EQ(picture_of(run(folder, {"render", "a.nff", "--shading", "simple"})), mesh);
  EXPECT_NE(picture_of(run(folder, {"render", "a.nff", "--shading", "none"})), mesh);

  // Each part gives way to the command line's, and all of it to a camera file's.
  const struct {
    Words nff, ply;
  } cases[] = {
      {{"--size", "50x20"}, {"--size", "50x20"}}, {{"--eye", "2,0,5"}, {"--eye", "2,0,5"}},
      {{"--at", "0,0.2,0"}, {"--at", "0,0.2,0"}}, {{"--up", "1,0,0"}, {"--up", "1,0,0"}},
      {{"--fov", "50"}, {"--fov", "50"}},
  };
  for (const auto& part : cases) {
    Words changed = view;
    for (std::size_t i = 0; i < changed.size(); i += 2) {
      if (changed[i] == part.ply[0]) changed[i + 1] = part.ply[1];
    }
    const std::string expected = picture_of(run(folder, Words{"render", "ball.ply"} + changed));
    EXPECT_EQ(picture_of(run(folder, Words{"render", "a.nff", "--shading", "simple"} + part.nff)), expected)
        << part.nff[0];
    EXPECT_NE(expected, mesh) << part.nff[0];
  }
  folder.write("c.camera", "eye 0 4 4\nat 0 0 0\n");
  EXPECT_EQ(picture_of(run(folder, {"render", "a.nff", "--shading", "simple", "--camera", "c.camera"})),
            picture_of(run(folder, {"render", "ball.ply", "--size", "40x24", "--camera", "c.camera"})));
}

// Without a view a text scene is framed like a mesh; a given side replaces its view's eye and at.
TEST(TextScene, IsFramedWhereItBringsNoView) {
  const TemporaryFolder folder("ball.ply", make_sphere(12, 16, 1.0f));
  folder.write("a.nff", "f 1 1 1 1 0 0 0 0 m ball.ply\n");
  folder.write("v.nff",
               "v from 1 2 6 at 9 0 0 up 0 0 1 angle 30 hither 8 resolution 40 24\n"
               "f 1 1 1 1 0 0 0 0 m ball.ply\n");
  const std::string mesh = picture_of(run(folder, {"render", "ball.ply", "--size", "40x24"}));
  EXPECT_EQ(picture_of(run(folder, {"render", "a.nff", "--size", "40x24", "--shading", "simple"})), mesh);
  EXPECT_EQ(picture_of(run(folder, {"render", "a.nff", "--shading", "simple"})),
            picture_of(run(folder, {"render", "ball.ply"})))
      << "1024x1024";
  EXPECT_EQ(info_json(folder, {"a.nff"})["main_memory"]["picture_bytes"],
            info_json(folder, {"ball.ply"})["main_memory"]["picture_bytes"]);
  EXPECT_EQ(picture_of(run(folder, {"render", "v.nff", "--shading", "simple", "--from", "30,25"})),
            picture_of(run(folder, {"render", "ball.ply", "--size", "40x24", "--up", "z", "--fov", "30"})));
  folder.write("c.camera", "eye 0 4 4\nat 0 0 0\nfov 60\n");
  EXPECT_EQ(picture_of(run(folder, {"render", "ball.ply", "--from", "top", "--camera", "c.camera", "--size", "40x24"})),
            picture_of(run(folder, {"render", "ball.ply", "--from", "0,90", "--fov", "60", "--size", "40x24"})));
}

TEST(TextScene, ToleranceMakesFinerBalls) {
  const TemporaryFolder folder("a.nff", kBall);
  const Json coarse = info_json(folder, {"a.nff", "--tolerance", "0.1"});
  const Json fine = info_json(folder, {"a.nff", "--tolerance", "0.001"});
  EXPECT_GT(fine["scene"]["triangles"].get<int>(), 20 * coarse["scene"]["triangles"].get<int>());
  (void)run(folder, {"pack", "a.nff", "-o", "a.gri", "--tolerance", "0.1"});
  EXPECT_EQ(info_json(folder, {"a.gri"})["scene"]["triangles"], coarse["scene"]["triangles"]);
  EXPECT_NE(picture_of(run(folder, {"render", "a.nff", "--shading", "simple", "--tolerance", "0.1"})),
            picture_of(run(folder, {"render", "a.nff", "--shading", "simple", "--tolerance", "0.001"})));
}

TEST(TextScene, InfoTellsWhatItCallsFor) {
  const TemporaryFolder folder;
  const std::string everything = (kSceneFolder / "everything.nff").string();
  const Json info = info_json(folder, {everything});
  const Json& effects = info["effects"];
  EXPECT_EQ(effects["called_for"].size(), kEffectCount - 1) << "no text has colours at vertices";
  EXPECT_EQ(effects["point_lights"], 1);
  EXPECT_EQ(effects["area_lights"], 1);
  EXPECT_EQ(effects["samples_per_pixel"], 4);
  EXPECT_EQ(effects["recursion_depth"], 5);
  EXPECT_EQ(effects["environment_width"], 16);
  EXPECT_EQ(effects["environment_bytes"], 6 * 3 * 3 * 768) << "blocks of 7 patches";
  EXPECT_EQ(effects["spill_bytes_per_core"], spill_bytes(5));
  std::uint64_t bytes = 0;
  for (const Json& section : effects["sections"]) bytes += section["bytes"].get<std::uint64_t>();
  EXPECT_EQ(effects["section_bytes"], bytes);
  EXPECT_GT(bytes, info["scene"]["triangles"].get<std::uint64_t>() * sizeof(SurfaceRecord));
  EXPECT_EQ(info["main_memory"]["picture_bytes"], 512 * 512 * 4 + 384) << "the scene's own size";

  // The sections are the difference to an image of the same triangles alone.
  (void)run(folder, {"pack", everything, "-o", "e.gri"});
  const Json packed = info_json(folder, {"e.gri"});
  EXPECT_EQ(packed["effects"], effects);
  EXPECT_EQ(packed["main_memory"]["image_bytes"], info["main_memory"]["image_bytes"]);
  EXPECT_EQ(packed["main_memory"]["image_bytes"], std::filesystem::file_size(folder.path("e.gri")));
}

TEST(TextScene, InfoNamesTheRenderer) {
  const TemporaryFolder folder;
  const std::string mirror = (kSceneFolder / "mirror.nff").string();
  EXPECT_EQ(info_json(folder, {mirror})["effects"]["renderer"], "EffectLayout256K<kSceneShading | kReflection, 0>");
  EXPECT_EQ(info_json(folder, with_reference({mirror}))["effects"]["renderer"],
            "EffectLayout256K<kSceneShading | kReflection, 8>");
  EXPECT_EQ(info_json(folder, {mirror, "--configuration", "grid"})["effects"]["renderer"],
            "EffectLayout256K<kSceneShading | kReflection>");
  EXPECT_EQ(info_json(folder, {mirror})["effects"]["has_room"], true);
  EXPECT_EQ(info_json(folder, {mirror, "--store", "64"})["effects"]["renderer"],
            "EffectLayout64K<kSceneShading | kReflection>");
  EXPECT_EQ(info_json(folder, {mirror, "--store", "64"})["effects"]["has_room"], true);
  EXPECT_EQ(info_json(folder, {mirror, "--store", "128"})["effects"]["has_room"], false);
  const std::string text = run(folder, {"info", (kSceneFolder / "shadow.nff").string()}).out;
  EXPECT_NE(text.find("scene_shading, point_shadows\n"), std::string::npos) << text;
  EXPECT_NE(text.find("EffectLayout256K<kSceneShading | kPointShadows, 0>"), std::string::npos) << text;

  folder.write_ply("ball.ply", make_sphere(12, 16, 1.0f));
  const Json mesh = info_json(folder, with_reference({"ball.ply", "--store", "128"}));
  EXPECT_EQ(mesh["effects"], Json({{"called_for", Json::array()}, {"renderer", "StoreLayout128K<8>"}}));
}

TEST(TextScene, ANearPlaneThatCutsIsRefused) {
  const TemporaryFolder folder;
  const auto scene = [](const std::string& hither) {
    return "b 0 0 0\nv from 0 0 6 at 0 0 0 up 0 1 0 angle 30 hither " + hither +
           " resolution 16 16\nf 1 1 1 1 0 0 0 0\np 3 -1 -1 1 1 -1 1 0 1 1\n";
  };
  folder.write("before.nff", scene("4.9"));
  folder.write("behind.nff", scene("5.1"));
  (void)run(folder, {"render", "before.nff", "--shading", "simple"});
  expect_failure(folder, {"render", "behind.nff", "--shading", "simple"}, 1,
                 "behind.nff:2: hither 5.1 would cut what is seen from 5 on");
  // Elsewhere it means nothing.
  (void)run(folder, {"render", "behind.nff", "--shading", "simple", "--eye", "0,0,3", "-o", "a.png"});
  (void)run(folder, {"info", "behind.nff"});
  (void)run(folder, {"pack", "behind.nff", "-o", "a.gri"});
}

TEST(TextScene, WrongOnesAreToldWithFileAndLine) {
  const TemporaryFolder folder("ball.ply", make_sphere(8, 12, 1.0f));
  const std::string good = kBall;  // 4 lines
  const std::string face = std::string("PF\n2 2\n-1.0\n") + std::string(48, '\0');
  for (const char* name : {"px", "nx", "py", "ny", "pz"}) folder.write(std::string(name) + ".pfm", face);
  folder.write("wide.pfm", std::string("PF\n4 4\n-1.0\n") + std::string(192, '\0'));
  const struct {
    std::string text, words;
  } cases[] = {
      {good + "box 1 2 3\n", "zoo.nff:5: unknown word 'box'"},
      {good + "\nm nowhere.ply\n", "zoo.nff:6: "},
      {good + "l nan 0 0\n", "zoo.nff:5: 'nan' is not a finite number"},
      {good + "f 1 1 1 0.5 0 0 0.5 0\n", "zoo.nff:5: "},
      {good + "d 1000000000\n", "zoo.nff:5: "},
      {good + "e px.pfm nx.pfm py.pfm ny.pfm pz.pfm wide.pfm\n", "zoo.nff:5: "},
  };
  for (const auto& bad : cases) {
    folder.write("zoo.nff", bad.text);
    expect_failure(folder, {"render", "zoo.nff", "--shading", "simple"}, 1, bad.words);
    expect_failure(folder, {"info", "zoo.nff"}, 1, bad.words);
    expect_failure(folder, {"pack", "zoo.nff", "-o", "zoo.gri"}, 1, bad.words);
  }
}

TEST(TextScene, OddOnesAreRenderedWithANote) {
  const TemporaryFolder folder("a.nff", std::string(kBall) + "p 3 0 0 0 1 1 1 2 2 2\n");
  const ProgramResult result = run(folder, {"render", "a.nff", "--shading", "simple"});
  EXPECT_EQ(result.err.find("a.nff:5: note: "), 0u) << result.err;
  EXPECT_EQ(run(folder, {"render", "a.nff", "--shading", "simple", "--quiet"}).err, "");
}

TEST(TextScene, ManyTrianglesGetTheToleranceOfThePicture) {
  const TemporaryFolder folder("a.nff", scene_makers::make_lattice(8));
  const auto json = [&folder](const Words& options) { return info_json(folder, Words{"a.nff"} + options); };
  const Json chosen = json({}), asked = json({"--tolerance", "0.00018"}), large = json({"--size", "4096x4096"});
  EXPECT_EQ(chosen["scene"]["tolerance"]["rule"], "picture");
  EXPECT_EQ(asked["scene"]["tolerance"]["rule"], "asked");
  EXPECT_EQ(asked["scene"]["tolerance"]["least"], asked["scene"]["tolerance"]["most"]);
  EXPECT_LT(2 * chosen["scene"]["triangles"].get<int>(), asked["scene"]["triangles"].get<int>());
  EXPECT_GT(large["scene"]["triangles"], chosen["scene"]["triangles"]);
  const Words render = {"render", "a.nff", "--mode", "plain", "--shading", "none"};
  const Words small = render + Words{"--size", "8x8"};
  const ProgramResult result = run(folder, small);
  EXPECT_EQ(result.err.find("a.nff: tolerance of round shapes chosen by the picture: 0.000"), 0u) << result.err;
  EXPECT_NE(result.err.find("--tolerance sets another"), std::string::npos) << result.err;
  EXPECT_EQ(run(folder, small + Words{"--quiet"}).err, "");
  EXPECT_NE(result.err.find(" would make about 780,000; --tolerance sets another"), std::string::npos) << result.err;

  // Another place to look from is another picture; of a large one, so that no shape is at its coarsest.
  const Words tile = render + Words{"--size", "2048x2048", "--tile", "0,0"};
  const std::string own = run(folder, tile).err;
  for (const Words& view : {Words{"--eye", "0.55,0.45,0.5"}, Words{"--from", "top"}, Words{"--fov", "20"}}) {
    EXPECT_NE(run(folder, tile + view).err, own) << view[0];
  }

  // The same scene without a view has the same picture from the same place, and one that frames it.
  std::string text = scene_makers::make_lattice(8);
  const std::size_t view = text.find("v\n");
  text.erase(view, text.find("resolution 512 512") + 18 - view);
  folder.write("b.nff", text);
  const auto triangles_of = [](const std::string& err) { return err.substr(err.find("picture: ")); };
  const Words bare = {"render", "b.nff", "--mode", "plain", "--shading", "none", "--tile", "0,0"};
  const Words eye = {"--size", "2048x2048", "--eye", "1.75,1.55,3", "--at", "0.5,0.5,0.5"};
  EXPECT_EQ(triangles_of(run(folder, bare + eye).err), triangles_of(own));
  EXPECT_EQ(run(folder, bare).err.find("b.nff: tolerance of round shapes chosen by the picture: "), 0u);
  EXPECT_EQ(info_json(folder, {"b.nff"})["scene"]["tolerance"]["rule"], "picture");
  const Words within = {"--size", "4096x4096", "--eye", "0.55,0.45,0.5"};
  EXPECT_EQ(run(folder, bare + within).err, "") << "no shape is coarser";
}

TEST(TextScene, WhatDoesNotFitNamesATolerance) {
  const TemporaryFolder folder("a.nff", scene_makers::make_lattice(3));
  folder.write("small.machine", "based_on cell-ps3\nname small\nmain_memory_bytes 6291456\n");
  const Words render = {"render", "a.nff", "--machine", "small.machine", "--size", "8x8", "--quiet", "--mode", "plain"};
  const ProgramResult refused = run_program(folder.folder(), render);
  EXPECT_EQ(refused.exit_code, 1);
  const std::string words = "would fit: --tolerance ";
  const std::size_t place = refused.err.find(words);
  ASSERT_NE(place, std::string::npos) << refused.err;
  const std::string rest = refused.err.substr(place + words.size());
  const ProgramResult fits = run(folder, render + Words{"--tolerance", rest.substr(0, rest.find(' '))});
  EXPECT_EQ(fits.exit_code, 0) << refused.err << fits.err;
}

TEST(TextScene, MeshImagesHaveNoSceneShading) {
  const TemporaryFolder folder("ball.ply", make_sphere(8, 12, 1.0f));
  (void)run(folder, {"pack", "ball.ply", "-o", "ball.gri"});
  expect_failure(folder, {"render", "ball.gri", "--shading", "scene"}, 2, "ball.gri has no lights and materials");
}

TEST(TextScene, RendersItsEffects) {
  const TemporaryFolder folder("a.nff", kBall);
  const std::string picture = picture_of(run(folder, {"render", "a.nff"}));
  EXPECT_EQ(picture.substr(0, 7), "40x24, ");
  EXPECT_NE(picture, picture_of(run(folder, {"render", "a.nff", "--shading", "simple"})));
  EXPECT_EQ(picture, picture_of(run(folder, {"render", "a.nff", "--threads", "7"}))) << "more than cores";
  for (const char* configuration : {"reference", "deep", "grid"}) {
    EXPECT_EQ(picture, picture_of(run(folder, {"render", "a.nff", "--configuration", configuration})));
  }
  EXPECT_EQ(picture, picture_of(run(folder, {"render", "a.nff", "--buffering", "single"})));

  // A packed scene has lights but no view; it is shaded by them by default.
  (void)run(folder, {"pack", "a.nff", "-o", "a.gri"});
  const Words view = {"--eye", "1,2,6", "--at", "0.1,0,0", "--up", "0,1,0.1", "--fov", "30", "--size", "40x24"};
  Words packed = {"render", "a.gri"};
  packed.insert(packed.end(), view.begin(), view.end());
  EXPECT_EQ(picture, picture_of(run(folder, packed)));
}

TEST(TextScene, NoOutputTakesThePlaceOfItsFiles) {
  const TemporaryFolder folder("ball.ply", make_sphere(6, 8, 1.0f));
  folder.write("a.nff",
               "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 8 8\nf 1 1 1 1 0 0 0 0\nm ball.ply\n");
  const auto bytes = std::filesystem::file_size(folder.path("ball.ply"));
  for (const Words& words :
       {Words{"render", "a.nff", "-o", "b.png", "--timeline", "ball.ply"}, Words{"pack", "a.nff", "-o", "./ball.ply"},
        Words{"render", "a.nff", "-o", "b.png", "--report", "ball.ply"}}) {
    expect_failure(folder, words, 2, "is the input 'ball.ply' of this command");
    EXPECT_EQ(std::filesystem::file_size(folder.path("ball.ply")), bytes);
  }
}

TEST(TextScene, EveryEffectAtOnce) {
  const TemporaryFolder folder;
  const std::string everything = (kSceneFolder / "everything.nff").string();
  const Words small = {"--size", "48x48", "-o", "a.png"};
  const auto picture = [&](Words more) {
    more.insert(more.begin(), {"render", everything});
    more.insert(more.end(), small.begin(), small.end());
    return picture_of(run(folder, more));
  };
  const std::string reference = picture({});
  EXPECT_EQ(reference, picture({"--configuration", "grid", "--threads", "1"}));
  EXPECT_EQ(reference, picture({"--configuration", "reference"}));
  EXPECT_EQ(reference, picture({"--completion", "late"}));
  EXPECT_NE(reference, picture({"--shading", "simple"}));
  EXPECT_EQ(reference, picture({"--store", "64"}));
  EXPECT_EQ(reference, picture({"--machine", GRIDIRON_MACHINES "/cluster-8.machine"})) << "64 KB";
}

}  // namespace
}  // namespace gridiron::test
