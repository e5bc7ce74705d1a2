// glTF scene. SPDX-License-Identifier: Apache-2.0
#include "import/gltf_scene.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "import/model_stream.h"

namespace gridiron::tool {
namespace {

// Indices in an array, as Assimp takes them: what is none is skipped.
std::vector<std::size_t> indices_in(const Json& object, const char* key) {
  std::vector<std::size_t> indices;
  const Json* const list = member(&object, key);
  if (list == nullptr || !list->is_array()) return indices;
  for (const Json& index : *list) {
    if (index.is_number_unsigned()) indices.push_back(index.get<std::size_t>());
  }
  return indices;
}

// The numbers of an attribute that Assimp misreads; nothing if there is none.
std::optional<std::vector<float>> misread_numbers(const GltfText& text, const Json& attributes, const std::string& name,
                                                  unsigned components, std::size_t vertices) {
  const std::optional<std::size_t> accessor = index_in(attributes, name.c_str());
  if (!text.is_misread(accessor)) return std::nullopt;
  std::optional<std::vector<float>> numbers = text.numbers(accessor, components);
  if (!numbers || numbers->size() != components * vertices)
    throw ImportError("the accessor of a " + name + " is damaged");
  return numbers;
}

void replace(aiVector3D* vectors, const std::vector<float>& numbers) {
  for (std::size_t i = 0; i < numbers.size() / 3; ++i) {
    vectors[i] = aiVector3D(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  }
}

void mend_targets(const GltfText& text, const Json& primitive, aiMesh& mesh) {
  const Json* const targets = member(&primitive, "targets");
  if (targets == nullptr || !targets->is_array() || targets->size() != mesh.mNumAnimMeshes) return;
  for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i) {
    aiAnimMesh* const target = mesh.mAnimMeshes[i];
    if (target == nullptr || target->mNumVertices != mesh.mNumVertices) continue;
    const std::pair<const char*, std::pair<aiVector3D*, const aiVector3D*>> parts[] = {
        {"POSITION", {target->mVertices, mesh.mVertices}}, {"NORMAL", {target->mNormals, mesh.mNormals}}};
    for (const auto& [name, vectors] : parts) {
      const auto& [moved, own] = vectors;
      if (moved == nullptr || own == nullptr) continue;
      // Assimp has added its reading of the displacement to its reading of the mesh.
      const std::optional<std::size_t> accessor = index_in((*targets)[i], name);
      if (!accessor) {
        std::copy_n(own, mesh.mNumVertices, moved);
        continue;
      }
      const std::optional<std::vector<float>> numbers = text.numbers(accessor, 3);
      if (!numbers || numbers->size() != std::size_t{3} * mesh.mNumVertices) continue;
      replace(moved, *numbers);
      for (unsigned k = 0; k < mesh.mNumVertices; ++k) moved[k] += own[k];
    }
  }
}

// The weights of all bones anew, from shares that are integers.
void mend_weights(const GltfText& text, const Json& attributes, aiMesh& mesh) {
  bool is_misread = false;
  for (int set = 0; set < 8; ++set) {
    is_misread = is_misread || text.is_misread(index_in(attributes, ("WEIGHTS_" + std::to_string(set)).c_str()));
  }
  if (!is_misread) return;
  std::vector<std::vector<aiVertexWeight>> weights(mesh.mNumBones);
  for (int set = 0; set < 8; ++set) {
    const std::string number = std::to_string(set);
    const auto joints = text.numbers(index_in(attributes, ("JOINTS_" + number).c_str()), 4);
    const auto shares = text.numbers(index_in(attributes, ("WEIGHTS_" + number).c_str()), 4);
    if (!joints || !shares) continue;
    const std::size_t vertices = std::min({joints->size(), shares->size(), std::size_t{4} * mesh.mNumVertices}) / 4;
    for (std::size_t i = 0; i < 4 * vertices; ++i) {
      const auto bone = static_cast<std::size_t>((*joints)[i]);
      if (bone < weights.size()) weights[bone].emplace_back(static_cast<unsigned>(i / 4), (*shares)[i]);
    }
  }
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    if (mesh.mBones[i] == nullptr) continue;
    mesh.mBones[i]->mNumWeights = static_cast<unsigned>(weights[i].size());
    // Never freed: the process ends without destructors.
    mesh.mBones[i]->mWeights = new aiVertexWeight[weights[i].size()];
    std::ranges::copy(weights[i], mesh.mBones[i]->mWeights);
  }
}

}  // namespace

GltfScene::GltfScene(const GltfText& text, aiScene& scene) : text_(text), scene_(scene) {
  match_nodes();
  std::set<unsigned> seen;
  for (const auto& [node, index] : nodes_) {
    const Json* const own = text_.item("nodes", index);
    const Json* const mesh = own != nullptr ? text_.item("meshes", index_in(*own, "mesh")) : nullptr;
    const Json* const primitives = member(mesh, "primitives");
    if (primitives == nullptr || primitives->size() != node->mNumMeshes) continue;
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      const unsigned number = node->mMeshes[i];
      if (number >= scene_.mNumMeshes || scene_.mMeshes[number] == nullptr || !seen.insert(number).second) continue;
      const Json& primitive = (*primitives)[i];
      if (const auto material = index_in(primitive, "material")) {
        materials_.emplace(scene_.mMeshes[number]->mMaterialIndex, *material);
      }
      mend_mesh(*scene_.mMeshes[number], primitive);
      bind_bones(*scene_.mMeshes[number], *own);
    }
  }
}

// Both trees side by side. Names cannot match them: they need not differ.
void GltfScene::match_nodes() {
  const Json* const scene = text_.item("scenes", index_in(text_.root(), "scene").value_or(0));
  if (scene == nullptr || scene_.mRootNode == nullptr) return;
  std::vector<std::pair<aiNode*, std::size_t>> waiting;
  // @returns false if the trees differ.
  const auto match = [&waiting](aiNode* const* nodes, std::size_t count, const std::vector<std::size_t>& indices) {
    if (count != indices.size()) return false;
    for (std::size_t i = 0; i < count; ++i) waiting.emplace_back(nodes[i], indices[i]);
    return true;
  };
  const std::vector<std::size_t> roots = indices_in(*scene, "nodes");
  aiNode* const root = scene_.mRootNode;
  // Above several roots Assimp puts one.
  bool is_alike = roots.size() == 1 ? match(&root, 1, roots) : match(root->mChildren, root->mNumChildren, roots);
  while (is_alike && !waiting.empty()) {
    const auto [node, index] = waiting.back();
    waiting.pop_back();
    const Json* const own = text_.item("nodes", index);
    is_alike =
        node != nullptr && own != nullptr && match(node->mChildren, node->mNumChildren, indices_in(*own, "children"));
    if (!is_alike) break;
    nodes_.emplace_back(node, index);
    first_nodes_.emplace(index, node);
  }
  if (is_alike) return;
  nodes_.clear();
  first_nodes_.clear();
}

void GltfScene::mend_mesh(aiMesh& mesh, const Json& primitive) const {
  const Json* const attributes = member(&primitive, "attributes");
  const Json* const extensions = member(&primitive, "extensions");
  if (attributes == nullptr || (extensions != nullptr && extensions->contains("KHR_draco_mesh_compression"))) return;
  const std::size_t vertices = mesh.mNumVertices;
  const auto positions = misread_numbers(text_, *attributes, "POSITION", 3, vertices);
  const auto normals = mesh.mNormals != nullptr ? misread_numbers(text_, *attributes, "NORMAL", 3, vertices)
                                                : std::optional<std::vector<float>>();
  if (positions && mesh.mVertices != nullptr) replace(mesh.mVertices, *positions);
  if (normals) replace(mesh.mNormals, *normals);
  mend_targets(text_, primitive, mesh);
  for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++set) {
    aiVector3D* const target = mesh.mTextureCoords[set];
    if (target == nullptr) continue;
    const auto places = misread_numbers(text_, *attributes, "TEXCOORD_" + std::to_string(set), 2, vertices);
    if (!places) continue;
    // Assimp counts v upwards.
    for (std::size_t i = 0; i < vertices; ++i) target[i] = aiVector3D((*places)[2 * i], 1 - (*places)[2 * i + 1], 0);
  }
  if (mesh.mNumBones != 0) mend_weights(text_, *attributes, mesh);
}

void GltfScene::bind_bones(aiMesh& mesh, const Json& node) const {
  const Json* const skin = text_.item("skins", index_in(node, "skin"));
  if (skin == nullptr || mesh.mNumBones == 0) return;
  const std::vector<std::size_t> joints = indices_in(*skin, "joints");
  if (joints.size() != mesh.mNumBones) return;
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const auto found = first_nodes_.find(joints[i]);
    if (found != first_nodes_.end() && mesh.mBones[i] != nullptr) mesh.mBones[i]->mNode = found->second;
  }
}

const Json* GltfScene::material(unsigned index) const {
  const auto found = materials_.find(index);
  return found != materials_.end() ? text_.item("materials", found->second) : nullptr;
}

std::vector<float> GltfScene::rest_weights(std::size_t node) const {
  const Json* const own = text_.item("nodes", node);
  if (own == nullptr) return {};
  const Json* list = member(own, "weights");
  if (list == nullptr) list = member(text_.item("meshes", index_in(*own, "mesh")), "weights");
  std::vector<float> weights;
  if (list == nullptr || !list->is_array()) return weights;
  for (const Json& weight : *list) weights.push_back(weight.is_number() ? weight.get<float>() : 0.0f);
  return weights;
}

}  // namespace gridiron::tool
