// A program without an operating system's help: renders the frame that lies in its image, and ends. second_opinion
// counts its instructions. Build: GRIDIRON_MEMORY, the file that gridiron_calibrate wrote; GRIDIRON_PACKET_WIDTH;
// GRIDIRON_EFFECTS, of the layout, 0 for none; GRIDIRON_DECISIONS instead, where the file holds exact decisions.
// Memory: static. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/effect_records.h>
#include <gridiron/base/exact_sum.h>
#include <gridiron/base/lanes.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include <cstdint>
#include <new>

#include "program_core.h"

asm(".data\n.balign 4096\n.global gridiron_memory\ngridiron_memory:\n.incbin \"" GRIDIRON_MEMORY
    "\"\n"
    ".global gridiron_memory_end\ngridiron_memory_end:\n.text\n");

namespace {

using namespace gridiron;

[[noreturn]] void exit_with(long code) {
#ifdef __riscv
  register long value asm("a0") = code;
  register long call asm("a7") = 93;  // exit
  asm volatile("ecall" : : "r"(value), "r"(call));
#else
  register long value asm("x0") = code;
  register long call asm("x8") = 93;  // exit
  asm volatile("svc 0" : : "r"(value), "r"(call));
#endif
  __builtin_unreachable();
}

#ifdef GRIDIRON_DECISIONS

// Eye, direction and three corners of each decision.
int decide_all() {
  WorkCounters work;
  int sum = 0;
  for (const auto *at = reinterpret_cast<const float *>(gridiron_memory);
       at != reinterpret_cast<const float *>(gridiron_memory_end); at += 15) {
    const float *const eye = at, *const dir = at + 3, *const a = at + 6, *const b = at + 9, *const c = at + 12;
    float first[3][3], second[3][3];
    for (int axis = 0; axis < 3; ++axis) {
      first[0][axis] = a[axis], first[1][axis] = b[axis], first[2][axis] = c[axis];
      second[0][axis] = b[axis], second[1][axis] = c[axis], second[2][axis] = a[axis];
    }
    work.charge_to(Work::kExactSign);
    sum += exact_edge_sign(eye, dir, a, b);
    work.charge_to(Work::kExactDistance);
    sum += exact_distance(eye, dir, a, b, c) > 0.0f ? 1 : 0;
    work.charge_to(Work::kExactOrder);
    sum += exact_distance_order(eye, dir, first, second);
    mark_nothing();
  }
  return sum > -1'000'000 ? 0 : 1;
}

#else

#if GRIDIRON_EFFECTS == 0
using Store = LocalStore<StoreLayout256K<GRIDIRON_PACKET_WIDTH> >;
#else
using Store = LocalStore<EffectLayout256K<GRIDIRON_EFFECTS, GRIDIRON_PACKET_WIDTH> >;
#endif

alignas(128) std::byte store_bytes[sizeof(Store)];

// Memory for rays that wait is the end of a frame's memory.
SpillRegion spill_of(const FrameRecord& frame) {
  if (frame.effects_address == 0) return {};
  const auto& effects = *reinterpret_cast<const EffectsRecord*>(gridiron_memory + frame.effects_address);
  const std::uint64_t bytes = spill_bytes(effects.recursion_depth);
  return {MainAddress{static_cast<std::uint64_t>(gridiron_memory_end - gridiron_memory) - bytes}, bytes};
}

#endif

}  // namespace

extern "C" [[noreturn]] void _start() {
  mark_nothing();
#ifdef GRIDIRON_DECISIONS
  exit_with(decide_all());
#else
  const auto& frame = *reinterpret_cast<const FrameRecord*>(gridiron_memory);
  Store& store = *::new (static_cast<void*>(store_bytes)) Store;
  ProgramCore core(store_bytes, sizeof store_bytes, frame.tiles_x * frame.tiles_y);
  const Status status = render_tiles<Lanes<4> >(store, core.port(), MainAddress{0}, spill_of(frame));
  exit_with(status == Status::kOk ? 0 : 1);
#endif
}
