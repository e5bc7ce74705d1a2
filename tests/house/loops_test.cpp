// The table of loop bounds: every loop of the sources has its row, and a loop or a row too many is noticed.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "run_script.h"

namespace gridiron::test {
namespace {

ScriptResult check_loops(const std::string& root) {
  return run_script(source_path("tools/house/check_loops") + " '" + root + "'");
}

constexpr const char* kHead = "\"file\",\"function\",\"loop\",\"kind\",\"bound\"\n";
constexpr const char* kRow = "\"ray/a.h\",\"f\",\"for (int i = 0; i < n; ++i)\",\"constant\",\"3\"\n";
constexpr const char* kSource =
    "// A file with a while (true) in its comment.\n"
    "int f(int n) {\n"
    "  const char* text = \"for (;;)\";\n"
    "  int formula(3);\n"
    "  for (int i = 0;\n"
    "       i < n; ++i) n += *text;\n"
    "  return n;\n"
    "}\n";

ScriptResult check_tree(const std::string& source, const std::string& table) {
  const ScratchDirectory tree;
  tree.write("core/gridiron/ray/a.h", source);
  tree.write("core/loop_bounds.csv", table);
  return check_loops(tree.path().string());
}

TEST(Loops, EveryLoopOfTheSourcesHasItsRow) {
  const ScriptResult result = check_loops(source_path(""));
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST(Loops, HeadersMayBeLongAndCommentsAreNoLoops) {
  const ScriptResult result = check_tree(kSource, std::string(kHead) + kRow);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("1 loops"), std::string::npos) << result.output;
}

TEST(Loops, ALoopWithoutARowIsNoticed) {
  for (const char* loop : {"  while (n > 3) --n;\n", "  for (;;) break;\n", "  do { --n; } while (n > 3);\n",
                           "  while\n    (n > 3) --n;\n", "  __builtin_memcpy(&n, text, 4);\n",
                           "  for (const char c : \"ab\") n += c;\n"}) {
    std::string source = kSource;
    source.insert(source.find("  return"), loop);
    const ScriptResult result = check_tree(source, std::string(kHead) + kRow);
    EXPECT_EQ(result.exit_code, 1) << loop << result.output;
    EXPECT_NE(result.output.find("> \"ray/a.h\",\"f\""), std::string::npos) << loop << result.output;
  }
}

TEST(Loops, ARowWithoutALoopAndAChangedHeaderAreNoticed) {
  const ScriptResult stale = check_tree(kSource, std::string(kHead) + kRow + kRow);
  EXPECT_EQ(stale.exit_code, 1) << stale.output;
  EXPECT_NE(stale.output.find("< \"ray/a.h\",\"f\""), std::string::npos) << stale.output;
  std::string source = kSource;
  source.replace(source.find("i < n"), 5, "i < m");
  EXPECT_EQ(check_tree(source, std::string(kHead) + kRow).exit_code, 1);
}

}  // namespace
}  // namespace gridiron::test
