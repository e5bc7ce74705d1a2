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
    EffectSize{0x000, 46426, 118272, 0, 0, false},  // none
    EffectSize{0x200, 52866, 139648, 23820, 18048, true},  // scene shading
    EffectSize{0x201, 84078, 139648, 25122, 18048, true},  // + point shadows
    EffectSize{0x202, 84818, 139648, 25902, 18048, true},  // + area lights
    EffectSize{0x204, 85054, 157952, 25688, 20224, true},  // + reflection
    EffectSize{0x208, 86152, 157952, 26816, 20224, true},  // + refraction
    EffectSize{0x210, 84800, 139648, 25966, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 54876, 139648, 25832, 18048, true},  // + environment
    EffectSize{0x240, 54246, 139648, 25236, 18048, true},  // + smooth normals
    EffectSize{0x280, 53608, 139648, 24562, 18048, true},  // + highlights
    EffectSize{0x300, 53400, 139648, 24142, 18048, true},  // + multisampling
    EffectSize{0x3fe, 95566, 157952, 35250, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 94750, 157952, 34434, 20224, true},  // all but area lights
    EffectSize{0x3fb, 95566, 157952, 35250, 20224, true},  // all but reflection
    EffectSize{0x3f7, 94430, 157952, 34114, 20224, true},  // all but refraction
    EffectSize{0x3ef, 93342, 157952, 33160, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 93492, 157952, 33208, 20224, true},  // all but environment
    EffectSize{0x3bf, 94152, 157952, 33810, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 94826, 157952, 34510, 20224, true},  // all but highlights
    EffectSize{0x2ff, 95014, 157952, 35096, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 95558, 157952, 35242, 20224, true},  // all
};

}  // namespace gridiron::experiment
