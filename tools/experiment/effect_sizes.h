// Code and data of a core for sets of effects, as measured from cross-compiled firmware. Empty: not measured.
// Memory: one table. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace gridiron::experiment {

/// What a core built for a set of effects takes of its local store, in bytes.
struct EffectSize {
  std::uint32_t effects;  ///< EffectBits
  std::uint32_t code_bytes_256k;
  std::uint32_t store_bytes_256k;
  std::uint32_t code_bytes_64k;
  std::uint32_t store_bytes_64k;
  bool fits_64k;
};

inline constexpr std::array<EffectSize, 0> kEffectSizes{};

}  // namespace gridiron::experiment
