// Hart 0, the monitor core: the frame's master, and with GRIDIRON_ASYNC the workers' DMA engine too. No floating point:
// the build checks every instruction of this code and of all it calls.
// Memory: its own data, shared memory, the job. Threads: hart 0. SPDX-License-Identifier: Apache-2.0
#include "master.h"

#include <cstdint>
#include <cstring>

#include "desk_engine.h"
#include "firmware_facts.h"
#include "layout_256k.h"
#include "memory_map.h"
#include "scene_workshop.h"
#include "shared_memory.h"
#include "wrong_ports.h"
#ifdef GRIDIRON_MOVING
#include "moving_frames.h"
#endif

namespace gridiron::port {

[[gnu::section(".bss.shared")]] SharedMemory shared_memory;

namespace {

constexpr std::uint64_t kTicksPerMillisecond = 1000;
constexpr std::uint64_t kUartTransmit = GRIDIRON_UART + 0x00;
constexpr std::uint64_t kUartTransmitControl = GRIDIRON_UART + 0x08;

class Monitor {
 public:
  Monitor() : engine_(shared_memory.desks, number_option("seed=", 0)) {}

  void start_core(std::uint32_t core_index) { wake_hart(core_index + 1); }
  void take_part() {}
  void pause() {
#ifdef GRIDIRON_ASYNC
    // Serves the desks first, and looks at the frame now and then.
    for (std::uint32_t round = 0; round < 4096; ++round) {
      if (!engine_.run_round([](std::uint32_t core_index) { wake_hart(core_index + 1); })) break;
      if (round == 4095) return;
    }
#endif
#ifdef GRIDIRON_COUNTED
    // Sleeps until a worker calls; instructions that this core executed meanwhile would be counted too.
    sleep_hart(false);
#else
    // Sleeps for 20 ms, or until a worker calls. If one has called since the last sleep, returns at once.
    set_alarm(0, clock_ticks() + 20 * kTicksPerMillisecond);
    sleep_hart(true);
#endif
    hush_hart(0);
  }
  [[nodiscard]] std::uint64_t milliseconds() {
    return clock_ticks() / kTicksPerMillisecond;
  }
  void take_results() {
    asm volatile("fence" ::: "memory");
#ifdef GRIDIRON_ASYNC
    if (shared_memory.control.frame_address != 0) print("the master made ", engine_.done(), " transfers\n");
#endif
  }

 private:
  DeskEngine<GRIDIRON_WORKERS> engine_;
};

#ifdef GRIDIRON_DYNAMIC
// Has worker 0 build the scene of an animated frame, and renders it with the job's camera.
RunExit render_animated(Monitor& monitor, Master<Monitor>& master, const FirmwareFacts& facts, const FrameJob& job) {
  print(facts.name, ": ", facts.core_count, " cores\n");
  if (!check_job(job, facts)) return RunExit::kJobRefused;
  if (job.effects != 0) {
    print("job refused: effects are not animated\n");
    return RunExit::kJobRefused;
  }
  std::memcpy(&scene_workshop().frame, reinterpret_cast<const void*>(job.frame_address), sizeof(FrameRecord));
  std::memset(&shared_memory.control, 0, sizeof shared_memory.control);
  shared_memory.must_build = 1;
  shared_memory.animation_frame = static_cast<std::uint32_t>(number_option("frame=", 0));
  shared_memory.build_status = kNotRun;
  monitor.start_core(0);
  const std::uint64_t begin = monitor.milliseconds();
  std::uint32_t status = kNotRun;
  while ((status = __atomic_load_n(&shared_memory.build_status, __ATOMIC_ACQUIRE)) == kNotRun) {
    const CoreSlot& slot = shared_memory.control.cores[0];
    if (state_of(slot) == CoreState::kTrapped) {
      print("trap: core 0 cause ", Hex{slot.trap.cause}, " address ", Hex{slot.trap.address}, " pc ", Hex{slot.trap.pc},
            "\n");
      return RunExit::kTrapped;
    }
    if (monitor.milliseconds() - begin > Master<Monitor>::kQuietMilliseconds) return RunExit::kTimedOut;
    monitor.pause();
  }
  shared_memory.must_build = 0;
  print("scene of frame ", shared_memory.animation_frame, " built: status ", StatusNumber{status}, ", ",
        scene_workshop().frame.engine.grid.reference_count, " references, stack ",
        shared_memory.control.cores[0].result.stack_bytes, "\n");
  if (status != 0) return RunExit::kFrameFailed;
  return master.render("result.bin", reinterpret_cast<std::uintptr_t>(&scene_workshop().frame));
}
#endif

}  // namespace

void put_character(char character) {
  constexpr std::uint32_t kFull = 1u << 31, kPollBound = 1u << 20;
  for (std::uint32_t i = 0; i < kPollBound && (register_at(kUartTransmit) & kFull) != 0; ++i) {
  }
  register_at(kUartTransmit) = static_cast<unsigned char>(character);
}

extern "C" {

[[noreturn]] void gridiron_master();
void gridiron_trap(std::uint64_t hart, std::uint64_t cause, std::uint64_t address, std::uint64_t pc);

/// Hart 0, from start.S.
void gridiron_master() {
  register_at(kUartTransmitControl) = 1;
#ifdef GRIDIRON_COUNTED
  constexpr std::uint32_t kCores = 1;  // the emulator's counter is one for all cores
#else
  constexpr std::uint32_t kCores = GRIDIRON_WORKERS;
#endif
  const FirmwareFacts facts = firmware_facts<FirmwareLayout, FirmwareLanes>("gridiron sifive_u " GRIDIRON_IMAGE, kCores,
                                                                            GRIDIRON_MEMORY_END, kMostTiles);
  Monitor monitor;
#ifdef GRIDIRON_TRESPASS
  shared_memory.trespass = wanted_trespass(kTrespassCount);
#endif
  const auto& job = *reinterpret_cast<const FrameJob*>(GRIDIRON_JOB);
  Master<Monitor> master(monitor, facts, job, shared_memory.control, shared_memory.tiles);
#if defined(GRIDIRON_DYNAMIC)
  exit_run(static_cast<std::uint32_t>(render_animated(monitor, master, facts, job)));
#elif defined(GRIDIRON_MOVING)
  exit_run(static_cast<std::uint32_t>(render_moving(monitor, master, facts, job, shared_memory.moving,
                                                    GRIDIRON_WORKSHOP, GRIDIRON_WORKSHOP + GRIDIRON_WORKSHOP_BYTES)));
#else
  exit_run(static_cast<std::uint32_t>(master.run("result.bin")));
#endif
}

/// Any hart, from start.S. A worker cannot reach the serial line: it leaves the trap for the master.
void gridiron_trap(std::uint64_t hart, std::uint64_t cause, std::uint64_t address, std::uint64_t pc) {
  if (hart == 0) {
    print("trap: master cause ", Hex{cause}, " address ", Hex{address}, " pc ", Hex{pc}, "\n");
    exit_run(static_cast<std::uint32_t>(RunExit::kTrapped));
  }
  CoreSlot& slot = shared_memory.control.cores[hart - 1];
  slot.trap = {cause, address, pc};
  set_state(slot, CoreState::kTrapped);
  wake_hart(0);
}

}  // extern "C"

}  // namespace gridiron::port
