// Scaling model: how long a command takes by N ranks, from measured costs, by a simulation of the fixed schedule.
// Memory: the costs. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gridiron::scaling {

/// What one rank does without a message, and what rank 0 is sent of it.
struct Piece {
  double seconds = 0;
  double bytes = 0;
};

/// Costs of one command, in processor seconds.
struct Costs {
  std::string name;
  double start_seconds = 0;        ///< of rank 0, before all others can begin: reading, building
  double broadcast_bytes = 0;      ///< that each rank needs before it begins
  double message_pieces = 1;       ///< that a message holds at most
  double message_seconds = 0;      ///< a message ends with the piece that reaches so much work; 0: any amount
  double take_seconds = 0;         ///< of rank 0, for a piece of another rank
  double own_take_seconds = 0;     ///< of rank 0, for a piece of its own, besides its work
  double end_seconds = 0;          ///< of rank 0, when all pieces are there: hashes, files, tables
  double end_divided_seconds = 0;  ///< of all ranks then: encoding
  double end_pieces = 1;           ///< in so many equal pieces
  double scatter_seconds = 0;      ///< of rank 0, to send all that it needs, its own part too
  double scatter_bytes = 0;        ///< these
  double spread_bytes = 0;         ///< that each rank needs at the end
  std::vector<Piece> pieces;
};

struct Network {
  double latency_seconds = 0;
  double bytes_per_second = 0;  ///< of the link of one rank; 0: without end
};

/// @returns the costs in a CSV text: lines `key,value` with the names of Costs' members, `piece,seconds,bytes`; `#`
/// begins a comment. Errors: tool::Failure (kBadInput) with the line.
[[nodiscard]] Costs read_costs(const std::string& file, const std::string& text);

/// @returns seconds of the whole command. Ranks have the pieces of tool::piece_of_rank(); each rank has one message
/// under way at most; rank 0 takes what has arrived between two pieces of its own. A broadcast is a tree of copies.
[[nodiscard]] double simulate(const Costs& costs, const Network& network, std::uint32_t ranks);

struct Prediction {
  std::uint32_t ranks = 1;
  double seconds = 0, speed_up = 1, efficiency = 1;
  std::string limit;  ///< what would save most if it cost nothing; "none" if no part would save a twentieth
};

[[nodiscard]] Prediction predict(const Costs& costs, const Network& network, std::uint32_t ranks);

}  // namespace gridiron::scaling
