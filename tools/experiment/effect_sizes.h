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
    EffectSize{0x200, 61204, 126464, 25292, 14592, true},  // scene shading
    EffectSize{0x201, 81412, 126464, 26170, 14592, true},  // + point shadows
    EffectSize{0x202, 82056, 126464, 26812, 14592, true},  // + area lights
    EffectSize{0x204, 83266, 144768, 26884, 16768, true},  // + reflection
    EffectSize{0x208, 84280, 144768, 27898, 16768, true},  // + refraction
    EffectSize{0x210, 82648, 126464, 27410, 14592, true},  // + ambient occlusion
    EffectSize{0x220, 63188, 126464, 27280, 14592, true},  // + environment
    EffectSize{0x240, 62566, 126464, 26648, 14592, true},  // + smooth normals
    EffectSize{0x280, 61946, 126464, 26034, 14592, true},  // + highlights
    EffectSize{0x300, 61566, 126464, 25604, 14592, true},  // + multisampling
    EffectSize{0x3fe, 92752, 144768, 36710, 16768, true},  // all but point shadows
    EffectSize{0x3fd, 91734, 144768, 35674, 16768, true},  // all but area lights
    EffectSize{0x3fb, 92744, 144768, 36702, 16768, true},  // all but reflection
    EffectSize{0x3f7, 91720, 144768, 35678, 16768, true},  // all but refraction
    EffectSize{0x3ef, 90256, 144768, 34180, 16768, true},  // all but ambient occlusion
    EffectSize{0x3df, 90774, 144768, 34728, 16768, true},  // all but environment
    EffectSize{0x3bf, 91356, 144768, 35324, 16768, true},  // all but smooth normals
    EffectSize{0x37f, 92002, 144768, 35960, 16768, true},  // all but highlights
    EffectSize{0x2ff, 92382, 144768, 36386, 16768, true},  // all but multisampling
    EffectSize{0x3ff, 92744, 144768, 36702, 16768, true},  // all
};

}  // namespace gridiron::experiment
