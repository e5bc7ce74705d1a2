// gridiron_manual: writes the man pages and the shells' completions of the programs gridiron and gridiron_mpi, which
// are then installed. It reads the program's own tables of commands and options. SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "base/failure.h"
#include "completions.h"
#include "man_pages.h"

namespace {

using namespace gridiron::tool;

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) input_error(path, "cannot be written");
}

void write_completions(const std::filesystem::path& folder, const ProgramFacts& facts, const std::string& program) {
  write(folder / "bash" / program, bash_completion(facts, program));
  write(folder / "zsh" / ("_" + program), zsh_completion(facts, program));
  write(folder / "fish" / (program + ".fish"), fish_completion(facts, program));
}

void write_all(const std::filesystem::path& folder) {
  const ProgramFacts facts = program_facts();
  write(folder / "man1" / "gridiron.1", program_page(facts));
  for (const CommandFacts& command : facts.commands) {
    if (command.name != "help") write(folder / "man1" / (page_name(command) + ".1"), command_page(facts, command));
  }
  write_completions(folder, facts, "gridiron");
  write(folder / "mpi" / "man1" / "gridiron_mpi.1", mpi_page(facts));
  write_completions(folder / "mpi", facts, "gridiron_mpi");
}

}  // namespace

int main(int count, char** values) {
  if (count != 2 || values[1][0] == '-') {
    std::fputs("usage: gridiron_manual FOLDER\n", stderr);
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    write_all(values[1]);
    return static_cast<int>(ExitCode::kDone);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(ExitCode::kBadInput);
  }
}
