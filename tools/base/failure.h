// Failure: ends a command of the program with an exit code and a message.
// Memory: owns its message. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace gridiron::tool {

/// Exit codes of the program.
enum class ExitCode : int {
  kDone = 0,
  kBadInput = 1,       ///< a file is missing, wrong, too large for the machine, or cannot be written
  kUsage = 2,          ///< the command line
  kCheckFailed = 3,    ///< a check of the simulator or a memory budget failed
  kHungUp = 129,       ///< SIGHUP
  kInterrupted = 130,  ///< SIGINT
  kTerminated = 143,   ///< SIGTERM
};

/// Ends the command; main prints the message, one line or several, and exits with the code.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}

  [[nodiscard]] ExitCode code() const { return code_; }
  [[nodiscard]] bool is_interrupt() const { return code_ >= ExitCode::kHungUp; }

 private:
  ExitCode code_;
};

[[noreturn]] inline void usage_error(const std::string& message) {
  throw Failure(ExitCode::kUsage, message);
}

/// Throws the Failure (kBadInput) `source: reason`. @param source  a file or folder.
[[noreturn]] inline void input_error(const std::filesystem::path& source, const std::string& reason) {
  throw Failure(ExitCode::kBadInput, source.string() + ": " + reason);
}

/// The same for `file:line: reason`.
[[noreturn]] inline void input_error(const std::filesystem::path& file, std::uint64_t line, const std::string& reason) {
  throw Failure(ExitCode::kBadInput, file.string() + ":" + std::to_string(line) + ": " + reason);
}

}  // namespace gridiron::tool
