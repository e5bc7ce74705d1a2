// The symbol check lets freestanding archives pass and names what others need. SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

// Compiles `text` into an archive and checks it.
ScriptResult check_symbols_of(const std::string& text) {
  const ScratchDirectory scratch;
  scratch.write("a.cpp", text);
  const std::string directory = scratch.path().string();
  const ScriptResult built =
      run_script("cd '" + directory +
                 "' && " GRIDIRON_CXX_COMPILER " -std=c++20 -O1 -c a.cpp -o a.o && " GRIDIRON_AR " rc a.a a.o");
  EXPECT_EQ(built.exit_code, 0) << built.output;
  return run_script(source_path("tools/checks/check_symbols") + " " GRIDIRON_NM " '" + directory + "/a.a'");
}

TEST(Symbols, MemoryFunctionsAndOwnSymbolsAreAllowed) {
  const ScriptResult result = check_symbols_of(
      "extern \"C\" void* memset(void*, int, unsigned long);\n"
      "int g(int x);\n"
      "void f(char* p, unsigned long n) { memset(p, g(0), n); }\n"
      "int g(int x) { return x + 1; }\n");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

struct Need {
  const char* name;
  const char* text;
  const char* expected;
};

void PrintTo(const Need& need, std::ostream* stream) {
  *stream << need.name;
}

class SymbolsNeed : public testing::TestWithParam<Need> {};

TEST_P(SymbolsNeed, IsNamed) {
  const ScriptResult result = check_symbols_of(GetParam().text);
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_NE(result.output.find(GetParam().expected), std::string::npos) << result.output;
}

INSTANTIATE_TEST_SUITE_P(
    Each, SymbolsNeed,
    testing::Values(
        Need{"heap", "int* f() { return new int(3); }", "(heap)"},
        Need{"malloc", "extern \"C\" void* malloc(unsigned long); void* f() { return malloc(9); }", "malloc (heap)"},
        Need{"exception", "void f(int x) { if (x) throw x; }", "(exception)"},
        Need{"guard", "int g(); int f() { static int x = g(); return x; } int g() { return 1; }", "(thread)"},
        Need{"stdio", "extern \"C\" int puts(const char*); void f() { puts(\"a\"); }", "puts (stdio)"},
        Need{"printf", "extern \"C\" int printf(const char*, ...); void f(int x) { printf(\"%d\", x); }",
             "printf (stdio)"},
        Need{"own_heap", "extern \"C\" void* malloc(unsigned long) { return nullptr; }", "brings malloc (heap)"},
        Need{"delete", "void f(int* x) { delete x; }", "(heap)"},
        Need{"destructor", "struct S { ~S(); }; S a; int f() { return 1; }", "(code that runs before main)"},
        Need{"constructor", "volatile int x = 1; int y = x + 1;", "(code that runs before main)"},
        Need{"libm", "extern \"C\" float powf(float, float); float f(float x) { return powf(x, x); }", "powf (libm)"},
        Need{"system", "extern \"C\" long write(int, const void*, unsigned long); long f() { return write(1, 0, 0); }",
             "write (operating system)"}),
    [](const testing::TestParamInfo<Need>& need) { return std::string(need.param.name); });

TEST(Symbols, WhatALinkerScriptPlacesIsDefined) {
  const ScratchDirectory scratch;
  scratch.write("a.cpp", "extern const char code_end[], code_begin[]; long f() { return code_end - code_begin; }\n");
  const std::string directory = scratch.path().string();
  const ScriptResult built =
      run_script("cd '" + directory + "' && " GRIDIRON_CXX_COMPILER " -std=c++20 -O1 -c a.cpp -o a.o");
  ASSERT_EQ(built.exit_code, 0) << built.output;
  const auto check = [&](const std::string& script) {
    scratch.write("a.ld", script);
    return run_script("cd '" + directory + "' && " + source_path("tools/checks/check_symbols") +
                      " " GRIDIRON_NM " a.o a.ld");
  };
  const ScriptResult whole = check("code_begin = ORIGIN(code);\nSECTIONS {\n  .text : {\n    code_end = . ;\n  }\n}\n");
  EXPECT_EQ(whole.exit_code, 0) << whole.output;
  const ScriptResult half = check("SECTIONS {\n  .text : {\n    code_end = . ;\n    . = ALIGN(16);\n  }\n}\n");
  EXPECT_EQ(half.exit_code, 1);
  EXPECT_NE(half.output.find("needs code_begin"), std::string::npos) << half.output;
  EXPECT_EQ(half.output.find("needs code_end"), std::string::npos) << half.output;
}

TEST(Symbols, AMissingArchiveIsAnError) {
  const ScriptResult result = run_script(source_path("tools/checks/check_symbols") + " " GRIDIRON_NM " /nowhere/a.a");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("no such archive"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace gridiron::test
