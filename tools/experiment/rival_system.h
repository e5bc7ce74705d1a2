// Rival system: the hierarchy with software caches, as the experiment compares it with the grid.
// Memory: a recording owns its hierarchy. Threads: any; record() and time() share nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "experiment/systems.h"

namespace gridiron::experiment {

/// Packets through a hierarchy of boxes, software caches for nodes and triangles (sim_platform/gridiron/rival). What a
/// tile costs there depends on which core renders it, so each machine and core count is rendered anew, not replayed.
class RivalSystem : public System {
 public:
  /// @param hyper_threading  packets that miss make way for the next of a ring; else a core waits for every miss.
  explicit RivalSystem(bool hyper_threading) : hyper_threading_(hyper_threading) {}
  [[nodiscard]] std::string key() const override { return hyper_threading_ ? "bvh" : "bvh_single"; }
  [[nodiscard]] std::unique_ptr<Recording> record(const View& view, const FrameRequest& request) const override;

 private:
  bool hyper_threading_;
};

}  // namespace gridiron::experiment
