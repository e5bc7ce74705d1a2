// Check values of bytes, and of a scene image: eight interleaved FNV-1a streams, so that a core with a pipelined
// multiplier is kept busy. Every stream is a bijection of its state per word, so a change of any single word changes
// the value. An image is taken in pieces, so that several cores can share the work. Memory: by value. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Takes bytes part by part. Word i (64 bits, little-endian) of them belongs to stream i modulo 8; each stream is
/// FNV-1a 64 taken a word at a time; the value is the same hash over the eight streams' states, stream 0 first.
class CheckValue {
 public:
  static constexpr std::size_t kGroupBytes = 64;  ///< what add() takes multiples of

  CheckValue();

  /// Appends bytes. Precondition: their number is a multiple of kGroupBytes.
  void add(std::span<const std::byte> bytes);

  /// @returns the check value of all bytes so far.
  [[nodiscard]] std::uint64_t value() const;

 private:
  friend class ImageCheckValue;
  static constexpr int kStreamCount = 8;
  static constexpr std::uint64_t kOffsetBasis = 0xcbf29ce484222325u;
  static constexpr std::uint64_t kPrime = 0x100000001b3u;

  std::uint64_t streams_[kStreamCount];
};

/// The check value of a scene image: FNV-1a 64 over the check values of its pieces, in their order. All pieces but the
/// last have kPieceBytes.
class ImageCheckValue {
 public:
  static constexpr std::uint32_t kPieceBytes = 16 * 1024;  ///< of a piece, but for the last

  /// Appends bytes. Precondition: their number is a multiple of CheckValue::kGroupBytes.
  void add(std::span<const std::byte> bytes);
  /// @returns bytes that are missing to a whole piece; 0: what came before are whole pieces.
  [[nodiscard]] std::size_t missing_bytes() const {
    if (piece_bytes_ == 0) return 0;
    return kPieceBytes - piece_bytes_;
  }
  /// Appends a piece by its check value. Precondition: what came before are whole pieces.
  void add_piece(std::uint64_t check_value) { value_ = (value_ ^ check_value) * CheckValue::kPrime; }

  /// @returns the check value of all bytes so far.
  [[nodiscard]] std::uint64_t value() const;

 private:
  CheckValue piece_;                                // of the bytes behind the last whole piece
  std::uint64_t value_ = CheckValue::kOffsetBasis;  // of whole pieces
  std::size_t piece_bytes_ = 0;
};

}  // namespace gridiron
