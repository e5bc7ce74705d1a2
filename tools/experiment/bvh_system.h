// BVH system: the hierarchy with software caches, as the experiment compares it with the grid.
// Memory: a recording owns its hierarchy. Threads: any; record() and time() share nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/bvh.h>
#include <gridiron/bvh/bvh_renderer.h>

#include <memory>
#include <string>
#include <utility>

#include "experiment/systems.h"

namespace gridiron::experiment {

/// Settings of the hierarchy's build and traversal; tuned by default.
struct BvhVariant {
  std::string key;
  bvh::BvhParameters build;
  bvh::RenderOptions options;  ///< core_count is not looked at
};

/// Packets through a hierarchy of boxes, software caches for nodes and triangles (sim_platform/gridiron/bvh). The cost
/// of a tile depends on the core that renders it, so each machine and core count is rendered anew, not replayed.
class BvhSystem : public System {
 public:
  explicit BvhSystem(BvhVariant variant) : variant_(std::move(variant)) {}
  /// @param hyper_threading  packets that miss are suspended for the next of a ring; else a core waits for every miss.
  explicit BvhSystem(bool hyper_threading) : variant_{hyper_threading ? "bvh" : "bvh_single", {}, {}} {
    variant_.options.hyper_threading = hyper_threading;
  }
  [[nodiscard]] std::string key() const override { return variant_.key; }
  [[nodiscard]] std::unique_ptr<Recording> record(const View& view, const FrameRequest& request) const override;

 private:
  BvhVariant variant_;
};

}  // namespace gridiron::experiment
