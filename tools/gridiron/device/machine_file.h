// Machine files: a machine profile as text, and the machine that a command names.
// Memory: owns names and text. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/sim_chip.h>

#include <filesystem>
#include <memory>
#include <string>

namespace gridiron::tool {

/// A machine profile, built in or from a file, with its name and description.
using Machine = std::shared_ptr<const sim::MachineProfile>;

/// @returns the built-in profile of that name, or the profile in the file of that name. Errors: Failure (kBadInput) as
/// `file:line: reason`, or with the built-in names if there is no such file.
[[nodiscard]] Machine find_machine(const std::string& name_or_file);

/// Reads a machine file; tools/README.md, "Machines", documents the format. Errors: Failure (kBadInput), `file:line:
/// reason`.
[[nodiscard]] Machine read_machine_file(const std::filesystem::path& path);

/// @returns the largest store that core is built for and that fits a core of the machine.
[[nodiscard]] sim::StoreSize largest_store(const sim::MachineProfile& machine);

/// @returns the profile in the same format, every constant in it; reading it gives the identical profile.
[[nodiscard]] std::string machine_text(const sim::MachineProfile& machine);

}  // namespace gridiron::tool
