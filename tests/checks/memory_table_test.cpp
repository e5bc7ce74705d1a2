// The table of memory: measured on small builds of the cross compilers, compared with what was committed; and what must
// not be in code for a core is refused, compiled as core is. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/store/local_store.h>

#include "run_script.h"

namespace gridiron::test {
namespace {

const std::vector<std::string> kTargets = {"riscv64", "aarch64"};
const std::string kFlags =
    "-std=c++20 -O2 -ffreestanding -fno-exceptions -fno-rtti -fno-pie -ffunction-sections "
    "-fno-asynchronous-unwind-tables -fno-unwind-tables "
    "-fcallgraph-info=su,da";

bool has_cross_compilers() {
  return run_script("command -v riscv64-linux-gnu-g++ aarch64-linux-gnu-g++ ninja").exit_code == 0;
}

std::string quoted(const std::filesystem::path& path) {
  return "'" + path.string() + "'";
}

void expect_said(const ScriptResult& result, int exit_code, const std::string& words) {
  EXPECT_EQ(result.exit_code, exit_code) << result.output;
  EXPECT_NE(result.output.find(words), std::string::npos) << result.output << "lacks: " << words;
}

std::string memory_table() {
  return source_path("tools/checks/memory_table");
}

// --- What was committed against what was measured.

struct Figures {
  std::string code = "10000", read_only = "1000", data = "0", stack = "2000", left = "30000", arena = "65536",
              verdict = "fits";
};

std::string rows_of(const Figures& figures) {
  return "target,part,name,effects,tile_width,packet_width,code_bytes,read_only_bytes,data_bytes,stack_bytes,store_"
         "bytes,"
         "sum_bytes,arena_bytes,left_bytes,verdict\nriscv64,kernel,StoreLayout64K,none,16,8," +
         figures.code + "," + figures.read_only + "," + figures.data + "," + figures.stack + ",20000,33000," +
         figures.arena + "," + figures.left + "," + figures.verdict +
         "\nriscv64,prepare,read_ply,,,,5000,,,9216,,,,,\n";
}

ScriptResult compare(const std::string& committed, const std::string& measured) {
  const ScratchDirectory scratch;
  scratch.write("committed.csv", committed);
  scratch.write("measured.csv", measured);
  return run_script(memory_table() + " --compare " + quoted(scratch.path() / "committed.csv") + " " +
                    quoted(scratch.path() / "measured.csv"));
}

TEST(MemoryTable, OnePercentIsBorne) {
  EXPECT_EQ(compare(rows_of({}), rows_of({})).exit_code, 0);
  const ScriptResult up = compare(rows_of({}), rows_of({.code = "10100", .stack = "2016", .left = "29000"}));
  EXPECT_EQ(up.exit_code, 0) << up.output;
  EXPECT_EQ(compare(rows_of({}), rows_of({.code = "9900"})).exit_code, 0);
}

TEST(MemoryTable, MoreFailsEitherWayAndIsNamed) {
  const ScriptResult code = compare(rows_of({}), rows_of({.code = "10200"}));
  EXPECT_EQ(code.exit_code, 1);
  EXPECT_NE(code.output.find("StoreLayout64K, effects none, tiles of 16, packets of 8: code_bytes was 10000, is 10200"),
            std::string::npos)
      << code.output;
  EXPECT_NE(code.output.find("--update"), std::string::npos) << code.output;
  const Figures others[] = {{.code = "9800"},  {.read_only = "1011"}, {.data = "4"},
                            {.stack = "2032"}, {.arena = "65535"},    {.verdict = "over_arena"}};
  for (const Figures& other : others) EXPECT_EQ(compare(rows_of({}), rows_of(other)).exit_code, 1) << rows_of(other);
}

TEST(MemoryTable, RowsThatComeAndGoFail) {
  const std::string row = "riscv64,prepare,count_ply,,,,5000,,,9120,,,,,\n";
  expect_said(compare(rows_of({}), rows_of({}) + row), 1, "riscv64 prepare count_ply: a new row");
  expect_said(compare(rows_of({}) + row, rows_of({})), 1, "riscv64 prepare count_ply: a row without its");
}

TEST(MemoryTable, TheReadmeShowsWhatIsCommitted) {
  const ScriptResult table = run_script(memory_table() + " --table " + source_path("core/memory.csv"));
  ASSERT_EQ(table.exit_code, 0) << table.output;
  EXPECT_NE(table.output.find("On riscv64 64 KB hold `TreeLayout64K`, `EffectLayout64K<kAllEffects>`"),
            std::string::npos)
      << table.output;
  std::ifstream file(source_path("core/README.md"));
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(readme.find("<!-- memory_table -->\n" + table.output + "<!-- end of memory_table -->\n"), std::string::npos)
      << "tools/checks/memory_table build/riscv64 build/aarch64 --update";
}

// --- Small builds, measured.

constexpr const char* kKernel =
    "extern \"C\" void* memset(void*, int, unsigned long);\n"
    "namespace gridiron { extern const int kTable[100]; const int kTable[100] = {7};\n"
    "int helper(int x) { char a[1000]; memset(a, x, 1000); return a[x & 7]; } }\n";
constexpr const char* kPort =
    "#include <gridiron/store/local_store.h>\nnamespace gridiron { int helper(int);\n"
    "int render(LocalStore<StoreLayout64K<8>>& store, int x) { return 3 * helper(x + int(store.output[0].id[1])); } "
    "}\n";
constexpr const char* kBuild64K =
    "#include <gridiron/build/passes/build_plan.h>\nnamespace gridiron { int helper(int);\n"
    "template <BuildPass kPass> int build_on_template_board(int x);\n"
    "template <BuildPass kPass> int build_on_template_board(int x) {\n"
    "  return kPass == BuildPass::kSort ? 7 * helper(x) * helper(x + 9) : x + 1; }\n"
    "#define PASS(pass) template int build_on_template_board<BuildPass::pass>(int);\n"
    "PASS(kBounds) PASS(kCodes) PASS(kBuckets) PASS(kCuts) PASS(kSort) PASS(kTop) PASS(kSubtrees) PASS(kJoin)\n"
    "PASS(kNumbers) PASS(kCheck) }\n";
constexpr const char* kBuild256K =
    "namespace gridiron { int helper(int); int build_on_template_board(int x);\n"
    "int build_on_template_board(int x) { return 7 * helper(x); } }\n";
constexpr const char* kPrepare =
    "namespace gridiron { struct FrameSettings { int width; }; int helper(int);\n"
    "int make_frame_record(const FrameSettings& settings) { return 5 * helper(settings.width); } }\n";

// Builds kernel, port and prepare of both targets below `scratch` as the cross builds lay them out, and measures them.
ScriptResult measure(const ScratchDirectory& scratch, const std::string& kernel, const std::string& prepare) {
  std::filesystem::create_directories(scratch.path() / "include");
  if (!std::filesystem::exists(scratch.path() / "include/glm")) {
    std::filesystem::create_directory_symlink("/usr/include/glm", scratch.path() / "include/glm");
  }
  scratch.write("kernel.cpp", kernel);
  scratch.write("port.cpp", kPort);
  scratch.write("prepare.cpp", prepare);
  scratch.write("build64k.cpp", kBuild64K);
  scratch.write("build256k.cpp", kBuild256K);
  std::string builds;
  for (const std::string& target : kTargets) {
    const std::string source = (scratch.path()).string();
    const auto build = [&source](const std::string& layout) {
      return "build platform/CMakeFiles/gridiron_template_build" + layout + ".dir/build.cpp.obj: compile " + source +
             "/build" + layout + ".cpp\n";
    };
    scratch.write(
        target + "/build.ninja",
        "rule compile\n  command = " + target + "-linux-gnu-g++ " + kFlags + " -I" + source_path("core") + " -I" +
            source_path("platform") + " -isystem " + source +
            "/include -MD -MT $out -MF $out.d -o $out -c $in\n"
            "build platform/CMakeFiles/gridiron_template_port_packet8.dir/template/template_firmware.cpp.obj: "
            "compile " +
            source +
            "/port.cpp\n"
            "build core/CMakeFiles/gridiron_kernel.dir/kernel.cpp.obj: compile " +
            source +
            "/kernel.cpp\n"
            "build core/CMakeFiles/gridiron_prepare.dir/prepare.cpp.obj: compile " +
            source + "/prepare.cpp\n" + build("64k") + build("256k"));
    const ScriptResult built = run_script("ninja -C " + quoted(scratch.path() / target));
    if (built.exit_code != 0) return built;
    builds += " " + quoted(scratch.path() / target);
  }
  return run_script(memory_table() + builds);
}

// Fields of the row that begins with `key`.
std::vector<long> numbers_of(const std::string& csv, const std::string& key) {
  std::vector<long> numbers;
  const std::size_t place = csv.find("\n" + key + ",");
  if (place == std::string::npos) return numbers;
  const std::size_t begin = place + key.size() + 2;
  std::stringstream fields(csv.substr(begin, csv.find('\n', begin) - begin));
  for (std::string field; std::getline(fields, field, ',');) {
    if (!field.empty() && field.find_first_not_of("-0123456789") == std::string::npos)
      numbers.push_back(std::stol(field));
  }
  return numbers;
}

TEST(MemoryTable, MeasuresWhatTheCompilersMade) {
  if (!has_cross_compilers()) GTEST_SKIP() << "no cross compilers";
  const ScratchDirectory scratch;
  const ScriptResult first = measure(scratch, kKernel, kPrepare);
  ASSERT_EQ(first.exit_code, 0) << first.output;
  for (const std::string& target : kTargets) {
    const std::vector<long> row = numbers_of(first.output, target + ",kernel,StoreLayout64K,none,16,8");
    ASSERT_EQ(row.size(), 8u) << first.output;
    EXPECT_GT(row[0], 40);
    EXPECT_LT(row[0], 400);
    EXPECT_EQ(row[1], 400);
    EXPECT_EQ(row[2], 0);
    EXPECT_GT(row[3], 1000);
    EXPECT_LT(row[3], 1300);
    EXPECT_EQ(row[4], static_cast<long>(sizeof(LocalStore<StoreLayout64K<8>>)));
    EXPECT_EQ(row[5], row[0] + row[1] + row[2] + row[3] + row[4]);
    EXPECT_EQ(row[6], 65536);
    EXPECT_EQ(row[7], row[6] - row[5]);
    const std::vector<long> entry = numbers_of(first.output, target + ",prepare,make_frame_record,,,");
    ASSERT_EQ(entry.size(), 2u) << first.output;
    EXPECT_GT(entry[0], 40);
    EXPECT_GT(entry[1], 1000);
    // Passes of 64 KB are programs of their own: one has the helper and its stack, the others have not.
    const std::vector<long> sort = numbers_of(first.output, target + ",build,BuildLayout64K,sort,,");
    const std::vector<long> top = numbers_of(first.output, target + ",build,BuildLayout64K,top,,");
    const std::vector<long> all = numbers_of(first.output, target + ",build,BuildLayout256K,all passes,,");
    ASSERT_EQ(sort.size(), 8u) << first.output;
    ASSERT_EQ(top.size(), 8u) << first.output;
    ASSERT_EQ(all.size(), 8u) << first.output;
    EXPECT_GT(sort[0], top[0] + 40);
    EXPECT_GT(sort[3], 1000);
    EXPECT_LT(top[3], 100);
    EXPECT_EQ(sort[4], static_cast<long>(sizeof(BuildStore<BuildLayout64K>)));
    EXPECT_EQ(all[4], static_cast<long>(sizeof(BuildStore<BuildLayout256K>)));
    EXPECT_EQ(all[6], 262144);
  }

  // Code that grows shows in the rows that hold it, and fails.
  std::string grown = kKernel;
  grown += "namespace gridiron { int more(int x) { return helper(x) * 7 + helper(x + 3); } }\n";
  const ScriptResult second = measure(scratch, grown, kPrepare);
  ASSERT_EQ(second.exit_code, 0) << second.output;
  const ScriptResult verdict = compare(first.output, second.output);
  EXPECT_EQ(verdict.exit_code, 1);
  for (const std::string& target : kTargets) {
    EXPECT_NE(
        verdict.output.find(target + " kernel StoreLayout64K, effects none, tiles of 16, packets of 8: code_bytes"),
        std::string::npos)
        << verdict.output;
  }
}

TEST(MemoryTable, DataAndRecursionAreRefused) {
  if (!has_cross_compilers()) GTEST_SKIP() << "no cross compilers";
  const ScratchDirectory scratch;
  const ScriptResult data = measure(scratch, std::string(kKernel) + "extern int count; int count = 3;", kPrepare);
  expect_said(data, 1, "gridiron_template_port_packet8: 4 bytes of data that is not constant");
  const ScriptResult recursion = measure(
      scratch, kKernel,
      std::string(kPrepare) + "namespace gridiron { int deep(int x) { return x > 0 ? helper(deep(x - 1)) : 1; } }");
  expect_said(recursion, 1, "deep");
  EXPECT_NE(recursion.output.find("recursion"), std::string::npos) << recursion.output;
}

// --- What must not be in code for a core.

struct Break {
  const char* name;
  const char* text;
  const char* expected;  ///< of deepest_stack
};

void PrintTo(const Break& wrong, std::ostream* stream) {
  *stream << wrong.name;
}

class CoreBreak : public testing::TestWithParam<Break> {};

TEST_P(CoreBreak, IsNamed) {
  if (!has_cross_compilers()) GTEST_SKIP() << "no cross compilers";
  const ScratchDirectory scratch;
  scratch.write("a.cpp", std::string("extern \"C\" void* memset(void*, int, unsigned long);\n") + GetParam().text);
  for (const std::string& target : kTargets) {
    const ScriptResult built = run_script("cd " + quoted(scratch.path()) + " && " + target + "-linux-gnu-g++ " +
                                          kFlags + " -c a.cpp -o a.obj");
    ASSERT_EQ(built.exit_code, 0) << built.output;
    expect_said(run_script(source_path("tools/checks/deepest_stack") + " " + quoted(scratch.path()) + "/*.ci"), 1,
                GetParam().expected);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, CoreBreak,
    testing::Values(
        Break{"recursion",
              "int walk(int x) { char a[64]; memset(a, x, 64); return x > 0 ? walk(x - 1) ^ a[x & 7] : a[0]; }",
              "recursion"},
        Break{"pointer", "int each(int (*visit)(int)) { return visit(1) + 1; }", "each"},
        Break{"virtual_call", "struct B { virtual int f() = 0; }; int g(B& b) { return b.f() + 1; }",
              "a call through a pointer"},
        Break{"alloca", "int f(unsigned n) { char* a = (char*)__builtin_alloca(n); memset(a, 1, n); return a[n / 2]; }",
              "a frame of no fixed size"},
        Break{"array_of_variable_length", "int f(int n) { char a[n]; memset(a, 1, (unsigned)n); return a[n / 2]; }",
              "a frame of no fixed size"},
        Break{"malloc", "extern \"C\" void* malloc(unsigned long); void* f(unsigned long n) { return malloc(n); }",
              "malloc: a function of unknown depth"}),
    [](const testing::TestParamInfo<Break>& wrong) { return std::string(wrong.param.name); });

// From one function: code that it does not reach is ignored; code that it reaches must be known or declared a leaf.
TEST(CoreBreak, OfOtherPathsNothingIsAsked) {
  const ScratchDirectory scratch;
  scratch.write("a.ci",
                "graph: { title: \"a.cpp\"\n"
                "node: { title: \"worker\" label: \"worker\\n100 bytes (static)\" }\n"
                "node: { title: \"b.cpp:step\" label: \"step\\n20 bytes (static)\" }\n"
                "node: { title: \"in_assembly\" label: \"in_assembly\" shape : ellipse }\n"
                "node: { title: \"master\" label: \"master\\n4000 bytes (dynamic)\" }\n"
                "edge: { sourcename: \"worker\" targetname: \"b.cpp:step\" }\n"
                "edge: { sourcename: \"b.cpp:step\" targetname: \"in_assembly\" }\n"
                "edge: { sourcename: \"master\" targetname: \"master\" }\n"
                "edge: { sourcename: \"master\" targetname: \"__indirect_call\" }\n"
                "}\n");
  const auto deepest = [&scratch](const std::string& options) {
    return run_script(source_path("tools/checks/deepest_stack") + " " + options + " " + quoted(scratch.path()) +
                      "/a.ci");
  };
  const ScriptResult worker = deepest("--from worker --leaf in_assembly");
  EXPECT_EQ(worker.exit_code, 0) << worker.output;
  EXPECT_EQ(worker.output, "184\n");
  const struct {
    const char* options;
    const char* expected;
  } wrongs[] = {{"--from worker", "in_assembly: a function of unknown depth"},
                {"--from master", "master: recursion"},
                {"--from master", "master: a frame of no fixed size"},
                {"--from master", "master: a call through a pointer"},
                {"--from step_2 --leaf in_assembly", "step_2: no such function"}};
  for (const auto& wrong : wrongs) {
    SCOPED_TRACE(wrong.options);
    expect_said(deepest(wrong.options), 1, wrong.expected);
  }
}

// As a build that was interrupted leaves it.
TEST(CoreBreak, ACallGraphThatEndsEarlyIsRefused) {
  const std::string whole = "graph: { title: \"a.cpp\"\nnode: { title: \"_Z1fv\" label: \"f\\n16 bytes (static)\" }\n";
  for (const std::string end : {"}\n", ""}) {
    const ScratchDirectory scratch;
    scratch.write("a.ci", whole + end);
    const ScriptResult result =
        run_script(source_path("tools/checks/deepest_stack") + " " + quoted(scratch.path()) + "/a.ci");
    expect_said(result, end.empty() ? 1 : 0, end.empty() ? "a call graph that ends early" : "16");
  }
}

TEST(CoreBreak, AFrameOverTheBudgetIsNamed) {
  if (!has_cross_compilers()) GTEST_SKIP() << "no cross compilers";
  const ScratchDirectory scratch;
  const std::string text =
      "extern \"C\" void* memset(void*, int, unsigned long);\n"
      "int f(int x) { char a[4200]; memset(a, x, 4200); return a[x & 7]; }";
  scratch.write("gridiron_kernel.dir/a.cpp", "int g(int x) { return x + 1; }");
  scratch.write("gridiron_template_port_effects64k.dir/a.cpp", text);
  const ScriptResult built =
      run_script("cd " + quoted(scratch.path()) + " && for d in *.dir; do (cd $d && riscv64-linux-gnu-g++ " + kFlags +
                 " -c a.cpp -o a.obj) || exit 1; done");
  ASSERT_EQ(built.exit_code, 0) << built.output;
  const ScriptResult result =
      run_script(source_path("tools/checks/check_budgets") + " riscv64-linux-gnu-size " + quoted(scratch.path()));
  constexpr std::uint32_t kCodeBytes = EffectLayout64K<kAllEffects>::kCodeBudgetBytes;
  expect_said(result, 1, "of " + std::to_string(kCodeBytes) + " bytes, stack 4");
  EXPECT_NE(result.output.find(" of 4064 bytes"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace gridiron::test
