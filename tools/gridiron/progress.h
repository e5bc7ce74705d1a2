// Progress: a bar on a terminal, nothing anywhere else.
// Memory: small. Threads: update() is called by one at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::tool {

/// Draws on standard error while it lives and wipes the line when it dies.
class Progress {
 public:
  /// @param wanted  false, or a standard error that is no terminal: nothing is ever drawn.
  /// @param noun    what is counted.
  explicit Progress(bool wanted, const char* noun = "tile");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::uint32_t done, std::uint32_t total);

 private:
  bool drawing_;
  const char* noun_;
  std::uint32_t drawn_percent_ = ~0u;
};

}  // namespace gridiron::tool
