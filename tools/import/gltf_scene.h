// glTF scene: which parts of a file's text the nodes, meshes and materials of an Assimp scene come from; puts right
// what Assimp has read wrongly there. Memory: borrows text and scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "import/gltf_text.h"

namespace gridiron::tool {

class GltfScene {
 public:
  /// Replaces coordinates, normals, texture coordinates and weights that are integers in the file, and binds bones to
  /// the nodes of their skin, whose names need not differ. Errors: ImportError for a damaged accessor among them.
  GltfScene(const GltfText& text, aiScene& scene);

  [[nodiscard]] const GltfText& text() const { return text_; }

  /// Nodes of the Assimp scene with their index in the file.
  [[nodiscard]] const std::vector<std::pair<aiNode*, std::size_t>>& nodes() const { return nodes_; }
  /// @returns the text of a material of the Assimp scene; null if there is none.
  [[nodiscard]] const Json* material(unsigned index) const;
  /// @returns weights of a node's morph targets at rest; empty: all zero.
  [[nodiscard]] std::vector<float> rest_weights(std::size_t node) const;

 private:
  void match_nodes();
  void mend_mesh(aiMesh& mesh, const Json& primitive) const;
  void bind_bones(aiMesh& mesh, const Json& node) const;

  const GltfText& text_;
  aiScene& scene_;
  std::vector<std::pair<aiNode*, std::size_t>> nodes_;
  std::unordered_map<std::size_t, aiNode*> first_nodes_;
  std::unordered_map<unsigned, std::size_t> materials_;
};

}  // namespace gridiron::tool
