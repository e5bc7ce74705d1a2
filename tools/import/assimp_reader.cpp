// Assimp reader: an Assimp scene as one mesh with its surface. Runs in the child only: Assimp may do anything.
// SPDX-License-Identifier: Apache-2.0
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "base/numbers.h"
#include "base/words.h"
#include "import/assimp_files.h"
#include "import/gltf_motion.h"
#include "import/gltf_scene.h"
#include "import/gltf_text.h"
#include "import/import_child.h"
#include "import/model_materials.h"
#include "import/model_stream.h"
#include "import/node_pose.h"
#include "import/value_pool.h"

namespace gridiron::tool {
namespace {

using DoubleVector = aiVector3t<double>;

ModelFormat format_of_ending(const std::string& ending) {
  if (ending == "gltf" || ending == "glb") return ModelFormat::kGltf;
  if (ending == "obj") return ModelFormat::kObj;
  return ending == "stl" ? ModelFormat::kStl : ModelFormat::kOther;
}

bool is_identity(const NodeMatrix& matrix) {
  return matrix == NodeMatrix();
}

// Turns normals as a matrix turns surfaces: its cofactors, which a singular matrix has too.
aiMatrix3x3t<double> normal_matrix(const NodeMatrix& m) {
  return {m.b2 * m.c3 - m.b3 * m.c2, m.b3 * m.c1 - m.b1 * m.c3, m.b1 * m.c2 - m.b2 * m.c1,
          m.a3 * m.c2 - m.a2 * m.c3, m.a1 * m.c3 - m.a3 * m.c1, m.a2 * m.c1 - m.a1 * m.c2,
          m.a2 * m.b3 - m.a3 * m.b2, m.a3 * m.b1 - m.a1 * m.b3, m.a1 * m.b2 - m.a2 * m.b1};
}

double determinant(const NodeMatrix& m) {
  return m.a1 * (m.b2 * m.c3 - m.b3 * m.c2) - m.a2 * (m.b1 * m.c3 - m.b3 * m.c1) + m.a3 * (m.b1 * m.c2 - m.b2 * m.c1);
}

// One matrix for each vertex: that of its node, or the weighted ones of its bones.
std::vector<NodeMatrix> skin_of(const aiMesh& mesh, const NodePose& pose, const NodeMatrix& world_from_node) {
  NodeMatrix zero = NodeMatrix();
  zero.a1 = zero.b2 = zero.c3 = zero.d4 = 0;
  std::vector<NodeMatrix> matrices(mesh.mNumVertices, zero);
  std::vector<double> sums(mesh.mNumVertices, 0.0);
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const aiBone& bone = *mesh.mBones[i];
    const NodeMatrix* const place = pose.find(bone);
    if (place == nullptr) continue;
    const NodeMatrix world_from_mesh = *place * as_double(bone.mOffsetMatrix);
    for (unsigned k = 0; k < bone.mNumWeights; ++k) {
      const aiVertexWeight& weight = bone.mWeights[k];
      if (weight.mVertexId >= mesh.mNumVertices || !(weight.mWeight > 0)) continue;
      const double share = weight.mWeight;
      sums[weight.mVertexId] += share;
      for (unsigned row = 0; row < 4; ++row) {
        for (unsigned column = 0; column < 4; ++column) {
          matrices[weight.mVertexId][row][column] += share * world_from_mesh[row][column];
        }
      }
    }
  }
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    if (sums[i] < 1e-6) {
      matrices[i] = world_from_node;
      continue;
    }
    for (unsigned row = 0; row < 4; ++row) {
      for (unsigned column = 0; column < 4; ++column) matrices[i][row][column] /= sums[i];
    }
  }
  return matrices;
}

// A mesh as its morph targets leave it: its own vectors, and the way to each target's by its weight.
std::vector<aiVector3D> morphed(const aiMesh& mesh, const std::vector<float>& weights, const aiVector3D* own,
                                aiVector3D* aiAnimMesh::*of_target) {
  std::vector<aiVector3D> vectors(own, own + mesh.mNumVertices);
  for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i) {
    const aiAnimMesh& target = *mesh.mAnimMeshes[i];
    const aiVector3D* const moved = target.*of_target;
    if (weights[i] == 0.0f || moved == nullptr || target.mNumVertices != mesh.mNumVertices) continue;
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) vectors[k] += (moved[k] - own[k]) * weights[i];
  }
  return vectors;
}

class MeshJoiner {
 public:
  MeshJoiner(const aiScene& scene, ModelFormat format, const NodePose& pose, const ModelMaterials& materials)
      : scene_(scene), format_(format), pose_(pose), materials_(materials) {}

  void add_all() {
    for (const PosedNode& node : pose_.nodes()) {
      for (unsigned i = 0; i < node.node->mNumMeshes; ++i) {
        const unsigned mesh = node.node->mMeshes[i];
        if (mesh >= scene_.mNumMeshes || scene_.mMeshes[mesh] == nullptr) throw ImportError("a node names no mesh");
        add(*scene_.mMeshes[mesh], node);
      }
    }
  }

  [[nodiscard]] Mesh take();
  [[nodiscard]] std::uint64_t mesh_count() const { return meshes_; }
  void tell(std::vector<std::string>& ignored) const;

 private:
  void add(const aiMesh& mesh, const PosedNode& node);
  void morph(const aiMesh& mesh, const aiNode& node);
  void add_triangle(const aiMesh& mesh, const std::array<unsigned, 3>& corners, const ModelMaterial& material);
  [[nodiscard]] std::uint16_t material_index(const aiMesh& mesh, bool has_normals);
  [[nodiscard]] float footprint_of(const aiMesh& mesh, const std::array<unsigned, 3>& corners,
                                   const ModelMaterial& material) const;
  [[nodiscard]] Vec3 color_of(const aiMesh& mesh, unsigned vertex, const ModelMaterial& material,
                              float footprint) const;

  const aiScene& scene_;
  ModelFormat format_;
  const NodePose& pose_;
  const ModelMaterials& materials_;
  ValuePool positions_, normals_, colors_;
  Mesh result_;
  std::map<std::pair<unsigned, bool>, std::uint16_t> material_indices_;
  bool has_own_material_ = false, has_normals_ = false, has_colors_ = false;
  std::uint64_t meshes_ = 0, points_ = 0, lines_ = 0, polygons_ = 0, placeless_ = 0;
  // Of the mesh being added, one per vertex; morphed vectors only where a target has a weight.
  std::vector<std::uint32_t> position_of_, normal_of_;
  std::vector<aiVector3D> morphed_positions_, morphed_normals_;
};

std::uint16_t MeshJoiner::material_index(const aiMesh& mesh, bool has_normals) {
  const ModelMaterial& material = materials_.of(mesh.mMaterialIndex);
  // All default materials are one.
  const unsigned key = material.is_default ? std::numeric_limits<unsigned>::max() : mesh.mMaterialIndex;
  const auto [place, is_new] = material_indices_.try_emplace({key, has_normals}, std::uint16_t{0});
  if (is_new) {
    std::vector<SceneMaterial>& list = result_.surface.materials;
    if (list.size() >= kMostSceneMaterials) throw ImportError("has more than 65535 materials");
    place->second = static_cast<std::uint16_t>(list.size());
    list.push_back(material.material);
    list.back().smooth_normals = has_normals;
    has_own_material_ = has_own_material_ || !material.is_default;
  }
  return place->second;
}

bool has_places(const aiMesh& mesh, const ModelMaterial& material) {
  return material.texture != nullptr && mesh.mTextureCoords[material.uv_channel] != nullptr;
}

// The place of a vertex in its texture.
std::array<double, 2> place_of(const aiMesh& mesh, unsigned vertex, const ModelMaterial& material) {
  const aiVector3D& uv = mesh.mTextureCoords[material.uv_channel][vertex];
  const double u = uv.x, v = uv.y;
  const PlaceTransform& t = material.places;
  return {t.u_of_u * u + t.u_of_v * v + t.u_shift, t.v_of_u * u + t.v_of_v * v + t.v_shift};
}

// How wide the third of a triangle that a corner stands for is, in texels.
float MeshJoiner::footprint_of(const aiMesh& mesh, const std::array<unsigned, 3>& corners,
                               const ModelMaterial& material) const {
  const auto a = place_of(mesh, corners[0], material), b = place_of(mesh, corners[1], material),
             c = place_of(mesh, corners[2], material);
  const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - a[0], vy = c[1] - a[1];
  const double texels = 0.5 * std::abs(ux * vy - uy * vx) * material.texture->width() * material.texture->height();
  return std::isfinite(texels) ? static_cast<float>(std::sqrt(texels / 3.0)) : 0.0f;
}

Vec3 MeshJoiner::color_of(const aiMesh& mesh, unsigned vertex, const ModelMaterial& material, float footprint) const {
  const auto clamped = [](float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f; };
  Vec3 color = material.material.color;
  if (has_places(mesh, material)) {
    const std::array<double, 2> place = place_of(mesh, vertex, material);
    color *= material.texture->sample(static_cast<float>(place[0]), static_cast<float>(place[1]), material.wrap_u,
                                      material.wrap_v, footprint);
  }
  if (mesh.mColors[0] != nullptr) {
    const aiColor4D& own = mesh.mColors[0][vertex];
    Vec3 factor(clamped(own.r), clamped(own.g), clamped(own.b));
    // glTF's are linear; those of other formats are shown as they are, which is sRGB.
    if (format_ != ModelFormat::kGltf) {
      factor = Vec3(linear_of_srgb(factor.x), linear_of_srgb(factor.y), linear_of_srgb(factor.z));
    }
    color *= factor;
  }
  return {clamped(color.x), clamped(color.y), clamped(color.z)};
}

void MeshJoiner::morph(const aiMesh& mesh, const aiNode& node) {
  morphed_positions_.clear();
  morphed_normals_.clear();
  std::vector<float> weights;
  for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i) {
    const bool is_there = mesh.mAnimMeshes[i] != nullptr;
    const float weight = is_there ? pose_.weight_of(node, mesh, i) : 0.0f;
    weights.push_back(std::isfinite(weight) ? weight : 0.0f);
  }
  if (std::ranges::all_of(weights, [](float weight) { return weight == 0.0f; })) return;
  morphed_positions_ = morphed(mesh, weights, mesh.mVertices, &aiAnimMesh::mVertices);
  if (mesh.mNormals != nullptr) morphed_normals_ = morphed(mesh, weights, mesh.mNormals, &aiAnimMesh::mNormals);
}

void MeshJoiner::add(const aiMesh& mesh, const PosedNode& node) {
  const NodeMatrix& world_from_node = node.world_from_node;
  if (mesh.mNumFaces == 0) {
    points_ += mesh.mNumVertices;
    return;
  }
  if (mesh.mVertices == nullptr) throw ImportError("a mesh has faces and no vertices");
  const std::vector<NodeMatrix> skin =
      mesh.mNumBones != 0 ? skin_of(mesh, pose_, world_from_node) : std::vector<NodeMatrix>();
  const bool has_normals = mesh.mNormals != nullptr && format_ != ModelFormat::kStl;
  const bool stays = skin.empty() && is_identity(world_from_node);
  const bool turns = determinant(skin.empty() ? world_from_node : skin[0]) < 0;
  morph(mesh, *node.node);
  position_of_.assign(mesh.mNumVertices, kNoNormal);
  normal_of_.assign(mesh.mNumVertices, kNoNormal);
  const ModelMaterial& material = materials_.of(mesh.mMaterialIndex);
  bool has_triangle = false;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) {
      ++(face.mNumIndices <= 1 ? points_ : face.mNumIndices == 2 ? lines_ : polygons_);
      continue;
    }
    std::array<unsigned, 3> corners = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (turns) std::swap(corners[1], corners[2]);
    for (const unsigned vertex : corners) {
      if (vertex >= mesh.mNumVertices) throw ImportError("an index names no vertex");
      if (position_of_[vertex] != kNoNormal) continue;
      const aiVector3D& own = morphed_positions_.empty() ? mesh.mVertices[vertex] : morphed_positions_[vertex];
      Vec3 position(own.x, own.y, own.z);
      const NodeMatrix& matrix = skin.empty() ? world_from_node : skin[vertex];
      if (!stays) {
        const DoubleVector moved = matrix * DoubleVector(own.x, own.y, own.z);
        position = Vec3(static_cast<float>(moved.x), static_cast<float>(moved.y), static_cast<float>(moved.z));
      }
      if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
        throw ImportError("a coordinate is not finite");
      }
      position_of_[vertex] = positions_.index_of(position);
      if (!has_normals) continue;
      const aiVector3D& normal = morphed_normals_.empty() ? mesh.mNormals[vertex] : morphed_normals_[vertex];
      DoubleVector turned(normal.x, normal.y, normal.z);
      if (!stays) turned = normal_matrix(matrix) * turned * (turns ? -1.0 : 1.0);
      const double length = turned.Length();
      if (!(length > 0) || !std::isfinite(length)) continue;
      turned /= length;
      normal_of_[vertex] = normals_.index_of(
          Vec3(static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z)));
    }
    add_triangle(mesh, corners, material);
    has_triangle = true;
  }
  meshes_ += has_triangle ? 1 : 0;
  if (has_triangle && material.texture != nullptr && !has_places(mesh, material)) ++placeless_;
}

void MeshJoiner::add_triangle(const aiMesh& mesh, const std::array<unsigned, 3>& corners,
                              const ModelMaterial& material) {
  const auto three = [&corners](const std::vector<std::uint32_t>& of) {
    return UVec3(of[corners[0]], of[corners[1]], of[corners[2]]);
  };
  if (result_.triangles.size() >= kMostSceneTriangles) throw ImportError("has more than 67,108,864 triangles");
  result_.triangles.push_back(three(position_of_));
  UVec3 normals = three(normal_of_);
  const bool has_normals = normals.x != kNoNormal && normals.y != kNoNormal && normals.z != kNoNormal;
  if (!has_normals) normals = UVec3(kNoNormal);
  result_.surface.triangle_materials.push_back(material_index(mesh, has_normals));
  result_.surface.triangle_normals.push_back(normals);
  has_normals_ = has_normals_ || has_normals;
  UVec3 colors(kNoNormal);
  const bool has_texture = has_places(mesh, material);
  if (has_texture || mesh.mColors[0] != nullptr) {
    const float footprint = has_texture ? footprint_of(mesh, corners, material) : 0.0f;
    for (int i = 0; i < 3; ++i) {
      colors[i] = colors_.index_of(color_of(mesh, corners[static_cast<std::size_t>(i)], material, footprint));
    }
    has_colors_ = true;
  }
  result_.surface.triangle_colors.push_back(colors);
}

Mesh MeshJoiner::take() {
  MeshSurface& surface = result_.surface;
  // The file has none: those who use the surface know better than Assimp what to take.
  if (!has_own_material_) {
    surface.materials.clear();
    surface.triangle_materials = {};
  }
  if (!has_normals_) surface.triangle_normals = {};
  if (!has_colors_) surface.triangle_colors = {};
  result_.vertices = positions_.take();
  surface.normals = normals_.take();
  surface.colors = colors_.take();
  return std::move(result_);
}

void MeshJoiner::tell(std::vector<std::string>& ignored) const {
  if (points_ != 0) ignored.push_back(words_of_count(points_, "point"));
  if (lines_ != 0) ignored.push_back(words_of_count(lines_, "line"));
  if (polygons_ != 0) ignored.push_back(words_of_count(polygons_, "polygon") + " that cannot be cut into triangles");
  if (placeless_ != 0) {
    ignored.push_back("the texture of " + words_of_count(placeless_) + (placeless_ == 1 ? " mesh" : " meshes") +
                      " without texture coordinates");
  }
}

std::string words_of_format(const std::string& ending, const Assimp::Importer& importer) {
  if (ending == "obj" || ending == "stl") return ending == "obj" ? "OBJ" : "STL";
  if (ending == "gltf" || ending == "glb") return "glTF";
  const std::size_t index = importer.GetImporterIndex(("." + ending).c_str());
  const aiImporterDesc* const description =
      index != static_cast<std::size_t>(-1) ? importer.GetImporterInfo(index) : nullptr;
  return description != nullptr && description->mName != nullptr ? description->mName : ending;
}

// Units and axes as the joined mesh has them.
void read_frame(ModelFormat format, const std::string& ending, const aiScene& scene, ImportReport& report) {
  // Assimp converts Collada to both.
  if (format == ModelFormat::kGltf || ending == "dae") {
    report.unit_metres = 1;
    report.up = std::string("y");
    return;
  }
  if (scene.mMetaData == nullptr) return;
  std::int32_t axis = -1, sign = 1;
  if (scene.mMetaData->Get("UpAxis", axis) && axis >= 0 && axis <= 2) {
    (void)scene.mMetaData->Get("UpAxisSign", sign);
    constexpr const char* kAxes[2][3] = {{"x", "y", "z"}, {"-x", "-y", "-z"}};
    report.up = std::string(kAxes[sign < 0 ? 1 : 0][axis]);
  }
  float centimetres = 0;
  double wide = 0;
  if (!scene.mMetaData->Get("UnitScaleFactor", centimetres) && scene.mMetaData->Get("UnitScaleFactor", wide)) {
    centimetres = static_cast<float>(wide);
  }
  if (centimetres > 0 && centimetres < 1e9f) report.unit_metres = static_cast<double>(centimetres) / 100;
}

// What Assimp warns of indices that name nothing: it leaves such a corner or face out, or takes another vertex.
class IndexWarnings final : public Assimp::LogStream {
 public:
  void write(const char* message) override {
    constexpr std::size_t kMostWarnings = 3;
    std::string text(message);
    text.erase(0, text.find(": ") == std::string::npos ? 0 : text.find(": ") + 2);  // "Warn,  T1: "
    text.erase(text.find_last_not_of("\r\n") + 1);
    const auto has = [&text](const char* word) { return text.find(word) != std::string::npos; };
    const bool is_of_index = has("index") || has("Index") || has("indices") || has("idx");
    if (!is_of_index || !(has("range") || has("bounds") || has("nvalid"))) return;
    if (warnings_.size() < kMostWarnings && std::ranges::find(warnings_, text) == warnings_.end()) {
      warnings_.push_back(text);
    }
  }

  void tell(std::vector<std::string>& ignored) const {
    for (const std::string& text : warnings_) ignored.push_back("wrong indices (" + in_quotes(text) + ")");
  }

 private:
  std::vector<std::string> warnings_;
};

bool is_shortage(const std::string& words) {
  return words.find("bad_alloc") != std::string::npos || words.find("emory") != std::string::npos;
}

void tell_scene(const aiScene& scene, const AssimpFiles& files, const GltfText* gltf, bool is_posed,
                std::vector<std::string>& ignored) {
  const auto add = [&ignored](std::uint64_t count, const char* noun) {
    if (count != 0) ignored.push_back(words_of_count(count, noun));
  };
  add(scene.mNumCameras, "camera");
  add(scene.mNumLights, "light");
  const unsigned kept = is_posed && scene.mNumAnimations != 0 ? 1 : 0;
  if (scene.mNumAnimations != kept) {
    const std::string count = words_of_count(scene.mNumAnimations - kept, "animation");
    ignored.push_back(is_posed ? count : count + ", which 'gridiron animate --animation N' shows");
  }
  if (gltf != nullptr) {
    const Json* const scenes = member(&gltf->root(), "scenes");
    if (scenes != nullptr && scenes->size() > 1) add(scenes->size() - 1, "other scene");
    std::vector<std::string> names;
    for (const std::string& name : gltf->unused_extensions()) names.push_back(in_quotes(name));
    if (!names.empty()) {
      ignored.push_back(std::string(names.size() == 1 ? "the extension " : "the extensions ") + words_of_list(names));
    }
  }
  constexpr std::size_t kMostNames = 5;
  std::size_t named = 0;
  for (const std::string& path : files.missing()) {
    if (named++ < kMostNames) ignored.push_back("the missing file " + in_quotes(path));
  }
}

std::vector<ImportedAnimation> animations_of(const aiScene& scene) {
  std::vector<ImportedAnimation> animations;
  for (unsigned i = 0; i < scene.mNumAnimations; ++i) {
    if (scene.mAnimations[i] == nullptr) throw ImportError("an animation is missing");
    const aiString& name = scene.mAnimations[i]->mName;
    animations.push_back({std::string(name.data, name.length), seconds_of(*scene.mAnimations[i])});
  }
  return animations;
}

// The animation with a name, or with a number from 1 on; the first one if neither is given.
unsigned choose_animation(const std::vector<ImportedAnimation>& animations, const std::string& wanted) {
  if (wanted.empty()) return 0;
  const auto named = std::ranges::find(animations, wanted, &ImportedAnimation::name);
  if (named != animations.end()) return static_cast<unsigned>(named - animations.begin());
  const std::optional<std::uint32_t> number = parse_count(wanted);
  if (number && *number >= 1 && *number <= animations.size()) return *number - 1;
  std::vector<std::string> names;
  constexpr std::size_t kMostNames = 20;
  for (std::size_t i = 0; i < std::min(animations.size(), kMostNames); ++i) {
    names.push_back(std::to_string(i + 1));
    if (!animations[i].name.empty()) names.back().append(" ").append(in_quotes(animations[i].name));
  }
  if (animations.size() > kMostNames) names.push_back("more");
  throw ImportError("has " + words_of_count(animations.size(), "animation") + ", " + words_of_list(names) +
                    "; none is " + in_quotes(wanted));
}

// The scene at rest, or at a moment of one of its animations.
Movement choose_movement(const aiScene& scene, const GltfScene* gltf, const ChildSettings& settings,
                         ImportReport& report) {
  report.animations = animations_of(scene);
  std::optional<unsigned> chosen;
  if (settings.moment && !report.animations.empty()) chosen = choose_animation(report.animations, settings.animation);
  if (gltf != nullptr) {
    const GltfMotion motion(*gltf, chosen);
    if (motion.damaged_count() != 0) {
      report.ignored.push_back(words_of_count(motion.damaged_count(), "channel") + " with damaged keys");
    }
    // Assimp's length is rounded, and the last moment must reach the last key.
    return motion.movement_at(settings.moment.value_or(0) * motion.seconds());
  }
  if (!chosen) return {};
  if (scene.mAnimations[*chosen]->mNumMorphMeshChannels != 0 || scene.mAnimations[*chosen]->mNumMeshChannels != 0) {
    report.ignored.push_back("what the animation does to shapes");
  }
  return movement_of(scene, *chosen, *settings.moment * report.animations[*chosen].seconds);
}

}  // namespace

ImportedModel read_with_assimp(std::span<const std::byte> bytes, const ChildSettings& settings) {
  // Never destroyed: the process ends without destructors.
  auto& importer = *new Assimp::Importer();
  const std::filesystem::path folder = folder_of_input(settings.path);
  const std::string stem = is_stream(settings.path) ? "model" : settings.path.stem().string();
  auto& files = *new AssimpFiles((folder / (stem + "." + settings.ending)).string(), bytes);
  importer.SetIOHandler(&files);
  const ModelFormat format = format_of_ending(settings.ending);
  Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
  auto& warnings = *new IndexWarnings();
  Assimp::DefaultLogger::get()->attachStream(&warnings, Assimp::Logger::Warn | Assimp::Logger::Err);
  std::optional<GltfText> text;
  std::string fault;  // of the text; Assimp names none
  if (format == ModelFormat::kGltf) text = GltfText::parse(bytes, files, fault);
  if (text) text->require_readable();
  if (importer.ReadFile(files.name(), aiProcess_Triangulate) == nullptr) {
    const std::string words = importer.GetErrorString();
    if (is_shortage(words)) throw std::bad_alloc();
    if (!fault.empty()) throw ImportError(fault);
    throw ImportError(words.empty() ? "Assimp cannot read it" : "Assimp cannot read it: " + words);
  }
  const std::string reader_format = words_of_format(settings.ending, importer);
  aiScene& scene = *importer.GetOrphanedScene();
  std::optional<GltfScene> gltf;
  if (text) gltf.emplace(*text, scene);
  const GltfScene* const gltf_scene = gltf ? &*gltf : nullptr;
  ImportedModel model;
  ImportReport& report = model.report;
  const NodePose pose(scene, choose_movement(scene, gltf_scene, settings, report));
  const ModelMaterials materials(scene, format, files, gltf_scene);
  MeshJoiner joiner(scene, format, pose, materials);
  joiner.add_all();
  model.mesh = joiner.take();
  report.format = reader_format;
  report.reader = "Assimp " + std::to_string(aiGetVersionMajor()) + "." + std::to_string(aiGetVersionMinor()) + "." +
                  std::to_string(aiGetVersionPatch());
  read_frame(format, settings.ending, scene, report);
  report.meshes = joiner.mesh_count();
  report.textures = materials.texture_count();
  joiner.tell(report.ignored);
  warnings.tell(report.ignored);
  materials.tell(report.ignored);
  tell_scene(scene, files, text ? &*text : nullptr, settings.moment.has_value(), report.ignored);
  model.neighbours = files.neighbours();
  return model;
}

}  // namespace gridiron::tool
