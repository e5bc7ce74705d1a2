// What port.c, which is C, and the master's firmware.cpp share: the worker's call of the master, its state, its memory.
// Memory: data memory. Threads: one core, as worker without privileges and as master.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// NOLINTBEGIN(modernize-deprecated-headers): the header is C
#include <gridiron/c/gridiron.h>
#include <stdint.h>
// NOLINTEND(modernize-deprecated-headers)

#ifdef __cplusplus
extern "C" {
#endif

enum {
  kBoardQueueDepth = 16  ///< commands that the port holds
};

/// A copy that was started and not waited for.
typedef struct BoardCommand {
  void* local;            ///< in the store
  uint32_t main_address;  ///< in the job's memory
  uint16_t bytes;         ///< 16..4,096
  uint8_t tag;            ///< 0..31
  uint8_t is_get;         ///< 1: to local memory, 0: to main memory
} BoardCommand;

/// Memory of the worker besides its stack: all that it may write.
typedef struct BoardWorker {
  unsigned char store[GRIDIRON_STORE_BYTES];
  BoardCommand commands[kBoardQueueDepth];  ///< in the order in which they were started
  uint32_t command_count;
  uint32_t transfers;       ///< started in this frame
  uint32_t transfer_bytes;  ///< of them
  uint32_t frame_address;   ///< set by the master
  uint32_t trespass;        ///< set by the master: which forbidden access the image for such accesses makes
} BoardWorker;

extern BoardWorker board_worker;

/// What a worker asks of the master, by a supervisor call.
typedef enum BoardCall {
  kBoardCopy = 0,   ///< makes the copies of the tags `argument` that are in the queue; answers a GridironStatus
  kBoardClaim = 1,  ///< answers the number of a tile, or kBoardNoTile
  kBoardEnd = 2,    ///< the frame has ended with the GridironStatus `argument`
} BoardCall;
#define kBoardNoTile 0xFFFFFFFFu

/// The call: an SVC instruction (start.S).
uint32_t board_call(uint32_t argument, BoardCall which);

/// The worker's program (port.c): renders, and never returns.
void board_render(void);

/// Runs board_render() without privileges, on a stack that ends at `stack_top`, until its kBoardEnd (start.S).
void board_start_worker(void* stack_top);

// Of firmware.cpp, called by start.S: the master's program, what serves a call, and what reports a fault.
void board_main(void);
uint32_t board_serve(uint32_t argument, BoardCall which);
void board_fault(const uint32_t* frame);

#ifdef __cplusplus
}
#endif
