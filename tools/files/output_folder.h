// Output folder: created if it is missing, removed again if nothing was written into it.
// Memory: its path. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "overdue_exit.h"

namespace gridiron::tool {

class OutputFolder {
 public:
  /// @param names  of the files that may be written into it; all are declared as outputs of the command.
  /// Errors: Failure (kBadInput), and those of declare_outputs().
  OutputFolder(std::filesystem::path path, const std::vector<std::string>& names);
  ~OutputFolder() { remove_if_made(); }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  void keep();

 private:
  void remove_if_made();

  std::filesystem::path path_;
  bool made_ = false, kept_ = false;
  Leftover leftover_;
};

}  // namespace gridiron::tool
