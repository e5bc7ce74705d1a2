// Effect sizes: what a renderer built for a set of effects takes of a core, on riscv64.
// tools/checks/memory_table --effects wrote the rows.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace gridiron::experiment {

/// Bytes of one build. `effects` are EffectBits; 0 is StoreLayout256K<32>, which has no counterpart of 64 KB here.
struct EffectSize {
  std::uint32_t effects;
  std::uint32_t code_bytes_256k;   ///< EffectLayout256K<effects, 32>, the kernel's library included
  std::uint32_t store_bytes_256k;
  std::uint32_t code_bytes_64k;    ///< EffectLayout64K<effects>
  std::uint32_t store_bytes_64k;
  bool fits_64k;                   ///< code, store and the deepest stack in 65,536 bytes
};

inline constexpr std::array kEffectSizes{
    EffectSize{0x000, 46438, 118272, 0, 0, false},  // none
    EffectSize{0x200, 53600, 139648, 24576, 18048, true},  // scene shading
    EffectSize{0x201, 84812, 139648, 25868, 18048, true},  // + point shadows
    EffectSize{0x202, 85552, 139648, 26648, 18048, true},  // + area lights
    EffectSize{0x204, 85792, 157952, 26432, 20224, true},  // + reflection
    EffectSize{0x208, 86890, 157952, 27560, 20224, true},  // + refraction
    EffectSize{0x210, 85534, 139648, 26712, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 55610, 139648, 26588, 18048, true},  // + environment
    EffectSize{0x240, 54980, 139648, 25992, 18048, true},  // + smooth normals
    EffectSize{0x280, 53918, 139648, 24894, 18048, true},  // + highlights
    EffectSize{0x300, 54096, 139648, 24860, 18048, true},  // + multisampling
    EffectSize{0x600, 53600, 139648, 24576, 18048, true},  // + vertex colors
    EffectSize{0x7fe, 96018, 157952, 35726, 20224, true},  // all but point shadows
    EffectSize{0x7fd, 95202, 157952, 34910, 20224, true},  // all but area lights
    EffectSize{0x7fb, 96018, 157952, 35726, 20224, true},  // all but reflection
    EffectSize{0x7f7, 94862, 157952, 34570, 20224, true},  // all but refraction
    EffectSize{0x7ef, 93858, 157952, 33634, 20224, true},  // all but ambient occlusion
    EffectSize{0x7df, 93944, 157952, 33684, 20224, true},  // all but environment
    EffectSize{0x7bf, 94430, 157952, 34112, 20224, true},  // all but smooth normals
    EffectSize{0x77f, 95702, 157952, 35410, 20224, true},  // all but highlights
    EffectSize{0x6ff, 95506, 157952, 35594, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 95848, 157952, 35556, 20224, true},  // all but vertex colors
    EffectSize{0x7ff, 96010, 157952, 35718, 20224, true},  // all
};

}  // namespace gridiron::experiment
