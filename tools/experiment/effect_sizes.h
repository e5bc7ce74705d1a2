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
    EffectSize{0x000, 54820, 163968, 0, 0, false},  // none
    EffectSize{0x200, 61282, 140288, 23990, 18048, true},  // scene shading
    EffectSize{0x201, 79410, 140288, 25424, 18048, true},  // + point shadows
    EffectSize{0x202, 80184, 140288, 26192, 18048, true},  // + area lights
    EffectSize{0x204, 80512, 158592, 25676, 20224, true},  // + reflection
    EffectSize{0x208, 81640, 158592, 26804, 20224, true},  // + refraction
    EffectSize{0x210, 80288, 140288, 26286, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 63306, 140288, 26002, 18048, true},  // + environment
    EffectSize{0x240, 62706, 140288, 25406, 18048, true},  // + smooth normals
    EffectSize{0x280, 62024, 140288, 24732, 18048, true},  // + highlights
    EffectSize{0x300, 61804, 140288, 24314, 18048, true},  // + multisampling
    EffectSize{0x3fe, 91204, 158592, 35676, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 90374, 158592, 34860, 20224, true},  // all but area lights
    EffectSize{0x3fb, 91204, 158592, 35676, 20224, true},  // all but reflection
    EffectSize{0x3f7, 90068, 158592, 34540, 20224, true},  // all but refraction
    EffectSize{0x3ef, 88846, 158592, 33434, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 89116, 158592, 33634, 20224, true},  // all but environment
    EffectSize{0x3bf, 89760, 158592, 34236, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 90464, 158592, 34936, 20224, true},  // all but highlights
    EffectSize{0x2ff, 90662, 158592, 35348, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 91196, 158592, 35668, 20224, true},  // all
};

}  // namespace gridiron::experiment
