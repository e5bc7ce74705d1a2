// Commands of the program, one function each. Errors: Failure.
// Memory: their own. Threads: one; render and experiment start more. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridiron/command_line/arguments.h"

namespace gridiron::tool {

void run_command(const RenderArguments& arguments);
void run_command(const AnimateArguments& arguments);
void run_command(const InfoArguments& arguments);
void run_command(const PackArguments& arguments);
void run_command(const JobArguments& arguments);
void run_command(const ResultArguments& arguments);
void run_command(const MachinesArguments& arguments);
void run_command(const ExperimentArguments& arguments);  ///< in tools/experiment
void run_command(const TextRequest& request);

}  // namespace gridiron::tool
