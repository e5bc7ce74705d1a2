// Frame sharing: the frames of an animation divided among ranks. Each renders its own; rank 0 receives those of others.
// Memory: a frame's message at a time. Threads: calls are serialised. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "frame_maker.h"

namespace gridiron::tool {

/// Gives all ranks the numbers of the frames to render, which rank 0 knows. All ranks call it. Rank r of N renders
/// those at the places r, r + N, r + 2 N and so on. Errors: those of Ranks.
[[nodiscard]] std::vector<std::size_t> share_frame_numbers(std::vector<std::size_t> numbers);

/// The part of another rank than 0 in an animation. Errors: those of FrameMaker and of Ranks.
void render_frames_for_first(const AnimateRequest& request);

/// Errors: Failure (kUsage) if ranks other than 0 cannot read an input.
void require_shared_inputs(const AnimateRequest& request);

/// Of rank 0: the frames that other ranks have rendered.
class FrameArrivals {
 public:
  using Take = std::function<void(std::size_t i, const MadeFrame& made)>;

  /// @param take  called for each frame, whatever the order.
  explicit FrameArrivals(Take take);

  /// Takes what has arrived. Errors: those of Ranks and of `take`.
  void take_arrived();
  /// Waits for a message and takes it.
  void take_next();
  /// Parts of frames that other ranks have under way, in frames.
  [[nodiscard]] double parts() const;

 private:
  void take_message(std::size_t rank, const std::vector<std::byte>& bytes);

  Take take_;
  std::vector<double> parts_;  // by rank
};

}  // namespace gridiron::tool
