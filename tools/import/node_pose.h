// Node pose: where the nodes of an Assimp scene stand, at rest or at a moment of its first animation.
// Memory: borrows the scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gridiron::tool {

using NodeMatrix = aiMatrix4x4t<double>;

[[nodiscard]] NodeMatrix as_double(const aiMatrix4x4& matrix);

/// A node with its place in the world.
struct PosedNode {
  const aiNode* node = nullptr;
  NodeMatrix world_from_node;
};

class NodePose {
 public:
  /// @param moment  of the first animation, 0..1 of its length; nothing: at rest. Errors: ImportError for more nodes
  /// than a scene may have.
  NodePose(const aiScene& scene, std::optional<double> moment);

  /// All nodes, parents before children, a child's branch before the next child.
  [[nodiscard]] const std::vector<PosedNode>& nodes() const { return nodes_; }

  /// @returns the matrix of the first node with a name, null if there is none.
  [[nodiscard]] const NodeMatrix* find(std::string_view name) const;

 private:
  std::vector<PosedNode> nodes_;
  std::unordered_map<std::string_view, std::size_t> by_name_;
};

/// @returns the length of the first animation in seconds, 0 without one.
[[nodiscard]] double animation_seconds(const aiScene& scene);

}  // namespace gridiron::tool
