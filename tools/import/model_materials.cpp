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

constexpr float kDielectric = 0.04f;  // share that what is no metal reflects

// A share that is reflected and a roughness as a mirror's share and the exponent of a highlight. A rough surface has no
// clear mirror image, so its share fades with the roughness. Source of the exponent: B. Walter et al., "Microfacet
// Models for Refraction through Rough Surfaces", 2007, equation 38 and below: 2 / alpha^2 - 2; glTF's alpha is the
// roughness squared.
void set_mirror(float reflected, float roughness, SceneMaterial& material) {
  constexpr float kLeastShare = 0.01f, kMostExponent = 1e4f;
  const float clear = (1.0f - roughness) * (1.0f - roughness);
  const float share = reflected * clear;
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

// Whether a material is one of KHR_materials_pbrSpecularGlossiness, whose colours replace the others.
bool has_gloss(const aiMaterial& source, ai_real& gloss) {
  return source.Get(AI_MATKEY_GLOSSINESS_FACTOR, gloss) == aiReturn_SUCCESS;
}

void read_gltf(const aiMaterial& source, SceneMaterial& material) {
  ai_real metal = 1, roughness = 1, transmission = 0, index = kUsualIndex;
  aiColor4D base(1, 1, 1, 1);
  (void)source.Get(AI_MATKEY_METALLIC_FACTOR, metal);
  (void)source.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness);
  if (source.Get(AI_MATKEY_BASE_COLOR, base) != aiReturn_SUCCESS) (void)source.Get(AI_MATKEY_COLOR_DIFFUSE, base);
  material.color = Vec3(share_of(base.r), share_of(base.g), share_of(base.b));
  int unlit = 0;
  const bool is_lit = source.Get("$mat.gltf.unlit", 0, 0, unlit) != aiReturn_SUCCESS || unlit == 0;
  ai_real gloss = 0;
  if (has_gloss(source, gloss)) {
    aiColor4D specular(1, 1, 1, 1);
    (void)source.Get(AI_MATKEY_COLOR_DIFFUSE, base);
    (void)source.Get(AI_MATKEY_COLOR_SPECULAR, specular);
    material.color = Vec3(share_of(base.r), share_of(base.g), share_of(base.b));
    const float reflected = brightness_of(aiColor3D(specular.r, specular.g, specular.b));
    if (is_lit) set_mirror(reflected, 1.0f - share_of(gloss), material);
  } else if (is_lit) {
    set_mirror(kDielectric + (1.0f - kDielectric) * share_of(metal), share_of(roughness), material);
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

struct LeftOut {
  bool highlight = false, clearness = false;
};

LeftOut read_phong(const aiMaterial& source, ModelFormat format, SceneMaterial& material) {
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
  LeftOut left_out;
  const float share = brightness_of(specular);
  // Of OBJ's models of illumination 3 to 9 have mirrors. The others mean a highlight alone, which no material of ours
  // has: most programs write 2 for everything, and a mirror in its place is not what they mean.
  const bool is_obj = format == ModelFormat::kObj;
  (void)source.Get(AI_MATKEY_OBJ_ILLUM, model);
  ai_real reflectivity = 0;
  (void)source.Get(AI_MATKEY_REFLECTIVITY, reflectivity);
  const bool is_mirror = is_obj ? model >= 3 && model <= 9 : reflectivity > 0;
  if (share > 0 && is_mirror) {
    material.ks = is_obj ? share : share_of(reflectivity) * share;
    material.kd = 1.0f - material.ks;
    material.shine = std::isfinite(exponent) ? std::clamp(exponent, 0.0f, kMostShine) : 0.0f;
  } else {
    left_out.highlight = share > 0 && exponent > 0;
  }
  // Nobody models what cannot be seen: exporters write 0 where they mean 1.
  left_out.clearness = share_of(opacity) == 0.0f;
  if (!left_out.clearness) set_transmittance(1.0f - share_of(opacity), index_of(index), material);
  return left_out;
}

Wrap wrap_of(int mode) {
  if (mode == aiTextureMapMode_Mirror) return Wrap::kMirror;
  return mode == aiTextureMapMode_Wrap ? Wrap::kRepeat : Wrap::kClamp;
}

}  // namespace

ModelMaterials::ModelMaterials(const aiScene& scene, ModelFormat format, AssimpFiles& files, const GltfScene* gltf)
    : scene_(scene), format_(format), files_(files), gltf_(gltf) {
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    materials_.push_back(scene.mMaterials[i] != nullptr ? read(i) : ModelMaterial{});
  }
}

std::size_t ModelMaterials::texture_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(textures_, [](const auto& t) { return t.second.has_value(); }));
}

void ModelMaterials::tell(std::vector<std::string>& ignored) const {
  const auto add = [&ignored](std::size_t count, const std::string& what) {
    if (count != 0) ignored.push_back(what + " of " + words_of_count(count, "material"));
  };
  if (!other_textures_.empty()) {
    ignored.push_back(words_of_count(other_textures_.size(), "texture") + " of something other than base colour");
  }
  add(highlights_, "highlights without mirrors");
  add(clear_, "full transparency");
  add(emissions_, "emission");
  add(masks_, "cut-outs");
  add(transforms_, "shifted or scaled textures");
  constexpr std::size_t kMostNames = 5;
  for (std::size_t i = 0; i < std::min(kMostNames, unread_.size()); ++i) {
    ignored.push_back("the texture " + unread_[i]);
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
  } else {
    const LeftOut left_out = read_phong(source, format_, result.material);
    highlights_ += left_out.highlight ? 1 : 0;
    clear_ += left_out.clearness ? 1 : 0;
  }
  count_ignored(source);
  read_texture(source, index, result);
  return result;
}

void ModelMaterials::count_ignored(const aiMaterial& source) {
  for (int type = aiTextureType_NONE + 1; type <= AI_TEXTURE_TYPE_MAX; ++type) {
    const auto kind = static_cast<aiTextureType>(type);
    // glTF's texture of roughness has an unknown type beside its own.
    if (kind == aiTextureType_BASE_COLOR || kind == aiTextureType_DIFFUSE || kind == aiTextureType_UNKNOWN) continue;
    for (unsigned i = 0; i < source.GetTextureCount(kind); ++i) {
      aiString path;
      if (source.Get(AI_MATKEY_TEXTURE(kind, i), path) == aiReturn_SUCCESS) {
        other_textures_.emplace(path.data, path.length);
      }
    }
  }
  aiColor3D light(0, 0, 0);
  (void)source.Get(AI_MATKEY_COLOR_EMISSIVE, light);
  if (brightness_of(light) > 0) ++emissions_;
  aiString mode;
  if (source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS && mode == aiString("MASK")) ++masks_;
}

void ModelMaterials::read_texture(const aiMaterial& source, unsigned index, ModelMaterial& result) {
  ai_real gloss = 0;
  const bool is_glossy = has_gloss(source, gloss);
  const aiTextureType types[] = {is_glossy ? aiTextureType_DIFFUSE : aiTextureType_BASE_COLOR,
                                 is_glossy ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE};
  for (const aiTextureType type : types) {
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
    const Json* const text = gltf_ != nullptr ? gltf_->material(index) : nullptr;
    if (text != nullptr) {
      const Json* const glossy = member(member(text, "extensions"), "KHR_materials_pbrSpecularGlossiness");
      const Json* const texture = is_glossy ? member(glossy, "diffuseTexture")
                                            : member(member(text, "pbrMetallicRoughness"), "baseColorTexture");
      if (texture != nullptr) read_gltf_places(*texture, result);
    } else {
      aiUVTransform transform;
      const bool is_given = source.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS;
      const bool moves = transform.mTranslation != aiVector2D(0, 0) || transform.mScaling != aiVector2D(1, 1);
      if (is_given && (moves || transform.mRotation != 0)) ++transforms_;
    }
    return;
  }
}

// Scale, then rotation, then offset, of places that count downwards.
// Source: KHR_texture_transform; a rotation is counter-clockwise as one sees the picture, so its sine has the other
// sign for places that count downwards.
void ModelMaterials::read_gltf_places(const Json& texture, ModelMaterial& result) const {
  const Json* const transform = member(member(&texture, "extensions"), "KHR_texture_transform");
  if (transform == nullptr) return;
  const std::vector<double> none = {0, 0}, one = {1, 1};
  const std::vector<double> offset = numbers_in(*transform, "offset", 2).value_or(none);
  const std::vector<double> scale = numbers_in(*transform, "scale", 2).value_or(one);
  const double rotation = number_in(*transform, "rotation", 0);
  const double cosine = std::cos(rotation), sine = std::sin(rotation);
  // Of u' = c su u + s sv (1 - v) + ou and 1 - v' = -s su u + c sv (1 - v) + ov.
  result.places = {.u_of_u = cosine * scale[0],
                   .u_of_v = -sine * scale[1],
                   .u_shift = sine * scale[1] + offset[0],
                   .v_of_u = sine * scale[0],
                   .v_of_v = cosine * scale[1],
                   .v_shift = 1 - cosine * scale[1] - offset[1]};
  if (const auto set = index_in(*transform, "texCoord"); set && *set < AI_MAX_NUMBER_OF_TEXTURECOORDS) {
    result.uv_channel = static_cast<unsigned>(*set);
  }
}

const Texture* ModelMaterials::find_texture(const std::string& name) {
  auto found = textures_.find(name);
  if (found == textures_.end()) {
    std::string reason = "is no PNG or JPEG, damaged, or too large";
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
  const std::string whole = (folder / path).string();
  if (!files_.Exists(whole.c_str())) {
    reason = "is missing";
    return std::nullopt;
  }
  const auto bytes = files_.read(whole);
  if (!bytes) reason = "cannot be read";
  return bytes ? decode(*bytes) : std::nullopt;
}

}  // namespace gridiron::tool
