// Info plan: the request for `info`, and the local store, format and picture that it describes.
// Memory: owns paths; shares the machine. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/numbers.h"
#include "gridiron/device/layout_choice.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/scene/scene_request.h"

namespace gridiron::tool {

/// The request for `info`, as given. resolve() completes it.
struct InfoRequest {
  SceneRequest scene;
  LayoutRequest layout;                         ///< store and packets
  std::optional<TriangleFormat> format;         ///< of a mesh or a text scene
  std::optional<Accuracy> accuracy;             ///< of the bounds; nothing: the one for the image's format
  bool has_depth = false;                       ///< distances are wanted too
  std::optional<std::filesystem::path> camera;  ///< of a view whose tiles are bounded
  Shading shading = Shading::kSimple;           ///< of these, kNone or kSimple
  std::optional<CountPair> size;                ///< of the picture whose memory is counted
  bool json = false;
};

/// The completed request.
struct InfoPlan {
  SceneRequest scene;          ///< with a configuration
  sim::StoreSize store{};      ///< the requested one, or the machine's largest one with such packets
  sim::LayoutChoice layout{};  ///< with effects that the store cannot have, that of 256 KB
  StoreFacts local_store{};    ///< the layout's
  BufferDepths depths{};       ///< the configuration's, where the store has no fewer
  std::uint32_t most_macro_width = kMaxMacroWidth;
  TriangleFormat format = TriangleFormat::kVertices;
  std::optional<Accuracy> accuracy;
  bool has_depth = false;
  Shading shading = Shading::kSimple;
  CountPair size = kUsualPictureSize;
  bool json = false;
};

/// Completes a request; opens no file and prints nothing. Precondition: the scene's kind is known.
/// Errors: Failure (kUsage) if accuracy and format do not match, no kernel is built for the layout, or it lacks
/// requested distances.
[[nodiscard]] InfoPlan resolve(const InfoRequest& request, const KnownScene& scene);

}  // namespace gridiron::tool
