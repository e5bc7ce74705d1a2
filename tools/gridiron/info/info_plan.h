// Info plan: what was asked of `info`, and which local store, format and picture it tells of.
// Memory: owns paths; shares the machine. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <optional>

#include "base/numbers.h"
#include "gridiron/device/layout_choice.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/scene/scene_request.h"

namespace gridiron::tool {

/// What is asked of `info`, as given. What is not given resolve() settles.
struct InfoRequest {
  SceneRequest scene;
  LayoutRequest layout;                  ///< store and packets
  std::optional<TriangleFormat> format;  ///< of a mesh or a text scene
  std::optional<Accuracy> accuracy;      ///< whose bounds are told; nothing: the one that the image's format is for
  bool has_depth = false;                ///< distances are wanted too
  std::optional<CountPair> size;         ///< of the picture whose memory is counted
  bool json = false;
};

/// The same, settled.
struct InfoPlan {
  SceneRequest scene;
  sim::StoreSize store{};      ///< asked for, or the largest one of the machine that is built for the packets asked for
  sim::LayoutChoice layout{};  ///< with effects, where the store has none for these, that of 256 KB
  StoreFacts local_store{};    ///< the layout's
  BufferDepths depths{};       ///< the configuration's, where the store has no fewer
  std::uint32_t most_macro_width = kMaxMacroWidth;
  TriangleFormat format = TriangleFormat::kVertices;
  std::optional<Accuracy> accuracy;
  bool has_depth = false;
  CountPair size = kUsualPictureSize;
  bool json = false;
};

/// Settles what `info` tells of; opens no file and prints nothing. Precondition: the scene's kind is known.
/// Errors: Failure (kUsage) where accuracy and format are of different triangles, no kernel is built for the layout, or
/// it has no distances and these are wanted.
[[nodiscard]] InfoPlan resolve(const InfoRequest& request, const KnownScene& scene);

}  // namespace gridiron::tool
