// Bytes on a line boundary, for scene images. Memory: owns. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace gridiron::test {

/// Bytes aligned to a line.
class LineBuffer {
 public:
  LineBuffer() = default;
  explicit LineBuffer(std::size_t size, std::byte fill = std::byte{0})
      : lines_((size + kLineBytes - 1) / kLineBytes), size_(size) {
    if (size != 0) std::memset(lines_.data(), std::to_integer<int>(fill), lines_.size() * kLineBytes);
  }
  /// Drops the bytes behind the first `size`; copies take as much memory as they need.
  void shrink(std::size_t size) {
    lines_.resize((size + kLineBytes - 1) / kLineBytes);
    size_ = size;
  }
  [[nodiscard]] std::span<std::byte> bytes() { return {reinterpret_cast<std::byte*>(lines_.data()), size_}; }
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return {reinterpret_cast<const std::byte*>(lines_.data()), size_};
  }

 private:
  struct alignas(kLineBytes) Line {
    std::byte bytes[kLineBytes];
  };
  std::vector<Line> lines_;
  std::size_t size_ = 0;
};

}  // namespace gridiron::test
