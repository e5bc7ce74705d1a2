// The program: parses, runs one command, turns failures into messages and exit codes.
// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <type_traits>
#include <variant>

#include "base/ranks.h"
#include "base/words.h"
#include "commands.h"
#include "files/command_files.h"
#include "files/interrupt.h"
#include "gridiron/command_line/arguments.h"

namespace gridiron::tool {
namespace {

// Runs before main and all other initialisers of the program, so that signals during these are caught too. If standard
// input, output or error is closed, an unusable descriptor takes its place; otherwise the next opened file would take
// it, and receive messages.
[[gnu::constructor(101)]] void begin() {
  watch_for_interrupt();
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
  stop_if_interrupted();
  throw Failure(ExitCode::kBadInput, "standard output: cannot write" + reason);
}

// The state of a failed command's files: all, some or none of them have got their names.
std::string words_of_files(const Failure& failure) {
  const std::size_t count = written_file_count();
  if (count == 0) return failure.is_interrupt() ? "; no file was written" : "";
  return std::string(failure.is_interrupt() ? "; " : "\n") + words_of_count(count, "file") +
         (count == 1 ? " was" : " were") + " written before that and " + (count == 1 ? "is" : "are") + " kept";
}

// Other commands are done by rank 0.
template <class Request>
constexpr bool kIsShared = std::is_same_v<Request, RenderRequest> || std::is_same_v<Request, AnimateRequest> ||
                           std::is_same_v<Request, ExperimentRequest>;

}  // namespace

ProgramEnd end_of(const Failure& failure) {
  const char* prefix = failure.code() == ExitCode::kUsage ? "gridiron: " : "";
  return {failure.code(), std::string(prefix) + failure.what() + (ranks().is_first() ? words_of_files(failure) : "")};
}

ProgramEnd run_program(int count, const char* const* values) {
  const bool is_first = ranks().is_first();
  try {
    const Command command = parse_arguments(count, values);
    std::visit(
        [is_first]<class Request>(const Request& request) {
          if (is_first || kIsShared<Request>) run_command(request);
        },
        command);
    flush_text();
    return {};
  } catch (const Failure& failure) {
    return end_of(failure);
  } catch (const std::bad_alloc&) {
    std::string line;
    for (int i = 1; i < count; ++i) line += std::string(i == 1 ? "" : " ") + values[i];
    return {ExitCode::kBadInput, "gridiron: this host has not enough memory for this command: " + line};
  } catch (const std::exception& error) {
    return {ExitCode::kBadInput, std::string("gridiron: ") + error.what()};
  }
}

}  // namespace gridiron::tool
