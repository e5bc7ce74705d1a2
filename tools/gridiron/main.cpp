// The gridiron program: parses, runs one command, turns failures into messages and exit codes.
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <variant>

#include "base/failure.h"
#include "base/words.h"
#include "commands.h"
#include "files/command_files.h"
#include "files/interrupt.h"
#include "files/overdue_exit.h"
#include "gridiron/command_line/arguments.h"
#include "import/model_import.h"

namespace {

using gridiron::tool::ExitCode;
using gridiron::tool::Failure;

// Runs before main and all other initialisers of the program, so that signals during these are caught too. If standard
// input, output or error is closed, an unusable descriptor takes its place; otherwise the next opened file would take
// it, and receive messages.
[[gnu::constructor(101)]] void begin() {
  gridiron::tool::watch_for_interrupt();
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(standard, F_GETFD) >= 0) continue;
    (void)::open("/dev/null", standard == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // takes the lowest closed descriptor
  }
}

// Text for a full disk or a closed pipe is lost only here.
void flush_text() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  gridiron::tool::stop_if_interrupted();
  throw Failure(ExitCode::kBadInput, "standard output: cannot write" + reason);
}

// The state of a failed command's files: all, some or none of them have got their names.
std::string words_of_files(const Failure& failure) {
  const std::size_t count = gridiron::tool::written_file_count();
  if (count == 0) return failure.is_interrupt() ? "; no file was written" : "";
  return std::string(failure.is_interrupt() ? "; " : "\n") + gridiron::tool::words_of_count(count, "file") +
         (count == 1 ? " was" : " were") + " written before that and " + (count == 1 ? "is" : "are") + " kept";
}

ExitCode run(int count, const char* const* values) {
  try {
    const gridiron::tool::Command command = gridiron::tool::parse_arguments(count, values);
    std::visit([](const auto& arguments) { gridiron::tool::run_command(arguments); }, command);
    flush_text();
    return ExitCode::kDone;
  } catch (const gridiron::tool::Failure& failure) {
    const char* prefix = failure.code() == ExitCode::kUsage ? "gridiron: " : "";
    gridiron::tool::say_last_words((std::string(prefix) + failure.what() + words_of_files(failure) + "\n").c_str());
    return failure.code();
  } catch (const std::bad_alloc&) {
    std::string line;
    for (int i = 1; i < count; ++i) line += std::string(i == 1 ? "" : " ") + values[i];
    const std::string words = "gridiron: this host has not enough memory for this command: " + line + "\n";
    gridiron::tool::say_last_words(words.c_str());
    return ExitCode::kBadInput;
  } catch (const std::exception& error) {
    gridiron::tool::say_last_words((std::string("gridiron: ") + error.what() + "\n").c_str());
    return ExitCode::kBadInput;
  }
}

}  // namespace

int main(int count, char** values) {
  if (const std::optional<int> code = gridiron::tool::serve_import(count, values)) return *code;
  const gridiron::tool::CommandFiles files;
  return static_cast<int>(run(count, values));
}
