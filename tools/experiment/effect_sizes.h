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
    EffectSize{0x000, 46424, 118272, 0, 0, false},  // none
    EffectSize{0x200, 52856, 139648, 24074, 18048, true},  // scene shading
    EffectSize{0x201, 84292, 139648, 25518, 18048, true},  // + point shadows
    EffectSize{0x202, 85032, 139648, 26298, 18048, true},  // + area lights
    EffectSize{0x204, 85296, 157952, 25764, 20224, true},  // + reflection
    EffectSize{0x208, 86394, 157952, 26892, 20224, true},  // + refraction
    EffectSize{0x210, 85042, 139648, 26376, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 54866, 139648, 26086, 18048, true},  // + environment
    EffectSize{0x240, 54236, 139648, 25490, 18048, true},  // + smooth normals
    EffectSize{0x280, 53598, 139648, 24816, 18048, true},  // + highlights
    EffectSize{0x300, 53390, 139648, 24396, 18048, true},  // + multisampling
    EffectSize{0x3fe, 96044, 157952, 35782, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 95228, 157952, 34966, 20224, true},  // all but area lights
    EffectSize{0x3fb, 96044, 157952, 35782, 20224, true},  // all but reflection
    EffectSize{0x3f7, 94908, 157952, 34646, 20224, true},  // all but refraction
    EffectSize{0x3ef, 93684, 157952, 33546, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 93970, 157952, 33740, 20224, true},  // all but environment
    EffectSize{0x3bf, 94630, 157952, 34342, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 95304, 157952, 35042, 20224, true},  // all but highlights
    EffectSize{0x2ff, 95494, 157952, 35454, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 96036, 157952, 35774, 20224, true},  // all
};

}  // namespace gridiron::experiment
