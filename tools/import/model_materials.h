// Model materials: those of an Assimp scene as far as ours can express them, with their textures of base colour.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "import/assimp_files.h"
#include "import/gltf_scene.h"
#include "import/texture.h"
#include "scene_text/scene_description.h"

namespace gridiron::tool {

/// Places in a picture from a mesh's texture coordinates; v counts upwards in both.
struct PlaceTransform {
  double u_of_u = 1, u_of_v = 0, u_shift = 0;
  double v_of_u = 0, v_of_v = 1, v_shift = 0;
};

struct ModelMaterial {
  SceneMaterial material;
  bool is_default = false;           ///< the file has none; Assimp made it
  const Texture* texture = nullptr;  ///< of the base colour, which material.color multiplies
  unsigned uv_channel = 0;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  PlaceTransform places{};
};

/// The formats whose meaning of colours differs.
enum class ModelFormat : std::uint8_t { kGltf, kObj, kStl, kOther };

/// Reads all materials of a scene. Owns their textures.
class ModelMaterials {
 public:
  /// @param gltf  of a glTF scene whose text could be read, else null.
  ModelMaterials(const aiScene& scene, ModelFormat format, AssimpFiles& files, const GltfScene* gltf);

  /// @returns the material of a mesh; a default one for an index that names none.
  [[nodiscard]] const ModelMaterial& of(unsigned index) const;

  /// Pictures of base colours that could be read.
  [[nodiscard]] std::size_t texture_count() const;
  /// Says what of the materials makes no difference.
  void tell(std::vector<std::string>& ignored) const;

 private:
  [[nodiscard]] ModelMaterial read(unsigned index);
  void read_texture(const aiMaterial& material, unsigned index, ModelMaterial& result);
  void read_gltf_places(const Json& texture, ModelMaterial& result) const;
  void count_ignored(const aiMaterial& material);
  [[nodiscard]] const Texture* find_texture(const std::string& name);
  /// @param reason  why there is none, if there is none.
  [[nodiscard]] std::optional<Texture> load_texture(const std::string& name, std::string& reason);

  const aiScene& scene_;
  ModelFormat format_;
  AssimpFiles& files_;
  const GltfScene* gltf_;
  std::vector<ModelMaterial> materials_;
  std::map<std::string, std::optional<Texture>> textures_;
  std::vector<std::string> unread_;
  std::set<std::string> other_textures_;
  std::size_t highlights_ = 0, clear_ = 0, emissions_ = 0, masks_ = 0,
              transforms_ = 0;  // materials whose one is ignored
};

}  // namespace gridiron::tool
