// Check value of a scene image: eight interleaved FNV-1a streams, so that a core with a pipelined multiplier is kept
// busy. Every stream is a bijection of its state per word, so a change of any single word changes the value. Memory: 64
// bytes by value. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Takes an image piece by piece. Word i (64 bits, little-endian) of the image belongs to stream i modulo 8; each
/// stream is FNV-1a 64 taken a word at a time; the value is the same hash over the eight streams' states, stream 0
/// first.
class CheckValue {
 public:
  static constexpr std::size_t kGroupBytes = 64;  ///< what add() takes multiples of

  CheckValue();

  /// Appends bytes. Precondition: their number is a multiple of kGroupBytes.
  void add(std::span<const std::byte> bytes);

  /// @returns the check value of all bytes so far.
  [[nodiscard]] std::uint64_t value() const;

 private:
  static constexpr int kStreamCount = 8;
  std::uint64_t streams_[kStreamCount];
};

}  // namespace gridiron
