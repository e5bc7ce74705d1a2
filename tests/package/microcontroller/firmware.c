// A firmware of one core that renders the frame whose record lies at the start of main memory. Its copies are made when
// they are waited for.
// Memory: static, in the chip's data memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/c/gridiron.h>
#include <stdint.h>

enum { kFrameRecord = 0x60000000, kTileCount = 0x60000800, kQueueDepth = 4 };

typedef struct Command {
  void* to;
  const void* from;
  uint32_t bytes, tag;
} Command;

static Command queue[kQueueDepth];
static uint32_t command_count, next_tile;
static _Alignas(kGridironLineBytes) unsigned char store[GRIDIRON_STORE_BYTES];
static volatile unsigned char own_variables[FIRMWARE_OWN_BYTES];

static GridironStatus start(void* to, const void* from, uint32_t bytes, uint32_t tag) {
  if (command_count == kQueueDepth) return kGridironTransferQueueFull;
  queue[command_count++] = (Command){to, from, bytes, tag};
  return kGridironOk;
}

GridironStatus gridiron_dma_get(uint32_t core, void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  (void)core;
  return start(local, (const void*)(uintptr_t)main_address, bytes, tag);
}

GridironStatus gridiron_dma_put(uint32_t core, const void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  (void)core;
  return start((void*)(uintptr_t)main_address, local, bytes, tag);
}

GridironStatus gridiron_dma_wait(uint32_t core, uint32_t tags) {
  (void)core;
  uint32_t kept = 0;
  for (uint32_t i = 0; i < command_count; ++i) {
    if ((tags >> queue[i].tag & 1u) != 0) {
      __builtin_memcpy(queue[i].to, queue[i].from, queue[i].bytes);
    } else {
      queue[kept++] = queue[i];
    }
  }
  command_count = kept;
  return kGridironOk;
}

GridironClaim gridiron_claim_item(uint32_t core, uint32_t* item) {
  (void)core;
  if (next_tile == *(const volatile uint32_t*)(uintptr_t)kTileCount) return kGridironClaimNone;
  *item = next_tile++;
  return kGridironClaimItem;
}

extern unsigned char gridiron_stack_end[];
void reset(void);

void reset(void) {
  own_variables[0] = (unsigned char)gridiron_render(0, store, kFrameRecord, 0, 0);
  for (;;) {
  }
}

typedef void (*Vector)(void);
__attribute__((section(".vectors"), used)) static const Vector vectors[] = {
    (Vector)(uintptr_t)gridiron_stack_end, reset};
