// The table of loop bounds: every loop that no constant bounds has its row, and a loop or a row too many is noticed.
// SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

ScriptResult check_loops(const std::string& root) {
  return run_script(source_path("tools/checks/check_loops") + " '" + root + "'");
}

constexpr const char* kHead = "\"file\",\"function\",\"loop\",\"kind\",\"bound\"\n";
constexpr const char* kRow = "\"ray/a.h\",\"f\",\"for (int i = 0; i < n; ++i)\",\"layout\",\"lanes\"\n";
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
  EXPECT_NE(result.output.find("1 loops with a row, 0 with a constant bound"), std::string::npos) << result.output;
}

// A function with a loop behind the function of kSource; the constants and types are for the loop.
ScriptResult check_loop(const std::string& loop) {
  const std::string function =
      "#include <initializer_list>\nconstexpr int kEdge = 3;\nstruct Changing { int kMost; };\n"
      "template <class Layout, int W> void g(int n, unsigned bits, Layout layout, Changing& changing) {\n"
      "  const int words[] = {1, 2};\n" +
      loop + "\n}\n";
  return check_tree(kSource + function, std::string(kHead) + kRow);
}

TEST(Loops, ALoopWithAConstantBoundNeedsNoRow) {
  for (const char* loop :
       {"for (int i = 0; i < kEdge; ++i) n += i;", "for (unsigned i = bits; i < 2 * W - 1; i += kEdge) n += i;",
        "for (int i = 0; n != 0 && i < Layout::kCount / 4; ++i) --n;", "for (int i = kEdge; i >= 0; --i) n += i;",
        "for (; bits != 0; bits &= bits - 1) ++n;", "for (const int word : words) n += word;",
        "for (const int word : {n, 2}) n += word;", "__builtin_memset(&n, 0, sizeof(n));"}) {
    const ScriptResult result = check_loop(loop);
    EXPECT_EQ(result.exit_code, 0) << loop << result.output;
  }
}

TEST(Loops, ALoopWithoutARowIsNoticed) {
  for (const char* loop :
       {"while (n > 3) --n;", "for (;;) break;", "do { --n; } while (n > 3);", "while\n  (n > 3) --n;",
        "again: if (n > 3) goto again;", "__builtin_memset(&n, 0, bits);", "for (int i = 0; i < n; ++i) --n;",
        "for (int i = 0; i < layout.count; ++i) --n;", "for (int i = n; i < kEdge; ++i) --n;",
        "for (int i = 0; i < kEdge; i += n) --n;", "for (int i = 0; i < kEdge; --i) --n;",
        "for (int i = 0; i < kEdge; ++i) i -= n;", "for (int i = 0; i < kEdge; ++i) { int& j = i; --j; }",
        "for (unsigned i = 3; i >= 0; --i) --n;", "for (int i = 0; i < Layout::kMost; ++i) --n;",
        "for (; bits != 0; bits &= bits - 1) bits += 2;", "for (; bits != 0; bits &= n - 1) --n;",
        "for (const int word : layout.words) n += word;"}) {
    const ScriptResult result = check_loop(loop);
    EXPECT_EQ(result.exit_code, 1) << loop << result.output;
    EXPECT_NE(result.output.find("> \"ray/a.h\",\"g\""), std::string::npos) << loop << result.output;
  }
}

// Where clang gives the place of the macro, several loops would be one without a header.
TEST(Loops, LoopsInArgumentsOfMacrosAreToldApart) {
  const ScriptResult result = check_loop(
      "\n#define TRY(code) code\nTRY({ for (int i = 0; i < n; ++i) --n; while (n > 3) --n; });");
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_NE(result.output.find("> \"ray/a.h\",\"g\",\"for (int i = 0; i < n; ++i)\"\n"
                               "> \"ray/a.h\",\"g\",\"while (n > 3)\"\n"), std::string::npos) << result.output;
}

TEST(Loops, ACallOperatorHasTheNameOfItsClass) {
  const ScriptResult result =
      check_loop("} struct Named { void operator()(int n) { while (n > 3) --n; } };\nvoid h() {");
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_NE(result.output.find("> \"ray/a.h\",\"Named\",\"while"), std::string::npos) << result.output;
}

// Of build: its passes, what they include there, and the sources of that.
TEST(Loops, OfBuildThoseOfThePassesAreTold) {
  const ScratchDirectory tree;
  tree.write("core/gridiron/ray/a.h", kSource);
  tree.write("core/loop_bounds.csv", std::string(kHead) + kRow);
  const auto write = [&](const std::string& name, const std::string& include, const std::string& function) {
    tree.write("core/gridiron/build/" + name + ".h", "#pragma once\n" + include + "void " + function + "(int n);\n");
    tree.write("core/gridiron/build/" + name + ".cpp",
               "#include <gridiron/build/" + name + ".h>\nvoid " + function + "(int n) { while (n > 3) --n; }\n");
  };
  write("passes/pass", "#include <gridiron/build/tree/used.h>\n", "of_pass");
  write("tree/used", "#include <gridiron/build/deeper.h>\n", "of_used");
  write("deeper", "", "of_deeper");
  write("host_only", "#include <gridiron/build/passes/pass.h>\n", "of_host");
  const ScriptResult result = check_loops(tree.path().string());
  EXPECT_EQ(result.exit_code, 1) << result.output;
  for (const char* function : {"of_pass", "of_used", "of_deeper"}) {
    EXPECT_NE(result.output.find(std::string("\"") + function + "\",\"while"), std::string::npos) << result.output;
  }
  EXPECT_EQ(result.output.find("of_host"), std::string::npos) << result.output;
}

TEST(Loops, SourcesThatClangCannotReadAreRefused) {
  const ScriptResult result = check_loop("int;;; nothing");
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_NE(result.output.find("clang cannot read"), std::string::npos) << result.output;
}

TEST(Loops, ARowWithoutALoopAndAChangedHeaderAreNoticed) {
  const ScriptResult stale = check_tree(kSource, std::string(kHead) + kRow + kRow);
  EXPECT_EQ(stale.exit_code, 1) << stale.output;
  EXPECT_NE(stale.output.find("< \"ray/a.h\",\"f\""), std::string::npos) << stale.output;
  std::string source = kSource;
  source.replace(source.find("i < n"), 5, "n > i");
  EXPECT_EQ(check_tree(source, std::string(kHead) + kRow).exit_code, 1);
}

}  // namespace
}  // namespace gridiron::test
