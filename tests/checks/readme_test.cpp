// The README: its example is short, its links lead somewhere, its picture is small. SPDX-License-Identifier: Apache-2.0
#include <regex>

#include "run_script.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Readme, TheExampleHasAtMostFifteenLinesOfCode) {
  const ScriptResult example =
      run_script(source_path("tools/checks/readme_blocks") + " cpp " + source_path("README.md"));
  ASSERT_EQ(example.exit_code, 0) << example.output;
  const std::size_t body = example.output.find("int main");
  ASSERT_NE(body, std::string::npos);
  const auto lines = std::count(example.output.begin() + static_cast<std::ptrdiff_t>(body), example.output.end(), '\n');
  EXPECT_LE(lines - 2, 15) << "lines between the braces of main";
}

TEST(Readme, IsShort) {
  const std::string text = text_of(source_path("README.md"));
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150) << "lines";
}

TEST(Readme, LinksAndPicturesExist) {
  for (const char* readme : {"README.md", "CHANGELOG.md", "CONTRIBUTING.md", "core/README.md", "platform/README.md",
                             "scenes/README.md", "tests/README.md", "tools/README.md"}) {
    const std::string text = text_of(source_path(readme));
    ASSERT_FALSE(text.empty()) << readme;
    const std::regex link(R"(\]\(([^)# ]+)(#[^)]*)?\))");
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match) {
      const std::string target = (*match)[1];
      if (target.rfind("http", 0) == 0) continue;
      const fs::path path = fs::path(source_path(readme)).parent_path() / target;
      EXPECT_TRUE(fs::exists(path)) << readme << " links to " << target;
      if (path.extension() == ".png") {
        EXPECT_LT(fs::file_size(path), 300'000u) << target;
      }
    }
  }
}

TEST(Readme, BothCommandsAreThereAndCanBeRun) {
  const std::string text = text_of(source_path("README.md"));
  for (const char* command : {"tools/demo", "tools/check", "tools/fetch_scenes", "tools/setup", ".ci/run"}) {
    const fs::perms permissions = fs::status(source_path(command)).permissions();
    EXPECT_NE(permissions & fs::perms::owner_exec, fs::perms::none) << command;
  }
  EXPECT_NE(text.find("\ntools/demo\n"), std::string::npos);
  EXPECT_NE(text.find("\ntools/check\n"), std::string::npos);
}

}  // namespace
}  // namespace gridiron::test
