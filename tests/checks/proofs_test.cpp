// The check of the error bounds' proofs refuses a constant that is too small, a source that no longer is as a proof
// says, and a proof that shows nothing. SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

// A sum of a product, 3.0001 e of rounding, and a script that proves its bound.
struct Proof {
  std::string constant = "inline constexpr float kBound = 4.0f * 0x1p-23f;";
  std::string line = "return a * b + c;";
  std::string round = "%round value = a * b + c";
  std::string hypotheses = "|a| <= 1 /\\ |b| <= 1 /\\ |c| <= 1";
  std::string row = "| `sum.g` | `kBound` | 0.751 | 4 e | a sum |";
};

class Proofs : public testing::Test {
 protected:
  void SetUp() override {
    if (run_script("command -v gappa").exit_code != 0) GTEST_SKIP() << "no gappa here";
  }

  static ScriptResult prove(const Proof& proof) {
    const ScratchDirectory tree;
    tree.write("core/sum.h", proof.constant + "\nfloat sum(float a, float b, float c) {\n  " + proof.line + "\n}\n");
    tree.write("tests/numeric/proofs/README.md", proof.row + "\n");
    tree.write("tests/numeric/proofs/sum.g",
               "# A sum.\n%source core/sum.h\n%constant kBound inline constexpr float kBound = {};\n"
               "%proves kBound least 0.751\n%line return a * b + c;\n" +
                   proof.round + "\n{ " + proof.hypotheses +
                   " /\\\n  %roundings\n  -> kBound - |value - exact_value| >= 0 }\n");
    return run_script(source_path("tools/checks/prove") + " --root '" + tree.path().string() + "'");
  }

  static void expect_refused(const Proof& proof, const std::string& reason) {
    const ScriptResult result = prove(proof);
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_NE(result.output.find(reason), std::string::npos) << result.output;
  }
};

TEST_F(Proofs, ABoundIsProved) {
  const ScriptResult result = prove({});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("1 constants are proved"), std::string::npos) << result.output;
}

TEST_F(Proofs, AConstantThatIsTooSmallIsRefused) {
  expect_refused({.constant = "inline constexpr float kBound = 3.0f * 0x1p-23f;"}, "kBound: not proved");
}

TEST_F(Proofs, AConstantThatTheCompilerRoundsIsRefused) {
  expect_refused({.constant = "inline constexpr float kBound = 4.1f * 0x1p-23f;"}, "rounded by the compiler");
  expect_refused({.constant = "inline constexpr float kBound = 0.1f;"}, "rounded by the compiler");
  expect_refused({.constant = "inline constexpr float kBound = 0x1p-20f / 3.0f;"}, "rounded by the compiler");
}

TEST_F(Proofs, ALineThatIsGoneIsNoticed) {
  expect_refused({.line = "return c + a * b;"}, "no such line any more: return a * b + c;");
  expect_refused({.constant = "constexpr float kBound = 4.0f * 0x1p-23f;"}, "has 0 lines of this form");
}

TEST_F(Proofs, AProofThatLeavesOutARoundingIsNoticed) {
  expect_refused({.round = "%define product = a * b\n%define exact_value = a * b + c\n%round value_ = product + c\n"
                           "%define value = value_"},
                 "proved with 0.99 of what should be the least");
}

TEST_F(Proofs, AProofFromAContradictionIsNoticed) {
  expect_refused({.hypotheses = "|a| <= 1 /\\ |b| <= 1 /\\ |c| <= 1 /\\ a >= 2"},
                 "proved with 0.99 of what should be the least");
}

TEST_F(Proofs, ARowThatIsStaleIsNoticed) {
  expect_refused({.row = "| `sum.g` | `kBound` | 0.9 | 4 e | a sum |"}, "no row that begins like this one");
}

}  // namespace
}  // namespace gridiron::test
