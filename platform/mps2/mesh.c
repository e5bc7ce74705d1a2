// A scene that the firmware makes by itself. tools/boards/check_mps2 renders the same mesh on the simulated chip.
// Memory: caller's. Threads: the master. SPDX-License-Identifier: Apache-2.0
#include "mesh.h"

#include <stddef.h>

enum { kWidth = 64, kHeight = 48, kSquares = 8, kEdge = kSquares + 1 };  // of the picture; of the mesh, along an edge

// The next bytes of main memory, in lines; NULL where there are too few.
typedef struct Room {
  unsigned char* memory;
  uint32_t bytes, used_bytes;
} Room;
static void* take(Room* room, uint64_t bytes) {
  if (bytes > room->bytes - room->used_bytes) return NULL;
  unsigned char* const begin = room->memory + room->used_bytes;
  const uint32_t lines = ((uint32_t)bytes + kGridironLineBytes - 1) / kGridironLineBytes;
  const uint32_t after = room->used_bytes + lines * kGridironLineBytes;
  room->used_bytes = after < room->bytes ? after : room->bytes;
  return begin;
}

static void make_hills(float* vertices, uint32_t* indices) {
  for (uint32_t i = 0; i < kEdge * kEdge; ++i) {
    const uint32_t x = i % kEdge, z = i / kEdge;
    *vertices++ = (float)x * 0.25f - 1.0f;
    *vertices++ = (float)((x * x * 5 + z * z * 3 + x * z) % 17) * 0.03125f;
    *vertices++ = (float)z * 0.25f - 1.0f;
  }
  for (uint32_t i = 0; i < kSquares * kSquares; ++i) {
    const uint32_t corner = i / kSquares * kEdge + i % kSquares, below = corner + kEdge;
    *indices++ = corner;
    *indices++ = below;
    *indices++ = corner + 1;
    *indices++ = corner + 1;
    *indices++ = below;
    *indices++ = below + 1;
  }
}

GridironStatus mesh_prepare(void* memory, uint32_t bytes, MeshFrame* frame, GridironFault* fault) {
  *fault = (GridironFault){0, ""};
  Room room = {memory, bytes, 0};
  float* const vertices = take(&room, sizeof(float[kEdge * kEdge][3]));
  uint32_t* const indices = take(&room, sizeof(uint32_t[kSquares * kSquares][6]));
  if (vertices == NULL || indices == NULL) return kGridironMemoryTooSmall;
  make_hills(vertices, indices);

  const GridironMesh mesh = {vertices, indices, kEdge * kEdge, 2 * kSquares * kSquares};
  const GridironBuild build = gridiron_usual_build();
  GridironNeed need;
  GridironStatus status = gridiron_count_image(&mesh, &build, &need);
  if (status != kGridironOk) return status;
  void* const image_bytes = take(&room, need.image_bytes);
  void* const scratch = take(&room, need.scratch_bytes);
  void* const record = take(&room, gridiron_sizes().frame_record_bytes);
  const uint32_t plane_bytes = (uint32_t)gridiron_plane_bytes(kWidth, kHeight);
  uint32_t* const color = take(&room, plane_bytes);
  if (image_bytes == NULL || scratch == NULL || record == NULL || color == NULL) return kGridironMemoryTooSmall;
  status = gridiron_build_image(&mesh, &build, &need, image_bytes, (size_t)need.image_bytes, scratch,
                                (size_t)need.scratch_bytes);
  if (status != kGridironOk) return status;

  GridironImage image;
  status = gridiron_open_image(image_bytes, (size_t)need.image_bytes, &image, fault);
  if (status != kGridironOk) return status;
  GridironFrame wanted = gridiron_usual_frame();
  wanted.eye[0] = 0.5f;
  wanted.eye[1] = 1.5f;
  wanted.eye[2] = 2.25f;
  wanted.width = kWidth;
  wanted.height = kHeight;
  wanted.color_address = (uintptr_t)color;
  status = gridiron_make_frame(&wanted, &image, (uintptr_t)image_bytes, record, fault);
  if (status != kGridironOk) return status;
  frame->color = color;
  frame->record_address = (uint32_t)(uintptr_t)record;
  frame->tile_count = gridiron_tile_count(kWidth, kHeight);
  frame->image_bytes = (uint32_t)image.image_bytes;
  frame->used_bytes = room.used_bytes;
  return kGridironOk;
}

uint64_t mesh_hash(const MeshFrame* frame) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const uint32_t word = frame->color[gridiron_plane_index(kWidth, pixel % kWidth, pixel / kWidth)];
    for (uint32_t shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 0xFFu)) * 0x100000001b3u;
  }
  return hash;
}
