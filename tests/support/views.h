// The reference views: which scan, from where.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/frame/frame_setup.h>
#include <gridiron/scene/mesh.h>

#include <optional>

namespace gridiron::test {

/// Our view of a model; Cho, Kim, Han 2012 render the first four, but do not describe their views.
struct SceneView {
  const char* name;
  const char* file;              ///< in the directory of scans
  std::optional<Camera> camera;  ///< nothing: framed
};

inline constexpr float kTanHalf45Degrees = 0.414213562f;
inline constexpr float kTanHalf65Degrees = 0.637070261f;

inline const SceneView kBunnyView = {"bunny", "bunny.ply", {}};
inline const SceneView kHorseView = {"horse", "horse.ply", {}};
inline const SceneView kArmadilloView = {"armadillo_standin", "armadillo_standin_345944.ply", {}};
inline const SceneView kConferenceView = {"conference_1", "conference.ply",
                                          Camera{{-73, 454, -883}, {603, 128, 151}, {0, 1, 0}, kTanHalf65Degrees}};
inline const SceneView kConferenceView2 = {"conference_2", "conference.ply",
                                           Camera{{1415, 389, -797}, {-208, 160, -21}, {0, 1, 0}, kTanHalf65Degrees}};
inline const SceneView kSponzaView = {"sponza", "sponza_dabrovic.ply",
                                      Camera{{-12, 3, 0.5f}, {10, 4.5f, 0}, {0, 1, 0}, kTanHalf65Degrees}};
inline const SceneView kDragonView = {"dragon", "stanford_dragon_res2.ply", {}};

/// Frames a mesh: eye = c + 1.05 d n with c the centre of the bounding box of all vertices, d its diagonal,
/// n = (0.35, 0.25, 1) normalised; 45 degrees.
Camera framed_camera(const MeshView& mesh);

}  // namespace gridiron::test
