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
    EffectSize{0x000, 46438, 118272, 0, 0, false},  // none
    EffectSize{0x200, 52878, 139648, 23834, 18048, true},  // scene shading
    EffectSize{0x201, 84090, 139648, 25138, 18048, true},  // + point shadows
    EffectSize{0x202, 84830, 139648, 25918, 18048, true},  // + area lights
    EffectSize{0x204, 85066, 157952, 25702, 20224, true},  // + reflection
    EffectSize{0x208, 86164, 157952, 26830, 20224, true},  // + refraction
    EffectSize{0x210, 84812, 139648, 25982, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 54888, 139648, 25846, 18048, true},  // + environment
    EffectSize{0x240, 54258, 139648, 25250, 18048, true},  // + smooth normals
    EffectSize{0x280, 53620, 139648, 24576, 18048, true},  // + highlights
    EffectSize{0x300, 53412, 139648, 24156, 18048, true},  // + multisampling
    EffectSize{0x3fe, 95582, 157952, 35268, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 94766, 157952, 34452, 20224, true},  // all but area lights
    EffectSize{0x3fb, 95582, 157952, 35268, 20224, true},  // all but reflection
    EffectSize{0x3f7, 94446, 157952, 34132, 20224, true},  // all but refraction
    EffectSize{0x3ef, 93422, 157952, 33176, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 93508, 157952, 33226, 20224, true},  // all but environment
    EffectSize{0x3bf, 94168, 157952, 33828, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 94842, 157952, 34528, 20224, true},  // all but highlights
    EffectSize{0x2ff, 95030, 157952, 35114, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 95574, 157952, 35260, 20224, true},  // all
};

}  // namespace gridiron::experiment
