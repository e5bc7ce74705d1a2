// Node pose: where the nodes of an Assimp scene stand and what weights their morph targets have, at rest or at a moment
// of one of its animations.
// Memory: borrows the scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include <cstddef>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gridiron::tool {

using NodeMatrix = aiMatrix4x4t<double>;

[[nodiscard]] NodeMatrix as_double(const aiMatrix4x4& matrix);

/// What an animation has moved. Nodes that are missing are at rest.
struct Movement {
  std::unordered_map<const aiNode*, NodeMatrix> parent_from_node;
  std::unordered_map<const aiNode*, std::vector<float>> weights;  ///< of morph targets
  bool has_weights = false;  ///< targets without a weight there have none; else that of their mesh
};

/// @returns the movement of an animation as Assimp has it. @param seconds  from its begin.
[[nodiscard]] Movement movement_of(const aiScene& scene, unsigned animation, double seconds);

/// A node with its place in the world.
struct PosedNode {
  const aiNode* node = nullptr;
  NodeMatrix world_from_node;
};

class NodePose {
 public:
  /// Errors: ImportError for more nodes than a scene may have.
  NodePose(const aiScene& scene, Movement movement);

  /// All nodes, parents before children, a child's branch before the next child.
  [[nodiscard]] const std::vector<PosedNode>& nodes() const { return nodes_; }

  /// @returns the place of a bone's node, or of the first one with its name; null if there is none.
  [[nodiscard]] const NodeMatrix* find(const aiBone& bone) const;

  /// @returns the weight of a mesh's morph target where a node shows it.
  [[nodiscard]] float weight_of(const aiNode& node, const aiMesh& mesh, unsigned target) const;

 private:
  Movement movement_;
  std::vector<PosedNode> nodes_;
  std::unordered_map<std::string_view, std::size_t> by_name_;
  std::unordered_map<const aiNode*, std::size_t> by_node_;
};

/// @returns the length of an animation.
[[nodiscard]] double seconds_of(const aiAnimation& animation);

}  // namespace gridiron::tool
