// The budget check finds the deepest stack and refuses what has none. SPDX-License-Identifier: Apache-2.0
#include <gridiron/store/local_store.h>

#include "run_script.h"

namespace gridiron::test {
namespace {

void compile_as(const ScratchDirectory& scratch, const std::string& target, const std::string& text) {
  scratch.write(target + ".dir/a.cpp", text);
  const ScriptResult built = run_script("cd '" + scratch.path().string() + "/" + target +
                                        ".dir' && " GRIDIRON_CXX_COMPILER
                                        " -std=c++20 -O1 -fcallgraph-info=su,da -c a.cpp -o a.obj");
  EXPECT_EQ(built.exit_code, 0) << built.output;
}

// Compiles `text` as if it were the kernel of a cross build, and a port where one is named, and checks their budgets.
ScriptResult check_budgets_of(const std::string& text, const std::string& port = "",
                              const std::string& port_text = "") {
  const ScratchDirectory scratch;
  compile_as(scratch, "gridiron_kernel", text);
  if (!port.empty()) compile_as(scratch, "gridiron_template_port_" + port, port_text);
  const std::string directory = scratch.path().string();
  return run_script(source_path("tools/checks/check_budgets") + " size '" + directory + "'");
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

std::string words_of_budget(std::uint32_t code_bytes) {
  return " of " + std::to_string(code_bytes) + " bytes, stack ";
}

// A port of 60,000 bytes of constants is within the budget of all effects in 256 KB and beyond the others'.
TEST_F(Budgets, EachPortIsHeldAgainstItsOwnLayout) {
  const std::string small = "int f(int x) { return x + 1; }";
  const std::string table = "extern const char table[60000]; const char table[60000] = {1}; int g() { return 1; }";
  const ScriptResult effects = check_budgets_of(small, "effects", table);
  EXPECT_EQ(effects.exit_code, 0) << effects.output;
  EXPECT_NE(effects.output.find("effects: code "), std::string::npos) << effects.output;
  EXPECT_NE(effects.output.find(words_of_budget(EffectLayout256K<kAllEffects, 8>::kCodeBudgetBytes)), std::string::npos)
      << effects.output;
  const ScriptResult effects64k = check_budgets_of(small, "effects64k", table);
  EXPECT_EQ(effects64k.exit_code, 1);
  EXPECT_NE(effects64k.output.find(words_of_budget(EffectLayout64K<kAllEffects>::kCodeBudgetBytes)), std::string::npos)
      << effects64k.output;
  const ScriptResult tree = check_budgets_of(small, "tree", table);
  EXPECT_NE(tree.output.find(words_of_budget(TreeLayout256K<>::kCodeBudgetBytes)), std::string::npos) << tree.output;
  const ScriptResult tree64k = check_budgets_of(small, "tree64k", table);
  EXPECT_EQ(tree64k.exit_code, 1);
  EXPECT_NE(tree64k.output.find(words_of_budget(TreeLayout64K::kCodeBudgetBytes)), std::string::npos) << tree64k.output;
  EXPECT_EQ(check_budgets_of(small, "packet32", table).exit_code, 1);
  EXPECT_EQ(check_budgets_of(small, "packet32", small).exit_code, 0);
  // Stacks too: 5,000 bytes are too much for 64 KB alone.
  const std::string deep =
      "extern void use(char*) asm(\"memset\"); int g(int x) { char a[5000]; use(a); return a[x]; }";
  EXPECT_EQ(check_budgets_of(small, "effects", deep).exit_code, 0);
  EXPECT_EQ(check_budgets_of(small, "effects64k", deep).exit_code, 1);
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
