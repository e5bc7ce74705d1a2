// Rays in Embree: see the header. SPDX-License-Identifier: Apache-2.0
#include "embree_peer/embree_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

namespace gridiron::peer {
namespace {

constexpr float kNoLimit = std::numeric_limits<float>::infinity();

void stop_on_error(void*, RTCError, const char* words) {
  std::fprintf(stderr, "embree: %s\n", words);
  std::abort();
}

void intersect(RTCScene scene, RTCIntersectContext& context, const int* valid, RTCRayHit4& rays) {
  rtcIntersect4(valid, scene, &context, &rays);
}
void intersect(RTCScene scene, RTCIntersectContext& context, const int* valid, RTCRayHit8& rays) {
  rtcIntersect8(valid, scene, &context, &rays);
}
void intersect(RTCScene scene, RTCIntersectContext& context, const int* valid, RTCRayHit16& rays) {
  rtcIntersect16(valid, scene, &context, &rays);
}

bool hits_one(RTCScene scene, const float origin[3], const float (&dir)[3][EmbreeRays::kMostRays], std::uint32_t i) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = origin[0];
  ray.ray.org_y = origin[1];
  ray.ray.org_z = origin[2];
  ray.ray.dir_x = dir[0][i];
  ray.ray.dir_y = dir[1][i];
  ray.ray.dir_z = dir[2][i];
  ray.ray.tfar = kNoLimit;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &ray);
  return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

template <class Rays, std::uint32_t kWidth>
std::uint32_t hits_of(RTCScene scene, const float origin[3], const float (&dir)[3][EmbreeRays::kMostRays],
                      std::uint32_t active) {
  std::uint32_t result = 0;
  for (std::uint32_t first = 0; first < EmbreeRays::kMostRays; first += kWidth) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    alignas(64) int valid[kWidth];
    Rays rays{};
    for (std::uint32_t i = 0; i < kWidth; ++i) {
      valid[i] = (active >> (first + i) & 1u) != 0 ? -1 : 0;
      rays.ray.org_x[i] = origin[0];
      rays.ray.org_y[i] = origin[1];
      rays.ray.org_z[i] = origin[2];
      rays.ray.dir_x[i] = dir[0][first + i];
      rays.ray.dir_y[i] = dir[1][first + i];
      rays.ray.dir_z[i] = dir[2][first + i];
      rays.ray.tfar[i] = kNoLimit;
      rays.ray.mask[i] = ~0u;
      rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    intersect(scene, context, valid, rays);
    for (std::uint32_t i = 0; i < kWidth; ++i) {
      if (valid[i] != 0 && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) result |= 1u << (first + i);
    }
  }
  return result;
}

constexpr std::uint32_t kPacketRays = 16;

RTCBuildQuality embree_quality(EmbreeQuality quality) {
  switch (quality) {
    case EmbreeQuality::kLow:
      return RTC_BUILD_QUALITY_LOW;
    case EmbreeQuality::kMedium:
      return RTC_BUILD_QUALITY_MEDIUM;
    case EmbreeQuality::kHigh:
      break;
  }
  return RTC_BUILD_QUALITY_HIGH;
}

// Fills lane i of a packet.
void set_lane(RTCRay16& packet, std::uint32_t i, const PeerRay& ray) {
  packet.org_x[i] = ray.origin[0];
  packet.org_y[i] = ray.origin[1];
  packet.org_z[i] = ray.origin[2];
  packet.tnear[i] = 0.0f;
  packet.dir_x[i] = ray.dir[0];
  packet.dir_y[i] = ray.dir[1];
  packet.dir_z[i] = ray.dir[2];
  packet.time[i] = 0.0f;
  packet.tfar[i] = ray.t;
  packet.mask[i] = ~0u;
  packet.id[i] = i;
  packet.flags[i] = 0;
}

void set_ray(RTCRay& single, const PeerRay& ray) {
  single = {ray.origin[0], ray.origin[1], ray.origin[2], 0.0f, ray.dir[0], ray.dir[1],
            ray.dir[2],    0.0f,          ray.t,         ~0u,  0,          0};
}

}  // namespace

// Of the four layouts one is in use.
struct EmbreeRayBatch::State {
  EmbreeCall call;
  bool any_hit;
  std::vector<RTCRay> rays{};              // any hit
  std::vector<RTCRayHit> hits{};           // nearest hit
  std::vector<RTCRay16> packets{};         // any hit, 16 rays
  std::vector<RTCRayHit16> hit_packets{};  // nearest hit, 16 rays

  [[nodiscard]] bool has_packets() const { return call == EmbreeCall::kPacket16; }
};

EmbreeRayBatch::EmbreeRayBatch(EmbreeCall call, bool any_hit)
    : state_(std::make_unique<State>(State{.call = call, .any_hit = any_hit})) {}
EmbreeRayBatch::~EmbreeRayBatch() = default;
EmbreeRayBatch::EmbreeRayBatch(EmbreeRayBatch&&) noexcept = default;

void EmbreeRayBatch::fill(std::span<const PeerRay> rays) {
  if (rays.size() % kPacketRays != 0) {
    std::fprintf(stderr, "the peer takes multiples of 16 rays only\n");
    std::abort();
  }
  const auto lane = [](std::size_t i) { return static_cast<std::uint32_t>(i % kPacketRays); };
  if (state_->has_packets() && state_->any_hit) {
    state_->packets.resize(rays.size() / kPacketRays);
    for (std::size_t i = 0; i < rays.size(); ++i) set_lane(state_->packets[i / kPacketRays], lane(i), rays[i]);
  } else if (state_->has_packets()) {
    state_->hit_packets.resize(rays.size() / kPacketRays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RTCRayHit16& packet = state_->hit_packets[i / kPacketRays];
      set_lane(packet.ray, lane(i), rays[i]);
      packet.hit.geomID[lane(i)] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.primID[lane(i)] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][lane(i)] = RTC_INVALID_GEOMETRY_ID;
    }
  } else if (state_->any_hit) {
    state_->rays.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) set_ray(state_->rays[i], rays[i]);
  } else {
    state_->hits.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RTCRayHit& ray = state_->hits[i];
      set_ray(ray.ray, rays[i]);
      ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      ray.hit.primID = RTC_INVALID_GEOMETRY_ID;
      ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
  }
}

bool EmbreeRayBatch::is_hit(std::size_t ray) const {
  // An occluded ray ends at minus infinity.
  if (state_->any_hit) return t(ray) < 0.0f;
  return triangle(ray) != kNoHit;
}

std::uint32_t EmbreeRayBatch::triangle(std::size_t ray) const {
  static_assert(kNoHit == RTC_INVALID_GEOMETRY_ID);
  if (state_->has_packets()) return state_->hit_packets[ray / kPacketRays].hit.primID[ray % kPacketRays];
  return state_->hits[ray].hit.primID;
}

float EmbreeRayBatch::t(std::size_t ray) const {
  if (state_->has_packets()) {
    const std::size_t packet = ray / kPacketRays;
    return (state_->any_hit ? state_->packets[packet] : state_->hit_packets[packet].ray).tfar[ray % kPacketRays];
  }
  return state_->any_hit ? state_->rays[ray].tfar : state_->hits[ray].ray.tfar;
}

struct EmbreeRays::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

EmbreeRays::EmbreeRays(const MeshView& mesh, bool robust, EmbreeQuality quality) : state_(std::make_unique<State>()) {
  state_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (state_->device == nullptr) {
    std::fprintf(stderr, "embree: no device\n");
    std::abort();
  }
  rtcSetDeviceErrorFunction(state_->device, stop_on_error, nullptr);
  RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) *vertices++ = vertex[axis];
  }
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const UVec3& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) *indices++ = triangle[corner];
  }
  rtcSetGeometryBuildQuality(geometry, embree_quality(quality));
  rtcCommitGeometry(geometry);
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneBuildQuality(state_->scene, embree_quality(quality));
  rtcSetSceneFlags(state_->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcAttachGeometry(state_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(state_->scene);
}

EmbreeRays::~EmbreeRays() {
  rtcReleaseScene(state_->scene);
  rtcReleaseDevice(state_->device);
}

std::uint32_t EmbreeRays::hits(const float origin[3], const float (&dir)[3][kMostRays], std::uint32_t active,
                               std::uint32_t width) const {
  if (width == 4) return hits_of<RTCRayHit4, 4>(state_->scene, origin, dir, active);
  if (width == 8) return hits_of<RTCRayHit8, 8>(state_->scene, origin, dir, active);
  if (width == 16) return hits_of<RTCRayHit16, 16>(state_->scene, origin, dir, active);
  std::uint32_t result = 0;
  for (std::uint32_t i = 0; i < kMostRays; ++i) {
    if ((active >> i & 1u) != 0 && hits_one(state_->scene, origin, dir, i)) result |= 1u << i;
  }
  return result;
}

void EmbreeRays::trace(EmbreeRayBatch& batch, std::uint32_t stream_rays, bool is_coherent) const {
  alignas(64) static constexpr int kAllValid[kPacketRays] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                             -1, -1, -1, -1, -1, -1, -1, -1};
  EmbreeRayBatch::State& rays = *batch.state_;
  const RTCScene scene = state_->scene;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  switch (rays.call) {
    case EmbreeCall::kSingle:
      for (RTCRay& ray : rays.rays) rtcOccluded1(scene, &context, &ray);
      for (RTCRayHit& ray : rays.hits) rtcIntersect1(scene, &context, &ray);
      break;
    case EmbreeCall::kPacket16:
      for (RTCRay16& packet : rays.packets) rtcOccluded16(kAllValid, scene, &context, &packet);
      for (RTCRayHit16& packet : rays.hit_packets) rtcIntersect16(kAllValid, scene, &context, &packet);
      break;
    case EmbreeCall::kStream: {
      const auto share = [&](std::size_t first, std::size_t count) {
        return static_cast<unsigned>(std::min<std::size_t>(stream_rays, count - first));
      };
      for (std::size_t first = 0; first < rays.rays.size(); first += stream_rays) {
        rtcOccluded1M(scene, &context, &rays.rays[first], share(first, rays.rays.size()), sizeof(RTCRay));
      }
      for (std::size_t first = 0; first < rays.hits.size(); first += stream_rays) {
        rtcIntersect1M(scene, &context, &rays.hits[first], share(first, rays.hits.size()), sizeof(RTCRayHit));
      }
      break;
    }
  }
}

}  // namespace gridiron::peer
