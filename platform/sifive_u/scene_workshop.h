// Memory in which worker 0 of the dynamic image builds a frame's scene: the one extra region that its PMP opens.
// Memory: GRIDIRON_WORKSHOP. Threads: worker 0 writes, then the master reads. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>

#include "memory_map.h"
#include "wave_mesh.h"

namespace gridiron::port {

struct SceneWorkshop {
  static constexpr std::uint64_t kImageRoomBytes = 16u << 20, kScratchRoomBytes = 16u << 20;

  alignas(128) FrameRecord frame;  ///< the job's, of the scene that was built
  Vec3 vertices[kWaveVertexCount];
  UVec3 triangles[kWaveTriangleCount];
  alignas(4096) std::byte image[kImageRoomBytes];
  alignas(4096) std::byte scratch[kScratchRoomBytes];
};
static_assert(sizeof(SceneWorkshop) <= std::uint64_t{GRIDIRON_WORKSHOP_BYTES});  // NOLINT(bugprone-sizeof-expression)

inline SceneWorkshop& scene_workshop() {
  return *reinterpret_cast<SceneWorkshop*>(std::uintptr_t{GRIDIRON_WORKSHOP});
}

}  // namespace gridiron::port
