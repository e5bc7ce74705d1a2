// The rules of .clang-tidy, and those of its paths, report what they are for. SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

struct Untidy {
  const char* name;
  const char* text;
  const char* expected;  ///< null: no complaint
};

void PrintTo(const Untidy& untidy, std::ostream* stream) {
  *stream << untidy.name;
}

class Tidy : public testing::TestWithParam<Untidy> {};

// As tools/checks/tidy --full reads a source: once by the rules, once along paths.
TEST_P(Tidy, IsNamed) {
  if (run_script("command -v clang-tidy-14").exit_code != 0) GTEST_SKIP() << "no clang-tidy-14";
  const ScratchDirectory scratch;
  scratch.write("a.cpp", GetParam().text);
  const std::string file = " '" + (scratch.path() / "a.cpp").string() + "' -- -std=c++20 -ffreestanding";
  const ScriptResult rules = run_script("clang-tidy-14 --quiet --warnings-as-errors='*' --config-file='" +
                                        source_path(".clang-tidy") + "'" + file);
  const ScriptResult paths =
      run_script("eval \"$(grep '^paths=' " + source_path("tools/checks/tidy") +
                 ")\"; clang-tidy-14 --quiet --warnings-as-errors='*' --allow-enabling-analyzer-alpha-checkers "
                 "--checks=\"$paths\"" +
                 file);
  if (GetParam().expected == nullptr) {
    EXPECT_EQ(rules.exit_code, 0) << rules.output;
    EXPECT_EQ(paths.exit_code, 0) << paths.output;
  } else {
    EXPECT_NE(rules.exit_code + paths.exit_code, 0);
    EXPECT_NE((rules.output + paths.output).find(GetParam().expected), std::string::npos)
        << rules.output << paths.output;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, Tidy,
    testing::Values(
        Untidy{"clean", "int twice(int value) { return 2 * value; }", nullptr},
        Untidy{"recursion", "int walk(int left) { return left > 0 ? walk(left - 1) + 1 : 0; }", "misc-no-recursion"},
        Untidy{"narrowing", "int whole(double value) { int result = 0; result += value; return result; }",
               "cppcoreguidelines-narrowing-conversions"},
        Untidy{"heap", "extern \"C\" void* malloc(unsigned long); void* take() { return malloc(8); }",
               "cppcoreguidelines-no-malloc"},
        Untidy{"beyond_an_array", "int f(int n) { int a[8] = {}; if (n < 8) return 0; return a[n]; }",
               "alpha.security.ArrayBound"},
        Untidy{"null", "int f(const int* p) { if (p == nullptr) return *p; return 0; }", "core.NullDereference"}),
    [](const testing::TestParamInfo<Untidy>& untidy) { return std::string(untidy.param.name); });

}  // namespace
}  // namespace gridiron::test
