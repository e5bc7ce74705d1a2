// Work counters: how much of each kind of work a core has done. Plain integers, no clock.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// Kinds of work that cost time on a chip, whatever engine traces the rays: of rays, tests, shading and output. An
/// engine's own kinds are an enumeration of its own, which goes on from kSharedWorkCount. "Group" is one SIMD group of
/// L::kCount rays.
enum class Work : std::uint8_t {
  kTileStart,          ///< tiles begun: parameter reset, output buffer turned over         (initialisation)
  kRayPacket,          ///< packets of eye rays begun                                        (initialisation)
  kPixelProjection,    ///< packets of which the projection to pixels was set up             (initialisation)
  kRayGenerated,       ///< groups of eye rays generated                                     (initialisation)
  kRaySetWord,         ///< words of sets of rays that were gone through                     (initialisation)
  kRecentSlot,         ///< places of recently hit triangles cleared                         (initialisation)
  kCullTest,           ///< corner-ray culling tests, one per triangle
  kPixelBoxGroup,      ///< SIMD groups of triangles of which the pixels that they can cover were computed
  kOpenTriangle,       ///< of these, triangles that may cover some: listed to be tested
  kListedTriangle,     ///< triangles listed to be tested, whatever pixels they cover
  kTriangleSetup,      ///< per (packet, triangle) set-ups of the `standard` test
  kSlopeSetup,         ///< triangles whose edge functions were made linear in the pixel, for culling subpackets
  kSubpacketSetup,     ///< triangles of which the subpackets were looked for that they may touch
  kSubpacketGroup,     ///< SIMD groups of squares or subpackets tested against a triangle's edges
  kTriangleTest,       ///< triangles tested ray by ray: their edge functions spread over the lanes
  kSubpacketPick,      ///< of many subpackets, those that were picked to be visited
  kSubpacketVisit,     ///< (subpacket, triangle) pairs of which the groups were gone through
  kGroupTestStandard,  ///< (group, triangle) tests, filtered edge functions
  kGroupSkip,          ///< groups of these that were left out: no ray is active
  kInsideTest,         ///< of the others, groups with rays that do not surely miss: asked whether they surely hit
  kRowVisit,           ///< such pairs where rows may be left out
  kRowTest,            ///< (group, triangle) tests of rows of them, filtered edge functions
  kRowSkip,            ///< rows of them that were left out: no ray is active, or none is near
  kRowInsideTest,      ///< of the others, rows with rays that do not surely miss: asked whether they surely hit
  kCullTestPaper,      ///< corner-ray culling tests, precomputed projection
  kGroupTestPaper,     ///< (group, triangle) tests, precomputed projection
  kHitGroup,           ///< groups with hits to be merged, `standard` test
  kOpenHitGroup,       ///< of these, groups with hits that are not surely the nearest so far
  kSettledGroup,       ///< of these, groups of which exact distances decided
  kHitSubpacket,       ///< whole subpackets inside a triangle, tested against what they hit before
  kTakenSubpacket,     ///< of these, those that took the triangle
  kFacingGroup,        ///< groups with hits of which the angle to the triangle was computed for shading
  kHitGroupPaper,      ///< groups of which hits were merged, precomputed projection
  kHitSetup,           ///< triangles for which the distance set-up was computed
  kDoubleSign,         ///< edge signs the float filter left open, tried in double
  kExactSign,          ///< signs decided in integers
  kExactDistance,      ///< distances rounded in integers
  kShadedGroup,        ///< ray groups turned into pixels without shading
  kShadedSimpleGroup,  ///< ray groups shaded by facing ratio
  kDepthGroup,         ///< ray groups written to the depth plane
  kIdGroup,            ///< groups of triangle ids written to a plane, or of words cleared
  kRowGroup,           ///< subpackets whose rows were tested against a triangle's edges
  kEstimateSetup,      ///< triangles for which estimates of distances were set up
  kNormalSetup,        ///< triangles whose unit normal was computed for shading
  kHitHalf,            ///< halves of groups of which distances were computed in double
  kExactOrder,         ///< pairs of distances, equal once rounded, of which integers found the nearer
  kLatticeTriangle,    ///< triangles made of their vertices' places on a lattice
  // Effects.
  kWaveRay,            ///< rays of a wave taken from pixels or from the queue
  kQueuedRay,          ///< reflected and refracted rays made, and put into the queue
  kListRay,            ///< rays of a batch prepared for lists
  kListBeam,           ///< beams made of 16 of them, or tried in vain
  kListBeamNode,       ///< tests of a beam against a node's boxes
  kListChild,          ///< lists made for a child of a node
  kListEntry,          ///< rays that were gone through for these
  kListNode,           ///< nodes that a list of rays has entered
  kListRun,            ///< runs of their rays of one octant: the sides of boxes that these enter and leave by
  kListRayNode,        ///< tests of one or two rays against a node's union boxes; wide lanes: against all boxes
  kListBoxQuad,        ///< likewise, against a quad of a node's boxes
  kListSharedBox,      ///< both, of rays with one origin
  kListLeaf,           ///< leaves that a list of rays was tested against: triangles spread over lanes
  kListTriangleGroup,  ///< SIMD groups of a leaf's triangles tested by a ray
  kListSharedLeaf,     ///< leaves likewise, for rays with one origin
  kListSharedGroup,    ///< groups likewise
  kListCandidate,      ///< of these, groups with triangles that floats do not rule out
  kRayDistance,        ///< distances of single rays, in double
  kSurfacePoint,       ///< hits of which point, normal and material were found
  kSmoothNormal,       ///< hits of which the normal was interpolated
  kJitterSeed,         ///< hits of which the jitter's seed was found, for places on area lights and occlusion rays
  kShadowRay,          ///< shadow rays made, of point and area lights
  kAreaPlace,          ///< places found on area lights, one for each point and sample
  kLightSample,        ///< lights, or samples of them, that light a point: their share of the colour
  kHighlight,          ///< of these, highlights
  kOcclusionRay,       ///< rays of ambient occlusion made
  kMirrorRay,          ///< reflected rays made
  kRefractedRay,       ///< refracted rays made
  kEnvironmentLookup,  ///< colours looked up in the environment map
  kColorAdded,         ///< colours added to a pixel's sum
  kColorGroup,         ///< SIMD groups of pixels made of their sums
  kVertexColor,        ///< hits of which the colour was interpolated
  kSrgbLevel,          ///< channels of pixels put on the curve of sRGB
  kGetIssue,           ///< get commands issued
  kPutIssue,           ///< put commands issued
  kWait,               ///< waits
  kCount
};

/// The number of the first kind of an engine.
inline constexpr std::uint32_t kSharedWorkCount = static_cast<std::uint32_t>(Work::kCount);
/// Kinds that there are counters for. A frame has one engine of eye rays, so all of these use the
/// same ones; the kinds of the tree, which traces the other rays beside any of them, are in Work.
inline constexpr std::uint32_t kWorkKindCount = 103;

/// A kind of Work or of an engine: the number of its counter.
class WorkId {
 public:
  constexpr WorkId() = default;
  /// A kind that all engines share.
  constexpr WorkId(Work kind) : number_(static_cast<std::uint32_t>(kind)) {}  // NOLINT: kinds are passed as they are
  /// @tparam Kind  an engine's kinds: kFirst to kEnd - 1.
  template <class Kind>
  requires requires { Kind::kFirst != Kind::kEnd; }
  constexpr WorkId(Kind kind) : number_(static_cast<std::uint32_t>(kind)) {  // NOLINT: the same
    static_assert(static_cast<std::uint32_t>(Kind::kFirst) == kSharedWorkCount);
    static_assert(static_cast<std::uint32_t>(Kind::kEnd) <= kWorkKindCount);
  }
  explicit constexpr WorkId(std::uint32_t number) : number_(number) {}  ///< by the number of its counter

  [[nodiscard]] constexpr std::uint32_t number() const { return number_; }  ///< of its counter
  friend constexpr bool operator==(WorkId, WorkId) = default;               ///< the same kind of the same engine

 private:
  std::uint32_t number_ = 0;
};

/// One counter per kind of work; wraps after 2^32 - 1.
struct WorkCounters {
  std::uint32_t counts[kWorkKindCount] = {};  ///< by WorkId

  /// Counts so many more of a kind.
  constexpr void add(WorkId kind, std::uint32_t amount = 1) { counts[kind.number()] += amount; }
  /// The operations that follow belong to `kind`. Nothing to a core: tools/calibrate listens to it, and to add().
  constexpr void charge_to(WorkId) const {}
  /// @returns the count of a kind.
  [[nodiscard]] constexpr std::uint32_t operator[](WorkId kind) const { return counts[kind.number()]; }
};

}  // namespace gridiron
