// Builds and rules of floating point: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/machines.h"

#include <cfenv>
#include <vector>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// The entries of the builds, each in the namespace that core has there.
#define WATERTIGHT_BUILD(space)                                                                   \
  namespace space {                                                                               \
  void shoot(const watertight::Shot& shot, std::uint32_t accuracy_value, watertight::Hits& hits); \
  }
WATERTIGHT_BUILD(gridiron_lanes4)
WATERTIGHT_BUILD(gridiron_lanes8)
WATERTIGHT_BUILD(gridiron_lanes16)
WATERTIGHT_BUILD(gridiron_fused)
WATERTIGHT_BUILD(gridiron_contracted)
WATERTIGHT_BUILD(gridiron_cell)
#undef WATERTIGHT_BUILD

namespace gridiron::test {
namespace {

std::vector<Machine> find_machines() {
  std::vector<Machine> found = {{"4 lanes, to nearest", gridiron_lanes4::shoot, FE_TONEAREST, false, true}};
  found.push_back({"8 lanes", gridiron_lanes8::shoot, FE_TONEAREST, false, true, 8});
  found.push_back({"16 lanes", gridiron_lanes16::shoot, FE_TONEAREST, false, true, 16});
  found.push_back({"to zero, flushed", gridiron_lanes4::shoot, FE_TOWARDZERO, true, true});
  found.push_back({"up", gridiron_lanes4::shoot, FE_UPWARD, false, true});
  found.push_back({"down", gridiron_lanes4::shoot, FE_DOWNWARD, false, true});
#if defined(WATERTIGHT_FMA)
  found.push_back({"FMA, not contracted", gridiron_fused::shoot, FE_TONEAREST, false, true});
  found.push_back({"FMA, contracted", gridiron_contracted::shoot, FE_TONEAREST, false, false});
#endif
  found.push_back({"Cell floats", gridiron_cell::shoot, FE_TONEAREST, false, true});
  return found;
}

}  // namespace

std::span<const Machine> machines() {
  static const std::vector<Machine> all = find_machines();
  return all;
}

RoundingGuard::RoundingGuard(const Machine& machine) : rounding_(std::fegetround()) {
#if defined(__SSE2__)
  control_ = _mm_getcsr();
  constexpr unsigned kFlush = 0x8040u;  // results to zero, operands as zero
  if (machine.flushes_denormals) _mm_setcsr(control_ | kFlush);
#endif
  std::fesetround(machine.rounding);
}

RoundingGuard::~RoundingGuard() {
  std::fesetround(rounding_);
#if defined(__SSE2__)
  _mm_setcsr(control_);
#endif
}

}  // namespace gridiron::test
