// Work counters: how much of each kind of work a core has done. Plain integers, no clock.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// Kinds of work that cost time on a chip. "Group" is one SIMD group of kLaneCount rays.
enum class Work : std::uint8_t {
  kTileStart,          ///< tiles begun: parameter reset, output buffer turned over         (initialisation)
  kRayGenerated,       ///< primary ray groups generated                                     (initialisation)
  kPacketStart,        ///< packet passes begun: frustum, mailbox reset                      (initialisation)
  kPassGroup,          ///< ray groups held against a pass's march axis, and their slopes        (initialisation)
  kPassSquare,         ///< squares of ray groups held against it by their corners              (initialisation)
  kMacroSliceStep,     ///< macro slices entered
  kMacroCellStep,      ///< macrocells looked up in the macrocell table
  kMacroCellVisit,     ///< non-empty macrocells whose cell block was walked
  kSliceStep,          ///< slices entered inside a visited macrocell
  kCellStep,           ///< cells looked up inside a visited macrocell
  kCellVisit,          ///< non-empty cells visited
  kTriangleBatch,      ///< triangle buffers consumed
  kMailboxProbe,       ///< mailbox look-ups
  kCullTest,           ///< corner-ray culling tests, one per triangle
  kPixelBoxGroup,      ///< SIMD groups of triangles of which the pixels that they can cover were computed
  kTriangleSetup,      ///< per (packet, triangle) set-ups of the `standard` test
  kSubpacketSetup,     ///< triangles whose edge functions were made linear in the pixel, for culling subpackets
  kSubpacketGroup,     ///< SIMD groups of squares or subpackets held against a triangle's edges
  kGroupTestStandard,  ///< (group, triangle) tests, filtered edge functions
  kGroupTestPaper,     ///< (group, triangle) tests, precomputed projection
  kHitGroup,           ///< groups with hits to be merged, `standard` test
  kHitSubpacket,       ///< whole subpackets inside a triangle, held against what they had hit
  kHitGroupPaper,      ///< groups of which hits were merged, precomputed projection
  kHitSetup,           ///< triangles for which the distance set-up was computed
  kDoubleSign,         ///< edge signs the float filter left open, tried in double
  kExactSign,          ///< signs decided in integers
  kExactDistance,      ///< distances rounded in integers
  kReachGroup,         ///< SIMD groups of which the farthest hit was sought, or held against a cell's entry
  kShadedGroup,        ///< ray groups turned into pixels without shading
  kShadedSimpleGroup,  ///< ray groups shaded by facing ratio
  kDepthGroup,         ///< ray groups written to the depth plane
  kIdGroup,            ///< groups of triangle ids written to a plane, or copied, or of words cleared
  kFootprintGroup,     ///< SIMD groups of squares of subpackets held against a cell
  kRowGroup,           ///< subpackets whose rows were held against a triangle's edges
  kEstimateSetup,      ///< triangles for which estimates of distances were set up
  kNormalSetup,        ///< triangles whose unit normal was computed for shading
  kHitHalf,            ///< halves of groups of which distances were computed in double
  kExactOrder,         ///< pairs of distances, equal once rounded, of which integers told the nearer
  kLatticeTriangle,    ///< triangles made of their vertices' places on a lattice
  kCellBoundStep,      ///< cells looked up inside a visited macrocell by their bounds, beside lattice triangles
  // Effects.
  kWaveRay,            ///< rays of a wave taken from pixels or from the queue
  kQueuedRay,          ///< reflected and refracted rays made, and put into the queue
  kWalkPass,           ///< walks of up to 16 rays begun: axis, shaft
  kShaftGroup,         ///< SIMD groups of walked rays held against a slab of the grid
  kRayGroupTest,       ///< (group, triangle) tests of rays with origins of their own
  kRayDistance,        ///< distances of single rays, in double
  kSurfacePoint,       ///< hits of which point, normal and material were found
  kSmoothNormal,       ///< hits of which the normal was interpolated
  kShadowRay,          ///< shadow rays made, of point and area lights
  kLightSample,        ///< lights, or samples of them, that light a point: their share of the colour
  kHighlight,          ///< of these, highlights
  kOcclusionRay,       ///< rays of ambient occlusion made
  kMirrorRay,          ///< reflected rays made
  kRefractedRay,       ///< refracted rays made
  kEnvironmentLookup,  ///< colours looked up in the environment map
  kColorAdded,         ///< colours added to a pixel's sum
  kColorGroup,         ///< SIMD groups of pixels made of their sums
  kGetIssue,           ///< get commands issued
  kPutIssue,           ///< put commands issued
  kWait,               ///< waits
  kCount
};

/// Kinds of work.
inline constexpr std::uint32_t kWorkKindCount = static_cast<std::uint32_t>(Work::kCount);

/// One counter per kind of work; wraps after 2^32 - 1.
struct WorkCounters {
  std::uint32_t counts[kWorkKindCount] = {};  ///< by Work

  /// Counts so many more of a kind.
  constexpr void add(Work kind, std::uint32_t amount = 1) { counts[static_cast<std::uint32_t>(kind)] += amount; }
  /// The operations that follow belong to `kind`. Nothing to a core: tools/calibrate listens to it, and to add().
  constexpr void charge_to(Work) const {}
  /// @returns the count of a kind.
  [[nodiscard]] constexpr std::uint32_t operator[](Work kind) const { return counts[static_cast<std::uint32_t>(kind)]; }
};

}  // namespace gridiron
