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
    EffectSize{0x000, 54916, 163968, 0, 0, false},  // none
    EffectSize{0x200, 61378, 140288, 24086, 18048, true},  // scene shading
    EffectSize{0x201, 79506, 140288, 25520, 18048, true},  // + point shadows
    EffectSize{0x202, 80280, 140288, 26288, 18048, true},  // + area lights
    EffectSize{0x204, 80608, 158592, 25772, 20224, true},  // + reflection
    EffectSize{0x208, 81736, 158592, 26900, 20224, true},  // + refraction
    EffectSize{0x210, 80384, 140288, 26382, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 63402, 140288, 26098, 18048, true},  // + environment
    EffectSize{0x240, 62802, 140288, 25502, 18048, true},  // + smooth normals
    EffectSize{0x280, 62120, 140288, 24828, 18048, true},  // + highlights
    EffectSize{0x300, 61900, 140288, 24410, 18048, true},  // + multisampling
    EffectSize{0x3fe, 91300, 158592, 35772, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 90470, 158592, 34956, 20224, true},  // all but area lights
    EffectSize{0x3fb, 91300, 158592, 35772, 20224, true},  // all but reflection
    EffectSize{0x3f7, 90164, 158592, 34636, 20224, true},  // all but refraction
    EffectSize{0x3ef, 88942, 158592, 33530, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 89212, 158592, 33730, 20224, true},  // all but environment
    EffectSize{0x3bf, 89856, 158592, 34332, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 90560, 158592, 35032, 20224, true},  // all but highlights
    EffectSize{0x2ff, 90758, 158592, 35444, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 91292, 158592, 35764, 20224, true},  // all
};

}  // namespace gridiron::experiment
