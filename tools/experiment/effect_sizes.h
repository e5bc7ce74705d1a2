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
    EffectSize{0x000, 54194, 163840, 0, 0, false},  // none
    EffectSize{0x200, 60242, 126592, 24920, 14720, true},  // scene shading
    EffectSize{0x201, 79860, 126592, 26030, 14720, true},  // + point shadows
    EffectSize{0x202, 80522, 126592, 26696, 14720, true},  // + area lights
    EffectSize{0x204, 80986, 144896, 26442, 16896, true},  // + reflection
    EffectSize{0x208, 82000, 144896, 27456, 16896, true},  // + refraction
    EffectSize{0x210, 80736, 126592, 26886, 14720, true},  // + ambient occlusion
    EffectSize{0x220, 62202, 126592, 26880, 14720, true},  // + environment
    EffectSize{0x240, 61572, 126592, 26242, 14720, true},  // + smooth normals
    EffectSize{0x280, 60984, 126592, 25662, 14720, true},  // + highlights
    EffectSize{0x300, 60764, 126592, 25078, 14720, true},  // + multisampling
    EffectSize{0x3fe, 91116, 144896, 36010, 16896, true},  // all but point shadows
    EffectSize{0x3fd, 90030, 144896, 34958, 16896, true},  // all but area lights
    EffectSize{0x3fb, 91116, 144896, 36010, 16896, true},  // all but reflection
    EffectSize{0x3f7, 90092, 144896, 34986, 16896, true},  // all but refraction
    EffectSize{0x3ef, 88742, 144896, 33648, 16896, true},  // all but ambient occlusion
    EffectSize{0x3df, 89146, 144896, 34064, 16896, true},  // all but environment
    EffectSize{0x3bf, 89736, 144896, 34648, 16896, true},  // all but smooth normals
    EffectSize{0x37f, 90376, 144896, 35270, 16896, true},  // all but highlights
    EffectSize{0x2ff, 90576, 144896, 35666, 16896, true},  // all but multisampling
    EffectSize{0x3ff, 91110, 144896, 36004, 16896, true},  // all
};

}  // namespace gridiron::experiment
