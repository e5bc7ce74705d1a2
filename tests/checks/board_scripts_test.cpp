// The linker scripts of the boards: which images they reject, linked like the boards' own, with sections collected.
// SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

struct BoardScript {
  const char* board;
  const char* target;
  const char* file;
  const char* flags;
  const char* arenas;  ///< sections that the script wants
};

const BoardScript kScripts[] = {
    {"sifive_u", "riscv64", "sifive_u.ld.in", "-mcmodel=medany", ".bss.arena_store .bss.arena_stack"},
    {"zcu102", "aarch64", "zcu102.ld", "", ".arena0 .arena1 .arena2 .arena3"},
};

constexpr const char* kConstructor =
    "extern volatile int elsewhere; volatile int elsewhere;\n"
    "struct Early { Early() { elsewhere = 1; } } early;\n";

// Links an image of nothing but `source` and the arenas.
ScriptResult link(const BoardScript& script, const std::string& source) {
  const ScratchDirectory scratch;
  std::string text = "extern \"C\" [[gnu::section(\".text.start\")]] void _start();\nvoid _start() { for (;;) {} }\n";
  text += source;
  std::string sections = script.arenas;
  for (std::size_t begin = 0, count = 0; begin < sections.size(); ++count) {
    const std::size_t end = std::min(sections.find(' ', begin), sections.size());
    text += "[[gnu::section(\"" + sections.substr(begin, end - begin) + "\"), gnu::used]] char arena" +
            std::to_string(count) + "[64];\n";
    begin = end + 1;
  }
  scratch.write("image.cpp", text);
  const std::string compiler = std::string(script.target) + "-linux-gnu-g++ ";
  const std::string board = source_path(std::string("platform/") + script.board);
  return run_script("cd '" + scratch.path().string() + "' && " + compiler + "-E -P -undef -x c -I '" + board +
                    "' -o board.ld '" + board + "/" + script.file + "' && " + compiler +
                    "-std=c++20 -O2 -ffreestanding -fno-exceptions -fno-pie -ffunction-sections " + script.flags +
                    " -nostdlib -nostartfiles -static -no-pie -T board.ld -Wl,--build-id=none -Wl,--gc-sections "
                    "-Wl,--orphan-handling=error -o image.elf image.cpp");
}

TEST(BoardScripts, RefuseWhatWouldRunBeforeTheEntry) {
  for (const BoardScript& script : kScripts) {
    SCOPED_TRACE(script.board);
    if (run_script(std::string("command -v ") + script.target + "-linux-gnu-g++").exit_code != 0) {
      GTEST_SKIP() << "no cross compiler";
    }
    const ScriptResult plain = link(script, "");
    EXPECT_EQ(plain.exit_code, 0) << plain.output;
    const ScriptResult early = link(script, kConstructor);
    EXPECT_NE(early.exit_code, 0);
    EXPECT_NE(early.output.find("constructors or "), std::string::npos) << early.output;
  }
}

}  // namespace
}  // namespace gridiron::test
