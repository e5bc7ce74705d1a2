// Passes: a frame as a list of kernels, each with a number of items that cores claim; run one after another on the
// cores of the simulated chip, checked or plain, with main memory shared. What they cost on a machine: pass_timing.h.
// Memory: owns local stores, borrows SimMemory. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/engine_work.h>
#include <gridiron/sim/plain_core.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/sim/sim_memory.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace gridiron::sim {

/// How many items a pass has: a number, or one that the master reads from main memory when the pass before has ended.
struct ItemCount {
  std::uint32_t most = 0;      ///< the number of items, or the most that may be read
  MainAddress address{};       ///< of a little-endian 32-bit word of things; 0: there are `most` items
  std::uint32_t per_item = 1;  ///< with an address: things an item, the last of which may have fewer; at least 1
};

/// What can be the code of a pass: `kernel(core, data)` -> Status for SimCore and PlainCore.
template <class Kernel>
concept PassCode = std::invocable<Kernel&, SimCore&, std::span<std::byte>> &&
    std::invocable<Kernel&, PlainCore&, std::span<std::byte>>;

/// The code of a pass. It claims items until there are none and has waited for its transfers when it returns kOk.
/// `data` is the core's local store, zeroed and kLineBytes-aligned: nothing is left there from the pass before. What it
/// does before its first claim and after its last item must be the same on each core. A kernel holds references to what
/// it needs; it is called on several threads at once.
class PassKernel {
 public:
  /// Takes a generic lambda, or the like, for both.
  template <PassCode Kernel>
  PassKernel(Kernel kernel)  // NOLINT: kernels are passed as they are
      : checked_(kernel), plain_(std::move(kernel)) {}

  [[nodiscard]] const CoreProgram& checked() const { return checked_; }  ///< of Mode::kChecked
  [[nodiscard]] const PlainProgram& plain() const { return plain_; }     ///< of Mode::kPlain

 private:
  CoreProgram checked_;
  PlainProgram plain_;
};

/// One pass. It begins when all items of the pass before it are done.
struct Pass {
  std::string_view name;            ///< stable, snake_case; outlives results and timings
  ItemCount items;                  ///< that cores claim, in rising order
  std::uint32_t data_bytes = 0;     ///< of the kernel's data in the local store, of which there is options.store
  std::vector<MainRange> writable;  ///< where puts may go, in any order; other memory may only be read. No item may put
                                    ///< bytes here that another item of the pass puts or gets.
  PassKernel kernel;                ///< its code
  const EngineWork* engine = &kGridEngine;  ///< names and prices its kinds of work; outlives results
  std::uint32_t output_depth = 1;  ///< output tags that items take in turn (kFirstOutputTag of core/dma/tags.h)
};

/// A pass that has begun.
struct PassRun {
  std::string_view name;    ///< of the pass
  std::uint32_t items = 0;  ///< that it had
  ChipResult result;        ///< failed_tile and the tiles of violations and trace are items; no trace in Mode::kPlain
};

/// How a list of passes ended.
struct PassesResult {
  Status status = Status::kOk;                       ///< of the last pass that has begun
  HostShortage host_shortage = HostShortage::kNone;  ///< as of ChipResult
  std::vector<PassRun> passes;  ///< those that have begun, in their order; if status is not kOk the last one failed
  std::uint64_t transfers = 0;  ///< gets and puts of all of them
};

/// Runs passes until one fails. A pass without items runs no kernel.
///
/// Of the options it takes mode (kInstrumented is kChecked: a kernel built with instrumentation opens its own
/// SimCore::AccessScope), threads, store, completion, seed, limits, spill, fail_transfer (counted over all passes),
/// abort and progress (of each pass).
///
/// Errors, in result.status: kBadParameter (options as of render_frame, only_tiles, data that does not fit the store, a
/// count that is not in memory or above its bound), kAborted (by the options, between two items, or by a shortage of
/// the host), kIncompleteFrame (the kernel left items unclaimed), those of kernels and of broken rules. They do not
/// depend on the number of threads. An exception of options.progress leaves this call once all threads have ended.
[[nodiscard]] PassesResult run_passes(SimMemory& memory, std::span<const Pass> passes, const ChipOptions& options);

}  // namespace gridiron::sim
