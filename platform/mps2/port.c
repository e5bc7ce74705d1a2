// The port of a core without an engine, in C: commands wait in a queue, and the copies are made by the wait, in the
// master's mode. That is as late as the contract allows, so a use before the wait reads old bytes.
// Memory: board_worker. Threads: the worker. SPDX-License-Identifier: Apache-2.0
#include <stdint.h>

#include "board.h"

// Everything that a worker may write is in its data memory (mps2.ld).
BoardWorker board_worker __attribute__((section(".worker"), aligned(128)));

static GridironStatus start(void* local, uint64_t main_address, uint32_t bytes, uint32_t tag, uint8_t is_get) {
  const GridironStatus status = gridiron_check_transfer(local, main_address, bytes, tag);
  if (status != kGridironOk) return status;
  const uintptr_t offset = (uintptr_t)local - (uintptr_t)board_worker.store;
  if (offset >= GRIDIRON_STORE_BYTES || bytes > GRIDIRON_STORE_BYTES - offset) return kGridironTransferLocalRange;
  if (main_address > UINT32_MAX) return kGridironTransferMainRange;  // the master compares it with the job's memory
  if (board_worker.command_count == kBoardQueueDepth) return kGridironTransferQueueFull;
  BoardCommand* command = &board_worker.commands[board_worker.command_count++];
  command->local = local;
  command->main_address = (uint32_t)main_address;
  command->bytes = (uint16_t)bytes;
  command->tag = (uint8_t)tag;
  command->is_get = is_get;
  ++board_worker.transfers;
  board_worker.transfer_bytes += bytes;
  return kGridironOk;
}

GridironStatus gridiron_dma_get(uint32_t core, void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  (void)core;
  return start(local, main_address, bytes, tag, 1);
}

GridironStatus gridiron_dma_put(uint32_t core, const void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  (void)core;
  // Only read, but one queue holds both kinds.
  return start((void*)(uintptr_t)local, main_address, bytes, tag, 0);
}

GridironStatus gridiron_dma_wait(uint32_t core, uint32_t tags) {
  (void)core;
#ifdef GRIDIRON_FORGETFUL
  static uint32_t waits __attribute__((section(".worker")));
  if (++waits % 64 == 0) return kGridironOk;
#endif
  for (uint32_t i = 0; i < board_worker.command_count; ++i) {
    if ((tags >> board_worker.commands[i].tag & 1u) != 0) return (GridironStatus)board_call(tags, kBoardCopy);
  }
  return kGridironOk;
}

GridironClaim gridiron_claim_item(uint32_t core, uint32_t* item) {
  (void)core;
  *item = board_call(0, kBoardClaim);
  return *item == kBoardNoTile ? kGridironClaimNone : kGridironClaimItem;
}

#ifdef GRIDIRON_TRESPASS
// Accesses that a worker must not make: each must trap, or be refused.
static volatile uint32_t* word_at(uint32_t address) {
  __asm__("" : "+r"(address));  // the compiler knows no array there
  return (volatile uint32_t*)(uintptr_t)address;
}

static uint32_t trespass(uint32_t number) {
  volatile uint32_t* const main_memory = word_at(0x60000000u);
  volatile uint32_t* const master = word_at(0x20100000u);
  switch (number) {
    case 1:
      return *main_memory;
    case 2:
      *main_memory = 0;
      break;
    case 3:
      return *master;
    case 4:
      *word_at(0x100u) = 0;
      break;
    case 5:  // the serial line
      return *word_at(0x40004000u);
    case 6:  // beyond the data memory
      *word_at(0x20004000u) = 0;
      break;
    case 7:  // data is not code
      ((void (*)(void))((uintptr_t)board_worker.store | 1u))();
      break;
    case 8:  // memory that is not the job's
      (void)start(board_worker.store, 0x20100000u, 128, 0, 1);
      return board_call(1, kBoardCopy);
    case 9:  // a destination that is not the store
      return start((void*)0x20000000u, 0x60000000u, 128, 0, 1);
    default:
      break;
  }
  return kGridironOk;
}
#endif

void board_render(void) {
#ifdef GRIDIRON_TRESPASS
  const uint32_t refused = trespass(board_worker.trespass);
  if (refused != kGridironOk) board_call(refused, kBoardEnd);
#endif
  board_call(gridiron_render(0, board_worker.store, board_worker.frame_address, 0, 0), kBoardEnd);
}
