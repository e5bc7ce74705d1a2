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
    EffectSize{0x000, 54190, 163840, 0, 0, false},  // none
    EffectSize{0x200, 60446, 126592, 25114, 14720, true},  // scene shading
    EffectSize{0x201, 80064, 126592, 26224, 14720, true},  // + point shadows
    EffectSize{0x202, 80726, 126592, 26890, 14720, true},  // + area lights
    EffectSize{0x204, 81190, 144896, 26636, 16896, true},  // + reflection
    EffectSize{0x208, 82204, 144896, 27650, 16896, true},  // + refraction
    EffectSize{0x210, 80940, 126592, 27080, 14720, true},  // + ambient occlusion
    EffectSize{0x220, 62406, 126592, 27074, 14720, true},  // + environment
    EffectSize{0x240, 61776, 126592, 26436, 14720, true},  // + smooth normals
    EffectSize{0x280, 61188, 126592, 25856, 14720, true},  // + highlights
    EffectSize{0x300, 60968, 126592, 25272, 14720, true},  // + multisampling
    EffectSize{0x3fe, 91320, 144896, 36204, 16896, true},  // all but point shadows
    EffectSize{0x3fd, 90234, 144896, 35152, 16896, true},  // all but area lights
    EffectSize{0x3fb, 91320, 144896, 36204, 16896, true},  // all but reflection
    EffectSize{0x3f7, 90296, 144896, 35180, 16896, true},  // all but refraction
    EffectSize{0x3ef, 88946, 144896, 33842, 16896, true},  // all but ambient occlusion
    EffectSize{0x3df, 89350, 144896, 34258, 16896, true},  // all but environment
    EffectSize{0x3bf, 89940, 144896, 34842, 16896, true},  // all but smooth normals
    EffectSize{0x37f, 90580, 144896, 35464, 16896, true},  // all but highlights
    EffectSize{0x2ff, 90780, 144896, 35860, 16896, true},  // all but multisampling
    EffectSize{0x3ff, 91314, 144896, 36198, 16896, true},  // all
};

}  // namespace gridiron::experiment
