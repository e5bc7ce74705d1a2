// Frames of a mesh that moves (wave_mesh.h). Each frame is a list of passes that all workers share: the mesh, the
// passes that build its scene image, the picture. The master drives them and adds the image's check value. Memory:
// shared memory for MovingFrame, main memory behind the job for the rest. Threads: the master writes while the workers
// sleep. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/firmware/frame_job.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "console.h"
#include "master.h"
#include "moving_frame.h"
#include "semihost.h"
#include "wave_mesh.h"
#include "worker.h"

namespace gridiron::port {

/// Vertices or triangles of an item of the mesh pass; of their bytes a multiple of kLineBytes.
inline constexpr std::uint32_t kMeshItem = 256;
inline constexpr std::uint32_t kVertexItems = (kWaveVertexCount + kMeshItem - 1) / kMeshItem;
inline constexpr std::uint32_t kMeshItems = kVertexItems + (kWaveTriangleCount + kMeshItem - 1) / kMeshItem;
static_assert(sizeof(Vec3) == sizeof(UVec3) && kMeshItem * sizeof(Vec3) % kLineBytes == 0);

/// What a worker keeps while the mesh is made.
struct MeshStore {
  alignas(kLineBytes) std::byte elements[kMeshItem * sizeof(Vec3)];
  WorkCounters work;
};

/// Room for whatever a worker runs.
template <class Layout>
union MovingStore {
  LocalStore<Layout> picture;
  BuildStore<BuildLayout256K> build;
  MeshStore mesh;
};

/// Writes the vertices and triangles of a frame. Items: first of vertices, then of triangles.
template <Platform P>
[[nodiscard]] Status run_mesh_pass(P& port, MeshStore& store, const MovingFrame& frame) {
  BuildTransfers<P> transfers(port, store.work);
  return for_each_item(transfers, kMeshItems, [&](std::uint32_t item) -> Status {
    const bool is_vertices = item < kVertexItems;
    const std::uint32_t all = is_vertices ? kWaveVertexCount : kWaveTriangleCount;
    const std::uint32_t first = (is_vertices ? item : item - kVertexItems) * kMeshItem;
    const std::uint32_t count = all - first < kMeshItem ? all - first : kMeshItem;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (is_vertices) {
        reinterpret_cast<Vec3*>(store.elements)[i] = wave_vertex(first + i, frame.number);
      } else {
        reinterpret_cast<UVec3*>(store.elements)[i] = wave_triangle(first + i);
      }
    }
    const MainAddress array = is_vertices ? frame.plan().input.vertices : frame.plan().input.triangles;
    const auto bytes = round_up(count * static_cast<std::uint32_t>(sizeof(Vec3)), kPortableGranuleBytes);
    GRIDIRON_TRY(transfers.put(store.elements, array.offset_by(first * sizeof(Vec3)), bytes, kFirstOutputTag));
    return transfers.wait(kFirstOutputTag);
  });
}

/// Runs the core's share of a pass, as run_worker() does of a picture.
template <class L, class Layout, Platform P>
void run_moving_worker(MovingStore<Layout>& store, P& port, RunControl& control, TileResult* tiles,
                       std::uint32_t core_index, StackArea stack, const MovingFrame& frame) {
  if (frame.pass == kPicturePass) return run_worker<L>(store.picture, port, control, tiles, core_index, stack);
  CoreSlot& slot = control.cores[core_index];
  paint_stack(stack);
  set_state(slot, CoreState::kWorking);
  CountingPort<P> counting(port, slot, tiles, core_index);
  const Status status = frame.pass == kMeshPass
                            ? run_mesh_pass(counting, store.mesh, frame)
                            : run_build_pass(counting, store.build, frame.plan(), static_cast<BuildPass>(frame.pass));
  counting.finish_tile();
  slot.result.status = static_cast<std::uint32_t>(status);
  slot.result.tiles = counting.claimed();
  slot.result.transfers = counting.transfers();
  slot.result.transfer_bytes = counting.transfer_bytes();
  slot.result.stack_bytes = used_stack_bytes(stack);
  set_state(slot, CoreState::kFinished);
}

/// Says where all that a frame needs lies: from `begin`, a multiple of kLineBytes, to `end` at most.
/// @param record  gets the place of the frame's record, in `MovingFrame::plan()` the others.
/// Errors: kMemoryTooSmall.
[[nodiscard]] inline Status place_moving_frame(std::uint64_t begin, std::uint64_t end, std::uint32_t leaf_triangles,
                                               std::uint64_t& record, MovingFrame& frame) {
  std::uint64_t free = begin;
  const auto place = [&free](std::uint64_t bytes) {
    const MainAddress address{free};
    free += round_up(bytes, std::uint64_t{kLineBytes});
    return address;
  };
  BuildInput input;
  record = place(sizeof(FrameRecord)).value;
  input.vertices = place(kVertexItems * kMeshItem * sizeof(Vec3));
  input.triangles = place((kMeshItems - kVertexItems) * kMeshItem * sizeof(UVec3));
  input.vertex_count = kWaveVertexCount;
  input.triangle_count = input.record_room = kWaveTriangleCount;
  input.leaf_triangles = leaf_triangles;
  input.order = TreeOrder::kByNumber;
  input.is_tree_image = true;
  input.node_room = static_cast<std::uint32_t>(most_tree_nodes(kWaveTriangleCount, leaf_triangles));
  input.image_room = kTreeImageHeadBytes +
                     round_up<std::uint64_t>(kWaveTriangleCount * sizeof(VertexTriangle), kLineBytes) +
                     input.node_room * sizeof(TreeNode);
  free = round_up(free, std::uint64_t{4096});  // as in a job: how leaves lie in lines decides the number of transfers
  input.image = place(input.image_room);
  input.result = place(sizeof(BuildResult));
  input.scratch = MainAddress{free};
  GRIDIRON_TRY(plan_build<BuildLayout256K>(input, frame.plan()));
  return frame.plan().end <= end ? Status::kOk : Status::kMemoryTooSmall;
}

/// Renders frames one after another with the settings of a job: command line words first=, the number of the first, and
/// frames=, how many. Each result is a file of its own, result_0.bin and so on.
///
/// @param frame       that the workers read.
/// @param begin, end  main memory that the frames may take, outside of the job's.
template <MasterBoard B>
[[nodiscard]] RunExit render_moving(B& board, Master<B>& master, const FirmwareFacts& facts, const FrameJob& job,
                                    MovingFrame& frame, std::uint64_t begin, std::uint64_t end) {
  print(facts.name, ": ", facts.core_count, " cores\n");
  if (!check_job(job, facts)) return RunExit::kJobRefused;
  const auto& settings = *reinterpret_cast<const FrameRecord*>(static_cast<std::uintptr_t>(job.frame_address));
  const auto& tree = *reinterpret_cast<const TreeRecord*>(static_cast<std::uintptr_t>(settings.tree_address));
  std::uint64_t record_address = 0;
  if (tree.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kVertices)) {
    print("job refused: the cores build trees of vertices only\n");
    return RunExit::kJobRefused;
  }
  if (place_moving_frame(begin, end, tree.leaf_triangles, record_address, frame) != Status::kOk) {
    print("job refused: no tree of such leaves fits the memory of frames\n");
    return RunExit::kJobRefused;
  }
  const BuildInput& input = frame.plan().input;
  auto& record = *reinterpret_cast<FrameRecord*>(static_cast<std::uintptr_t>(record_address));
  auto& image = *reinterpret_cast<TreeImageHead*>(static_cast<std::uintptr_t>(input.image.value));
  const std::span checks(
      reinterpret_cast<const PieceCheck*>(static_cast<std::uintptr_t>(frame.plan().piece_checks.value)),
      frame.plan().item_counts[static_cast<std::uint32_t>(BuildPass::kCheck)]);
  std::memcpy(&record, &settings, sizeof record);
  record.image_address = input.image.value;
  record.tree_address = input.image.value + offsetof(TreeImageHead, tree);
  const auto first = static_cast<std::uint32_t>(number_option("first=", 0));
  const auto count = static_cast<std::uint32_t>(number_option("frames=", 1));
  if (count > 10) {
    print("job refused: more than 10 frames\n");
    return RunExit::kJobRefused;
  }
  char name[] = "result_0.bin";
  for (std::uint32_t i = 0; i < count; ++i, ++name[sizeof "result_" - 1]) {
    frame.number = first + i;
    const std::uint64_t start = board.milliseconds();
    std::uint32_t stack_bytes = 0;
    const auto run_pass = [&](std::uint32_t pass, std::uint32_t items) {
      frame.pass = pass;
      return items == 0 ? RunExit::kDone : master.run_pass(pass, items, stack_bytes);
    };
    if (const RunExit ran = run_pass(kMeshPass, kMeshItems); ran != RunExit::kDone) return ran;
    for (std::uint32_t pass = 0; pass < kBuildPassCount; ++pass) {
      if (const RunExit ran = run_pass(pass, frame.plan().item_counts[pass]); ran != RunExit::kDone) return ran;
    }
    const Status finished = finish_built_image(checks, image.header);
    print("frame ", frame.number, ": image of ", image.header.image_bytes, " bytes, status ",
          StatusNumber{static_cast<std::uint32_t>(finished)}, ", check value ", Hex{image.header.check_value}, ", ",
          board.milliseconds() - start, " ms, stack ", stack_bytes, "\n");
    if (finished != Status::kOk) return RunExit::kFrameFailed;
    frame.pass = kPicturePass;
    if (const RunExit ran = master.render(name, record_address); ran != RunExit::kDone) return ran;
  }
  return RunExit::kDone;
}

}  // namespace gridiron::port
