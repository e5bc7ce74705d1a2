// Tallies: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/tally.h"

#include <atomic>
#include <thread>

namespace gridiron::test {
namespace {

using watertight::Hits;
using watertight::kNothing;
using watertight::Shot;

constexpr std::uint64_t kChunkPackets = 64;

std::uint32_t rays_that_hit(const Shot& shot, const Hits& hits) {
  std::uint32_t result = 0;
  for (std::uint32_t rest = shot.active; rest != 0; rest &= rest - 1) {
    const auto ray = static_cast<std::uint32_t>(std::countr_zero(rest));
    if (hits.id[ray] != kNothing) result |= 1u << ray;
  }
  return result;
}

// Active rays that did not hit the same triangle, at the same distance where that was wanted.
std::uint32_t rays_that_differ(const Shot& shot, const Hits& a, const Hits& b) {
  std::uint32_t result = 0;
  for (std::uint32_t rest = shot.active; rest != 0; rest &= rest - 1) {
    const auto ray = static_cast<std::uint32_t>(std::countr_zero(rest));
    const bool same_t = std::bit_cast<std::uint32_t>(a.t[ray]) == std::bit_cast<std::uint32_t>(b.t[ray]);
    if (a.id[ray] != b.id[ray] || (shot.with_distances && !same_t)) result |= 1u << ray;
  }
  return result;
}

Hits oracle_hits(const PlacedSolid& solid, const Shot& shot, Accuracy accuracy) {
  Hits hits;
  for (std::uint32_t ray = 0; ray < watertight::kShotRays; ++ray) {
    hits.t[ray] = kFloatMax;
    hits.id[ray] = kNothing;
    if ((shot.active >> ray & 1u) == 0) continue;
    const OracleRay asked{{shot.origin[0], shot.origin[1], shot.origin[2]},
                          {shot.dir[0][ray], shot.dir[1][ray], shot.dir[2][ray]}};
    const NearestHit nearest = solid.oracle().nearest(asked);
    const auto& ties = accuracy == Accuracy::kExact ? nearest.ties : nearest.float_ties;
    if (!ties.empty()) hits.id[ray] = ties.front();
    hits.t[ray] = nearest.t;
  }
  return hits;
}

// Shoots one packet at a time; a thread has its own.
class Shooting {
 public:
  Shooting(const PlacedSolid& solid, RayKind kind, std::span<const Machine> machines, std::span<const Peer> peers,
           const TallyOptions& options)
      : solid_(solid), kind_(kind), machines_(machines), peers_(peers), options_(options) {
    tally_.machines.resize(machines.size());
    for (MachineTally& machine : tally_.machines) machine.peer_misses.resize(peers.size());
  }

  void shoot(std::uint64_t packet) {
    const std::uint64_t seed = options_.first_seed + packet;
    // Neighbouring seeds are neighbours in the generator's sequence: jump.
    const std::uint64_t jumped = TestRandom(seed * 0x100000001B3u + static_cast<std::uint64_t>(kind_)).next();
    Shot shot;
    if (!aim(solid_, kind_, jumped, shot)) {
      ++tally_.lost_packets;
      return;
    }
    solid_.add_candidates(shot, records_);
    ++tally_.packets;
    tally_.rays += static_cast<std::uint64_t>(std::popcount(shot.active));
    Hits first[kProfileCount];
    for (std::size_t i = 0; i < machines_.size(); ++i) {
      const Machine& machine = machines_[i];
      MachineTally& own = tally_.machines[i];
      const RoundingGuard guard(machine);
      for (std::size_t p = 0; p < kProfileCount; ++p) {
        if (!takes_part(p)) continue;
        Hits hits;
        machine.shoot(shot, static_cast<std::uint32_t>(kProfiles[p].accuracy), hits);
        if (i == 0) first[p] = hits;
        const std::uint32_t missed = shot.active & ~rays_that_hit(shot, hits);
        const std::uint32_t differing = rays_that_differ(shot, hits, first[p]);
        own.misses[p] += static_cast<std::uint64_t>(std::popcount(missed));
        own.differences[p] += static_cast<std::uint64_t>(std::popcount(differing));
        if (kProfiles[p].is_watertight && machine.is_promised && (missed | differing) != 0) {
          fail(seed, missed != 0 ? "a miss" : "another hit", machine.name, p, missed != 0 ? missed : differing, shot);
        }
      }
      if (i > 0 && !shoots_anew(machine)) continue;
      for (std::size_t p = 0; p < peers_.size(); ++p) {
        const std::uint32_t missed = shot.active & ~peers_[p](shot, machine.peer_width);
        own.peer_misses[p] += static_cast<std::uint64_t>(std::popcount(missed));
      }
    }
    if (options_.oracle_stride != 0 && packet % options_.oracle_stride == 0) ask_oracle(seed, shot, first);
  }

  // What a peer does under a machine that has nothing for it to do otherwise is what it did under the first.
  [[nodiscard]] Tally finish() {
    for (std::size_t i = 1; i < machines_.size(); ++i) {
      if (!shoots_anew(machines_[i])) tally_.machines[i].peer_misses = tally_.machines[0].peer_misses;
    }
    return std::move(tally_);
  }

 private:
  [[nodiscard]] bool takes_part(std::size_t profile) const {
    return kProfiles[profile].is_on_lattice == solid_.is_on_lattice();
  }
  [[nodiscard]] bool shoots_anew(const Machine& machine) const {
    return machine.rounding != machines_[0].rounding || machine.flushes_denormals ||
           machine.peer_width != machines_[0].peer_width;
  }

  void ask_oracle(std::uint64_t seed, const Shot& shot, const Hits (&first)[kProfileCount]) {
    tally_.asked_rays += static_cast<std::uint64_t>(std::popcount(shot.active));
    for (std::size_t p = 0; p < kProfileCount; ++p) {
      if (!kProfiles[p].is_watertight || !takes_part(p)) continue;
      const std::uint32_t wrong = rays_that_differ(shot, first[p], oracle_hits(solid_, shot, kProfiles[p].accuracy));
      tally_.oracle_differences[p] += static_cast<std::uint64_t>(std::popcount(wrong));
      if (wrong != 0) fail(seed, "not the oracle's hit", machines_[0].name, p, wrong, shot);
    }
  }

  void fail(std::uint64_t seed, const char* what, const char* machine, std::size_t profile, std::uint32_t rays,
            const Shot& shot) {
    if (!tally_.first_failure.empty()) return;
    const int ray = std::countr_zero(rays);
    std::ostringstream words;
    words << kProfiles[profile].name << ", " << machine << ": " << what << ", " << name_of(kind_) << " rays, seed "
          << seed << ", ray " << ray << std::hexfloat << ", from";
    for (const float component : shot.origin) words << ' ' << component;
    words << ", along";
    for (const auto& component : shot.dir) words << ' ' << component[ray];
    tally_.first_failure = words.str();
  }

  const PlacedSolid& solid_;
  RayKind kind_;
  std::span<const Machine> machines_;
  std::span<const Peer> peers_;
  const TallyOptions& options_;
  Tally tally_;
  CandidateRecords records_;
};

}  // namespace

void Tally::add(const Tally& other) {
  packets += other.packets;
  rays += other.rays;
  lost_packets += other.lost_packets;
  asked_rays += other.asked_rays;
  machines.resize(std::max(machines.size(), other.machines.size()));
  for (std::size_t p = 0; p < kProfileCount; ++p) oracle_differences[p] += other.oracle_differences[p];
  for (std::size_t i = 0; i < other.machines.size(); ++i) {
    for (std::size_t p = 0; p < kProfileCount; ++p) {
      machines[i].misses[p] += other.machines[i].misses[p];
      machines[i].differences[p] += other.machines[i].differences[p];
    }
    machines[i].peer_misses.resize(other.machines[i].peer_misses.size());
    for (std::size_t p = 0; p < other.machines[i].peer_misses.size(); ++p) {
      machines[i].peer_misses[p] += other.machines[i].peer_misses[p];
    }
  }
  if (first_failure.empty()) first_failure = other.first_failure;
}

Tally shoot_all(const PlacedSolid& solid, RayKind kind, std::span<const Machine> machines, std::span<const Peer> peers,
                const TallyOptions& options) {
  const std::uint64_t packets = (options.rays + rays_of(kind) - 1) / rays_of(kind);
  const std::uint64_t chunks = (packets + kChunkPackets - 1) / kChunkPackets;
  std::vector<Tally> parts(chunks);
  std::atomic<std::uint64_t> next_chunk = 0;
  const auto work = [&] {
    for (std::uint64_t chunk = next_chunk++; chunk < chunks; chunk = next_chunk++) {
      Shooting shooting(solid, kind, machines, peers, options);
      const std::uint64_t end = std::min(packets, (chunk + 1) * kChunkPackets);
      for (std::uint64_t packet = chunk * kChunkPackets; packet < end; ++packet) shooting.shoot(packet);
      parts[chunk] = shooting.finish();
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < options.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  Tally sum;
  for (const Tally& part : parts) sum.add(part);
  return sum;
}

}  // namespace gridiron::test
