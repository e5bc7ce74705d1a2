// Machines: the builds of core's intersectors and the floating-point rules that the suite runs them under.
// Memory: constants. Threads: any; a RoundingGuard is the calling thread's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/records.h>

#include <iterator>
#include <span>

#include "numeric/watertight/shot.h"

namespace gridiron::test {

/// An accuracy that is shot with, and what it promises of rays from inside a closed mesh.
struct Profile {
  const char* name;
  Accuracy accuracy;
  bool is_watertight;  ///< else what it misses is only counted
  bool is_on_lattice;  ///< of meshes whose vertices have been moved to their lattice
};
consteval Profile profile_of(const char* name, Accuracy accuracy) {
  const AccuracyTraits traits = accuracy_traits(accuracy);
  return {name, accuracy, !traits.may_leak, traits.format == TriangleFormat::kLattice};
}
inline constexpr Profile kProfiles[] = {
    profile_of("standard", Accuracy::kStandard), profile_of("exact", Accuracy::kExact),
    profile_of("compact", Accuracy::kCompact),   profile_of("fast", Accuracy::kFast),
    profile_of("paper", Accuracy::kPaper),
};
static_assert(std::size(kProfiles) == kAccuracyCount);

/// A build of the intersectors, and the rules of floating point that hold while it runs.
struct Machine {
  const char* name;
  watertight::Shooter shoot;
  int rounding;            ///< of <cfenv>
  bool flushes_denormals;  ///< to zero, those that go in and those that come out
  bool is_promised;        ///< false: it shows what would break
  /// The rays of Embree's calls, for comparison.
  std::uint32_t peer_width = 1;
};

/// The first is the base case: four lanes, to nearest. Then eight and sixteen lanes; to zero, up and down; with
/// instructions that fuse, unused and used; over numbers that are as the Cell's. Those that this host cannot run are
/// not there.
[[nodiscard]] std::span<const Machine> machines();

/// Sets a machine's rules of floating point for as long as it lives.
class RoundingGuard {
 public:
  explicit RoundingGuard(const Machine& machine);
  ~RoundingGuard();
  RoundingGuard(const RoundingGuard&) = delete;
  RoundingGuard& operator=(const RoundingGuard&) = delete;

 private:
  unsigned control_ = 0;
  int rounding_ = 0;
};

}  // namespace gridiron::test
