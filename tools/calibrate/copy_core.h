// What counted frames run on: memory by the line, and a core that copies.
// Memory: owned where it says so. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>

namespace gridiron::calibrate {

inline constexpr std::size_t kLine = 128;

/// Bytes aligned to a line, all 0.
class LineBytes {
 public:
  explicit LineBytes(std::size_t bytes)
      : size_(bytes), data_(static_cast<std::byte*>(::operator new (bytes, std::align_val_t{kLine}))) {
    std::memset(data_.get(), 0, bytes);
  }
  [[nodiscard]] std::span<std::byte> bytes() const { return {data_.get(), size_}; }

 private:
  struct Free {
    void operator()(std::byte* data) const { ::operator delete (data, std::align_val_t{kLine}); }
  };
  std::size_t size_;
  std::unique_ptr<std::byte, Free> data_;
};

/// A core whose transfers are copies, and that has all these tiles.
class CopyCore {
 public:
  CopyCore(std::span<std::byte> memory, std::span<const std::uint32_t> tiles) : memory_(memory), tiles_(tiles) {}

  [[nodiscard]] PlatformLimits limits() const { return {}; }
  [[nodiscard]] Status get(void* local, MainAddress address, std::uint32_t bytes, Tag) {
    std::memcpy(local, memory_.subspan(address.value, bytes).data(), bytes);
    return Status::kOk;
  }
  [[nodiscard]] Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag) {
    std::memcpy(memory_.subspan(address.value, bytes).data(), local, bytes);
    return Status::kOk;
  }
  [[nodiscard]] Status wait(TagMask) { return Status::kOk; }
  [[nodiscard]] ItemClaim claim_item() {
    if (next_ == tiles_.size()) return {ItemClaim::Kind::kNone, 0};
    return {ItemClaim::Kind::kItem, tiles_[next_++]};
  }

 private:
  std::span<std::byte> memory_;
  std::span<const std::uint32_t> tiles_;
  std::size_t next_ = 0;
};

/// Errors: std::runtime_error where a frame cannot be set up or rendered.
inline void require(Status status) {
  if (status != Status::kOk) throw std::runtime_error("calibration: a frame cannot be rendered");
}

}  // namespace gridiron::calibrate
