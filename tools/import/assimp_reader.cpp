// Assimp reader: an Assimp scene as one mesh with its surface. Runs in the child only: Assimp may do anything.
// SPDX-License-Identifier: Apache-2.0
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "base/words.h"
#include "import/assimp_files.h"
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
    const NodeMatrix* const place = pose.find({bone.mName.data, bone.mName.length});
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

class MeshJoiner {
 public:
  MeshJoiner(const aiScene& scene, ModelFormat format, const NodePose& pose, const ModelMaterials& materials)
      : scene_(scene), format_(format), pose_(pose), materials_(materials) {}

  void add_all() {
    for (const PosedNode& node : pose_.nodes()) {
      for (unsigned i = 0; i < node.node->mNumMeshes; ++i) {
        const unsigned mesh = node.node->mMeshes[i];
        if (mesh >= scene_.mNumMeshes || scene_.mMeshes[mesh] == nullptr) throw ImportError("a node names no mesh");
        add(*scene_.mMeshes[mesh], node.world_from_node);
      }
    }
  }

  [[nodiscard]] Mesh take();
  [[nodiscard]] std::uint64_t mesh_count() const { return meshes_; }
  void tell(std::vector<std::string>& ignored) const;

 private:
  void add(const aiMesh& mesh, const NodeMatrix& world_from_node);
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
  std::uint64_t meshes_ = 0, points_ = 0, lines_ = 0, polygons_ = 0, morphs_ = 0;
  // Of the mesh being added, one per vertex.
  std::vector<std::uint32_t> position_of_, normal_of_;
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

// How wide the third of a triangle that a corner stands for is, in texels.
float MeshJoiner::footprint_of(const aiMesh& mesh, const std::array<unsigned, 3>& corners,
                               const ModelMaterial& material) const {
  const aiVector3D* const uv = mesh.mTextureCoords[material.uv_channel];
  const double ux = uv[corners[1]].x - uv[corners[0]].x, uy = uv[corners[1]].y - uv[corners[0]].y;
  const double vx = uv[corners[2]].x - uv[corners[0]].x, vy = uv[corners[2]].y - uv[corners[0]].y;
  const double texels = 0.5 * std::abs(ux * vy - uy * vx) * material.texture->width() * material.texture->height();
  return std::isfinite(texels) ? static_cast<float>(std::sqrt(texels / 3.0)) : 0.0f;
}

Vec3 MeshJoiner::color_of(const aiMesh& mesh, unsigned vertex, const ModelMaterial& material, float footprint) const {
  const auto clamped = [](float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f; };
  Vec3 color = material.material.color;
  if (material.texture != nullptr && mesh.mTextureCoords[material.uv_channel] != nullptr) {
    const aiVector3D& uv = mesh.mTextureCoords[material.uv_channel][vertex];
    color *= material.texture->sample(uv.x, uv.y, material.wrap_u, material.wrap_v, footprint);
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

void MeshJoiner::add(const aiMesh& mesh, const NodeMatrix& world_from_node) {
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
  morphs_ += mesh.mNumAnimMeshes != 0 ? 1 : 0;
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
      const aiVector3D& own = mesh.mVertices[vertex];
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
      const aiVector3D& normal = mesh.mNormals[vertex];
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
  const bool has_texture = material.texture != nullptr && mesh.mTextureCoords[material.uv_channel] != nullptr;
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
  if (morphs_ != 0)
    ignored.push_back("the morph targets of " + words_of_count(morphs_) + (morphs_ == 1 ? " mesh" : " meshes"));
}

std::string words_of_format(const std::string& ending, const Assimp::Importer& importer) {
  if (ending == "obj" || ending == "stl") return ending == "obj" ? "OBJ" : "STL";
  if (ending == "gltf" || ending == "glb") return "glTF";
  const std::size_t index = importer.GetImporterIndex(("." + ending).c_str());
  const aiImporterDesc* const description =
      index != static_cast<std::size_t>(-1) ? importer.GetImporterInfo(index) : nullptr;
  return description != nullptr && description->mName != nullptr ? description->mName : ending;
}

std::string words_of_frame(ModelFormat format, const aiScene& scene) {
  if (format == ModelFormat::kGltf) return "in metres, y up";
  std::int32_t axis = -1;
  if (scene.mMetaData != nullptr && scene.mMetaData->Get("UpAxis", axis) && axis >= 0 && axis <= 2) {
    std::string words = std::string(1, static_cast<char>('x' + axis)) + " up";
    double centimetres = 0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres) && centimetres > 0) {
      char text[64];
      std::snprintf(text, sizeof text, "in units of %g cm, ", centimetres);
      words = text + words;
    }
    return words;
  }
  return "";
}

bool is_shortage(const std::string& words) {
  return words.find("bad_alloc") != std::string::npos || words.find("emory") != std::string::npos;
}

void tell_scene(const aiScene& scene, const ModelMaterials& materials, const AssimpFiles& files, bool is_posed,
                std::vector<std::string>& ignored) {
  const auto add = [&ignored](std::uint64_t count, const char* noun) {
    if (count != 0) ignored.push_back(words_of_count(count, noun));
  };
  add(scene.mNumCameras, "camera");
  add(scene.mNumLights, "light");
  const unsigned kept = is_posed && scene.mNumAnimations != 0 ? 1 : 0;
  add(scene.mNumAnimations - kept, "animation");
  if (const std::size_t others = materials.other_texture_count(); others != 0) {
    ignored.push_back(words_of_count(others, "texture") + " of something other than base colour");
  }
  if (materials.dropped_highlight_count() != 0) {
    ignored.push_back("highlights without mirrors of " +
                      words_of_count(materials.dropped_highlight_count(), "material"));
  }
  constexpr std::size_t kMostNames = 5;
  for (std::size_t i = 0; i < std::min(kMostNames, materials.unread_textures().size()); ++i) {
    ignored.push_back("the texture " + materials.unread_textures()[i]);
  }
  std::size_t named = 0;
  for (const std::string& path : files.missing()) {
    if (named++ < kMostNames) ignored.push_back("the missing file " + in_quotes(path));
  }
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
  const aiScene* const scene = importer.ReadFile(files.name(), aiProcess_Triangulate);
  if (scene == nullptr) {
    const std::string words = importer.GetErrorString();
    if (is_shortage(words)) throw std::bad_alloc();
    throw ImportError(words.empty() ? "Assimp cannot read it" : "Assimp cannot read it: " + words);
  }
  const NodePose pose(*scene, settings.moment);
  const ModelMaterials materials(*scene, format, files);
  MeshJoiner joiner(*scene, format, pose, materials);
  joiner.add_all();
  ImportedModel model;
  model.mesh = joiner.take();
  ImportReport& report = model.report;
  report.format = words_of_format(settings.ending, importer);
  report.reader = "Assimp " + std::to_string(aiGetVersionMajor()) + "." + std::to_string(aiGetVersionMinor()) + "." +
                  std::to_string(aiGetVersionPatch());
  report.frame = words_of_frame(format, *scene);
  report.meshes = joiner.mesh_count();
  report.animation_seconds = animation_seconds(*scene);
  joiner.tell(report.ignored);
  tell_scene(*scene, materials, files, settings.moment.has_value(), report.ignored);
  model.neighbours = files.neighbours();
  return model;
}

}  // namespace gridiron::tool
