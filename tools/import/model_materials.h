// Model materials: those of an Assimp scene as far as ours can express them, with their textures of base colour.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include <map>
#include <string>
#include <vector>

#include "import/assimp_files.h"
#include "import/texture.h"
#include "scene_text/scene_description.h"

namespace gridiron::tool {

struct ModelMaterial {
  SceneMaterial material;
  bool is_default = false;           ///< the file has none; Assimp made it
  const Texture* texture = nullptr;  ///< of the base colour, which material.color multiplies
  unsigned uv_channel = 0;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
};

/// The formats whose meaning of colours differs.
enum class ModelFormat : std::uint8_t { kGltf, kObj, kStl, kOther };

/// Reads all materials of a scene. Owns their textures.
class ModelMaterials {
 public:
  ModelMaterials(const aiScene& scene, ModelFormat format, AssimpFiles& files);

  /// @returns the material of a mesh; a default one for an index that names none.
  [[nodiscard]] const ModelMaterial& of(unsigned index) const;

  [[nodiscard]] std::size_t other_texture_count() const { return other_textures_; }
  /// Textures of base colours that are damaged, or of kinds that are not read: the name in quotes, and why.
  [[nodiscard]] const std::vector<std::string>& unread_textures() const { return unread_; }
  /// Materials with a highlight that is left out, because ours comes with a mirror.
  [[nodiscard]] std::size_t dropped_highlight_count() const { return dropped_highlights_; }

 private:
  [[nodiscard]] ModelMaterial read(unsigned index);
  void read_texture(const aiMaterial& material, ModelMaterial& result);
  [[nodiscard]] const Texture* find_texture(const std::string& name);
  /// @param reason  why there is none, if there is none
  [[nodiscard]] std::optional<Texture> load_texture(const std::string& name, std::string& reason);

  const aiScene& scene_;
  ModelFormat format_;
  AssimpFiles& files_;
  std::vector<ModelMaterial> materials_;
  std::map<std::string, std::optional<Texture>> textures_;
  std::vector<std::string> unread_;
  std::size_t other_textures_ = 0, dropped_highlights_ = 0;
};

}  // namespace gridiron::tool
