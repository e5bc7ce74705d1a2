// The gridiron program: parses, runs one command, turns failures into messages and exit codes.
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <variant>

#include "arguments.h"
#include "commands.h"
#include "failure.h"
#include "interrupt.h"

namespace {

using gridiron::tool::ExitCode;

ExitCode run(int count, const char* const* values) {
  try {
    const gridiron::tool::Command command = gridiron::tool::parse_arguments(count, values);
    std::visit([](const auto& arguments) { gridiron::tool::run_command(arguments); }, command);
    // Text for a full disk or a closed pipe is lost only here.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      gridiron::tool::stop_if_interrupted("interrupted while writing to standard output");
      std::fputs("gridiron: cannot write to standard output\n", stderr);
      return ExitCode::kBadInput;
    }
    return ExitCode::kDone;
  } catch (const gridiron::tool::Failure& failure) {
    const char* prefix = failure.code() == ExitCode::kUsage ? "gridiron: " : "";
    std::fprintf(stderr, "%s%s\n", prefix, failure.what());
    return failure.code();
  } catch (const std::bad_alloc&) {
    std::fputs("gridiron: this host has not enough memory\n", stderr);
    return ExitCode::kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gridiron: %s\n", error.what());
    return ExitCode::kBadInput;
  }
}

}  // namespace

int main(int count, char** values) {
  gridiron::tool::watch_for_interrupt();
  return static_cast<int>(run(count, values));
}
