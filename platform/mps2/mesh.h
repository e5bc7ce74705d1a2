// A scene that the firmware makes by itself, from vertices to a frame record, in 64 KB of main memory: mesh.c.
// Memory: main memory that the caller gives. Threads: the master. SPDX-License-Identifier: Apache-2.0
#pragma once

// NOLINTBEGIN(modernize-deprecated-headers): the header is C
#include <gridiron/c/gridiron.h>
#include <stdint.h>
// NOLINTEND(modernize-deprecated-headers)

#ifdef __cplusplus
extern "C" {
#endif

/// A frame that is ready to be rendered.
typedef struct MeshFrame {
  const uint32_t* color;   ///< plane of colours
  uint32_t record_address; ///< of the frame's record
  uint32_t tile_count;     ///< of the picture
  uint32_t image_bytes;    ///< of the scene image
  uint32_t used_bytes;     ///< of main memory: mesh, image, scratch, record and plane
} MeshFrame;

/// Makes mesh, image and frame record.
///
/// @param memory  main memory of `bytes`, kGridironLineBytes-aligned; the frame lies in it.
/// @param frame   written on success.
/// @param fault   written: what is wrong with image or frame record.
/// Errors: kGridironMemoryTooSmall; those of the calls of gridiron.h.
GridironStatus mesh_prepare(void* memory, uint32_t bytes, MeshFrame* frame, GridironFault* fault);

/// @returns FNV-1a, 64 bits, of the picture's bytes in rows: the hash that `gridiron render` prints.
uint64_t mesh_hash(const MeshFrame* frame);

#ifdef __cplusplus
}
#endif
