// Ranks: the processes that do one command together, and the messages between them. The program alone is one rank.
// Memory: messages. Threads: calls are serialised by the caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "value_bytes.h"

namespace gridiron::tool {

/// Of every `count` pieces of work, a round, each rank has one, and no rank more than one piece above an even share.
/// From round to round they move on by a golden section of the ranks, so that no rank has all pieces of one kind where
/// kinds take turns, as halves and columns of a picture do.
/// @returns by how many ranks the pieces of a round are moved on; 0 in the first.
[[nodiscard]] constexpr std::uint32_t turn_of_round(std::uint64_t round, std::uint32_t count) {
  const auto part = static_cast<std::uint32_t>(round * 0x9E3779B9u);  // of 2^32
  return static_cast<std::uint32_t>(std::uint64_t{part} * count >> 32);
}
/// @returns the rank that has piece `i`.
[[nodiscard]] constexpr std::uint32_t rank_of_piece(std::uint64_t i, std::uint32_t count) {
  return static_cast<std::uint32_t>((i % count + turn_of_round(i / count, count)) % count);
}
/// @returns the k-th piece of a rank, rising with k. The first is the one with its number.
[[nodiscard]] constexpr std::uint64_t piece_of_rank(std::uint64_t k, std::uint32_t rank, std::uint32_t count) {
  return k * count + (rank + count - turn_of_round(k, count)) % count;
}

struct RankMessage {
  std::uint32_t rank = 0;  ///< that sent it
  Bytes bytes;
};

/// Errors of all calls that wait: Failure if another rank has failed, with its code and message; and
/// stop_if_interrupted()'s.
///
/// All ranks run the same command, so each knows which message comes next. Messages of one rank arrive in order.
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual std::uint32_t rank() const = 0;
  [[nodiscard]] virtual std::uint32_t count() const = 0;

  /// Rank 0 prints and writes all files.
  [[nodiscard]] bool is_first() const { return rank() == 0; }
  /// @returns the k-th piece of this rank.
  [[nodiscard]] std::uint64_t piece(std::uint64_t k) const { return piece_of_rank(k, rank(), count()); }
  /// @returns pieces of this rank, of so many.
  [[nodiscard]] std::uint64_t share_of(std::uint64_t pieces) const {
    const std::uint64_t rounds = pieces / count();
    return rounds + (piece(rounds) < pieces ? 1 : 0);
  }

  /// Of another rank than 0: sends a message. Waits until the one before has left, so that one at most is kept.
  virtual void tell_first(Bytes message) = 0;
  /// Of another rank than 0: whether tell_first() would not wait.
  [[nodiscard]] virtual bool has_told() = 0;
  /// Of rank 0: @returns a message that has arrived, of any rank.
  [[nodiscard]] virtual std::optional<RankMessage> poll() = 0;
  /// Of rank 0: sends a message to another rank. Waits until it has left, so that one at most is kept.
  virtual void tell(std::uint32_t rank, Bytes message) = 0;
  /// Of another rank than 0: @returns the next message of rank 0, once it has arrived.
  [[nodiscard]] virtual Bytes hear() = 0;
  /// Moves messages on and looks for failures of other ranks. Called now and then during long work; cheap.
  virtual void attend() = 0;
  /// Gives all ranks the bytes of rank 0. All call it; it returns once this rank has them.
  virtual void broadcast(Bytes& bytes) = 0;

  /// Gives all ranks the bytes of rank 0 so that they lie once in the memory of each node. All call it.
  /// @param bytes  of rank 0; on others as many that are overwritten. @param what  they are, for messages: "the scene".
  /// @param place  called for one piece after another, which lies in memory that the ranks of the node share and that
  ///               is gone when this call returns: the caller maps it, or copies it to `bytes`, from `begin` on. Not
  ///               called where a node has one rank.
  virtual void share_bytes(std::span<std::byte> bytes, const char* what,
                           const std::function<void(std::uint64_t begin, std::span<std::byte> shared)>& place) = 0;

  /// Threads that this rank should use by default. @param host_threads  of the whole host.
  [[nodiscard]] virtual std::uint32_t usual_threads(std::uint32_t host_threads) const = 0;

  // What follows from these.

  /// Of rank 0: waits for a message.
  [[nodiscard]] RankMessage wait_message();
  /// @returns the bytes that each rank brings, by rank, to all ranks.
  [[nodiscard]] std::vector<Bytes> exchange(Bytes own);
  /// Waits until all ranks have called it.
  void meet() { (void)exchange({}); }
};

/// @returns the ranks of this program: one, unless a RanksInUse exists.
[[nodiscard]] Ranks& ranks();

/// While it lives, ranks() returns these.
class RanksInUse {
 public:
  explicit RanksInUse(Ranks& used);
  ~RanksInUse();
  RanksInUse(const RanksInUse&) = delete;
  RanksInUse& operator=(const RanksInUse&) = delete;
};

/// The results of pieces that were divided by Ranks::piece(). On return every rank has those of all.
/// @param pack    @returns the result of an own piece as bytes.
/// @param unpack  takes the result of another rank's piece.
void exchange_results(std::size_t count, const std::function<Bytes(std::size_t)>& pack,
                      const std::function<void(std::size_t, const Bytes&)>& unpack);

}  // namespace gridiron::tool
