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
    EffectSize{0x000, 46424, 118272, 0, 0, false},  // none
    EffectSize{0x200, 52856, 139648, 24022, 18048, true},  // scene shading
    EffectSize{0x201, 84238, 139648, 25466, 18048, true},  // + point shadows
    EffectSize{0x202, 84978, 139648, 26246, 18048, true},  // + area lights
    EffectSize{0x204, 85242, 157952, 25712, 20224, true},  // + reflection
    EffectSize{0x208, 86340, 157952, 26840, 20224, true},  // + refraction
    EffectSize{0x210, 84988, 139648, 26324, 18048, true},  // + ambient occlusion
    EffectSize{0x220, 54866, 139648, 26034, 18048, true},  // + environment
    EffectSize{0x240, 54236, 139648, 25438, 18048, true},  // + smooth normals
    EffectSize{0x280, 53598, 139648, 24764, 18048, true},  // + highlights
    EffectSize{0x300, 53390, 139648, 24344, 18048, true},  // + multisampling
    EffectSize{0x3fe, 95984, 157952, 35730, 20224, true},  // all but point shadows
    EffectSize{0x3fd, 95168, 157952, 34914, 20224, true},  // all but area lights
    EffectSize{0x3fb, 95984, 157952, 35730, 20224, true},  // all but reflection
    EffectSize{0x3f7, 94848, 157952, 34594, 20224, true},  // all but refraction
    EffectSize{0x3ef, 93624, 157952, 33494, 20224, true},  // all but ambient occlusion
    EffectSize{0x3df, 93910, 157952, 33688, 20224, true},  // all but environment
    EffectSize{0x3bf, 94570, 157952, 34290, 20224, true},  // all but smooth normals
    EffectSize{0x37f, 95244, 157952, 34990, 20224, true},  // all but highlights
    EffectSize{0x2ff, 95434, 157952, 35402, 20224, true},  // all but multisampling
    EffectSize{0x3ff, 95976, 157952, 35722, 20224, true},  // all
};

}  // namespace gridiron::experiment
