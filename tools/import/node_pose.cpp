// Node pose. SPDX-License-Identifier: Apache-2.0
#include "import/node_pose.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "import/model_stream.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMostNodes = std::size_t{1} << 22;
constexpr double kUsualTicksPerSecond = 25;  // Assimp's own where a file has none

double ticks_per_second(const aiAnimation& animation) {
  return animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kUsualTicksPerSecond;
}

// The keys around a time, and the share of the second one.
template <class Key>
struct KeyPair {
  const Key* first;
  const Key* second;
  double share;
};

template <class Key>
std::optional<KeyPair<Key>> keys_at(const Key* keys, unsigned count, double time) {
  if (keys == nullptr || count == 0) return std::nullopt;
  const Key* const end = keys + count;
  const Key* const after = std::upper_bound(keys, end, time, [](double t, const Key& key) { return t < key.mTime; });
  if (after == keys) return KeyPair<Key>{keys, keys, 0.0};
  if (after == end) return KeyPair<Key>{end - 1, end - 1, 0.0};
  const double span = after->mTime - (after - 1)->mTime;
  return KeyPair<Key>{after - 1, after, span > 0 ? (time - (after - 1)->mTime) / span : 0.0};
}

aiVector3D vector_at(const aiVectorKey* keys, unsigned count, double time, const aiVector3D& otherwise) {
  const auto pair = keys_at(keys, count, time);
  if (!pair) return otherwise;
  return pair->first->mValue + (pair->second->mValue - pair->first->mValue) * static_cast<ai_real>(pair->share);
}

aiQuaternion rotation_at(const aiQuatKey* keys, unsigned count, double time, const aiQuaternion& otherwise) {
  const auto pair = keys_at(keys, count, time);
  if (!pair) return otherwise;
  aiQuaternion rotation;
  aiQuaternion::Interpolate(rotation, pair->first->mValue, pair->second->mValue, static_cast<ai_real>(pair->share));
  return rotation.Normalize();
}

aiMatrix4x4 matrix_of(const aiNodeAnim& channel, const aiMatrix4x4& at_rest, double time) {
  aiVector3D scaling, position;
  aiQuaternion rotation;
  at_rest.Decompose(scaling, rotation, position);
  return aiMatrix4x4(vector_at(channel.mScalingKeys, channel.mNumScalingKeys, time, scaling),
                     rotation_at(channel.mRotationKeys, channel.mNumRotationKeys, time, rotation),
                     vector_at(channel.mPositionKeys, channel.mNumPositionKeys, time, position));
}

std::string_view name_of(const aiNode& node) {
  return {node.mName.data, node.mName.length};
}

}  // namespace

NodeMatrix as_double(const aiMatrix4x4& matrix) {
  return {matrix.a1, matrix.a2, matrix.a3, matrix.a4, matrix.b1, matrix.b2, matrix.b3, matrix.b4,
          matrix.c1, matrix.c2, matrix.c3, matrix.c4, matrix.d1, matrix.d2, matrix.d3, matrix.d4};
}

double seconds_of(const aiAnimation& animation) {
  const double seconds = animation.mDuration / ticks_per_second(animation);
  constexpr double kMostSeconds = 1e6;
  return std::isfinite(seconds) ? std::clamp(seconds, 0.0, kMostSeconds) : 0;
}

Movement movement_of(const aiScene& scene, unsigned index, double seconds) {
  const aiAnimation& animation = *scene.mAnimations[index];
  std::unordered_map<std::string_view, const aiNodeAnim*> channels;
  for (unsigned i = 0; i < animation.mNumChannels; ++i) {
    const aiNodeAnim* const channel = animation.mChannels[i];
    channels.emplace(std::string_view(channel->mNodeName.data, channel->mNodeName.length), channel);
  }
  const double time = seconds * ticks_per_second(animation);
  Movement movement;
  std::vector<const aiNode*> waiting;
  if (scene.mRootNode != nullptr) waiting.push_back(scene.mRootNode);
  while (!waiting.empty() && movement.parent_from_node.size() <= kMostNodes) {
    const aiNode& node = *waiting.back();
    waiting.pop_back();
    if (const auto channel = channels.find(name_of(node)); channel != channels.end()) {
      movement.parent_from_node.emplace(&node, as_double(matrix_of(*channel->second, node.mTransformation, time)));
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      if (node.mChildren[i] != nullptr) waiting.push_back(node.mChildren[i]);
    }
  }
  return movement;
}

NodePose::NodePose(const aiScene& scene, Movement movement) : movement_(std::move(movement)) {
  struct Waiting {
    const aiNode* node;
    NodeMatrix world_from_parent;
  };
  std::vector<Waiting> waiting;
  if (scene.mRootNode != nullptr) waiting.push_back({scene.mRootNode, {}});
  while (!waiting.empty()) {
    const Waiting next = waiting.back();
    waiting.pop_back();
    if (nodes_.size() >= kMostNodes) throw ImportError("has more than " + std::to_string(kMostNodes) + " nodes");
    const auto moved = movement_.parent_from_node.find(next.node);
    const bool is_moved = moved != movement_.parent_from_node.end();
    const NodeMatrix own = is_moved ? moved->second : as_double(next.node->mTransformation);
    by_name_.emplace(name_of(*next.node), nodes_.size());
    by_node_.emplace(next.node, nodes_.size());
    nodes_.push_back({next.node, next.world_from_parent * own});
    for (unsigned i = next.node->mNumChildren; i-- > 0;) {
      if (next.node->mChildren[i] != nullptr)
        waiting.push_back({next.node->mChildren[i], nodes_.back().world_from_node});
    }
  }
}

const NodeMatrix* NodePose::find(const aiBone& bone) const {
  if (const auto found = by_node_.find(bone.mNode); bone.mNode != nullptr && found != by_node_.end()) {
    return &nodes_[found->second].world_from_node;
  }
  const auto found = by_name_.find(std::string_view(bone.mName.data, bone.mName.length));
  return found == by_name_.end() ? nullptr : &nodes_[found->second].world_from_node;
}

float NodePose::weight_of(const aiNode& node, const aiMesh& mesh, unsigned target) const {
  if (!movement_.has_weights) return mesh.mAnimMeshes[target]->mWeight;
  const auto found = movement_.weights.find(&node);
  return found != movement_.weights.end() && target < found->second.size() ? found->second[target] : 0.0f;
}

}  // namespace gridiron::tool
