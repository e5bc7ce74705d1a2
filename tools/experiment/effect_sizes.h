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
    EffectSize{0x000, 54762, 163968, 0, 0, false},  // none
    EffectSize{0x200, 61224, 140288, 23584, 18048, true},  // scene shading
    EffectSize{0x201, 79128, 140288, 25016, 18048, true},  // + point shadows
    EffectSize{0x202, 79890, 140288, 25772, 18048, true},  // + area lights
    EffectSize{0x204, 80230, 158592, 25270, 20224, true},  // + reflection
    EffectSize{0x208, 81358, 158592, 26398, 20224, true},  // + refraction
    EffectSize{0x210, 79994, 140288, 25866, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 63248, 140288, 25596, 18048, true},  // + environment
    EffectSize{0x240, 62648, 140288, 25000, 18048, true},  // + smooth normals
    EffectSize{0x280, 61966, 140288, 24326, 18048, true},  // + highlights
    EffectSize{0x300, 61746, 140288, 23912, 18048, true},  // + multisampling
    EffectSize{0x3fe, 90910, 158592, 35258, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 90080, 158592, 34442, 20224, true},  // all but area lights
    EffectSize{0x3fb, 90910, 158592, 35258, 20224, true},  // all but reflection
    EffectSize{0x3f7, 89774, 158592, 34122, 20224, true},  // all but refraction
    EffectSize{0x3ef, 88554, 158592, 33018, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 88822, 158592, 33216, 20224, true},  // all but environment
    EffectSize{0x3bf, 89466, 158592, 33818, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 90170, 158592, 34518, 20224, true},  // all but highlights
    EffectSize{0x2ff, 90364, 158592, 34926, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 90902, 158592, 35250, 20224, true},  // all
};

}  // namespace gridiron::experiment
