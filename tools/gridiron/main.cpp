// The gridiron program: one process. SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "files/command_files.h"
#include "files/overdue_exit.h"
#include "gridiron/program.h"
#include "import/model_import.h"

int main(int count, char** values) {
  if (const std::optional<int> code = gridiron::tool::serve_import(count, values)) return *code;
  const gridiron::tool::CommandFiles files;
  const gridiron::tool::ProgramEnd end = gridiron::tool::run_program(count, values);
  if (!end.words.empty()) gridiron::tool::say_last_words((end.words + "\n").c_str());
  return static_cast<int>(end.code);
}
