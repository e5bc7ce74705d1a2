// Commands of the program, one function each. Errors: Failure.
// Memory: their own. Threads: one; render and experiment start more. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "gridiron/command_line/arguments.h"

namespace gridiron::tool {

void run_command(const RenderRequest& request);
void run_command(const AnimateRequest& request);
void run_command(const InfoRequest& request);
void run_command(const PackRequest& request);
void run_command(const JobRequest& request);
void run_command(const ResultRequest& request);
void run_command(const MachinesRequest& request);
void run_command(const ExperimentRequest& request);  ///< in tools/experiment
inline void run_command(const TextRequest& request) {
  std::fputs(request.text.c_str(), stdout);
}

}  // namespace gridiron::tool
