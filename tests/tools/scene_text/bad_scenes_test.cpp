// A zoo of scenes that are wrong: each complaint names the file, the line and the reason.
// Memory: a folder on disk. Threads: one. SPDX-License-Identifier: Apache-2.0
#include "base/failure.h"
#include "check_scene.h"
#include "scene_makers/procedural.h"
#include "support/test_headers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

struct Case {
  std::string text;      // behind a good line 1 of view, fill and background
  std::string expected;  // from the line number on: what the complaint starts with
};

constexpr std::string_view kGoodLine =
    "v from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 8 6 b 0 0 0 f 1 1 1 1 0 0 0 0 s 0 0 0 1\n";

std::string view_with(std::string_view part) {
  return "f 1 1 1 1 0 0 0 0 s 0 0 0 1\nv\n" + std::string(part);
}

void expect_complaints(const std::vector<Case>& cases, std::string_view before, const std::string& path = "zoo.nff") {
  for (const Case& bad : cases) {
    const std::string text = std::string(before) + bad.text;
    const std::string said = complaint(text, {}, path), expected = path + ":" + bad.expected;
    EXPECT_EQ(said.substr(0, expected.size()), expected) << text;
    EXPECT_EQ(said.find('\n'), std::string::npos) << "one line";
  }
}

TEST(BadScenes, WordsAndNumbers) {
  expect_complaints(
      {
          {"\nbox 0 0 0", "3: unknown word 'box'; expected one of v b l f p pp c s m sn la e ao ms d sh"},
          {"S 0 0 0 1", "2: unknown word 'S'"},
          {"s 0 0 0 1\n\n2", "4: '2' is one number too many: 's' of line 2 has all of its numbers"},
          {"s 0 0\n0", "3: the file ends inside 's' of line 2: number 4 of 4 is missing"},
          {"s 0 0\n0\n", "3: the file ends inside 's' of line 2: number 4 of 4 is missing"},
          {"s 0 0 0\ns 0 0 0 1", "3: 's' found where number 4 of 4 of 's' of line 2 is expected"},
          {"s 0 zero 0 1", "2: 'zero' found where number 2 of 4 of 's' of line 2 is expected"},
          {"s 0 0x1 0 1", "2: '0x1' is not a finite number (number 2 of 4 of 's')"},
          {"s 0 1,5 0 1", "2: '1,5' is not a finite number"},
          {"s 0 1e 0 1", "2: '1e' is not a finite number"},
          {"s 0 +-1 0 1", "2: '+-1' is not a finite number"},
          {"s 0 + 0 1", "2: '+' is not a finite number"},
          {"s 0 . 0 1", "2: '.' is not a finite number"},
          {"s 0 nan 0 1", "2: 'nan' is not a finite number"},
          {"s 0 -NaN 0 1", "2: '-NaN' is not a finite number"},
          {"s 0 inf 0 1", "2: 'inf' is not a finite number"},
          {"s 0 -infinity 0 1", "2: '-infinity' is not a finite number"},
          {"s 0 1e999 0 1", "2: '1e999' is too large or too small a number (number 2 of 4 of 's')"},
          {"s 0 -1e-400 0 1", "2: '-1e-400' is too large or too small a number"},
          {"s 0 1e30 0 1", "2: a coordinate of 's' must be from -1e+18 to 1e+18, not '1e30'"},
          {std::string("s 0 0 0 1\0", 10), "2: not a text file: it holds a byte 0"},
          {std::string("# \0", 3), "2: not a text file: it holds a byte 0"},
          {"s 0\x1B 0 0 1", "2: not a text file: it holds a control character"},
          {"\xFF", "2: unknown word '\\xff'"},
          {std::string(5000, 'x'), "2: word of more than 4096 bytes"},
          {"# a\r# b\r\n# c\n\rbad", "6: unknown word 'bad'"},
      },
      kGoodLine);
}

TEST(BadScenes, Views) {
  expect_complaints(
      {
          {"from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0 yon 9", "3: 'yon' is no part of a view"},
          {"from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0\ns 0 0 0 1", "4: 's' is no part of a view"},
          {"from 0 0 9 at 0 0 0 up 0 1 0\n",
           "3: the file ends inside 'v' of line 2, before from, at, up, angle, hither"},
          {"from 0 0 9\nfrom 0 0 9", "4: second 'from' in a view"},
          {"from 0 0 9 at 0 0 9 up 0 1 0 angle 40 hither 0 resolution 1 1", "2: the view's from and at are the same"},
          {"from 0 0 1e17 at 1 0 1e17 up 0 1 0 angle 40 hither 0 resolution 1 1\nx", "4: unknown word 'x'"},
          {"from 0 1e17 0 at 1 1e17 1 up 1 0 1 angle 40 hither 0 resolution 1 1", "2: the view's up is parallel"},
          {"from 0 0 9 at 0 0 0 up 0 0 0 angle 40 hither 0 resolution 1 1", "2: the view's up has length 0"},
          {"from 0 0 9 at 0 0 0 up 0 0 -3 angle 40 hither 0 resolution 1 1", "2: the view's up is parallel"},
          {"from 0.1 0.2 0.3 at 0.4 0.6 0.8 up 0.3 0.4 0.5 angle 40 hither 0 resolution 1 1",
           "2: the view's up is parallel"},
          {"from 0 0 nan", "3: 'nan' is not a finite number (number 3 of 13 of 'v')"},
          {"angle 0", "3: angle must be from 0.001 to below 180 degrees, not '0'"},
          {"angle 180", "3: angle must be from 0.001 to below 180 degrees, not '180'"},
          {"angle -40", "3: angle must be from 0.001 to below 180 degrees, not '-40'"},
          {"angle 1e-60", "3: angle must be from 0.001"},
          {"hither -0.1", "3: hither of 'v' must be from 0 to 1e+18, not '-0.1'"},
          {"resolution 0 6", "3: the resolution's width of 'v' must be a whole number from 1 to 16384, not '0'"},
          {"resolution 8 6.5", "3: the resolution's height of 'v' must be a whole number from 1 to 16384, not '6.5'"},
          {"resolution 1e9 6", "3: the resolution's width of 'v' must be"},
          {"resolution -8 6", "3: the resolution's width of 'v' must be"},
      },
      view_with(""));
  EXPECT_EQ(complaint(""), "test.nff:1: the scene has no object: no p, pp, c, s or m");
}

TEST(BadScenes, SettingsAndLights) {
  std::string lights;
  for (int i = 0; i < 256; ++i) lights += "l 0 0 0\n";
  expect_complaints(
      {
          {"v", "2: second 'v'; the first is on line 1"},
          {"\nb 0 0 0", "3: second 'b'; the first is on line 1"},
          {"ms 4\nms 4", "3: second 'ms'; the first is on line 2"},
          {"d 4\nd 4", "3: second 'd'"},
          {"sh on\nsh on", "3: second 'sh'"},
          {"ao 1 1\nao 1 1", "3: second 'ao'"},
          {"l 0 0 nan", "2: 'nan' is not a finite number (number 3 of 3 of 'l')"},
          {"l nan 0 0", "2: 'nan' is not a finite number (number 1 of 3 of 'l')"},
          {"l 0 0 0 nan 0 0", "2: 'nan' is not a finite number (number 4 of 6 of 'l')"},
          {"l 0 0 0 1\n1", "3: the file ends inside 'l' of line 2: number 6 of 6 is missing"},
          {"l 0 0 0 -1 0 0", "2: red of 'l' must be from 0 to 1e+06, not '-1'"},
          {"l 0 0 0 1 1e7 0", "2: green of 'l' must be from 0 to 1e+06, not '1e7'"},
          {"l 0 0 0 1 1 1 1", "2: '1' is one number too many: 'l' of line 2"},
          {lights + "l 0 0 0", "258: more than 256 lights"},
          {lights + "la 0 0 0 1 0 0 0 1 0 1 1 1 4", "258: more than 256 lights"},
          {"la 0 0 0 1 0 0 2 0 0 1 1 1 4", "2: the edges of 'la' have length 0 or are parallel"},
          {"la 0 0 0 0 0 0 0 1 0 1 1 1 4", "2: the edges of 'la' have length 0 or are parallel"},
          {"la 0 0 0 1 0 0 0 1 0 1 1 1 0", "2: the number of samples of 'la' must be a whole number from 1 to 64"},
          {"la 0 0 0 1 0 0 0 1 0 1 1 1 65", "2: the number of samples of 'la' must be a whole number from 1 to 64"},
          {"la 0 0 0 1 0 0 0 1 0 1 1 1", "2: the file ends inside 'la' of line 2: number 13 of 13 is missing"},
          {"ao 0 1", "2: the number of samples of 'ao' must be a whole number from 1 to 64, not '0'"},
          {"ao 16 0", "2: the radius of 'ao' must be greater than 0 and at most 1e18, not '0'"},
          {"ao 16 -1", "2: the radius of 'ao' must be greater than 0"},
          {"ao 16 1e-60", "2: the radius of 'ao' must be greater than 0"},
          {"ms 2", "2: 'ms' takes 1, 4 or 16 samples a pixel, not '2'"},
          {"ms 1e9", "2: 'ms' takes 1, 4 or 16 samples a pixel, not '1e9'"},
          {"d 0", "2: the depth of recursion of 'd' must be a whole number from 1 to 8, not '0'"},
          {"d 1000000000", "2: the depth of recursion of 'd' must be a whole number from 1 to 8, not '1000000000'"},
          {"d 1e9", "2: the depth of recursion of 'd' must be a whole number from 1 to 8, not '1e9'"},
          {"d 2.5", "2: the depth of recursion of 'd' must be a whole number"},
          {"sh 0", "2: 'sh' takes 'on' or 'off', not '0'"},
          {"sn maybe", "2: 'sn' takes 'on' or 'off', not 'maybe'"},
          {"sn", "2: the file ends inside 'sn' of line 2, before 'on' or 'off'"},
      },
      kGoodLine);
  EXPECT_EQ(complaint(std::string(kView) + "b 0 0 2"), "test.nff:1: blue of 'b' must be from 0 to 1, not '2'");
}

TEST(BadScenes, Materials) {
  expect_complaints(
      {
          {"f 1 1 1.5 1 0 0 0 0", "2: blue of 'f' must be from 0 to 1, not '1.5'"},
          {"f 1 1 1 -0.1 0 0 0 0", "2: Kd of 'f' must be from 0 to 1, not '-0.1'"},
          {"f 1 1 1 1 2 0 0 0", "2: Ks of 'f' must be from 0 to 1, not '2'"},
          {"f 1 1 1 1 0 -1 0 0", "2: Shine of 'f' must be from 0 to 1e+05, not '-1'"},
          {"f 1 1 1 1 0 1e6 0 0", "2: Shine of 'f' must be from 0 to 1e+05, not '1e6'"},
          {"f 1 1 1 1 0 0 1.1 1", "2: T of 'f' must be from 0 to 1, not '1.1'"},
          {"f 1 1 1 1 0 0 0.5\n0", "3: the index of refraction of 'f' must be from 0.1 to 10, not '0'"},
          {"f 1 1 1 1 0 0 0.5 -1.5", "2: the index of refraction of 'f' must be from 0.1 to 10, not '-1.5'"},
          {"f 1 1 1 1 0 0 0.5 11", "2: the index of refraction of 'f' must be from 0.1 to 10, not '11'"},
          {"f 1 1 1 1 0 0 0 -1", "2: the index of refraction of 'f' must be from 0.1 to 10, not '-1'; 0 only where T"},
          {"f 1 1 1 1 0 0 0 nan", "2: 'nan' is not a finite number (number 8 of 8 of 'f')"},
          {"f 1 1 1 1 0 0 0\n", "2: the file ends inside 'f' of line 2: number 8 of 8 is missing"},
      },
      kGoodLine);
  expect_complaints({{"\ns 0 0 0 1", "2: 's' before the first 'f': it has no material"},
                     {"\nc 0 0 0 1 0 0 1 1", "2: 'c' before the first 'f'"},
                     {"\np 3", "2: 'p' before the first 'f'"},
                     {"\npp 3", "2: 'pp' before the first 'f'"},
                     {"\nm a.ply", "2: 'm' before the first 'f'"},
                     {"f 1 1 1 1 0 0 0 0\n\n", "2: the scene has no object: no p, pp, c, s or m"}},
                    kView);
}

TEST(BadScenes, Objects) {
  expect_complaints(
      {
          {"s 0 0 0 0", "2: the radius of 's' must be greater than 0 and at most 1e18, not '0'"},
          {"s 0 0 0 -1", "2: the radius of 's' must be greater than 0 and at most 1e18, not '-1'"},
          {"s 0 0 0 1e-60", "2: the radius of 's' must be greater than 0"},
          {"c 0 0 0 -1 0 0 1 -1", "2: the base radius of 'c' must be from 0 to 1e+18, not '-1'"},
          {"c 0 0 0 1 0 0 1 -1", "2: the apex radius of 'c' must be from 0 to 1e+18, not '-1'"},
          {"c 0 0 0 0 0 0 1 0", "2: both radii of 'c' are 0"},
          {"c\n1 2 3 1\n1 2 3 0", "2: base and apex of 'c' are the same point"},
          {"p 2 0 0 0 1 0 0", "2: the number of corners of 'p' must be a whole number from 3 to 1024, not '2'"},
          {"p 1025", "2: the number of corners of 'p' must be a whole number from 3 to 1024, not '1025'"},
          {"p -3", "2: the number of corners of 'p' must be"},
          {"p 4000000000", "2: the number of corners of 'p' must be"},
          {"p 3.5", "2: the number of corners of 'p' must be"},
          {"p 3 0 0 0\n1 0 0\n0 1", "4: the file ends inside 'p' of line 2: number 10 of 10 is missing"},
          {"p 4 0 0 0 1 1 0 1 0 0 0 1 0", "2: the outline of the polygon crosses or retraces itself"},
          {"pp 4 0 0 0 0 0 1 1 1 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1",
           "2: the outline of the patch crosses or retraces itself"},
          {"pp 3 0 0 0 0 0 1 1 0 0 0 0 1\n0 1 0 0 0 0", "3: the normal of corner 3 has length 0"},
          {"pp 2", "2: the number of corners of 'pp' must be a whole number from 3 to 1024, not '2'"},
      },
      kGoodLine);
  EXPECT_EQ(complaint(std::string(kViewAndFill) + "\np 3 0 0 0 1 1 1 2 2 2"),
            "test.nff:2: the scene has no triangle: none of its polygons has an area");
  EXPECT_EQ(complaint(std::string(kViewAndFill) + "\np 3 1 1 1 1 1 1 1 1 1"),
            "test.nff:2: the scene has no triangle: none of its polygons has an area");
  EXPECT_EQ(complaint(std::string(kViewAndFill) + "\ns 0 0 0 1e-44").substr(0, 41),
            "test.nff:2: a radius of 1e-44 is finer th");
}

TEST(BadScenes, ShapesThatDoNotFit) {
  tool::SceneOptions few;
  few.most_triangles = 100;
  EXPECT_EQ(
      complaint(std::string(kViewAndFill) + "\ns 0 0 0 1", few),
      "test.nff:2: with this object the scene has 18,000 triangles at a tolerance of 0.00034641015; at most 100 are "
      "allowed; --tolerance 0.077 makes fewer");
  tool::SceneOptions fine;
  fine.tolerance = 1e-6f;
  EXPECT_EQ(complaint(std::string(kViewAndFill) + "s 0 0 0 1 \n c 0 0 0 9000 0 0 1 1", fine).substr(0, 42),
            "test.nff:2: a tolerance of 1e-06 is finer ");
  fine.tolerance = 1e-3f;
  EXPECT_EQ(complaint(std::string(kViewAndFill) + "\ns 0 0 0 3e5", fine).substr(0, 42),
            "test.nff:2: a tolerance of 0.001 is finer ");
  EXPECT_EQ(complaint(std::string(kViewAndFill) + "\ns 1000 0 0 0.001", fine).substr(0, 41),
            "test.nff:2: a radius of 0.001 is finer th");
  fine.tolerance = 1e-7f;
  EXPECT_EQ(complaint(std::string(kViewAndFill) + "\ns 0 0 0 0.3", fine).substr(0, 40),
            "test.nff:2: a sphere of radius 0.3 needs");
  for (const float wrong : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), kInfinity}) {
    tool::SceneOptions bad;
    bad.tolerance = wrong;
    EXPECT_NE(complaint(std::string(kViewAndFill) + "s 0 0 0 1", bad).find("the tolerance of round shapes must be"),
              std::string::npos);
  }
}

TEST(BadScenes, MoreMaterialsThanAnIndexTellsApart) {
  std::string text(kView);
  for (int i = 0; i < 65536; ++i) {
    if (i == 65535) text += '\n';
    text += "f " + std::to_string(static_cast<float>(i) / 65536) + "1 0 0 1 0 0 0 0 p 3 0 0 0 1 0 0 0 1 0 ";
    if (i == 65534) expect_sound(read_good(text));
  }
  EXPECT_EQ(complaint(text), "test.nff:2: more than 65,535 different materials in use");
}

TEST(BadScenes, FilesThatAScenesNames) {
  const TemporaryFolder folder;
  const std::string path = folder.path("zoo.nff").string();
  const auto name = [&](const char* file) { return folder.path(file).string(); };
  folder.write("broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n");
  folder.write("none.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
               "end_header\n0 0 0\n");
  folder.write_ply("good.ply", {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {UVec3(0, 1, 2)}});
  for (std::uint32_t width : {2u, 3u}) {
    const std::vector<char> bytes = scene_makers::make_sky_face(0, width);
    folder.write("sky" + std::to_string(width) + ".pfm", std::string(bytes.begin(), bytes.end()));
  }
  folder.write("flat.pfm", "PF\n2 3\n-1\n" + std::string(72, '\0'));
  folder.write("huge.pfm", "PF\n100000 100000\n-1\n");
  folder.write("short.pfm", "PF\n2 2\n-1\n" + std::string(47, '\0'));
  folder.write("nan.pfm", "Pf\n1 1\n-1\n" + std::string("\0\0\xC0\x7F", 4));
  folder.write("text.pfm", "hello");
  folder.write("broken.png", "\x89PNG\r\n\x1A\n");
  expect_complaints(
      {
          {"\nm nothing.ply", "3: " + name("nothing.ply") + ": No such file or directory"},
          {"m broken.ply", "2: " + name("broken.ply") + ":"},
          {"m none.ply", "2: " + name("none.ply") + ": holds no triangle"},
          {"m .", "2: " + name(".") + ": not a regular file"},
          {"m /dev/zero", "2: /dev/zero: not a regular file"},
          {"m", "2: the file ends inside 'm' of line 2, before the file is named"},
          {"m good.ply 1 0 0 0", "2: the file ends inside 'm' of line 2: number 5 of 12 is missing"},
          {"m good.ply 1 0 0 0 0 1 0 0 0 0 nan 0", "2: 'nan' is not a finite number (number 11 of 12 of 'm')"},
          {"m good.ply 1 0 0 0 2 0 0 0 0 0 1 0", "2: the matrix of 'm' flattens the mesh"},
          {"m good.ply 1e18 0 0 1e18 0 1 0 0 0 0 1 0", "2: " + name("good.ply") + ": a vertex lies farther than 1e18"},
          {"e sky2.pfm sky2.pfm sky2.pfm\nsky2.pfm sky3.pfm sky2.pfm",
           "3: " + name("sky3.pfm") + ": is 3x3 texels; the first face is 2x2"},
          {"e sky2.pfm\nflat.pfm",
           "3: " + name("flat.pfm") + ": is 2x3 texels; a face of an environment cube is square"},
          {"e huge.pfm", "2: " + name("huge.pfm") + ": is 100000x100000 texels; a face has 1 to 1024 a side"},
          {"e short.pfm", "2: " + name("short.pfm") + ": holds 47 bytes of texels instead of 48"},
          {"e nan.pfm", "2: " + name("nan.pfm") + ": texel 0, 0 is negative, NaN or infinite"},
          {"e text.pfm", "2: " + name("text.pfm") + ": is neither a PNG nor a PFM file"},
          {"e broken.png", "2: " + name("broken.png") + ": broken PNG file: "},
          {"e missing.pfm", "2: " + name("missing.pfm") + ": No such file or directory"},
          {"e sky2.pfm sky2.pfm sky2.pfm sky2.pfm\nsky2.pfm",
           "3: the file ends inside 'e' of line 2, before all six faces are named"},
      },
      kGoodLine, path);
}

}  // namespace
}  // namespace gridiron::test
