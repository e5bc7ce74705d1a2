// Unseen scene: whether a frame shows nothing of its scene, and why.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/sim_chip.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "frame_memory.h"
#include "gridiron/scene/framing.h"

namespace gridiron::tool {

/// The known planes of a frame.
struct SeenPlanes {
  std::span<const std::byte> color, depth, ids;  ///< output planes; depth, ids: may be empty
  bool has_environment = false;                  ///< pixels that hit nothing differ from one another
  std::optional<bool> has_hits{};                ///< where the work of the frame was counted
  std::uint32_t ground_begin = kNoTriangle;      ///< triangles from here on are a look's ground, not the scene's own
};

/// @returns the note that no pixel of a frame shows the scene, with a reason if one applies to all of its points;
/// nothing if a pixel shows it, or may. A look's ground is not the scene: where nothing but hits of both is known, all
/// points have to lie outside of the picture.
/// @param points  of the scene without that ground; used only if no pixel seems to show it.
[[nodiscard]] std::optional<std::string> unseen_note(const FrameRecord& frame, const SeenPlanes& planes,
                                                     const PointSource& points);

/// The same for a whole frame of the simulated chip.
[[nodiscard]] std::optional<std::string> unseen_note(FrameMemory& frame, const sim::ChipResult& result, sim::Mode mode);

/// Prints a note, if there is one, on standard error: `FILE: note: text`.
void tell_note(const std::filesystem::path& file, const std::optional<std::string>& note);

}  // namespace gridiron::tool
