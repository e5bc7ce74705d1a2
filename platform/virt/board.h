// The Board (template_port.h) of a worker. A copy is made when its end is first polled, as late as the contract allows,
// so that a use before the wait reads old bytes.
// Memory: the command that was started. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "engine.h"
#include "memory_map.h"
#include "run_control.h"
#include "template_port.h"

namespace gridiron::port {

class VirtBoard : public SharedTiles {
 public:
  /// @param store_begin, store_bytes  the part of the arena that transfers may touch.
  VirtBoard(RunControl& control, std::uint64_t store_begin, std::uint64_t store_bytes)
      : SharedTiles(control), store_begin_(store_begin), store_bytes_(store_bytes) {}

  void start(const EngineCommand& command) {
    command_ = command;
    is_started_ = true;
  }
  // The hart itself copies, in machine mode: its own order of loads and stores is sufficient.
  [[nodiscard]] bool is_busy() {
    if (is_started_) {
      has_failed_ = gridiron_call(command_.target, command_.source, command_.bytes, Call::kCopy) == 0;
      is_started_ = false;
    }
    return false;
  }
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  [[nodiscard]] std::uint64_t bus_address(const void* local) const { return address_of(local); }
  [[nodiscard]] bool holds(const void* local, std::uint32_t bytes) const {
    const std::uint64_t offset = bus_address(local) - store_begin_;
    return offset <= store_bytes_ && bytes <= store_bytes_ - offset;
  }
  // The hart's own loads and stores copy, so its cache cannot hold back anything.
  void write_back(const void*, std::uint32_t) {}
  void discard(const void*, std::uint32_t) {}

 private:
  std::uint64_t store_begin_;
  std::uint64_t store_bytes_;
  EngineCommand command_;
  bool is_started_ = false;
  bool has_failed_ = false;
};

static_assert(Board<VirtBoard>);
static_assert(Platform<TemplatePort<VirtBoard>>);

}  // namespace gridiron::port
