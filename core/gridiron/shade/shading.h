// Shading: turns the hits of a tile into its pixels.
// Source: Cho, Kim, Han 2012, section 6.1 (no shading, simple shading). Memory: the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/hits.h>

#include <cstdint>

namespace gridiron {

/// Opaque grey of brightness [0, 1] as 0xAABBGGRR; brighter is white.
template <class L>
[[nodiscard]] GRIDIRON_INLINE typename L::Int grey(typename L::Float brightness) {
  using Float = typename L::Float;
  const Float scaled = brightness * Float(255.0f) + Float(0.5f);
  const typename L::Int level = L::truncate(L::min(scaled, Float(255.0f)));
  return level | (level << 8) | (level << 16) | L::Int::splat(0xFF000000u);
}

/// Writes the colours of a frame without the scene's shading.
///
/// @param hits         with facing for Shading::kSimple.
/// @param pixel_count  pixels from the planes' start: a multiple of L::kCount.
/// @param color        RGBA8, as many; may share the memory of hits.facing.
template <class L>
void shade_hits(const FrameHead& frame, const Hits& hits, std::uint32_t pixel_count, std::uint32_t* color,
                WorkCounters& work) {
  using Float = typename L::Float;
  using Int = typename L::Int;
  const Int background = Int::splat(frame.background_rgba);
  if (frame.shading == static_cast<std::uint32_t>(Shading::kSimple)) {
    work.add(Work::kShadedSimpleGroup, pixel_count / L::kCount);
    hits.facing != nullptr ? void() : __builtin_unreachable();  // what the shading calls for; analyzers cannot know it
    for (std::uint32_t pixel = 0; pixel < pixel_count; pixel += L::kCount) {
      const Int lit = grey<L>(Float::load(hits.facing + pixel));
      L::select(L::equal(kNoTriangle, hits.id + pixel), background, lit).store(color + pixel);
    }
  } else {
    work.add(Work::kShadedGroup, pixel_count / L::kCount);
    const Int lit = Int::splat(0xFFFFFFFFu);
    for (std::uint32_t pixel = 0; pixel < pixel_count; pixel += L::kCount) {
      L::select(L::equal(kNoTriangle, hits.id + pixel), background, lit).store(color + pixel);
    }
  }
}

}  // namespace gridiron
