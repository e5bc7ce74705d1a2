// The rules of the folders: the sources keep them, and a breach of each is noticed. SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

ScriptResult check_folders(const std::string& root) {
  return run_script(source_path("tools/checks/check_folders") + " '" + root + "'");
}

TEST(Folders, TheSourcesKeepTheRules) {
  const ScriptResult result = check_folders(source_path(""));
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

struct Breach {
  const char* name;
  const char* file;
  const char* line;
  const char* reason;  ///< nullptr: no breach
};

void PrintTo(const Breach& breach, std::ostream* stream) {
  *stream << breach.name;
}

constexpr const char* kLicence = "// A file. SPDX-License-Identifier: Apache-2.0\n";

class FolderBreach : public testing::TestWithParam<Breach> {};

TEST_P(FolderBreach, IsNoticed) {
  const Breach& breach = GetParam();
  const ScratchDirectory tree;
  tree.write(breach.file, std::string(kLicence) + "\n" + breach.line + "\n");
  const ScriptResult result = check_folders(tree.path().string());
  if (breach.reason == nullptr) {
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return;
  }
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_NE(result.output.find(std::string(breach.file) + ":"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find(breach.reason), std::string::npos) << result.output;
}

constexpr const char* kNotFreestanding = "is not a freestanding header";
constexpr const char* kMustNot = "must not include folder";
constexpr const char* kHosted = "a hosted type";

INSTANTIATE_TEST_SUITE_P(
    Each, FolderBreach,
    testing::Values(
        // What is right stays quiet.
        Breach{"ray_on_base", "core/gridiron/ray/a.h", "#include <gridiron/base/math.h>", nullptr},
        Breach{"render_on_store", "core/gridiron/render/a.h", "#include <gridiron/store/local_store.h>", nullptr},
        Breach{"image_on_grid", "core/gridiron/image/a.h", "#include <gridiron/build/grid/grid_builder.h>", nullptr},
        Breach{"core_on_platform", "core/gridiron/ray/a.h", "#include <gridiron/platform/status.h>", nullptr},
        Breach{"core_on_glm", "core/gridiron/ray/a.h", "#include <glm/vec3.hpp>", nullptr},
        Breach{"port_on_core", "platform/board/a.h", "#include <gridiron/render/tile_renderer.h>", nullptr},
        Breach{"header_for_c", "platform/gridiron/c/a.h", "#include <stdint.h>", nullptr},
        Breach{"firmware_in_c", "platform/board/a.c", "#include <gridiron/c/gridiron.h>", nullptr},
        Breach{"library_in_c", "platform/gridiron/c/a.c", "int a;", "a kind of file that this folder does not have"},
        Breach{"core_in_c", "core/gridiron/ray/a.c", "int a;", "a kind of file that this folder does not have"},
        Breach{"c_header_elsewhere", "platform/gridiron/platform/a.h", "#include <stdint.h>", kNotFreestanding},
        Breach{"tools_on_anything", "tools/a.cpp", "#include <vector>", nullptr},
        Breach{"frame_on_scene", "tools/gridiron/frame/a.h", "#include \"gridiron/scene/view.h\"", nullptr},
        Breach{"command_on_job", "tools/gridiron/a.cpp", "#include \"gridiron/job/job_file.h\"", nullptr},
        Breach{"placement_new", "core/gridiron/ray/a.h", "void* f(void* p) { return new (p) int; }", nullptr},
        Breach{"deleted", "core/gridiron/ray/a.h", "struct A { A(const A&) = delete; };", nullptr},
        Breach{"word_in_comment", "core/gridiron/ray/a.h", "int a;  // try malloc(1) and throw it away", nullptr},
        // Arrows that do not point down.
        Breach{"build_name", "core/gridiron/ray/build_a.h", "#include <gridiron/store/local_store.h>", kMustNot},
        Breach{"ray_on_engine", "core/gridiron/ray/a.h", "#include <gridiron/engine/grid/slice_walk.h>", kMustNot},
        Breach{"engine_on_store", "core/gridiron/engine/grid/a.h", "#include <gridiron/store/local_store.h>", kMustNot},
        Breach{"store_on_render", "core/gridiron/store/a.h", "#include <gridiron/render/tile_renderer.h>", kMustNot},
        Breach{"kernel_on_prepare", "core/gridiron/render/a.h", "#include <gridiron/build/grid/grid_builder.h>",
               kMustNot},
        Breach{"kernel_on_frame", "core/gridiron/store/a.cpp", "#include <gridiron/frame/frame_setup.h>", kMustNot},
        Breach{"prepare_on_kernel", "core/gridiron/build/grid/a.cpp", "#include <gridiron/ray/packet.h>", kMustNot},
        Breach{"grid_on_image", "core/gridiron/build/grid/a.h", "#include <gridiron/image/scene_image.h>", kMustNot},
        Breach{"scene_on_io", "core/gridiron/scene/a.h", "#include <gridiron/io/ply_reader.h>", kMustNot},
        Breach{"base_on_ray", "core/gridiron/base/a.h", "#include <gridiron/ray/packet.h>", kMustNot},
        Breach{"core_on_sim", "core/gridiron/render/a.h", "#include <gridiron/sim/trace.h>", "no folder sim"},
        Breach{"platform_on_core", "platform/gridiron/platform/a.h", "#include <gridiron/base/math.h>",
               "platform knows nothing of base"},
        Breach{"platform_on_glm", "platform/gridiron/platform/a.h", "#include <glm/vec3.hpp>", "does not use GLM"},
        Breach{"port_on_sim", "platform/board/a.h", "#include <gridiron/sim/trace.h>", "nothing of the simulator"},
        Breach{"new_folder", "core/gridiron/attic/a.h", "int a;", "not in a folder of core"},
        Breach{"files_on_program", "tools/files/a.h", "#include \"gridiron/scene/view.h\"", kMustNot},
        Breach{"scene_text_on_program", "tools/scene_text/a.h", "#include \"gridiron/scene/view.h\"", kMustNot},
        Breach{"scene_on_frame", "tools/gridiron/scene/a.cpp", "#include \"gridiron/frame/frame_memory.h\"", kMustNot},
        Breach{"frame_on_command", "tools/gridiron/frame/a.h", "#include \"gridiron/commands.h\"", kMustNot},
        // What core does not use.
        Breach{"vector_header", "core/gridiron/build/grid/a.h", "#include <vector>", kNotFreestanding},
        Breach{"cmath_header", "core/gridiron/build/grid/a.cpp", "#include <cmath>", kNotFreestanding},
        Breach{"stdio_header", "platform/gridiron/platform/a.h", "  #  include <cstdio>", kNotFreestanding},
        Breach{"immintrin_outside_lanes", "core/gridiron/ray/a.h", "#include <immintrin.h>", kNotFreestanding},
        Breach{"quoted", "core/gridiron/ray/a.h", "#include \"packet.h\"", "with <gridiron/...> only"},
        Breach{"throw_word", "core/gridiron/ray/a.cpp", "void f() { throw 1; }", "a word that core does not use"},
        Breach{"virtual_word", "core/gridiron/ray/a.h", "struct A { virtual void f(); };", "a word that core"},
        Breach{"malloc_call", "core/gridiron/ray/a.cpp", "void* f() { return malloc(3); }", "heap or alloca"},
        Breach{"new_word", "core/gridiron/ray/a.cpp", "int* f() { return new int; }", "heap: new"},
        Breach{"delete_word", "core/gridiron/ray/a.cpp", "void f(int* p) { delete p; }", "heap: delete"},
        Breach{"string_type", "core/gridiron/io/a.h", "void f(std::string s);", kHosted},
        Breach{"function_type", "core/gridiron/io/a.h", "void f(std::function<void()> s);", kHosted},
        Breach{"libm_call", "core/gridiron/ray/a.cpp", "float f(float x) { return std::sin(x); }", "libm"}),
    [](const testing::TestParamInfo<Breach>& breach) { return std::string(breach.param.name); });

TEST(Folders, ALineTooLongAFileTooLongAndAHeaderTooLongAreNoticed) {
  const ScratchDirectory tree;
  tree.write("tools/wide.cpp", std::string(kLicence) + "// " + std::string(118, 'x') + "\n");
  std::string text = kLicence;
  for (int line = 0; line < 700; ++line) text += "int a" + std::to_string(line) + ";\n";
  tree.write("tools/tall.cpp", text);
  tree.write("tools/wordy.cpp", "// 1\n// 2\n// 3\n// 4\n// 5\n// 6\n" + std::string(kLicence) + "int a;\n");
  tree.write("tools/unlicensed.cpp", "int a;\n" + std::string(kLicence));
  const ScriptResult result = check_folders(tree.path().string());
  EXPECT_EQ(result.exit_code, 1);
  for (const char* line : {"tools/wide.cpp:2: longer than 120 columns", "tools/tall.cpp:701: longer than 700 lines",
                           "tools/wordy.cpp:1: opening comment of 7 lines", "tools/unlicensed.cpp:1: no SPDX",
                           "check_folders: 4 breaches"}) {
    EXPECT_NE(result.output.find(line), std::string::npos) << line << "\n" << result.output;
  }
}

TEST(Folders, WhatLiesOutsideTheFoldersOrIsAProgramIsNoticed) {
  const ScratchDirectory tree;
  tree.write("core/gridiron/ray/a.h", kLicence);
  for (const char* page : {"README.md", "CHANGELOG.md", "CONTRIBUTING.md"}) tree.write(page, "words\n");
  tree.write("tools/CMakeLists.txt", "# Words.\n# SPDX-License-Identifier: Apache-2.0\n");
  tree.write(".clang-format", "words\n");
  tree.write("build/host/program", std::string("\177ELF\0\1", 6));
  tree.write("scenes/a.png", std::string("\211PNG\0", 5));
  ScriptResult result = check_folders(tree.path().string());
  EXPECT_EQ(result.exit_code, 0) << result.output;
  tree.write("it", "words\n");
  tree.write("attic/a.h", kLicence);
  tree.write("tools/program", std::string("\177ELF\0\1", 6));
  tree.write("core/gridiron/ray/a.inl", kLicence);
  tree.write("tools/a.cc", kLicence);
  tree.write("core/CMakeLists.txt", "# Words.\n");
  result = check_folders(tree.path().string());
  EXPECT_EQ(result.exit_code, 1);
  for (const char* line :
       {"it:1: not in a folder", "attic/a.h:1: not in a folder", "tools/program:1: neither text",
        "core/gridiron/ray/a.inl:1: a kind of file", "tools/a.cc:1: a kind of file",
        "core/CMakeLists.txt:1: no SPDX", "check_folders: 6 breaches"}) {
    EXPECT_NE(result.output.find(line), std::string::npos) << line << "\n" << result.output;
  }
}

TEST(Folders, AnEmptyTreeIsNotInOrder) {
  const ScratchDirectory tree;
  EXPECT_EQ(check_folders(tree.path().string()).exit_code, 2);
}

}  // namespace
}  // namespace gridiron::test
