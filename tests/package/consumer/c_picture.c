// What port_picture.cpp does, in C: a port that copies, a mesh, a picture. Every call but printf is Gridiron's or the
// port's own.
// Memory: static, for no chip has a heap. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/c/gridiron.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { kWidth = 160, kHeight = 128, kSquares = 32 };  // of the picture, and along an edge of the mesh

// [port]
// A main address is the host's, and a copy has ended when the call returns.
GridironStatus gridiron_dma_get(uint32_t core, void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  (void)core;
  const GridironStatus status = gridiron_check_transfer(local, main_address, bytes, tag);
  if (status == kGridironOk) memcpy(local, (const void*)(uintptr_t)main_address, bytes);
  return status;
}

GridironStatus gridiron_dma_put(uint32_t core, const void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  (void)core;
  const GridironStatus status = gridiron_check_transfer(local, main_address, bytes, tag);
  if (status == kGridironOk) memcpy((void*)(uintptr_t)main_address, local, bytes);
  return status;
}

GridironStatus gridiron_dma_wait(uint32_t core, uint32_t tags) {
  (void)core;
  (void)tags;
  return kGridironOk;
}

static uint32_t next_tile, tile_count;

GridironClaim gridiron_claim_item(uint32_t core, uint32_t* item) {
  (void)core;
  if (next_tile == tile_count) return kGridironClaimNone;
  *item = next_tile++;
  return kGridironClaimItem;
}
// [port]

// Main memory, handed out in lines, and the core's local store.
static _Alignas(4096) unsigned char main_memory[8 << 20];
static size_t used_bytes;
static _Alignas(kGridironLineBytes) unsigned char store[256 << 10];

static void* allocate(uint64_t bytes) {
  const size_t begin = used_bytes;
  if (bytes > sizeof main_memory - begin) return NULL;
  used_bytes += ((size_t)bytes + kGridironLineBytes - 1) / kGridironLineBytes * kGridironLineBytes;
  return main_memory + begin;
}
static uint64_t address_of(const void* place) { return (uintptr_t)place; }

// The hills of hills.h.
static float vertices[(kSquares + 1) * (kSquares + 1)][3];
static uint32_t indices[2 * kSquares * kSquares][3];

static void make_hills(void) {
  for (uint32_t i = 0; i < (kSquares + 1) * (kSquares + 1); ++i) {
    const uint32_t x = i % (kSquares + 1), z = i / (kSquares + 1);
    vertices[i][0] = (float)x * 0.25f - 4.0f;
    vertices[i][1] = (float)((x * x * 5 + z * z * 3 + x * z) % 17) * 0.0625f;
    vertices[i][2] = (float)z * 0.25f - 4.0f;
  }
  for (uint32_t i = 0; i < kSquares * kSquares; ++i) {
    const uint32_t corner = i / kSquares * (kSquares + 1) + i % kSquares, below = corner + kSquares + 1;
    const uint32_t both[2][3] = {{corner, below, corner + 1}, {corner + 1, below, below + 1}};
    memcpy(indices[2 * i], both, sizeof both);
  }
}

// FNV-1a of the pixels' bytes in rows, as picture.h has it.
static uint64_t plane_hash(const uint32_t* plane) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const uint32_t word = plane[gridiron_plane_index(kWidth, pixel % kWidth, pixel / kWidth)];
    for (uint32_t shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 0xFFu)) * 0x100000001b3u;
  }
  return hash;
}

// @param what  the step, or the field that is at fault.
static int fail(const char* what, GridironStatus status) {
  fprintf(stderr, "c_picture: %s: %s\n", what, gridiron_status_text(status));
  return 1;
}

int main(void) {
  make_hills();
  const GridironSizes sizes = gridiron_sizes();
  if (sizes.store_bytes > sizeof store) return fail("store", kGridironMemoryTooSmall);

  // 1. The scene image.
  const GridironMesh mesh = {vertices[0], indices[0], (kSquares + 1) * (kSquares + 1), 2 * kSquares * kSquares};
  const GridironBuild build = gridiron_usual_build();
  GridironNeed need;
  GridironStatus status = gridiron_count_image(&mesh, &build, &need);
  if (status != kGridironOk) return fail("mesh", status);
  const uint64_t plane_bytes = gridiron_plane_bytes(kWidth, kHeight);
  void *image_bytes = allocate(need.image_bytes), *scratch = allocate(need.scratch_bytes);
  void *color = allocate(plane_bytes), *depth = allocate(plane_bytes), *record = allocate(sizes.frame_record_bytes);
  if (image_bytes == NULL || scratch == NULL || color == NULL || depth == NULL || record == NULL) {
    return fail("main memory", kGridironMemoryTooSmall);
  }
  status = gridiron_build_image(&mesh, &build, &need, image_bytes, (size_t)need.image_bytes, scratch,
                                (size_t)need.scratch_bytes);
  if (status != kGridironOk) return fail("image", status);
  GridironImage image;
  GridironFault fault;
  status = gridiron_open_image(image_bytes, (size_t)need.image_bytes, &image, &fault);
  if (status != kGridironOk) return fail(fault.field, status);

  // 2. The frame.
  GridironFrame frame = gridiron_usual_frame();
  const float eye[3] = {1.3f, 4.7f, 6.1f}, at[3] = {0.1f, 0.2f, 0.3f};
  memcpy(frame.eye, eye, sizeof eye);
  memcpy(frame.at, at, sizeof at);
  frame.width = kWidth;
  frame.height = kHeight;
  frame.color_address = address_of(color);
  frame.depth_address = address_of(depth);
  status = gridiron_make_frame(&frame, &image, address_of(image_bytes), record, &fault);
  if (status != kGridironOk) return fail(fault.field, status);

  // 3. The picture, by core 0.
  tile_count = gridiron_tile_count(kWidth, kHeight);
  status = gridiron_render(0, store, address_of(record), 0, 0);
  if (status != kGridironOk) return fail("render", status);
  printf("hash %016" PRIx64 " depth %016" PRIx64 "\n", plane_hash(color), plane_hash(depth));
  return 0;
}
