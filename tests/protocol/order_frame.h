// A small frame in the memory of a simulated core, rendered by the kernel anew for each order of its transfers.
// Memory: SimMemory, std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/effects.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/sim/sim_memory.h>
#include <gridiron/store/local_store.h>

#include "protocol/order_core.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// Sizes of a store with short buffers, so that small scenes need many.
struct OrderLayout {
  using Engine = GridEngine;
  static constexpr std::uint32_t kTileWidth = 8;
  static constexpr std::uint32_t kMaxOutputDepth = 5;
};

/// With packets of eight by eight.
struct PacketOrderLayout : OrderLayout {
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 64 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 32 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 6 * 1024;
  static constexpr std::uint32_t kPacketWidth = 8;
  static constexpr std::uint32_t kTableEntries = 16;
  static constexpr std::uint32_t kMaxMacroWidth = 2;
  static constexpr std::uint32_t kMaxMacroDepth = 5;
  static constexpr std::uint32_t kMaxTriangleDepth = 5;
  static constexpr std::uint32_t kMailboxSlots = 64;
  static constexpr std::uint32_t kTrianglesPerBuffer = 2;
  static constexpr std::uint32_t kRecentTriangles = 2;
};

/// The same for all effects: no packets, lists of a few rays, leaves of two triangles, slots for two materials.
struct EffectOrderLayout : OrderLayout {
  static constexpr std::uint32_t kEffects = kAllEffects;
  static constexpr std::uint32_t kArenaBytes = 96 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 44 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 4 * 1024;
  static constexpr std::uint32_t kPacketWidth = 0;
  using RayEngine = TreeEngine;
  static constexpr std::uint32_t kBatchRays = 32;
  static constexpr std::uint32_t kSpareListWords = 0;
  static constexpr bool kHasBeams = false;
  static constexpr std::uint32_t kTreeSlots = 16;  // eight records under way
  static constexpr std::uint32_t kLeafTriangles = 2;
  static constexpr std::uint32_t kWaveRays = 32;
  static constexpr std::uint32_t kMaterialSlots = 2;
  static constexpr std::uint32_t kLightSlots = 5;
};

/// For eye rays through the tree: two tiles of eight by eight take turns, the root stays for the frame.
struct TileOrderLayout {
  using Engine = TileEngine;
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 96 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 24 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 6 * 1024;
  static constexpr std::uint32_t kTileWidth = 16;
  static constexpr std::uint32_t kPacketWidth = 0;
  static constexpr std::uint32_t kMaxOutputDepth = 5;
  static constexpr std::uint32_t kEyeTileWidth = 8;
  static constexpr std::uint32_t kEyeTurns = 2;
  static constexpr std::uint32_t kEyeSlots = 16;
  static constexpr std::uint32_t kEyeTopNodes = 1;
  static constexpr std::uint32_t kLeafTriangles = 2;
  static constexpr std::uint32_t kMostLanes = 4;
};
static_assert(kFitsArena<PacketOrderLayout> && kFitsArena<EffectOrderLayout> && kFitsArena<TileOrderLayout>);

/// What a frame is made of. With effects the second layout renders it, with EngineId::kTree the third.
struct OrderScene {
  TestMesh mesh;
  std::vector<Material> materials;
  std::vector<std::uint16_t> triangle_materials;
  std::vector<Vec3> normals;
  std::vector<UVec3> triangle_normals;
  std::vector<Light> lights;
  std::vector<Vec3> environment_face;  ///< of all faces; empty: none
  std::uint32_t recursion_depth = 1;
  std::uint32_t occlusion_samples = 0;
  float lambda = 2.0f;
  Vec3 eye{0.3f, 0.2f, 3.0f};

  [[nodiscard]] bool has_effects() const { return !materials.empty(); }
};

/// Its size and buffers.
struct OrderSettings {
  std::uint32_t width = 8, height = 8;
  std::uint32_t output_depth = 1, macro_depth = 1, triangle_depth = 1, fetch_depth = 1;
  std::uint32_t queue_depth = 16;
  EngineId engine = EngineId::kGrid;
  bool wants_ids = false;  ///< a second plane, so two puts a tile
};

/// What came of a frame in one order.
struct OrderOutcome {
  Status status = Status::kOk;
  std::string violation;           ///< the first rule broken; empty: none
  std::vector<std::byte> planes;   ///< picture, and ids where wanted
  std::vector<std::byte> store;    ///< work counters among it
  std::vector<std::uint64_t> calls;
  std::vector<LoggedTransfer> transfers;
  std::vector<LoggedWait> waits;
  std::vector<Completion> completions;
  std::uint32_t most_pending = 0;

  /// Picture, work, calls and every byte left in the store.
  [[nodiscard]] bool is_as(const OrderOutcome& other) const;
};

class OrderFrame {
 public:
  OrderFrame(const OrderScene& scene, const OrderSettings& settings);

  [[nodiscard]] OrderOutcome run(const OrderPlan& plan);

 private:
  template <class Layout>
  [[nodiscard]] OrderOutcome run_layout(LocalStore<Layout>& store, const OrderPlan& plan);

  sim::SimMemory memory_{std::uint64_t{1} << 21};
  sim::MemoryRegion planes_{}, spill_{};
  MainAddress frame_{};
  std::uint32_t tile_count_ = 0, output_depth_ = 1;
  PlatformLimits limits_;
  std::unique_ptr<LocalStore<PacketOrderLayout>> packet_store_;
  std::unique_ptr<LocalStore<EffectOrderLayout>> effect_store_;
  std::unique_ptr<LocalStore<TileOrderLayout>> tile_store_;
};

}  // namespace gridiron::test
