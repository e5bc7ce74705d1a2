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
    EffectSize{0x000, 54794, 163968, 0, 0, false},  // none
    EffectSize{0x200, 60840, 126720, 24948, 14848, true},  // scene shading
    EffectSize{0x201, 80450, 126720, 26056, 14848, true},  // + point shadows
    EffectSize{0x202, 81110, 126720, 26702, 14848, true},  // + area lights
    EffectSize{0x204, 81588, 145024, 26478, 17024, true},  // + reflection
    EffectSize{0x208, 82602, 145024, 27486, 17024, true},  // + refraction
    EffectSize{0x210, 81336, 126720, 26932, 14848, true},  // + ambient occlusion
    EffectSize{0x220, 62804, 126720, 26914, 14848, true},  // + environment
    EffectSize{0x240, 62188, 126720, 26302, 14848, true},  // + smooth normals
    EffectSize{0x280, 61582, 126720, 25690, 14848, true},  // + highlights
    EffectSize{0x300, 61370, 126720, 25110, 14848, true},  // + multisampling
    EffectSize{0x3fe, 91754, 145024, 36066, 17024, true},  // all but point shadows
    EffectSize{0x3fd, 90686, 145024, 35016, 17024, true},  // all but area lights
    EffectSize{0x3fb, 91754, 145024, 36066, 17024, true},  // all but reflection
    EffectSize{0x3f7, 90730, 145024, 35042, 17024, true},  // all but refraction
    EffectSize{0x3ef, 89382, 145024, 33686, 17024, true},  // all but ambient occlusion
    EffectSize{0x3df, 89776, 145024, 34120, 17024, true},  // all but environment
    EffectSize{0x3bf, 90354, 145024, 34672, 17024, true},  // all but smooth normals
    EffectSize{0x37f, 91014, 145024, 35326, 17024, true},  // all but highlights
    EffectSize{0x2ff, 91204, 145024, 35742, 17024, true},  // all but multisampling
    EffectSize{0x3ff, 91748, 145024, 36060, 17024, true},  // all
};

}  // namespace gridiron::experiment
