// Single rays in Embree: see the header. SPDX-License-Identifier: Apache-2.0
#include "embree_peer/embree_rays.h"

#include <embree3/rtcore.h>

#include <cstdio>
#include <cstdlib>
#include <limits>

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

}  // namespace

struct EmbreeRays::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

EmbreeRays::EmbreeRays(const MeshView& mesh, bool robust) : state_(std::make_unique<State>()) {
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
  rtcCommitGeometry(geometry);
  state_->scene = rtcNewScene(state_->device);
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

}  // namespace gridiron::peer
