// Latency of a line of main memory: one number of cycles, or several with their shares.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace gridiron::sim {

/// Cycles from the end of a line's turn on the channel to its arrival, and the share of the lines that take so long.
struct LatencyShare {
  double cycles;
  double share = 1;  ///< above 0; those of a latency add up to 1

  /// Equal in both.
  bool operator==(const LatencyShare&) const = default;
};

/// What lines take. A number is a latency that all lines have.
class Latency {
 public:
  static constexpr std::size_t kMaxShares = 8;

  constexpr Latency(double cycles = 0) : shares_{{{cycles, 1}}} {}  // NOLINT: a number is a latency
  /// Precondition: 1 to kMaxShares of them.
  constexpr Latency(std::span<const LatencyShare> shares) : count_(shares.size()) {  // NOLINT: the same
    for (std::size_t i = 0; i < count_; ++i) shares_[i] = shares[i];
  }
  constexpr Latency(std::initializer_list<LatencyShare> shares)
      : Latency(std::span<const LatencyShare>(shares.begin(), shares.size())) {}

  [[nodiscard]] constexpr std::span<const LatencyShare> shares() const { return {shares_.data(), count_}; }
  /// The mean over the lines, in cycles.
  [[nodiscard]] constexpr double mean() const {
    double sum = 0;
    for (const LatencyShare& one : shares()) sum += one.cycles * one.share;
    return sum;
  }
  /// The longest, in cycles.
  [[nodiscard]] constexpr double longest() const {
    double most = 0;
    for (const LatencyShare& one : shares()) most = one.cycles > most ? one.cycles : most;
    return most;
  }

  /// Equal in every number.
  bool operator==(const Latency&) const = default;

 private:
  std::array<LatencyShare, kMaxShares> shares_{};
  std::size_t count_ = 1;
};

/// A number of 64 bits that tells a line of a frame from all others: the share of a latency that it falls into depends
/// on it alone. The core that transfers it does not enter, so that a frame has the same latencies on any number of
/// cores.
///
/// @param item      tile id; kNoTile before the first tile and after the last. @param transfer  its number within the
///                  item, from 0. @param line  its number within the transfer, from 0.
[[nodiscard]] constexpr std::uint64_t line_draw(std::uint32_t seed, std::uint32_t item, std::uint32_t transfer,
                                                std::uint64_t line) {
  // The finaliser of SplitMix64 (Steele, Lea, Flood 2014), over one part after another.
  const auto mixed = [](std::uint64_t bits) {
    bits = (bits ^ bits >> 30) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ bits >> 27) * 0x94D049BB133111EBu;
    return bits ^ bits >> 31;
  };
  const std::uint64_t place = mixed((std::uint64_t{seed} << 32 | item) + 0x9E3779B97F4A7C15u);
  return mixed(mixed(place + transfer) + line);
}

}  // namespace gridiron::sim
