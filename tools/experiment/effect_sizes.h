// Effect sizes: what a renderer built for a set of effects takes of a core, on riscv64.
// tools/house/effect_sizes wrote it.
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
    EffectSize{0x000, 54148, 163840, 0, 0, false},  // none
    EffectSize{0x200, 61108, 126464, 25202, 14592, true},  // scene shading
    EffectSize{0x201, 81316, 126464, 26080, 14592, true},  // + point shadows
    EffectSize{0x202, 81960, 126464, 26722, 14592, true},  // + area lights
    EffectSize{0x204, 83170, 144768, 26782, 16768, true},  // + reflection
    EffectSize{0x208, 84184, 144768, 27796, 16768, true},  // + refraction
    EffectSize{0x210, 82552, 126464, 27320, 14592, true},  // + ambient occlusion
    EffectSize{0x220, 63092, 126464, 27190, 14592, true},  // + environment
    EffectSize{0x240, 62470, 126464, 26558, 14592, true},  // + smooth normals
    EffectSize{0x280, 61850, 126464, 25944, 14592, true},  // + highlights
    EffectSize{0x300, 61470, 126464, 25508, 14592, true},  // + multisampling
    EffectSize{0x3fe, 92656, 144768, 36616, 16768, true},  // all but point shadows
    EffectSize{0x3fd, 91638, 144768, 35580, 16768, true},  // all but area lights
    EffectSize{0x3fb, 92648, 144768, 36608, 16768, true},  // all but reflection
    EffectSize{0x3f7, 91624, 144768, 35584, 16768, true},  // all but refraction
    EffectSize{0x3ef, 90160, 144768, 34086, 16768, true},  // all but ambient occlusion
    EffectSize{0x3df, 90678, 144768, 34634, 16768, true},  // all but environment
    EffectSize{0x3bf, 91260, 144768, 35230, 16768, true},  // all but smooth normals
    EffectSize{0x37f, 91906, 144768, 35866, 16768, true},  // all but highlights
    EffectSize{0x2ff, 92286, 144768, 36284, 16768, true},  // all but multisampling
    EffectSize{0x3ff, 92648, 144768, 36608, 16768, true},  // all
};

}  // namespace gridiron::experiment
