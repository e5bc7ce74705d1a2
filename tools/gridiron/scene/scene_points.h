// Scene points: the corners of all triangles that a frame can show, from a mesh or from a scene image.
// Memory: a bit for each vertex or triangle. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "framing.h"

namespace gridiron::tool {

/// Visits the corners of all triangles with an area. Precondition: indices below the number of vertices.
void visit_points(const MeshView& mesh, const PointVisitor& visitor);

/// Visits the corners of all triangles of an image as it stores them: unchanged vertices, or their places on the
/// lattice. A stored projection gives its corners up to the rounding of its numbers, within the scene's bounds.
///
/// @param image  the bytes from which `view` was opened. @param end  triangles from this id on are left out.
void visit_points(const SceneImageView& view, std::span<const std::byte> image, const PointVisitor& visitor,
                  std::uint32_t end = kNoTriangle);

}  // namespace gridiron::tool
