// Scenes cut short and scrambled: a sound scene or a complaint with file and line, never a crash.
// Memory: a folder on disk. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <cctype>

#include "base/failure.h"
#include "check_scene.h"
#include "scene_makers/procedural.h"
#include "support/test_headers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

class MutatedScenes : public testing::Test {
 protected:
  MutatedScenes() {
    folder_.write_ply("t.ply", {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                                {UVec3(0, 2, 1), UVec3(0, 1, 3), UVec3(0, 3, 2), UVec3(1, 2, 3)}});
    const std::vector<char> sky = scene_makers::make_sky_face(0, 2);
    folder_.write("s.pfm", {sky.begin(), sky.end()});
    options_.relative_tolerance = 0.02f;
    options_.most_triangles = 20000;
  }

  // Reads a text; what it says must begin with file and line.
  void try_text(const std::string& text) {
    try {
      expect_sound(tool::read_scene_text(text, path_, options_));
      ++accepted_;
    } catch (const tool::Failure& failure) {
      const std::string said = failure.what(), start = path_ + ":";
      ASSERT_EQ(said.substr(0, start.size()), start) << text;
      std::size_t digits = 0;
      while (std::isdigit(static_cast<unsigned char>(said[start.size() + digits])) != 0) ++digits;
      ASSERT_GT(digits, 0u) << said;
      ASSERT_EQ(said.substr(start.size() + digits, 2), ": ") << said;
      const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n') +
                                                  std::count(text.begin(), text.end(), '\r')) +
                         1;
      ASSERT_LE(std::stoull(said.substr(start.size(), digits)), lines) << said;
      ASSERT_EQ(said.find('\n'), std::string::npos) << said;
      ++refused_;
    }
  }

  const std::string whole_ = R"(# Everything in a few lines.
v
from 1 2 9
at 0 0 0
up 0 1 0
angle 40
hither 0.1
resolution 64 48
b 0.1 0.2 0.3
l 3 4 5
l -3 4 5 0.5 0.25 1
la 0 5 0 1 0 0 0 0 1 1 1 1 4
e s.pfm s.pfm s.pfm s.pfm s.pfm s.pfm
ao 4 1.5
ms 4
d 3
sh on
f 1 0.75 0.5 0.8 0.2 30 0.5 1.33
p 5
-1 0 -1
-1 0 1
0 0 0.5
1 0 1
1 0 -1
sn on
f 0.5 0.5 0.5 1 0 0 0 0
pp 3
0 0 0  0 0 2
1 0 0  0 0 3
0 1 0  1 0 0
s 0 1 0 0.5
c
0 0 0 0.5
0 2 0 0
m t.ply
1 0 0 0
0 1 0 2
0 0 1 0
)";
  const TemporaryFolder folder_;
  const std::string path_ = folder_.path("a.nff").string();
  tool::SceneOptions options_;
  int accepted_ = 0, refused_ = 0;
};

TEST_F(MutatedScenes, CutAnywhere) {
  for (std::size_t bytes = 0; bytes <= whole_.size(); ++bytes) try_text(whole_.substr(0, bytes));
  EXPECT_GT(accepted_, 5);
  EXPECT_GT(refused_, 200);
}

TEST_F(MutatedScenes, BytesChanged) {
  for (std::uint32_t seed = 0; seed < 4000; ++seed) {
    SCOPED_TRACE(seed);
    TestRandom random(seed);
    std::string text = whole_;
    for (std::uint32_t i = 0; i <= random.below(3); ++i) {
      constexpr std::string_view kLikely = "0123456789.-+e \n#svbflpcmao\t\r";
      const std::uint32_t at = random.below(static_cast<std::uint32_t>(text.size()));
      text[at] = random.below(4) == 0 ? static_cast<char>(random.below(256))
                                      : kLikely[random.below(static_cast<std::uint32_t>(kLikely.size()))];
    }
    try_text(text);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(accepted_, 300);
  EXPECT_GT(refused_, 400);
}

TEST_F(MutatedScenes, WordsExchangedLostAndDoubled) {
  constexpr std::string_view kWords[] = {
      "0", "1", "-1", "1e18", "-1e18", "1e-30", "3",     "1024",  "0.5", "1e9", "nan", "v",   "s", "c",  "p", "pp",
      "m", "e", "f",  "l",    "la",    "ao",    "t.ply", "s.pfm", ".",   "..",  "on",  "off", "#", "\n", "4", "16"};
  std::vector<std::string> words;
  for (std::size_t at = whole_.find('\n') + 1; at < whole_.size();) {
    const std::size_t end = std::min(whole_.find_first_of(" \n", at), whole_.size() - 1);
    if (end != at) words.push_back(whole_.substr(at, end - at));
    if (whole_[end] == '\n') words.emplace_back("\n");
    at = end + 1;
  }
  for (std::uint32_t seed = 0; seed < 4000; ++seed) {
    SCOPED_TRACE(seed);
    TestRandom random(seed);
    std::vector<std::string> changed = words;
    const std::uint32_t at = random.below(static_cast<std::uint32_t>(changed.size()));
    const auto place = changed.begin() + at;
    switch (random.below(3)) {
      case 0:
        *place = kWords[random.below(std::size(kWords))];
        break;
      case 1:
        changed.erase(place);
        break;
      default:
        changed.insert(place, std::string(kWords[random.below(std::size(kWords))]));
    }
    std::string text;
    for (const std::string& word : changed) text += word + " ";
    try_text(text);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(accepted_, 200);
  EXPECT_GT(refused_, 400);
}

}  // namespace
}  // namespace gridiron::test
