// A port for a chip that has no engine: get and put copy at once, main memory is the program's.
// Memory: a few bytes by value. Threads: one core per object. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/platform/transfer_rules.h>

#include <cstdint>
#include <cstring>

namespace example {

using namespace gridiron;

// [port]
// A main address is the host's.
class CopyPort {
 public:
  explicit CopyPort(std::uint32_t tile_count) : tile_count_(tile_count) {}

  [[nodiscard]] PlatformLimits limits() const { return {}; }

  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    GRIDIRON_TRY(check(local, address, bytes, tag));
    std::memcpy(local, reinterpret_cast<const void*>(address.value), bytes);
    return Status::kOk;
  }

  Status put(const void* source, MainAddress address, std::uint32_t bytes, Tag tag) {
    GRIDIRON_TRY(check(source, address, bytes, tag));
    std::memcpy(reinterpret_cast<void*>(address.value), source, bytes);
    return Status::kOk;
  }

  Status wait(TagMask) { return Status::kOk; }

  ItemClaim claim_item() {
    if (next_tile_ == tile_count_) return {ItemClaim::Kind::kNone, 0};
    return {ItemClaim::Kind::kItem, next_tile_++};
  }

 private:
  [[nodiscard]] Status check(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) const {
    return check_transfer(limits(), reinterpret_cast<std::uintptr_t>(local), address, bytes, tag);
  }

  std::uint32_t tile_count_;
  std::uint32_t next_tile_ = 0;
};
static_assert(Platform<CopyPort>);
// [port]

}  // namespace example
