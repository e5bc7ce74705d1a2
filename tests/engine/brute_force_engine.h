// An engine without a structure: every ray against every triangle. It shows what core/gridiron/engine/engine.h requires
// of an engine, and that nothing else needs to know of a new one.
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

/// One buffer of triangles for the whole frame.
struct alignas(128) BruteForceStore {
  static constexpr std::uint32_t kBufferTriangles = 64;
  std::byte triangles[kBufferTriangles * kTriangleRecordBytes + 32];
  static_assert(sizeof(triangles) >= kIdleBufferBytes);

  [[nodiscard]] std::byte* idle_buffer(std::uint32_t) { return triangles; }
  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("triangles", offsetof(BruteForceStore, triangles), sizeof(BruteForceStore::triangles));
  }
};

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

  template <class Jobs>
  [[nodiscard]] Status trace(const RayQuestion& question, Jobs& jobs) {
    WalkRays& rays = store_.wave.engine;
    std::uint32_t purpose = 0;
    for (std::uint32_t count = jobs.next(rays, purpose); count != 0; count = jobs.next(rays, purpose)) {
      std::uint32_t open = (1u << count) - 1u;
      for (std::uint32_t ray = 0; ray < kWalkRays; ++ray) {
        rays.dir_max[ray] = 0.0f;
        for (const auto& dir : rays.dir) {
          if (ray < count && magnitude(dir[ray]) > rays.dir_max[ray]) rays.dir_max[ray] = magnitude(dir[ray]);
        }
      }
      GRIDIRON_TRY(for_each_triangle([&](const VertexTriangle& triangle) {
        std::uint32_t settled = 0;
        std::uint32_t near = rays_near<L>(rays, open, triangle, question.trusts_floats, settled, store_.work) | settled;
        for (; near != 0; near &= near - 1) {
          const std::uint32_t ray = lowest_bit(near);
          const float t = ray_distance(rays, ray, triangle, store_.work);
          const bool is_first = t < rays.t[ray] || (t == rays.t[ray] && triangle.triangle_id < rays.id[ray]);
          if (!(t > 0.0f) || !is_first) continue;
          rays.id[ray] = triangle.triangle_id;
          if (question.any_hit) open &= ~(1u << ray);
          if (!question.any_hit) rays.t[ray] = t;
        }
        return Status::kOk;
      }));
      jobs.finish(rays, count, purpose);
    }
    return Status::kOk;
  }

 private:
  template <class Use>
  [[nodiscard]] Status for_each_triangle(Use&& use) {
    const BruteForceRecord& record = store_.frame.engine;
    for (std::uint32_t first = 0; first < record.triangle_count; first += BruteForceStore::kBufferTriangles) {
      std::uint32_t count = record.triangle_count - first;
      if (count > BruteForceStore::kBufferTriangles) count = BruteForceStore::kBufferTriangles;
      const MainAddress address{record.triangles_address + std::uint64_t{first} * kTriangleRecordBytes};
      std::byte* const place = store_.engine.triangles + address.value % kPortableCongruenceBytes;
      GRIDIRON_TRY(transfers_.get(place, address, count * kTriangleRecordBytes, kFirstTriangleTag));
      GRIDIRON_TRY(transfers_.wait(kFirstTriangleTag));
      store_.work.add(BruteForceWork::kBuffer);
      store_.work.add(BruteForceWork::kTriangle, count);
      const auto* const triangles = reinterpret_cast<const VertexTriangle*>(place);
      for (std::uint32_t i = 0; i < count; ++i) GRIDIRON_TRY(use(triangles[i]));
    }
    return Status::kOk;
  }

  Store& store_;
  Transfers<P>& transfers_;
};

/// The engine as a layout names it.
struct BruteForceEngine {
  static constexpr std::uint32_t kId = kFirstOtherEngine + 1;
  using Record = BruteForceRecord;
  template <class Layout>
  using Store = BruteForceStore;
  template <class Layout>
  using EyeStore = Packet<8>;
  template <class Layout>
  using RayStore = WalkRays;
  template <class Layout>
  static constexpr bool kTracesEyes = true;
  template <class Layout>
  static constexpr std::uint32_t kMaxRayDepth = 1;
  template <class L, class Store, Platform P>
  using Core = BruteForceCore<L, Store, P>;
};

}  // namespace gridiron::test
