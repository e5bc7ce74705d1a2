// Addresses of the chip's devices and memories, and their use by this firmware. start.S and the linker script read it
// too.
// Source: SiFive FU540-C000 Manual, chapters 4 (memory map), 9 (CLINT), 11 (L2), 12 (PDMA), 13 (UART).
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The chip.
#define GRIDIRON_CLINT 0x02000000      /* software interrupt of hart n at 4 n */
#define GRIDIRON_MTIMECMP0 0x02004000
#define GRIDIRON_PDMA 0x03000000       /* a channel every 4 KB */
#define GRIDIRON_LIM 0x08000000        /* the part of the L2 cache that is memory */
#define GRIDIRON_LIM_BYTES 0x1E0000    /* 15 ways of 128 KB: after reset one of 16 is cache, and stays so */
#define GRIDIRON_UART 0x10010000
#define GRIDIRON_DRAM 0x80000000

// The firmware. PMP regions are powers of two, and lie at a multiple of their size.
#define GRIDIRON_WORKERS 4             /* harts 1 to 4 */
#define GRIDIRON_ARENA_BYTES 0x40000   /* of each worker, in the LIM one after the other */
#define GRIDIRON_CODE GRIDIRON_DRAM
#define GRIDIRON_CODE_BYTES 0x40000    /* code and constants */
#define GRIDIRON_MASTER_DATA 0x80040000
#define GRIDIRON_MASTER_DATA_BYTES 0x40000
#define GRIDIRON_SHARED 0x80080000     /* what master and workers share */
#define GRIDIRON_SHARED_BYTES 0x20000
#define GRIDIRON_JOB 0x81000000        /* where a job is loaded */
#define GRIDIRON_WORKSHOP 0x88000000   /* where worker 0, or in the moving image all, build scenes */
#define GRIDIRON_WORKSHOP_BYTES 0x8000000
#if defined(GRIDIRON_DYNAMIC) || defined(GRIDIRON_MOVING)
#define GRIDIRON_MEMORY_END GRIDIRON_WORKSHOP
#else
#define GRIDIRON_MEMORY_END 0x90000000 /* of the 256 MB that this firmware counts on */
#endif
