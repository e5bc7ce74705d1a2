// Model materials. SPDX-License-Identifier: Apache-2.0
#include "import/model_materials.h"

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/words.h"

namespace gridiron::tool {
namespace {

constexpr float kUsualIndex = 1.5f;  // of glass, and glTF's default

float share_of(float value) {
  return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f;
}

float brightness_of(const aiColor3D& color) {
  return share_of((share_of(color.r) + share_of(color.g) + share_of(color.b)) / 3.0f);
}

float index_of(float value) {
  return std::isfinite(value) ? std::clamp(value, kLeastRefraction, kMostRefraction) : 1.0f;
}

// Metal and roughness as a mirror's share and the exponent of a highlight. A rough surface has no clear mirror image,
// so its share fades with the roughness. Source of the exponent: B. Walter et al., "Microfacet Models for Refraction
// through Rough Surfaces", 2007, equation 38 and below: 2 / alpha^2 - 2; glTF's alpha is the roughness squared.
void set_metal_roughness(float metal, float roughness, SceneMaterial& material) {
  constexpr float kDielectric = 0.04f, kLeastShare = 0.01f, kMostExponent = 1e4f;
  const float clear = (1.0f - roughness) * (1.0f - roughness);
  const float share = (kDielectric + (1.0f - kDielectric) * metal) * clear;
  material.kd = 1.0f - share;
  if (share < kLeastShare) {
    material.kd = 1.0f;
    return;
  }
  const float alpha = std::max(roughness * roughness, 1e-3f);
  material.ks = share;
  material.shine = std::clamp(2.0f / (alpha * alpha) - 2.0f, 1.0f, kMostExponent);
}

void set_transmittance(float share, float index, SceneMaterial& material) {
  if (share <= 0.0f) return;
  material.transmittance = share;
  material.index_of_refraction = index;
  material.kd = std::max(0.0f, material.kd - share);
}

void read_gltf(const aiMaterial& source, SceneMaterial& material) {
  ai_real metal = 1, roughness = 1, transmission = 0, index = kUsualIndex;
  aiColor4D base(1, 1, 1, 1);
  (void)source.Get(AI_MATKEY_METALLIC_FACTOR, metal);
  (void)source.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness);
  if (source.Get(AI_MATKEY_BASE_COLOR, base) != aiReturn_SUCCESS) (void)source.Get(AI_MATKEY_COLOR_DIFFUSE, base);
  material.color = Vec3(share_of(base.r), share_of(base.g), share_of(base.b));
  int unlit = 0;
  if (source.Get("$mat.gltf.unlit", 0, 0, unlit) != aiReturn_SUCCESS || unlit == 0) {
    set_metal_roughness(share_of(metal), share_of(roughness), material);
  }
  (void)source.Get(AI_MATKEY_TRANSMISSION_FACTOR, transmission);
  (void)source.Get(AI_MATKEY_REFRACTI, index);
  aiString mode;
  const bool blends = source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS && mode == aiString("BLEND");
  if (transmission > 0) {
    set_transmittance(share_of(transmission), index_of(index), material);
  } else if (blends) {
    set_transmittance(1.0f - share_of(base.a), 1.0f, material);
  }
}

// @returns whether a highlight was left out.
bool read_phong(const aiMaterial& source, ModelFormat format, SceneMaterial& material) {
  aiColor3D diffuse(1, 1, 1), specular(0, 0, 0);
  ai_real opacity = 1, index = 1, exponent = 0;
  int model = 0;
  if (source.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != aiReturn_SUCCESS) {
    aiColor4D base(1, 1, 1, 1);
    if (source.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS) diffuse = aiColor3D(base.r, base.g, base.b);
  }
  (void)source.Get(AI_MATKEY_COLOR_SPECULAR, specular);
  (void)source.Get(AI_MATKEY_OPACITY, opacity);
  (void)source.Get(AI_MATKEY_REFRACTI, index);
  (void)source.Get(AI_MATKEY_SHININESS, exponent);
  // A reflectivity is a share of light, so linear: the MTL specification gives Kd no other meaning.
  material.color = Vec3(share_of(diffuse.r), share_of(diffuse.g), share_of(diffuse.b));
  bool drops_highlight = false;
  const float share = brightness_of(specular);
  // Of OBJ's models of illumination those from 3 on have mirrors; the others mean a highlight alone.
  const bool is_obj = format == ModelFormat::kObj;
  (void)source.Get(AI_MATKEY_OBJ_ILLUM, model);
  ai_real reflectivity = 0;
  (void)source.Get(AI_MATKEY_REFLECTIVITY, reflectivity);
  const bool is_mirror = is_obj ? model >= 3 : reflectivity > 0;
  if (share > 0 && is_mirror) {
    material.ks = is_obj ? share : share_of(reflectivity) * share;
    material.kd = 1.0f - material.ks;
    material.shine = std::isfinite(exponent) ? std::clamp(exponent, 0.0f, kMostShine) : 0.0f;
  } else {
    drops_highlight = share > 0 && exponent > 0;
  }
  set_transmittance(1.0f - share_of(opacity), index_of(index), material);
  return drops_highlight;
}

Wrap wrap_of(int mode) {
  if (mode == aiTextureMapMode_Mirror) return Wrap::kMirror;
  return mode == aiTextureMapMode_Wrap ? Wrap::kRepeat : Wrap::kClamp;
}

// "%20" as the byte it stands for.
std::string without_percents(const std::string& text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
      plain += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
      i += 2;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

}  // namespace

ModelMaterials::ModelMaterials(const aiScene& scene, ModelFormat format, AssimpFiles& files)
    : scene_(scene), format_(format), files_(files) {
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    materials_.push_back(scene.mMaterials[i] != nullptr ? read(i) : ModelMaterial{});
  }
}

const ModelMaterial& ModelMaterials::of(unsigned index) const {
  static const ModelMaterial kNone = {.material = {}, .is_default = true};
  return index < materials_.size() ? materials_[index] : kNone;
}

ModelMaterial ModelMaterials::read(unsigned index) {
  const aiMaterial& source = *scene_.mMaterials[index];
  ModelMaterial result;
  aiString name;
  (void)source.Get(AI_MATKEY_NAME, name);
  // Behind the materials of a glTF file Assimp puts one for meshes without any.
  const bool is_made = name == aiString(AI_DEFAULT_MATERIAL_NAME) ||
                       (format_ == ModelFormat::kGltf && index + 1 == scene_.mNumMaterials && name.length == 0);
  if (format_ == ModelFormat::kStl || (is_made && source.GetTextureCount(aiTextureType_DIFFUSE) == 0)) {
    result.is_default = true;
    return result;
  }
  if (format_ == ModelFormat::kGltf) {
    read_gltf(source, result.material);
  } else if (read_phong(source, format_, result.material)) {
    ++dropped_highlights_;
  }
  read_texture(source, result);
  return result;
}

void ModelMaterials::read_texture(const aiMaterial& source, ModelMaterial& result) {
  constexpr aiTextureType kColors[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
  for (int type = aiTextureType_NONE + 1; type <= AI_TEXTURE_TYPE_MAX; ++type) {
    const auto kind = static_cast<aiTextureType>(type);
    // glTF's texture of roughness has an unknown type beside its own.
    if (std::ranges::find(kColors, kind) == std::end(kColors) && kind != aiTextureType_UNKNOWN) {
      other_textures_ += source.GetTextureCount(kind);
    }
  }
  for (const aiTextureType type : kColors) {
    if (source.GetTextureCount(type) == 0) continue;
    aiString path;
    if (source.Get(AI_MATKEY_TEXTURE(type, 0), path) != aiReturn_SUCCESS) continue;
    int channel = 0, u = aiTextureMapMode_Wrap, v = aiTextureMapMode_Wrap;
    (void)source.Get(AI_MATKEY_UVWSRC(type, 0), channel);
    (void)source.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), u);
    (void)source.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), v);
    result.texture = find_texture(std::string(path.data, path.length));
    result.uv_channel = static_cast<unsigned>(std::clamp(channel, 0, AI_MAX_NUMBER_OF_TEXTURECOORDS - 1));
    result.wrap_u = wrap_of(u);
    result.wrap_v = wrap_of(v);
    return;
  }
}

const Texture* ModelMaterials::find_texture(const std::string& name) {
  auto found = textures_.find(name);
  if (found == textures_.end()) {
    std::string reason = "is missing or cannot be read";
    found = textures_.emplace(name, load_texture(name, reason)).first;
    if (!found->second) unread_.push_back(in_quotes(name) + ", which " + reason);
  }
  return found->second ? &*found->second : nullptr;
}

std::optional<Texture> ModelMaterials::load_texture(const std::string& name, std::string& reason) {
  const auto decode = [&reason](std::span<const std::byte> file) {
    if (const auto option = Texture::missing_option(file)) {
      reason = "this build of gridiron cannot read (" + std::string(*option) + "=OFF)";
    }
    return Texture::decode(file);
  };
  if (const aiTexture* const embedded = scene_.GetEmbeddedTexture(name.c_str())) {
    if (embedded->mHeight == 0) {
      return decode(std::as_bytes(std::span(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth)));
    }
    const std::uint64_t count = std::uint64_t{embedded->mWidth} * embedded->mHeight;
    if (count == 0 || embedded->mWidth > Texture::kMostWidth || embedded->mHeight > Texture::kMostWidth)
      return std::nullopt;
    std::vector<std::uint8_t> rgb;
    for (std::uint64_t i = 0; i < count; ++i) {
      const aiTexel& texel = embedded->pcData[i];
      rgb.insert(rgb.end(), {texel.r, texel.g, texel.b});
    }
    return Texture(embedded->mWidth, embedded->mHeight, rgb);
  }
  std::string path = name;
  std::ranges::replace(path, '\\', '/');
  const std::filesystem::path folder = std::filesystem::path(files_.name()).parent_path();
  for (const std::string& each : {path, without_percents(path)}) {
    const std::string whole = (folder / each).string();
    if (!files_.Exists(whole.c_str())) continue;
    if (const auto bytes = files_.read(whole)) return decode(*bytes);
  }
  return std::nullopt;
}

}  // namespace gridiron::tool
