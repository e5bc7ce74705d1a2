// The budget check finds the deepest stack and refuses what has none. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "run_script.h"

namespace gridiron::test {
namespace {

// Compiles `text` as if it were the kernel of a cross build and checks its budgets.
ScriptResult check_budgets_of(const std::string& text) {
  const ScratchDirectory scratch;
  scratch.write("gridiron_kernel.dir/a.cpp", text);
  const std::string directory = scratch.path().string();
  const ScriptResult built = run_script("cd '" + directory +
                                        "/gridiron_kernel.dir' && " GRIDIRON_CXX_COMPILER
                                        " -std=c++20 -O1 -fcallgraph-info=su,da -c a.cpp -o a.obj");
  EXPECT_EQ(built.exit_code, 0) << built.output;
  return run_script(source_path("tools/house/check_budgets") + " size '" + directory + "'");
}

class Budgets : public testing::Test {
 protected:
  void SetUp() override {
#ifdef __clang__
    GTEST_SKIP() << "call graphs come from GCC";
#endif
  }
};

constexpr const char* kFill =
    "extern void use(char*) asm(\"memset\");\n"
    "__attribute__((noinline)) int leaf(int x) { char a[1000]; use(a); return a[x]; }\n";

TEST_F(Budgets, TheDeepestPathIsTheSumOfItsFrames) {
  const ScriptResult result =
      check_budgets_of(std::string(kFill) +
                       "__attribute__((noinline)) int middle(int x) { char a[2000]; use(a); "
                       "return a[x] + leaf(x); }\n"
                       "int top(int x) { char a[3000]; use(a); return a[x] + middle(x) + leaf(x); }");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  const std::size_t place = result.output.find("stack ");
  ASSERT_NE(place, std::string::npos) << result.output;
  const int stack_bytes = std::stoi(result.output.substr(place + 6));
  EXPECT_GE(stack_bytes, 6000);
  EXPECT_LE(stack_bytes, 6400);
}

TEST_F(Budgets, TooMuchStackAndTooMuchCodeFail) {
  EXPECT_EQ(check_budgets_of(std::string(kFill) + "int top(int x) { char a[8000]; use(a); return a[x] + leaf(x); }")
                .exit_code,
            1);
  EXPECT_EQ(check_budgets_of("extern const char table[60000]; const char table[60000] = {1};").exit_code, 1);
}

TEST_F(Budgets, RecursionPointersAndFramesOfNoFixedSizeAreNamed) {
  const ScriptResult recursion = check_budgets_of(
      std::string(kFill) +
      "int b(int x);\n__attribute__((noinline)) int a(int x) { return leaf(x) + (x > 0 ? b(x - 1) * 3 : 1); }\n"
      "__attribute__((noinline)) int b(int x) { return leaf(x) + (x > 0 ? a(x - 1) * 5 : 2); }");
  EXPECT_EQ(recursion.exit_code, 1);
  EXPECT_NE(recursion.output.find("recursion"), std::string::npos) << recursion.output;
  const ScriptResult pointer = check_budgets_of("int f(int (*g)(int)) { return g(1) + 1; }");
  EXPECT_EQ(pointer.exit_code, 1);
  EXPECT_NE(pointer.output.find("a call through a pointer"), std::string::npos) << pointer.output;
  const ScriptResult dynamic = check_budgets_of(
      std::string(kFill) + "int f(int n) { char* a = (char*)__builtin_alloca((unsigned)n); use(a); return a[0]; }");
  EXPECT_EQ(dynamic.exit_code, 1);
  EXPECT_NE(dynamic.output.find("a frame of no fixed size"), std::string::npos) << dynamic.output;
}

}  // namespace
}  // namespace gridiron::test
