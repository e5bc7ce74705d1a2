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
    EffectSize{0x000, 54180, 163840, 0, 0, false},  // none
    EffectSize{0x200, 60436, 126592, 25120, 14720, true},  // scene shading
    EffectSize{0x201, 80060, 126592, 26230, 14720, true},  // + point shadows
    EffectSize{0x202, 80722, 126592, 26896, 14720, true},  // + area lights
    EffectSize{0x204, 81186, 144896, 26642, 16896, true},  // + reflection
    EffectSize{0x208, 82200, 144896, 27656, 16896, true},  // + refraction
    EffectSize{0x210, 80936, 126592, 27086, 14720, true},  // + ambient occlusion
    EffectSize{0x220, 62396, 126592, 27080, 14720, true},  // + environment
    EffectSize{0x240, 61766, 126592, 26442, 14720, true},  // + smooth normals
    EffectSize{0x280, 61178, 126592, 25862, 14720, true},  // + highlights
    EffectSize{0x300, 60958, 126592, 25278, 14720, true},  // + multisampling
    EffectSize{0x3fe, 91316, 144896, 36210, 16896, true},  // all but point shadows
    EffectSize{0x3fd, 90230, 144896, 35158, 16896, true},  // all but area lights
    EffectSize{0x3fb, 91316, 144896, 36210, 16896, true},  // all but reflection
    EffectSize{0x3f7, 90292, 144896, 35186, 16896, true},  // all but refraction
    EffectSize{0x3ef, 88942, 144896, 33848, 16896, true},  // all but ambient occlusion
    EffectSize{0x3df, 89346, 144896, 34264, 16896, true},  // all but environment
    EffectSize{0x3bf, 89936, 144896, 34848, 16896, true},  // all but smooth normals
    EffectSize{0x37f, 90576, 144896, 35470, 16896, true},  // all but highlights
    EffectSize{0x2ff, 90776, 144896, 35866, 16896, true},  // all but multisampling
    EffectSize{0x3ff, 91310, 144896, 36204, 16896, true},  // all
};

}  // namespace gridiron::experiment
