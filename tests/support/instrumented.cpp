// Frames of tests by the instrumented kernel: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/instrumented.h"

#include <atomic>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

std::atomic<std::uint64_t> frame_count{0};

// Whether there is an instrumented kernel for the frame.
bool can_render(sim::SimMemory& memory, MainAddress address, const sim::ChipOptions& options) {
  const std::span<std::byte> bytes = memory.bytes_at(address, sizeof(FrameRecord));
  if (bytes.empty() || options.progress || options.abort != nullptr) return false;
  FrameRecord frame;
  std::memcpy(&frame, bytes.data(), sizeof frame);
  const bool has_effects = frame.shading == static_cast<std::uint32_t>(Shading::kScene);
  const sim::LayoutChoice layout{options.store, frame.tile_width, options.packet_width, has_effects};
  return options.lanes <= sim::widest_lanes() && sim::is_built(layout, sim::Mode::kInstrumented, 4) &&
         sim::is_built(layout, options.mode, options.lanes);
}

}  // namespace

bool is_instrumented() {
  const char* const value = std::getenv("GRIDIRON_TEST_INSTRUMENTED");
  return value != nullptr && *value != '\0';
}

std::uint64_t instrumented_frames() {
  return frame_count;
}

void note_instrumented_frame() {
  ++frame_count;
}

sim::ChipResult render_in_test(sim::SimMemory& memory, MainAddress frame, const sim::ChipOptions& options) {
  if (!is_instrumented() || options.mode == sim::Mode::kInstrumented) {
    return sim::render_frame(memory, frame, options);
  }
  EXPECT_TRUE(sim::has_instrumented_mode()) << "GRIDIRON_TEST_INSTRUMENTED: this build has no instrumented kernel";
  if (!can_render(memory, frame, options)) return sim::render_frame(memory, frame, options);
  sim::ChipOptions instrumented_options = options;
  instrumented_options.mode = sim::Mode::kInstrumented;
  instrumented_options.lanes = 4;
  const sim::ChipResult instrumented = sim::render_frame(memory, frame, instrumented_options);
  const sim::ChipResult usual = sim::render_frame(memory, frame, options);
  note_instrumented_frame();
  const char* const detail = instrumented.violations.empty() ? "" : instrumented.violations.front().detail.c_str();
  if (usual.status == Status::kOk || options.mode == sim::Mode::kChecked) {
    EXPECT_EQ(instrumented.status, usual.status) << "instrumented: " << detail;
    EXPECT_EQ(instrumented.violations.size(), usual.violations.size()) << "instrumented: " << detail;
  }
  if (usual.status == Status::kOk && options.mode == sim::Mode::kChecked && options.lanes == 4) {
    EXPECT_EQ(instrumented.work, usual.work) << "the instrumented kernel does other work";
  }
  return usual;
}

}  // namespace gridiron::test
