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
    EffectSize{0x200, 52856, 139648, 24068, 18048, true},  // scene shading
    EffectSize{0x201, 84282, 139648, 25512, 18048, true},  // + point shadows
    EffectSize{0x202, 85022, 139648, 26292, 18048, true},  // + area lights
    EffectSize{0x204, 85286, 157952, 25758, 20224, true},  // + reflection
    EffectSize{0x208, 86384, 157952, 26886, 20224, true},  // + refraction
    EffectSize{0x210, 85032, 139648, 26370, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 54866, 139648, 26080, 18048, true},  // + environment
    EffectSize{0x240, 54236, 139648, 25484, 18048, true},  // + smooth normals
    EffectSize{0x280, 53598, 139648, 24810, 18048, true},  // + highlights
    EffectSize{0x300, 53390, 139648, 24390, 18048, true},  // + multisampling
    EffectSize{0x3fe, 96034, 157952, 35776, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 95218, 157952, 34960, 20224, true},  // all but area lights
    EffectSize{0x3fb, 96034, 157952, 35776, 20224, true},  // all but reflection
    EffectSize{0x3f7, 94898, 157952, 34640, 20224, true},  // all but refraction
    EffectSize{0x3ef, 93674, 157952, 33540, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 93960, 157952, 33734, 20224, true},  // all but environment
    EffectSize{0x3bf, 94620, 157952, 34336, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 95294, 157952, 35036, 20224, true},  // all but highlights
    EffectSize{0x2ff, 95484, 157952, 35448, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 96026, 157952, 35768, 20224, true},  // all
};

}  // namespace gridiron::experiment
