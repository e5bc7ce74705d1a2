// Points of a scene, passed in groups, so that no scene has to hold them as one array.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <functional>
#include <span>

namespace gridiron::tool {

/// Takes some points of a scene. A point may be given more than once.
using PointVisitor = std::function<void(std::span<const Vec3>)>;

/// Passes all points of a scene to a visitor, at least one; the same ones at every call.
using PointSource = std::function<void(const PointVisitor&)>;

}  // namespace gridiron::tool
