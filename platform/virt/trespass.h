// Wrong on purpose, for an image that must fail: worker 1 touches memory of others, or has it copied.
// Memory: none. Threads: worker 1. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>

#include "clint.h"
#include "engine.h"
#include "memory_map.h"
#include "passing_port.h"
#include "trespassing.h"

namespace gridiron::port {

inline constexpr std::uint64_t kTrespassCount = 15;

/// Makes a forbidden access of worker 1. @param kind  1 to 12; others: nothing.
inline void trespass(std::uint64_t kind) {
  const std::uint64_t arena = address_of(&gridiron_arenas[1]);
  switch (kind) {
    case 1: load_from(arena - kArenaBytes); break;     // a neighbour's first word
    case 2: store_to(arena - 4); break;                // where a stack that is too deep would write
    case 3: load_from(arena + kArenaBytes); break;     // the first word after its own
    case 4: store_to(address_of(code_begin) + 64); break;
    case 5: load_from(address_of(code_end)); break;    // the master's data
    case 6: load_from(address_of(job_begin)); break;
    case 7: store_to(address_of(job_end) - 4); break;
    case 8: store_to(kClint); break;                   // another hart's software interrupt
    case 9: store_to(kUart); break;
    case 10: store_to(kFinisher); break;
    case 11: execute(arena + kArenaBytes / 2); break;  // code in its own arena
    case 12: asm volatile("csrw pmpcfg0, zero"); break;
    default: break;
  }
}

/// Starts forbidden transfers: with kind 13 a get from the code, with 14 puts from the neighbour's arena, with 15 the
/// same without the port. Other transfers are passed on unchanged.
template <Platform P>
class TrespassingPort : public PassingPort<P> {
 public:
  TrespassingPort(P& port, std::uint64_t kind) : PassingPort<P>(port), kind_(kind) {}

  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    if (kind_ == 13 && ++gets_ == 10) address.value = address_of(code_begin) + address.value % 4096;
    return PassingPort<P>::get(local, address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    if (kind_ == 15) {
      const std::uint64_t source = address_of(local) - kArenaBytes;
      return gridiron_call(address.value, source, bytes, Call::kCopy) == 0 ? Status::kTransferFailed : Status::kOk;
    }
    if (kind_ == 14) local = static_cast<const std::byte*>(local) - kArenaBytes;
    return PassingPort<P>::put(local, address, bytes, tag);
  }

 private:
  std::uint64_t kind_;
  std::uint32_t gets_ = 0;
};

}  // namespace gridiron::port
