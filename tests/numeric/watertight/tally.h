// Tallies: one kind of rays from inside one solid, shot by every intersector under every machine, and what they missed.
// Memory: std::vector. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numeric/watertight/aims.h"
#include "numeric/watertight/machines.h"
#include "numeric/watertight/placed_solid.h"
#include "numeric/watertight/shot.h"

namespace gridiron::test {

inline constexpr std::size_t kProfileCount = std::size(kProfiles);

/// Other intersectors, for comparison. @param width  the rays of one call. @returns the rays that hit something.
using Peer = std::function<std::uint32_t(const watertight::Shot& shot, std::uint32_t width)>;

/// What happened under one machine.
struct MachineTally {
  std::uint64_t misses[kProfileCount] = {};       ///< rays that hit nothing
  std::uint64_t differences[kProfileCount] = {};  ///< rays with another triangle, or another t where t was wanted, than
                                                  ///< under the first machine
  std::vector<std::uint64_t> peer_misses;
};

/// What happened to the rays of one kind.
struct Tally {
  std::uint64_t packets = 0, rays = 0;
  std::uint64_t lost_packets = 0;  ///< for which no origin inside was found
  std::uint64_t asked_rays = 0;    ///< for which the oracle was used too
  std::uint64_t oracle_differences[kProfileCount] =
      {};  ///< under the first machine: triangle, or t where it was wanted
  std::vector<MachineTally> machines;
  std::string first_failure;  ///< seed and ray of one of a watertight profile

  void add(const Tally& other);
};

struct TallyOptions {
  std::uint64_t rays = 1000;  ///< at least so many
  std::uint64_t first_seed = 1;
  unsigned threads = 1;
  std::uint32_t oracle_stride = 64;  ///< every so manieth packet is shown to the oracle; 0: none
};

/// Shoots rays. The same tally for any number of threads. Profiles on a lattice shoot at a solid that is on its
/// lattice, the others at one that is not.
///
/// @param machines  the first is the one that the others, and the oracle, are compared with.
[[nodiscard]] Tally shoot_all(const PlacedSolid& solid, RayKind kind, std::span<const Machine> machines,
                              std::span<const Peer> peers, const TallyOptions& options);

}  // namespace gridiron::test
