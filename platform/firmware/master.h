// The master of a frame: checks the job, starts the workers, waits for them within a bound, writes the result file.
// Integers only: the core it runs on may have no floating point unit.
// Memory: fills RunControl and the job's FrameResult. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>
#include <gridiron/platform/status.h>

#include <concepts>
#include <cstdint>
#include <cstring>

#include "console.h"
#include "job_check.h"
#include "run_control.h"
#include "semihost.h"

namespace gridiron::port {

/// Exit codes of a run. None is 1, which an emulator returns if it did not start.
enum class RunExit : std::uint32_t {
  kDone = 0,  ///< every core ended with kOk, the result is written
  kJobRefused = 2,
  kTimedOut = 3,     ///< no core finished a tile for kQuietMilliseconds
  kTrapped = 4,      ///< a core did what it must not
  kNotWritten = 5,   ///< the host did not write the result file
  kFrameFailed = 6,  ///< a core ended with another status; the result is written
};

/// What the master needs of its board.
///
/// start_core    wakes a worker; what was stored before is visible to it.
/// take_part     called once after all are started: if the master's core is a worker too, it works here, else nothing.
/// pause         lets a little time pass, or lets the master's core do its other duties.
/// milliseconds  since an arbitrary time.
/// take_results  called once after all are finished: afterwards the bytes that they and their engines wrote are
/// visible.
template <class B>
concept MasterBoard = requires(B& board, std::uint32_t core_index) {
  { board.start_core(core_index) } -> std::same_as<void>;
  { board.take_part() } -> std::same_as<void>;
  { board.pause() } -> std::same_as<void>;
  { board.milliseconds() } -> std::same_as<std::uint64_t>;
  { board.take_results() } -> std::same_as<void>;
};

template <MasterBoard B>
class Master {
 public:
  /// A frame has failed if it finishes no tile for this long.
  static constexpr std::uint64_t kQuietMilliseconds = 600'000;

  /// @param tiles  results of tiles as the workers write them: the job's own (tile_results), or facts.most_tiles
  ///               elsewhere, which are then copied into the job.
  Master(B& board, const FirmwareFacts& facts, const FrameJob& job, RunControl& control, TileResult* tiles)
      : board_(board), facts_(facts), job_(job), control_(control), tiles_(tiles) {}

  /// Runs the job.
  /// @param result_name  name of the file that the host gets.
  [[nodiscard]] RunExit run(const char* result_name) {
    print(facts_.name, ": ", facts_.core_count, " cores\n");
    if (!check_job(job_, facts_)) return RunExit::kJobRefused;
    return render(result_name, job_.frame_address);
  }

  /// Renders a frame of a job that has been checked.
  /// @param frame_address  of its record: the job's own or another one.
  [[nodiscard]] RunExit render(const char* result_name, std::uint64_t frame_address) {
    const RunExit ran = run_cores(frame_address, job_.tile_count);
    if (ran != RunExit::kDone) return ran;
    const Status status = write_result();
    if (!write_host_file(result_name, reinterpret_cast<const void*>(static_cast<std::uintptr_t>(job_.result_address)),
                         job_.result_bytes)) {
      print("the host did not take ", result_name, "\n");
      return RunExit::kNotWritten;
    }
    if (status != Status::kOk) return RunExit::kFrameFailed;
    print("frame done, ", job_.result_bytes, " bytes of result\n");
    return RunExit::kDone;
  }

  /// Has the cores run a pass that is no picture; what they do is the image's own.
  /// @param pass         its number, for the console.
  /// @param item_count   1..facts.most_tiles.
  /// @param stack_bytes  becomes the deepest stack, if that is deeper.
  [[nodiscard]] RunExit run_pass(std::uint32_t pass, std::uint32_t item_count, std::uint32_t& stack_bytes) {
    const RunExit ran = run_cores(0, item_count);
    if (ran != RunExit::kDone) return ran;
    std::uint32_t done = 0;
    for (std::uint32_t core = 0; core < facts_.core_count; ++core) {
      const CoreResult& result = control_.cores[core].result;
      done += result.tiles;
      stack_bytes = stack_bytes > result.stack_bytes ? stack_bytes : result.stack_bytes;
      if (result.status == 0) continue;
      print("pass ", pass, ", core ", core, ": status ", StatusNumber{result.status}, "\n");
      return RunExit::kFrameFailed;
    }
    if (done == item_count) return RunExit::kDone;
    print("pass ", pass, ": ", done, " of ", item_count, " items\n");
    return RunExit::kFrameFailed;
  }

 private:
  // Starts all cores, and waits until they have finished.
  RunExit run_cores(std::uint64_t frame_address, std::uint32_t item_count) {
    prepare(frame_address, item_count);
    for (std::uint32_t core = 0; core < facts_.core_count; ++core) {
      set_state(control_.cores[core], CoreState::kStarted);
      board_.start_core(core);
    }
    board_.take_part();
    const RunExit waited = wait_for_cores();
    if (waited == RunExit::kDone) board_.take_results();
    return waited;
  }

  void prepare(std::uint64_t frame_address, std::uint32_t item_count) {
    std::memset(&control_, 0, sizeof control_);
    for (std::uint32_t tile = 0; tile < item_count; ++tile) tiles_[tile] = {kNotRun, 0, 0};
    control_.tile_count = item_count;
    control_.core_count = facts_.core_count;
    control_.frame_address = frame_address;
    control_.spill_address = job_.spill_address;
    control_.spill_bytes = job_.spill_bytes;
    for (std::uint32_t core = 0; core < facts_.core_count; ++core) control_.cores[core].result.status = kNotRun;
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
  }

  // Prints the progress, an eighth of the frame at a time, until every core has finished.
  RunExit wait_for_cores() {
    std::uint32_t done_before = 0, told = 0;
    std::uint64_t quiet_since = board_.milliseconds();
    for (;;) {
      std::uint32_t done = 0, finished = 0;
      for (std::uint32_t core = 0; core < facts_.core_count; ++core) {
        const CoreSlot& slot = control_.cores[core];
        const CoreState state = state_of(slot);
        if (state == CoreState::kTrapped) return tell_trap(core, slot.trap);
        done += __atomic_load_n(&slot.tiles_done, __ATOMIC_RELAXED);
        if (state == CoreState::kFinished) ++finished;
      }
      const std::uint32_t eighth = done * 8 / control_.tile_count;
      if (eighth != told && control_.frame_address != 0) print("tiles ", done, " of ", control_.tile_count, "\n");
      told = eighth;
      if (finished == facts_.core_count) return RunExit::kDone;

      const std::uint64_t now = board_.milliseconds();
      if (done != done_before) quiet_since = now;
      done_before = done;
      if (now - quiet_since > kQuietMilliseconds) {
        print("timed out: no tile for ", kQuietMilliseconds / 1000, " s, ", finished, " cores have finished\n");
        return RunExit::kTimedOut;
      }
      board_.pause();
    }
  }

  static RunExit tell_trap(std::uint32_t core, const Trap& trap) {
    print("trap: core ", core, " cause ", Hex{trap.cause}, " address ", Hex{trap.address}, " pc ", Hex{trap.pc}, "\n");
    return RunExit::kTrapped;
  }

  Status write_result() {
    auto& result = *reinterpret_cast<FrameResult*>(static_cast<std::uintptr_t>(job_.result_address));
    std::memset(&result, 0, sizeof result);
    result.magic = kFrameResultMagic;
    result.version = kFrameJobVersion;
    result.core_count = facts_.core_count;
    result.work_kinds = facts_.work_kinds;
    result.lane_count = facts_.lane_count;
    result.queue_depth = facts_.queue_depth;
    for (std::uint32_t core = 0; core < facts_.core_count; ++core) {
      result.cores[core] = control_.cores[core].result;
      const CoreResult& done = result.cores[core];
      print("core ", core, ": status ", StatusNumber{done.status}, ", ", done.tiles, " tiles, ", done.transfers,
            " transfers, ", done.transfer_bytes, " bytes, stack ", done.stack_bytes, " of ", facts_.stack_bytes, "\n");
      if (done.missing_effects != 0) print("core ", core, ": built without ", EffectSet{done.missing_effects}, "\n");
      if (result.status == 0) result.status = done.status;
    }
    TileResult* wanted = tile_results(job_);
    if (tiles_ != wanted) std::memcpy(wanted, tiles_, job_.tile_count * sizeof(TileResult));
    return static_cast<Status>(result.status);
  }

  B& board_;
  const FirmwareFacts& facts_;
  const FrameJob& job_;
  RunControl& control_;
  TileResult* tiles_;
};

}  // namespace gridiron::port
