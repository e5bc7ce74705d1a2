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
    EffectSize{0x000, 54110, 163840, 0, 0, false},  // none
    EffectSize{0x200, 61068, 126464, 25154, 14592, true},  // scene shading
    EffectSize{0x201, 80876, 126464, 26032, 14592, true},  // + point shadows
    EffectSize{0x202, 81520, 126464, 26674, 14592, true},  // + area lights
    EffectSize{0x204, 83130, 144768, 26734, 16768, true},  // + reflection
    EffectSize{0x208, 84144, 144768, 27748, 16768, true},  // + refraction
    EffectSize{0x210, 82112, 126464, 27272, 14592, true},  // + ambient occlusion
    EffectSize{0x220, 63052, 126464, 27142, 14592, true},  // + environment
    EffectSize{0x240, 62430, 126464, 26510, 14592, true},  // + smooth normals
    EffectSize{0x280, 61810, 126464, 25896, 14592, true},  // + highlights
    EffectSize{0x300, 61430, 126464, 25458, 14592, true},  // + multisampling
    EffectSize{0x3fe, 92616, 144768, 36214, 16768, true},  // all but point shadows
    EffectSize{0x3fd, 91598, 144768, 35178, 16768, true},  // all but area lights
    EffectSize{0x3fb, 92608, 144768, 36206, 16768, true},  // all but reflection
    EffectSize{0x3f7, 91584, 144768, 35182, 16768, true},  // all but refraction
    EffectSize{0x3ef, 90120, 144768, 33684, 16768, true},  // all but ambient occlusion
    EffectSize{0x3df, 90638, 144768, 34232, 16768, true},  // all but environment
    EffectSize{0x3bf, 91220, 144768, 34828, 16768, true},  // all but smooth normals
    EffectSize{0x37f, 91866, 144768, 35464, 16768, true},  // all but highlights
    EffectSize{0x2ff, 92246, 144768, 35884, 16768, true},  // all but multisampling
    EffectSize{0x3ff, 92608, 144768, 36206, 16768, true},  // all
};

}  // namespace gridiron::experiment
