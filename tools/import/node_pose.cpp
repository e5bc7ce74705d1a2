// Node pose. SPDX-License-Identifier: Apache-2.0
#include "import/node_pose.h"

#include <algorithm>
#include <cmath>

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

using Channels = std::unordered_map<std::string_view, const aiNodeAnim*>;

Channels channels_of(const aiScene& scene) {
  Channels channels;
  const aiAnimation& animation = *scene.mAnimations[0];
  for (unsigned i = 0; i < animation.mNumChannels; ++i) {
    const aiNodeAnim* const channel = animation.mChannels[i];
    channels.emplace(std::string_view(channel->mNodeName.data, channel->mNodeName.length), channel);
  }
  return channels;
}

std::string_view name_of(const aiNode& node) {
  return {node.mName.data, node.mName.length};
}

}  // namespace

NodeMatrix as_double(const aiMatrix4x4& matrix) {
  return {matrix.a1, matrix.a2, matrix.a3, matrix.a4, matrix.b1, matrix.b2, matrix.b3, matrix.b4,
          matrix.c1, matrix.c2, matrix.c3, matrix.c4, matrix.d1, matrix.d2, matrix.d3, matrix.d4};
}

double animation_seconds(const aiScene& scene) {
  if (scene.mNumAnimations == 0 || scene.mAnimations[0] == nullptr) return 0;
  const double seconds = scene.mAnimations[0]->mDuration / ticks_per_second(*scene.mAnimations[0]);
  constexpr double kMostSeconds = 1e6;
  return std::isfinite(seconds) ? std::clamp(seconds, 0.0, kMostSeconds) : 0;
}

NodePose::NodePose(const aiScene& scene, std::optional<double> moment) {
  Channels channels;
  double time = 0;
  if (moment && scene.mNumAnimations != 0) {
    channels = channels_of(scene);
    time = *moment * animation_seconds(scene) * ticks_per_second(*scene.mAnimations[0]);
  }
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
    const auto channel = channels.find(name_of(*next.node));
    const aiMatrix4x4& at_rest = next.node->mTransformation;
    const NodeMatrix own = as_double(channel == channels.end() ? at_rest : matrix_of(*channel->second, at_rest, time));
    by_name_.emplace(name_of(*next.node), nodes_.size());
    nodes_.push_back({next.node, next.world_from_parent * own});
    for (unsigned i = next.node->mNumChildren; i-- > 0;) {
      if (next.node->mChildren[i] != nullptr)
        waiting.push_back({next.node->mChildren[i], nodes_.back().world_from_node});
    }
  }
}

const NodeMatrix* NodePose::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : &nodes_[found->second].world_from_node;
}

}  // namespace gridiron::tool
