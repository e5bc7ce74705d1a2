// Machine keys: all numbers of a machine profile in one table, by their names in machine files and JSON.
// Memory: constants; borrows a profile where it says so. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace gridiron::tool {

/// One number of a profile.
struct MachineKey {
  std::string name;  ///< "core_count", "work_cycles.cell_step"; its last word but numbers of things is its unit
  std::variant<std::uint32_t*, std::uint64_t*, double*, sim::Latency*> number;  ///< in the profile
  double least, most;       ///< what a machine file may say; of a latency, each of its numbers
  bool is_in_files = true;  ///< false: always 0, and only shown in JSON
};

/// @returns every number of `machine`, in the order of machine files and JSON.
[[nodiscard]] std::vector<MachineKey> machine_keys(sim::MachineProfile& machine);

/// @returns those of them that machine files have.
[[nodiscard]] std::vector<MachineKey> file_keys(sim::MachineProfile& machine);

/// Sets the number of `key` to what `text`, a value of a machine file, says.
/// @returns what is wrong with the text, with the name or the range of the key; nothing if the number is set.
[[nodiscard]] std::optional<std::string> set_number(const MachineKey& key, std::string_view text);

/// @returns the number of `key` as a value of a machine file.
[[nodiscard]] std::string text_of(const MachineKey& key);
/// @returns the shortest text that reads back as the same double.
[[nodiscard]] std::string text_of(double value);
/// @returns "500", or "400:0.98 5400:0.02".
[[nodiscard]] std::string text_of(const sim::Latency& latency);

/// A row of the help and of the table in tools/README.md.
struct MachineKeyHelp {
  std::string key;    ///< as in MachineKey, or "work_cycles.KIND"
  std::string range;  ///< "1 to 1024"
  std::string_view meaning;
};
[[nodiscard]] std::vector<MachineKeyHelp> machine_key_help();

}  // namespace gridiron::tool
