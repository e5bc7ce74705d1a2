// The master of the one core: checks the job, lets the worker render without privileges, serves its calls, writes the
// result. Memory: the master's, and the job's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/one_lane.h>
#include <gridiron/platform/tile_order.h>
#include <gridiron/store/local_store.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "board.h"
#include "console.h"
#include "firmware_facts.h"
#include "master.h"
#include "mesh.h"
#include "run_control.h"
#include "stack_paint.h"
#ifdef GRIDIRON_TRESPASS
#include "trespassing.h"
#endif

extern "C" {
// Symbols of mps2.ld.
extern const std::byte job_begin[], job_end[];
extern std::byte gridiron_stack_begin[], gridiron_stack_end[];
}

namespace gridiron::port {
namespace {

using Layout = TreeLayout16K;
static_assert(sizeof(LocalStore<Layout>) == GRIDIRON_STORE_BYTES);

constexpr std::uint32_t kMostTiles = 65536;  // results lie in the job's memory
constinit RunControl control{};
constinit TileResult* tiles = nullptr;
constinit std::uint32_t claimed_tile = kBoardNoTile;
constinit std::uint32_t transfers_before = 0;

std::uint32_t address_of(const void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

volatile std::uint32_t& device_register(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

// The worker may execute and read the code memory, and read and write the data memory. The master has the default map.
void protect_memory() {
  constexpr std::uint32_t kType = 0xE000ED90, kControl = kType + 4, kBase = kType + 12, kSize = kType + 16;
  constexpr std::uint32_t kValid = 1u << 4;
  constexpr std::uint32_t kReadOnly = 6u << 24, kReadWrite = 3u << 24, kNoExecute = 1u << 28, kEnable = 1;
  constexpr auto size_bits = [](std::uint32_t log2_bytes) { return (log2_bytes - 1) << 1; };
  device_register(kBase) = kValid;  // region 0, from address 0 on
  device_register(kSize) = kReadOnly | size_bits(15) | kEnable;
  device_register(kBase) = 0x20000000 | kValid | 1;
  device_register(kSize) = kReadWrite | kNoExecute | size_bits(14) | kEnable;
  device_register(kControl) = 5;  // enabled, with the default map for the master
  constexpr std::uint32_t kHandlers = 0xE000ED24;
  device_register(kHandlers) = device_register(kHandlers) | 7u << 16;  // faults have handlers of their own
  asm volatile("dsb\n\tisb" ::: "memory");
}

// The tile that was claimed last has ended: what it took.
void finish_tile() {
  if (claimed_tile == kBoardNoTile) return;
  tiles[claimed_tile] = {0, board_worker.transfers - transfers_before, 0};
  claimed_tile = kBoardNoTile;
  ++control.cores[0].tiles_done;
}

std::uint32_t claim() {
  finish_tile();
  if (control.next_tile == control.tile_count) return kBoardNoTile;
  claimed_tile = middle_out(control.next_tile++, control.tile_count);
  transfers_before = board_worker.transfers;
  return claimed_tile;
}

bool lies_in_job(std::uint32_t address, std::uint32_t bytes) {
  const std::uint32_t offset = address - address_of(job_begin);
  const std::uint32_t job_bytes = address_of(job_end) - address_of(job_begin);
  return offset <= job_bytes && bytes <= job_bytes - offset;
}

bool lies_in_store(const void* local, std::uint32_t bytes) {
  const std::uint32_t offset = address_of(local) - address_of(board_worker.store);
  return offset <= GRIDIRON_STORE_BYTES && bytes <= GRIDIRON_STORE_BYTES - offset;
}

// Makes the copies of some tags and takes them off the queue. The queue is the worker's: nothing in it is trusted.
GridironStatus copy(std::uint32_t tags) {
  GridironStatus status = kGridironOk;
  constexpr std::uint32_t kMost = kBoardQueueDepth;
  const std::uint32_t count = board_worker.command_count < kMost ? board_worker.command_count : kMost;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const BoardCommand command = board_worker.commands[i];
    if ((tags >> (command.tag & 31u) & 1u) == 0) {
      board_worker.commands[kept++] = command;
      continue;
    }
    auto* const main = reinterpret_cast<void*>(command.main_address);
    if (!lies_in_job(command.main_address, command.bytes) || !lies_in_store(command.local, command.bytes)) {
      status = kGridironTransferFailed;
    } else if (command.is_get != 0) {
      std::memcpy(command.local, main, command.bytes);
    } else {
      std::memcpy(main, command.local, command.bytes);
    }
  }
  board_worker.command_count = kept;
  return status;
}

// Instructions since some time, of an emulator that executes one in a nanosecond (run_mps2 --count): the core's timer
// has 24 bits and counts down, 25 million times a second.
constexpr std::uint32_t kTimer = 0xE000E010, kTimerMask = 0xFFFFFF, kInstructionsPerTick = 40;
void start_timer() {
  device_register(kTimer + 4) = kTimerMask;
  device_register(kTimer + 8) = 0;
  device_register(kTimer) = 5;  // enabled, by the core's clock
}
std::uint64_t instructions_since_start() {
  return std::uint64_t{kTimerMask - device_register(kTimer + 8)} * kInstructionsPerTick;
}

void end_worker(std::uint32_t status) {
  finish_tile();
  CoreSlot& slot = control.cores[0];
  slot.result.status = status;
  set_state(slot, CoreState::kFinished);
}

// The one core is the master's too: it works in take_part().
struct Mps2Master {
  static void start_core(std::uint32_t) {}
  static void take_part() {
    const StackArea stack{address_of(gridiron_stack_begin), address_of(gridiron_stack_end)};
    for (std::uintptr_t place = stack.low; place < stack.top; place += sizeof kStackPaint) {
      *reinterpret_cast<volatile std::uint64_t*>(place) = kStackPaint;
    }
    std::memset(&board_worker, 0, sizeof board_worker);
    board_worker.frame_address = static_cast<std::uint32_t>(control.frame_address);
#ifdef GRIDIRON_TRESPASS
    constexpr std::uint64_t kTrespassCount = 9;
    board_worker.trespass = static_cast<std::uint32_t>(wanted_trespass(kTrespassCount));
#endif
    const bool is_counted = number_option("count=", 0) != 0;
    start_timer();
    board_start_worker(gridiron_stack_end);
    CoreResult& result = control.cores[0].result;
    if (is_counted) {
      result.instructions = instructions_since_start();
      print("instructions ", result.instructions, "\n");
    }
    result.tiles = control.cores[0].tiles_done;
    result.transfers = board_worker.transfers;
    result.transfer_bytes = board_worker.transfer_bytes;
    result.stack_bytes = used_stack_bytes(stack);
    std::uint32_t count = 0;
    const std::uint32_t* const work = gridiron_work(board_worker.store, &count);
    for (std::uint32_t kind = 0; kind < count; ++kind) result.work[kind] = work[kind];
  }
  static void pause() {}
  static std::uint64_t milliseconds() {
    return 0;
  }
  static void take_results() {}
};

#ifdef GRIDIRON_MESH
constexpr std::uint32_t kMeshMemoryBytes = 64 * 1024;
constinit TileResult mesh_tiles[64]{};

// The image that makes its scene by itself.
RunExit render_mesh() {
  MeshFrame frame{};
  GridironFault fault{};
  const auto bytes = static_cast<std::uint32_t>(number_option("memory=", kMeshMemoryBytes));
  const GridironStatus prepared = mesh_prepare(const_cast<std::byte*>(job_begin), bytes, &frame, &fault);
  if (prepared != kGridironOk) {
    print("mesh: ", fault.field, fault.field[0] != 0 ? ": " : "", gridiron_status_text(prepared), "\n");
    return RunExit::kJobRefused;
  }
  tiles = mesh_tiles;
  control.tile_count = frame.tile_count;
  control.frame_address = frame.record_address;
  Mps2Master::take_part();
  const CoreResult& result = control.cores[0].result;
  print("mesh: status ", result.status, ", ", result.tiles, " tiles, stack ", result.stack_bytes, ", image ",
        frame.image_bytes, ", main memory ", frame.used_bytes, " of ", bytes, ", hash ", Hex{mesh_hash(&frame)}, "\n");
  return result.status == 0 ? RunExit::kDone : RunExit::kFrameFailed;
}
#endif

}  // namespace

// The serial line of the board: CMSDK UART 0.
void put_character(char character) {
  constexpr std::uint32_t kUart = 0x40004000, kPollBound = 1u << 20;
  for (std::uint32_t polls = 0; (device_register(kUart + 4) & 1u) != 0 && polls < kPollBound; ++polls) {
  }
  device_register(kUart) = static_cast<unsigned char>(character);
}

}  // namespace gridiron::port

using namespace gridiron;
using namespace gridiron::port;

std::uint32_t board_serve(std::uint32_t argument, BoardCall which) {
  switch (which) {
    case kBoardCopy:
      return copy(argument);
    case kBoardClaim:
      return claim();
    case kBoardEnd:
      end_worker(argument);
      break;
  }
  return 0;
}

// @param frame  what the core has pushed: r0 to r3, r12, lr, pc, psr.
void board_fault(const std::uint32_t* frame) {
  const std::uint32_t cause = device_register(0xE000ED28);
  constexpr std::uint32_t kAddressIsValid = 1u << 7;
  const std::uint32_t address = (cause & kAddressIsValid) != 0 ? device_register(0xE000ED34) : 0;
  // Where the stack itself is at fault, there is no frame.
  constexpr std::uint32_t kStacking = 1u << 4;
  const std::uint32_t pc = (cause & kStacking) != 0 ? 0 : frame[6];
  print("trap: core 0 cause ", Hex{cause}, " address ", Hex{address}, " pc ", Hex{pc}, "\n");
  exit_run(static_cast<std::uint32_t>(RunExit::kTrapped));
}

void board_main() {
  constexpr std::uint32_t kUartControl = 0x40004008, kUartDivider = 0x40004010;
  device_register(kUartDivider) = 16;
  device_register(kUartControl) = 1;  // transmits
  protect_memory();
#ifdef GRIDIRON_MESH
  exit_run(static_cast<std::uint32_t>(render_mesh()));
#else
  const auto& job = *reinterpret_cast<const FrameJob*>(job_begin);
  const FirmwareFacts facts =
      firmware_facts<Layout, Lanes<1> >("gridiron mps2 " GRIDIRON_IMAGE, 1, address_of(job_end), kMostTiles);
  tiles = tile_results(job);
  Mps2Master board;
  Master<Mps2Master> master(board, facts, job, control, tiles);
  exit_run(static_cast<std::uint32_t>(master.run("result.bin")));
#endif
}
