// machines: the machine profiles, as a list, as a machine file, or as JSON. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"
#include "device/machine_keys.h"

namespace gridiron::tool {
namespace {

nlohmann::ordered_json json_of(const sim::Latency& latency) {
  if (latency.shares().size() == 1) return latency.shares().front().cycles;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const sim::LatencyShare& one : latency.shares()) list.push_back({{"cycles", one.cycles}, {"share", one.share}});
  return list;
}
template <class Number>
nlohmann::ordered_json json_of(Number number) {
  return number;
}

nlohmann::ordered_json json_of_machine(sim::MachineProfile machine) {
  nlohmann::ordered_json json = {{"name", machine.name}, {"description", machine.description}};
  for (const MachineKey& key : machine_keys(machine)) {
    std::string path = "/" + key.name;
    std::ranges::replace(path, '.', '/');
    std::visit([&](const auto* number) { json[nlohmann::ordered_json::json_pointer(path)] = json_of(*number); },
               key.number);
  }
  return json;
}

}  // namespace

void run_command(const MachinesRequest& request) {
  if (request.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    if (request.machine) {
      list.push_back(json_of_machine(*request.machine));
    } else {
      for (const sim::MachineProfile& machine : sim::machine_profiles()) list.push_back(json_of_machine(machine));
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
