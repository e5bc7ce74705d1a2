// Runs a command through the shell and keeps what it says. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include "support/test_headers.h"

namespace gridiron::test {

struct ScriptResult {
  int exit_code = -1;
  std::string output;  ///< both streams
};

inline ScriptResult run_script(const std::string& command) {
  ScriptResult result;
  std::FILE* pipe = popen((command + " 2>&1 < /dev/null").c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> piece{};
  while (const std::size_t bytes = std::fread(piece.data(), 1, piece.size(), pipe)) {
    result.output.append(piece.data(), bytes);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  return result;
}

/// Path of a file of the checkout.
inline std::string source_path(const std::string& name) {
  return (std::filesystem::path(GRIDIRON_SOURCE_DIR) / name).string();
}

/// An empty directory of the running test's own, gone when the object goes.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string("gridiron_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace gridiron::test
