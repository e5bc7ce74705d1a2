// Embree as the peer: see the header. SPDX-License-Identifier: Apache-2.0
#include "embree_peer/embree_peer.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace gridiron::peer {
namespace {

constexpr std::uint32_t kPacketWidth = kEmbreePacketWidth;
constexpr std::uint32_t kPacketRays = kPacketWidth * kPacketWidth;

void stop_on_error(void*, RTCError, const char* words) {
  std::fprintf(stderr, "embree: %s\n", words);
  std::abort();
}

// Rays of the 4x4 pixels at (x, y), by the frame record's formula.
void generate_rays(const FrameRecord& frame, std::uint32_t x, std::uint32_t y, RTCRayHit16& packet) {
  for (std::uint32_t i = 0; i < kPacketRays; ++i) {
    const auto column = static_cast<float>(x + i % kPacketWidth);
    const auto row = static_cast<float>(y + i / kPacketWidth);
    packet.ray.org_x[i] = frame.eye[0];
    packet.ray.org_y[i] = frame.eye[1];
    packet.ray.org_z[i] = frame.eye[2];
    packet.ray.dir_x[i] = (frame.corner[0] + column * frame.step_x[0]) + row * frame.step_y[0];
    packet.ray.dir_y[i] = (frame.corner[1] + column * frame.step_x[1]) + row * frame.step_y[1];
    packet.ray.dir_z[i] = (frame.corner[2] + column * frame.step_x[2]) + row * frame.step_y[2];
    packet.ray.tnear[i] = 0.0f;
    packet.ray.tfar[i] = frame.t_far;
    packet.ray.time[i] = 0.0f;
    packet.ray.mask[i] = ~0u;
    packet.ray.id[i] = i;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}

// Facing ratio with the geometric normal, background without a hit.
void shade_rays(const FrameRecord& frame, const RTCRayHit16& packet, std::uint32_t out[kPacketRays]) {
  for (std::uint32_t i = 0; i < kPacketRays; ++i) {
    const float dx = packet.ray.dir_x[i], dy = packet.ray.dir_y[i], dz = packet.ray.dir_z[i];
    const float nx = packet.hit.Ng_x[i], ny = packet.hit.Ng_y[i], nz = packet.hit.Ng_z[i];
    const float cosine = std::fabs(nx * dx + ny * dy + nz * dz) /
                         std::sqrt((dx * dx + dy * dy + dz * dz) * (nx * nx + ny * ny + nz * nz));
    // One clamp keeps the conversion defined for lanes without a hit, whose normal is not set.
    const float scaled = 255.0f * cosine + 0.5f;
    const auto level = static_cast<std::uint32_t>(static_cast<std::int32_t>(scaled < 255.0f ? scaled : 255.0f)) & 0xFFu;
    const std::uint32_t lit = 0xFF000000u | level << 16 | level << 8 | level;
    out[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? frame.background_rgba : lit;
  }
}

void check_size(const FrameRecord& frame) {
  if (frame.width % kPacketWidth != 0 || frame.height % kPacketWidth != 0 || frame.tile_width % kPacketWidth != 0) {
    std::fprintf(stderr, "the peer renders multiples of 4 pixels only\n");
    std::abort();
  }
}

}  // namespace

struct EmbreeScene::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  RTCGeometry geometry = nullptr;

  void intersect(RTCRayHit16& packet) const {
    alignas(64) static constexpr int kAllValid[kPacketRays] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                               -1, -1, -1, -1, -1, -1, -1, -1};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(kAllValid, scene, &context, &packet);
  }
};

EmbreeScene::EmbreeScene() : state_(std::make_unique<State>()) {
  state_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (state_->device == nullptr) {
    std::fprintf(stderr, "embree: no device\n");
    std::abort();
  }
  rtcSetDeviceErrorFunction(state_->device, stop_on_error, nullptr);
}

EmbreeScene::~EmbreeScene() {
  if (state_->scene != nullptr) rtcReleaseScene(state_->scene);
  if (state_->geometry != nullptr) rtcReleaseGeometry(state_->geometry);
  rtcReleaseDevice(state_->device);
}

void EmbreeScene::set_mesh(const MeshView& mesh) {
  if (state_->geometry != nullptr) rtcReleaseGeometry(state_->geometry);
  state_->geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      state_->geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) *vertices++ = vertex[axis];
  }
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      state_->geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const UVec3& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) *indices++ = triangle[corner];
  }
}

void EmbreeScene::build(EmbreeQuality quality) {
  const RTCBuildQuality embree_quality = quality == EmbreeQuality::kLow      ? RTC_BUILD_QUALITY_LOW
                                         : quality == EmbreeQuality::kMedium ? RTC_BUILD_QUALITY_MEDIUM
                                                                             : RTC_BUILD_QUALITY_HIGH;
  if (state_->scene != nullptr) rtcReleaseScene(state_->scene);
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneBuildQuality(state_->scene, embree_quality);
  rtcSetGeometryBuildQuality(state_->geometry, embree_quality);
  rtcCommitGeometry(state_->geometry);
  rtcAttachGeometry(state_->scene, state_->geometry);
  rtcCommitScene(state_->scene);
}

void EmbreeScene::render(const FrameRecord& frame, std::vector<std::uint32_t>& color) const {
  check_size(frame);
  const std::uint32_t tile_width = frame.tile_width;
  color.resize(std::size_t{frame.tiles_x} * frame.tiles_y * tile_width * tile_width);
  for (std::uint32_t tile = 0; tile < frame.tiles_x * frame.tiles_y; ++tile) {
    const std::uint32_t left = tile % frame.tiles_x * tile_width;
    const std::uint32_t top = tile / frame.tiles_x * tile_width;
    std::uint32_t* tile_color = color.data() + std::size_t{tile} * tile_width * tile_width;
    for (std::uint32_t y = 0; y < tile_width && top + y < frame.height; y += kPacketWidth) {
      for (std::uint32_t x = 0; x < tile_width && left + x < frame.width; x += kPacketWidth) {
        RTCRayHit16 packet;
        generate_rays(frame, left + x, top + y, packet);
        state_->intersect(packet);
        alignas(64) std::uint32_t shaded[kPacketRays];
        shade_rays(frame, packet, shaded);
        for (std::uint32_t i = 0; i < kPacketRays; ++i) {
          tile_color[(y + i / kPacketWidth) * tile_width + x + i % kPacketWidth] = shaded[i];
        }
      }
    }
  }
}

std::uint64_t EmbreeScene::hit_count(const FrameRecord& frame) const {
  check_size(frame);
  std::uint64_t hits = 0;
  for (std::uint32_t y = 0; y < frame.height; y += kPacketWidth) {
    for (std::uint32_t x = 0; x < frame.width; x += kPacketWidth) {
      RTCRayHit16 packet;
      generate_rays(frame, x, y, packet);
      state_->intersect(packet);
      for (std::uint32_t i = 0; i < kPacketRays; ++i) hits += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    }
  }
  return hits;
}

}  // namespace gridiron::peer
