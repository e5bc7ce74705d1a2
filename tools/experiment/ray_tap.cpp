// Secondary rays of a frame. SPDX-License-Identifier: Apache-2.0
#include "experiment/ray_tap.h"

#include <gridiron/base/lanes.h>
#include <gridiron/build/lattice.h>
#include <gridiron/engine/tree/ray_lists.h>
#include <gridiron/engine/tree/tree_engine.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/shade/wave_jobs.h>
#include <gridiron/sim/plain_core.h>
#include <gridiron/store/local_store.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "base/failure.h"
#include "base/words.h"
#include "experiment/edge_points.h"
#include "files/interrupt.h"

namespace gridiron::experiment {
namespace {

using ChipLanes = Lanes<4>;

/// The rays of a frame so far, and the kind of those to its lights.
struct RayNotes {
  std::vector<TracedRay> rays;
  RayKind light_kind{};
};

// The tree engine's memory, and where its rays are noted.
struct TappedStore : TreeStore {
  RayNotes* notes;
};

// Kinds of rays by the jobs that make them. Call right after the ray was made.
template <class Store, std::uint32_t Built>
RayKind kind_of(const LightJobs<Store, Built>&, const Store& store, std::uint32_t) {
  return store.rays.notes->light_kind;
}
template <class Store>
RayKind kind_of(const OcclusionJobs<Store>&, const Store&, std::uint32_t) {
  return RayKind::kOcclusion;
}
// Refracted rays have odd paths (core/EFFECTS.md).
template <class Store>
RayKind kind_of(const WaveRayJobs<Store>&, const Store& store, std::uint32_t owner) {
  return store.wave.items[owner].ray.path % 2 == 0 ? RayKind::kReflection : RayKind::kRefraction;
}

// Hands jobs through and notes rays and answers.
template <class Store, class Jobs>
class TappedJobs {
 public:
  TappedJobs(Store& store, Jobs& jobs) : store_(store), jobs_(jobs), first_(rays().size()) {}

  bool next(RayBatch& batch) {
    const std::uint32_t before = batch.count;
    const bool has_more = jobs_.next(batch);
    for (std::uint32_t i = before; i < batch.count; ++i) {
      const BatchRay& ray = batch.rays[i];
      rays().push_back({.origin = Vec3(ray.origin[0], ray.origin[1], ray.origin[2]),
                        .dir = Vec3(ray.dir[0], ray.dir[1], ray.dir[2]),
                        .t = ray.t,
                        .kind = kind_of(jobs_, store_, batch.owners[i])});
    }
    return has_more;
  }
  void finish(const RayBatch& batch) {
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      if (batch.rays[i].has_hit()) rays()[first_ + i].id = batch.rays[i].id;
    }
    first_ += batch.count;
    jobs_.finish(batch);
  }

 private:
  [[nodiscard]] std::vector<TracedRay>& rays() { return store_.rays.notes->rays; }

  Store& store_;
  Jobs& jobs_;
  std::size_t first_;  ///< of the batch's rays
};

template <class L, class Store, Platform P>
class TappedCore {
 public:
  TappedCore(Store& store, Transfers<P>& transfers) : store_(store), tree_(store, transfers) {}

  [[nodiscard]] Status begin() { return tree_.begin(); }
  void begin_rays() { tree_.begin_rays(); }
  template <class Jobs>
  [[nodiscard]] Status trace(const RayQuestion& question, Jobs& jobs) {
    TappedJobs<Store, Jobs> tapped(store_, jobs);
    return tree_.trace(question, tapped);
  }

 private:
  Store& store_;
  TreeCore<L, Store, P> tree_;
};

/// TreeEngine, noted.
struct TappedEngine {
  using Store = TappedStore;
  template <class Layout>
  using RayStore = TreeEngine::RayStore<Layout>;
  template <class Layout>
  static constexpr std::uint32_t kMaxDepth = TreeEngine::kMaxDepth<Layout>;
  template <class L, class Store, Platform P>
  using Core = TappedCore<L, Store, P>;
};

/// The layout of configuration grid.
struct TappedLayout : EffectLayout256K<kAllEffects, 32> {
  using RayEngine = TappedEngine;
};

// Nodes and records where they lie.
class MemorySource {
 public:
  MemorySource(std::span<const TreeNode> nodes, std::span<const VertexTriangle> records, const MeshView& mesh)
      : nodes_(nodes), records_(records), mesh_(mesh) {}

  [[nodiscard]] static std::uint32_t window() { return 1; }
  [[nodiscard]] static Status ahead(TreeChild) { return Status::kOk; }
  [[nodiscard]] Status node(std::uint32_t index, const TreeNode*& node) const {
    node = &nodes_[index];
    return Status::kOk;
  }
  [[nodiscard]] Status leaf(TreeChild child, const VertexTriangle*& records) const {
    records = &records_[child.first()];
    return Status::kOk;
  }
  [[nodiscard]] Status triangle_of(MainAddress, std::uint32_t id, VertexTriangle& triangle) const {
    set_corners(mesh_, id, triangle);
    return Status::kOk;
  }

  static void set_corners(const MeshView& mesh, std::uint32_t id, VertexTriangle& triangle) {
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3& vertex = mesh.vertices[mesh.triangles[id][corner]];
      for (int axis = 0; axis < 3; ++axis) triangle.v[corner][axis] = vertex[axis];
    }
    triangle.triangle_id = id;
  }

 private:
  std::span<const TreeNode> nodes_;
  std::span<const VertexTriangle> records_;
  MeshView mesh_;
};

void require(Status status, const PreparedEffectFrame& frame) {
  if (status != Status::kOk)
    throw tool::Failure(tool::ExitCode::kCheckFailed,
                        frame.plan.scene.input.string() + ": " + std::string(tool::words_of(status)));
}

}  // namespace

std::vector<TracedRay> trace_secondary_rays(PreparedEffectFrame& frame) {
  tool::stop_if_interrupted();
  tool::FrameMemory& memory = frame.memory;
  RayNotes notes;
  notes.light_kind = (memory.image.effects.called_for & kAreaLights) != 0 ? RayKind::kArea : RayKind::kShadow;
  const auto store = std::make_unique<LocalStore<TappedLayout>>();
  store->rays.notes = &notes;
  sim::ItemSource tiles(memory.record.tiles_x * memory.record.tiles_y);
  PlatformLimits limits;
  limits.queue_depth = frame.plan.scene.machine->queue_depth;
  sim::PlainCore core(memory.memory.base(), limits, tiles);
  require(render_tiles<ChipLanes>(*store, core, memory.record_address,
                                  SpillRegion{memory.spill.address, memory.spill_bytes_per_core}),
          frame);
  const std::vector<Light>& lights = frame.input.effects->lights;
  for (TracedRay& ray : notes.rays) {
    ray.from_light =
        ray.kind == RayKind::kShadow && std::ranges::find(lights, ray.origin, &Light::corner) != lights.end();
  }
  return std::move(notes.rays);
}

RayTree::RayTree(PreparedEffectFrame& frame) {
  const tool::Mesh& mesh = std::get<tool::Mesh>(frame.input.content);
  const TreeRecord& tree = frame.memory.image.tree;
  const bool is_on_lattice = tree.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  triangles_ = mesh.triangles;
  vertices_ = mesh.vertices;
  if (is_on_lattice) {
    for (Vec3& vertex : vertices_) vertex = snap(tree.lattice, vertex);
  }
  const std::uint64_t image = frame.memory.image_address.value;
  const auto bytes_of = [&](std::uint64_t offset_bytes, std::uint64_t count) {
    return frame.memory.memory.bytes_at(MainAddress{image + offset_bytes}, count);
  };
  nodes_.resize(tree.node_count);
  const std::span<const std::byte> nodes = bytes_of(tree.nodes_offset_bytes, nodes_.size() * sizeof(TreeNode));
  std::memcpy(nodes_.data(), nodes.data(), nodes.size());
  // Each record ends with its triangle's number; the corners are the mesh's.
  records_.resize(tree.triangle_count);
  const std::span<const std::byte> records =
      bytes_of(tree.triangles_offset_bytes, records_.size() * std::uint64_t{tree.triangle_bytes});
  for (std::size_t i = 0; i < records_.size(); ++i) {
    std::uint32_t id = 0;
    std::memcpy(&id, records.data() + (i + 1) * tree.triangle_bytes - sizeof id, sizeof id);
    MemorySource::set_corners(this->mesh(), id, records_[i]);
  }
  Vec3 extent;
  for (int axis = 0; axis < 3; ++axis) {
    largest_ = std::max({largest_, std::abs(tree.bounds_minimum[axis]), std::abs(tree.bounds_maximum[axis])});
    extent[axis] = tree.bounds_maximum[axis] - tree.bounds_minimum[axis];
  }
  diagonal_ = glm::length(extent);
}

std::vector<RayHit> RayTree::nearest(std::span<const TracedRay> rays, Accuracy accuracy, WorkCounters& work) const {
  using Memory = ListMemory<512, 0, false>;
  const auto memory = std::make_unique<Memory>();
  MemorySource source(nodes_, records_, mesh());
  RayLists<ChipLanes, Memory, MemorySource> lists(*memory, source, work);
  const RayQuestion question{false, false, accuracy == Accuracy::kFast, accuracy == Accuracy::kExact, {}};
  std::vector<RayHit> hits;
  hits.reserve(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += Memory::kRays) {
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(rays.size() - first, Memory::kRays));
    for (std::uint32_t i = 0; i < count; ++i) {
      const TracedRay& ray = rays[first + i];
      BatchRay& asked = memory->rays[i];
      for (int axis = 0; axis < 3; ++axis) {
        asked.origin[axis] = ray.origin[axis];
        asked.dir[axis] = ray.dir[axis];
      }
      asked.t = ray.t;
      asked.id = no_hit(kNoTriangle);
    }
    // A source in memory has no transfers that fail.
    (void)lists.trace(question, count, largest_);
    for (std::uint32_t i = 0; i < count; ++i) {
      const TracedRay& ray = rays[first + i];
      const BatchRay& answered = memory->rays[i];
      if (!answered.has_hit()) {
        hits.emplace_back();
        continue;
      }
      // The direction may have been scaled by a power of two, and t with it.
      int axis = 0;
      while (axis < 2 && ray.dir[axis] == 0) ++axis;
      hits.push_back({answered.id, answered.t * (answered.dir[axis] / ray.dir[axis])});
    }
  }
  return hits;
}

std::vector<TracedRay> RayTree::aimed_at_edges(std::span<const TracedRay> rays, std::span<const RayHit> hits) const {
  std::vector<TracedRay> aimed;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].id == kNoTriangle) continue;
    TracedRay ray = rays[i];
    if (ray.from_light) ray.origin += ray.dir;
    ray.from_light = false;
    ray.dir = edge_point(mesh(), hits[i].id, aimed.size()) - ray.origin;
    ray.t = std::numeric_limits<float>::max();
    ray.id = kNoTriangle;
    aimed.push_back(ray);
  }
  return aimed;
}

}  // namespace gridiron::experiment
