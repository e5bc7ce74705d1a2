// machines: the machine profiles, as a list, as a machine file, or as JSON. SPDX-License-Identifier: Apache-2.0
#include <report/report.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"

namespace gridiron::tool {
namespace {

nlohmann::ordered_json json_of(const sim::MachineProfile& machine) {
  nlohmann::ordered_json work = nlohmann::ordered_json::object();
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    work[std::string(work_name(static_cast<Work>(kind)))] = machine.work_cycles[kind];
  }
  nlohmann::ordered_json steps = nlohmann::ordered_json::object();
  for (std::size_t step = 0; step < sim::kBuildStepCount; ++step) {
    steps[std::string(build_step_name(static_cast<sim::BuildStep>(step)))] = machine.master.step_cycles[step];
  }
  return {{"name", machine.name},
          {"description", machine.description},
          {"core_count", machine.core_count},
          {"clock_hz", machine.clock_hz},
          {"main_memory_bytes", machine.main_memory_bytes},
          {"local_store_bytes", machine.local_store_bytes},
          {"line_bytes", machine.line_bytes},
          {"queue_depth", machine.queue_depth},
          {"lines_in_flight", machine.lines_in_flight},
          {"issue_cycles", machine.issue_cycles},
          {"wait_cycles", machine.wait_cycles},
          {"latency_cycles", machine.latency_cycles},
          {"channel_bytes_per_cycle", machine.channel_bytes_per_cycle},
          {"core_line_interval_cycles", machine.core_line_interval_cycles},
          {"claim_cycles", machine.claim_cycles},
          {"work_cycles", work},
          {"master", {{"clock_hz", machine.master.clock_hz}, {"step_cycles", steps}}}};
}

}  // namespace

void run_command(const MachinesRequest& request) {
  if (request.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    if (request.machine) {
      list.push_back(json_of(*request.machine));
    } else {
      for (const sim::MachineProfile& machine : sim::machine_profiles()) list.push_back(json_of(machine));
    }
    const nlohmann::ordered_json document = {{"version", 2}, {"machines", list}};
    std::printf("%s\n", document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
    return;
  }
  if (request.machine) {
    std::printf("%s", machine_text(*request.machine).c_str());
    return;
  }
  for (const sim::MachineProfile& machine : sim::machine_profiles()) {
    std::printf("%-14s %s\n", std::string(machine.name).c_str(), std::string(machine.description).c_str());
  }
}

}  // namespace gridiron::tool
