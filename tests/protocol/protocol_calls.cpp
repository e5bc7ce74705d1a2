// Prints what the kernel asks of a simulated core as the model's trace.h: one byte a call, tag + 32 * (0 wait, 1 get,
// 2 put). TILE: a frame of packets; EYES: of tiles through the tree; LISTS, GATHER, SPILL: the part of a frame with
// effects that is theirs.
//   protocol_calls LEVEL DEPTH QUEUE_DEPTH [forgets]      forgets: without a wait in the middle that ended something
// SPDX-License-Identifier: Apache-2.0
#include "protocol/order_frame.h"
#include "protocol/order_scenes.h"

namespace gridiron::test {
namespace {

static_assert(EffectOrderLayout::kTreeSlots == 16 && TileOrderLayout::kEyeSlots == 16,
              "check_protocol has the model follow the tree with so many slots");

int print_calls(const std::string& level, std::uint32_t depth, std::uint32_t queue_depth, bool forgets) {
  const std::map<std::string, const char*> scenes = {
      {"TILE", "tiles"}, {"EYES", "tiles_of_tree"}, {"LISTS", "nodes"}, {"GATHER", "surfaces"}, {"SPILL", "spilling"}};
  OrderCase one = order_case(scenes.at(level));
  one.settings.queue_depth = queue_depth;
  one.settings.fetch_depth = depth;
  if (level == "EYES") one.settings.output_depth = depth;
  if (level == "TILE") one.settings.output_depth = one.settings.macro_depth = one.settings.triangle_depth = depth;
  const OrderOutcome outcome = OrderFrame(one.scene, one.settings).run({});
  const auto is_wanted = [&](Stage stage, bool is_spill) {
    if (level == "LISTS") return stage == Stage::kShadow;
    if (level == "GATHER") return stage == Stage::kSurface;
    return level == "TILE" || level == "EYES" || is_spill;
  };
  std::map<std::uint32_t, std::uint32_t> calls, spill_waits, ends;
  for (const LoggedTransfer& transfer : outcome.transfers) {
    const bool is_spill = transfer.purpose == Purpose::kSpill;
    if (is_spill) spill_waits[transfer.wait_call] = 1;
    if (!is_wanted(transfer.stage, is_spill)) continue;
    calls[transfer.start_call] = transfer.tag + (transfer.is_put ? 64u : 32u);
    if (transfer.purpose != Purpose::kSetup && transfer.purpose != Purpose::kTile) ends[transfer.wait_call] = 1;
  }
  for (const LoggedWait& wait : outcome.waits) {
    if (!is_wanted(wait.stage, spill_waits.contains(wait.call))) continue;
    for (std::uint32_t tag = 0; tag < 32; ++tag) {
      if (wait.tags == 1u << tag) calls[wait.call] = tag;
    }
  }
  if (forgets) calls.erase(std::next(ends.begin(), static_cast<std::ptrdiff_t>((ends.size() - 1) / 2))->first);
  std::printf("static const unsigned char kTrace[] = {");
  for (const auto& [call, code] : calls) std::printf("%u,", code);
  std::printf("};\nstatic const short kTraceCount = %zu;\n", calls.size());
  return outcome.status == Status::kOk && outcome.violation.empty() && !calls.empty() ? 0 : 1;
}

}  // namespace
}  // namespace gridiron::test

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) return 2;
  return gridiron::test::print_calls(argv[1], static_cast<std::uint32_t>(std::atoi(argv[2])),
                                     static_cast<std::uint32_t>(std::atoi(argv[3])), argc == 5);
}
