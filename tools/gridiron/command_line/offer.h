// Offer: what a shell may offer as the value of an option or argument. The program itself does not look at it.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace gridiron::tool {

/// Values of an option that can be listed; none of numbers and free text.
struct Offer {
  std::vector<std::string> words;    ///< the choices of an option, or names such as those of machines
  std::vector<std::string> endings;  ///< of files, without the dot; empty: files are offered by no ending
  bool has_files = false;            ///< any file can be named; those with one of the endings come first
  bool has_folders = false;          ///< a folder can be named

  bool operator==(const Offer&) const = default;
};

/// Remembers the offer with the option, in place of an earlier one. Changes neither its help nor how it is parsed.
void set_offer(CLI::Option& option, const Offer& offer);

/// @returns the offer of set_offer(), or an empty one.
[[nodiscard]] Offer offer_of(CLI::Option& option);

/// Sets an offer of files. @param endings  without the dot: "ply".
void offer_files(CLI::Option& option, std::vector<std::string> endings);

void offer_folders(CLI::Option& option);

/// Sets an offer of all built-in machines, and of files.
void offer_machines(CLI::Option& option);

}  // namespace gridiron::tool
