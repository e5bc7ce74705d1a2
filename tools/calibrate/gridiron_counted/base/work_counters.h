// Counted work: core's kinds, told to the pipe model. Memory: none. Threads: the model's.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron_counted/base/counted.h>

#include <cstdint>

namespace gridiron_counted {

using gridiron::kWorkKindCount;
using gridiron::Work;
using gridiron::WorkId;

/// Keeps nothing itself; as large as core's, so that the local store has the same map.
struct WorkCounters {
  std::uint32_t counts[kWorkKindCount];
  void add(WorkId kind, std::uint32_t amount = 1) { PipeModel::current().add_units(kind, amount); }
  void add(WorkId kind, const Counted<std::uint32_t>& amount) { add(kind, amount.value); }
  void charge_to(WorkId kind) const { PipeModel::current().charge_to(kind); }
};

}  // namespace gridiron_counted
