// Engines without a structure, of eye rays and of other rays: every ray against every triangle. They show what
// core/gridiron/engine/engine.h requires of an engine, and that nothing else needs to know of a new one.
// Memory: its parts of the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/engine.h>
#include <gridiron/ray/camera.h>
#include <gridiron/ray/intersect_rays.h>
#include <gridiron/ray/intersect_standard.h>
#include <gridiron/ray/packet_hits.h>
#include <gridiron/ray/ray_batch.h>

#include <cstddef>
#include <cstdint>

namespace gridiron::test {

/// Kinds of work of its own.
enum class BruteForceWork : std::uint8_t { kFirst = kSharedWorkCount, kBuffer = kFirst, kTriangle, kEnd };

/// Its part of a frame: vertex triangles of an image, a triangle any number of times.
struct BruteForceRecord {
  std::uint64_t triangles_address;
  std::uint32_t triangle_count;
  std::uint32_t reserved;
};

/// A buffer of triangles for either engine.
struct alignas(128) BruteForceBuffer {
  static constexpr std::uint32_t kTriangles = 64;
  std::byte bytes[kTriangles * kTriangleRecordBytes + 32];
};

/// Its memory for the whole frame.
struct alignas(128) BruteForceStore {
  BruteForceBuffer triangles;

  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("triangles", offsetof(BruteForceStore, triangles), sizeof(BruteForceStore::triangles));
  }
};

// Calls use(triangle) -> Status for all triangles of a frame, a buffer of them at a time.
template <Platform P, class Use>
[[nodiscard]] Status for_each_triangle(const BruteForceRecord& record, BruteForceBuffer& buffer,
                                       Transfers<P>& transfers, WorkCounters& work, Use&& use) {
  for (std::uint32_t first = 0; first < record.triangle_count; first += BruteForceBuffer::kTriangles) {
    std::uint32_t count = record.triangle_count - first;
    if (count > BruteForceBuffer::kTriangles) count = BruteForceBuffer::kTriangles;
    const MainAddress address{record.triangles_address + std::uint64_t{first} * kTriangleRecordBytes};
    std::byte* const place = buffer.bytes + address.value % kPortableCongruenceBytes;
    GRIDIRON_TRY(transfers.get(place, address, count * kTriangleRecordBytes, kFirstTriangleTag));
    GRIDIRON_TRY(transfers.wait(kFirstTriangleTag));
    work.add(BruteForceWork::kBuffer);
    work.add(BruteForceWork::kTriangle, count);
    const auto* const triangles = reinterpret_cast<const VertexTriangle*>(place);
    for (std::uint32_t i = 0; i < count; ++i) GRIDIRON_TRY(use(triangles[i]));
  }
  return Status::kOk;
}

template <class L, class Store, Platform P>
class BruteForceCore {
 public:
  using Layout = typename Store::Layout;

  BruteForceCore(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers) {}

  [[nodiscard]] Status begin() {
    // Of equal distances `exact` wants the nearer in truth, which needs both triangles at hand.
    if (store_.frame.accuracy != static_cast<std::uint32_t>(Accuracy::kStandard)) return Status::kUnsupportedFrame;
    return store_.frame.engine.triangles_address != 0 ? Status::kOk : Status::kBadFrame;
  }

  void begin_tile() {}

  [[nodiscard]] Status trace_eyes(const TileView& view, const Hits& hits) {
    auto& packet = store_.packet;
    for (std::uint32_t y = 0; y < Layout::kTileWidth && view.top + y < store_.frame.height; y += packet.kWidth) {
      for (std::uint32_t x = 0; x < Layout::kTileWidth && view.left + x < store_.frame.width; x += packet.kWidth) {
        generate_packet<L>(store_.frame, view.left + x, view.top + y, packet, packet.active, store_.work, view.dx,
                           view.dy);
        // If estimates leave a ray's hit open, exact distances decide.
        do {
          GRIDIRON_TRY(for_each_triangle([&](const VertexTriangle& triangle) {
            (void)(hits.facing != nullptr ? intersect_standard<L, true>(packet, triangle, true, store_.work)
                                          : intersect_standard<L, false>(packet, triangle, true, store_.work));
            return Status::kOk;
          }));
        } while (take_unsure_rays(packet, store_.frame.t_far, packet.active, store_.work));
        store_hits<L>(packet, x, y, Layout::kTileWidth, hits, store_.work);
      }
    }
    return Status::kOk;
  }

 private:
  template <class Use>
  [[nodiscard]] Status for_each_triangle(Use&& use) {
    return test::for_each_triangle(store_.frame.engine, store_.engine.triangles, transfers_, store_.work, use);
  }

  Store& store_;
  Transfers<P>& transfers_;
};

/// The engine of eye rays as a layout names it.
struct BruteForceEngine {
  static constexpr std::uint32_t kId = kFirstOtherEngine + 1;
  using Record = BruteForceRecord;
  template <class Layout>
  using Store = BruteForceStore;
  template <class Layout>
  using EyeStore = Packet<8>;
  template <class Layout>
  static constexpr bool kTracesEyes = true;
  template <class L, class Store, Platform P>
  using Core = BruteForceCore<L, Store, P>;
};

/// Memory of the engine of other rays for the whole frame: what its frames are checked by.
struct alignas(128) BruteForceRaysStore {
  std::uint32_t frames;
};

/// Its memory while rays are traced: a few jobs' rays, and a buffer.
struct alignas(128) BruteForceRayStore {
  static constexpr std::uint32_t kRays = 3 * kJobRays;
  BatchRay rays[kRays];
  std::uint32_t owners[kRays];
  BruteForceBuffer triangles;
  static_assert(sizeof(BruteForceBuffer) >= kIdleBufferBytes);

  // All triangles are fetched again for each batch: nothing is lost.
  void lend(std::uint32_t) {}
  [[nodiscard]] std::byte* idle_buffer(std::uint32_t) { return triangles.bytes; }
};

template <class L, class Store, Platform P>
class BruteForceRaysCore {
 public:
  BruteForceRaysCore(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers) {}

  [[nodiscard]] Status begin() {
    store_.rays.frames = 1;
    return Status::kOk;
  }

  void begin_rays() {}

  template <class Jobs>
  [[nodiscard]] Status trace(const RayQuestion& question, Jobs& jobs) {
    auto& memory = store_.wave.rays;
    for (bool has_more = true; has_more;) {
      RayBatch batch{memory.rays, memory.owners, 0};
      while (has_more && batch.count + kJobRays <= BruteForceRayStore::kRays) has_more = jobs.next(batch);
      if (batch.count == 0) break;
      for (std::uint32_t i = 0; i < batch.count; ++i) {
        BatchRay& ray = batch.rays[i];
        ray.dir_max = 0.0f;
        for (const float component : ray.dir) {
          if (magnitude(component) > ray.dir_max) ray.dir_max = magnitude(component);
        }
      }
      GRIDIRON_TRY(for_each_triangle(
          store_.frame.engine, memory.triangles, transfers_, store_.work, [&](const VertexTriangle& triangle) {
            for (std::uint32_t i = 0; i < batch.count; ++i) {
              BatchRay& ray = batch.rays[i];
              const bool has_answer = question.any_hit && ray.has_hit();
              if (has_answer || !passes_through(ray, triangle, store_.work)) continue;
              const float t = ray_distance(ray, triangle, store_.work);
              // A limit is still a hit; of equal distances the lowest id counts.
              const bool is_first = t < ray.t || (t == ray.t && triangle.triangle_id < ray.id);
              if (!(t > 0.0f) || !is_first) continue;
              ray.id = triangle.triangle_id;
              ray.t = t;
            }
            return Status::kOk;
          }));
      jobs.finish(batch);
    }
    return Status::kOk;
  }

 private:
  Store& store_;
  Transfers<P>& transfers_;
};

/// The engine of other rays as a layout names it.
struct BruteForceRays {
  using Store = BruteForceRaysStore;
  template <class Layout>
  using RayStore = BruteForceRayStore;
  template <class Layout>
  static constexpr std::uint32_t kMaxDepth = 1;
  template <class L, class Store, Platform P>
  using Core = BruteForceRaysCore<L, Store, P>;
};

}  // namespace gridiron::test
