// Embree as the peer: see the header. SPDX-License-Identifier: Apache-2.0
#include "embree_peer/embree_peer.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>

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

// --- Eye rays by all calls ------------------------------------------------------------------------------------------

// Directions of a frame's pixels: the sum of a term of the column and one of the row, as the frame record rounds them.
class EyeDirections {
 public:
  explicit EyeDirections(const FrameRecord& frame) {
    for (int axis = 0; axis < 3; ++axis) {
      for (std::uint32_t x = 0; x < frame.width; ++x) {
        columns_[axis].push_back(frame.corner[axis] + static_cast<float>(x) * frame.step_x[axis]);
      }
      for (std::uint32_t y = 0; y < frame.height; ++y) {
        rows_[axis].push_back(static_cast<float>(y) * frame.step_y[axis]);
      }
    }
  }
  // Of pixels (x, y) to (x + 3, y).
  void store_four(int axis, std::uint32_t x, std::uint32_t y, float* to) const {
    for (std::uint32_t i = 0; i < 4; ++i) to[i] = columns_[axis][x + i] + rows_[axis][y];
  }
  [[nodiscard]] float of(int axis, std::uint32_t x, std::uint32_t y) const {
    return columns_[axis][x] + rows_[axis][y];
  }

 private:
  std::vector<float> columns_[3], rows_[3];
};

// A packet of `kRays` rays, 4 pixels wide: all that stays the same from packet to packet, then what does not.
template <std::uint32_t kRays, class Packet>
void begin_packet(const FrameRecord& frame, Packet& packet) {
  for (std::uint32_t i = 0; i < kRays; ++i) {
    packet.ray.org_x[i] = frame.eye[0];
    packet.ray.org_y[i] = frame.eye[1];
    packet.ray.org_z[i] = frame.eye[2];
    packet.ray.tnear[i] = packet.ray.time[i] = 0.0f;
    packet.ray.mask[i] = ~0u;
    packet.ray.id[i] = i;
    packet.ray.flags[i] = 0;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}
template <std::uint32_t kRays, class Packet>
void aim_packet(const EyeDirections& directions, float t_far, std::uint32_t x, std::uint32_t y, Packet& packet) {
  for (std::uint32_t row = 0; row < kRays / 4; ++row) {
    directions.store_four(0, x, y + row, packet.ray.dir_x + 4 * row);
    directions.store_four(1, x, y + row, packet.ray.dir_y + 4 * row);
    directions.store_four(2, x, y + row, packet.ray.dir_z + 4 * row);
  }
  for (std::uint32_t i = 0; i < kRays; ++i) {
    packet.ray.tfar[i] = t_far;
    packet.hit.geomID[i] = packet.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
  }
}
template <std::uint32_t kRays, class Packet>
void store_ids(const Packet& packet, std::uint32_t width, std::uint32_t* ids) {
  for (std::uint32_t row = 0; row < kRays / 4; ++row) {
    for (std::uint32_t i = 0; i < 4; ++i) ids[std::size_t{row} * width + i] = packet.hit.primID[4 * row + i];
  }
}

constexpr std::uint32_t kEyeTile = 32, kEyeStream = 16;  // pixels along the edge of what is traced in turn

// Calls visit(x, y) for all parts of a frame, tile by tile.
template <class Visit>
void for_each_part(const FrameRecord& frame, std::uint32_t part_width, std::uint32_t part_height, Visit&& visit) {
  for (std::uint32_t top = 0; top < frame.height; top += kEyeTile) {
    for (std::uint32_t left = 0; left < frame.width; left += kEyeTile) {
      for (std::uint32_t y = top; y < top + kEyeTile; y += part_height) {
        for (std::uint32_t x = left; x < left + kEyeTile; x += part_width) visit(x, y);
      }
    }
  }
}

// Packet by packet. @param call  (all valid, packet).
template <std::uint32_t kRays, class Packet, class Call>
void trace_packets(const FrameRecord& frame, const Call& call, std::uint32_t* ids) {
  alignas(64) static constexpr int kAllValid[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  const EyeDirections directions(frame);
  Packet packet;
  begin_packet<kRays>(frame, packet);
  for_each_part(frame, 4, kRays / 4, [&](std::uint32_t x, std::uint32_t y) {
    aim_packet<kRays>(directions, frame.t_far, x, y, packet);
    call(kAllValid, packet);
    store_ids<kRays>(packet, frame.width, ids + std::size_t{y} * frame.width + x);
  });
}

// Streams of packets. @param call  (packets).
template <std::uint32_t kRays, class Packet, class Call>
void trace_packet_streams(const FrameRecord& frame, const Call& call, std::uint32_t* ids) {
  constexpr std::uint32_t kRows = kRays / 4, kColumns = kEyeStream / 4;
  const EyeDirections directions(frame);
  Packet packets[kEyeStream * kEyeStream / kRays];
  for (Packet& packet : packets) begin_packet<kRays>(frame, packet);
  for_each_part(frame, kEyeStream, kEyeStream, [&](std::uint32_t x, std::uint32_t y) {
    const auto for_each_packet = [&](const auto& body) {
      for (std::uint32_t i = 0; i < std::size(packets); ++i) {
        body(packets[i], x + i % kColumns * 4, y + i / kColumns * kRows);
      }
    };
    for_each_packet([&](Packet& packet, std::uint32_t column, std::uint32_t row) {
      aim_packet<kRays>(directions, frame.t_far, column, row, packet);
    });
    call(packets);
    for_each_packet([&](Packet& packet, std::uint32_t column, std::uint32_t row) {
      store_ids<kRays>(packet, frame.width, ids + std::size_t{row} * frame.width + column);
    });
  });
}

// Ray by ray, or as a stream of single rays. @param call  (first ray of kEyeStream^2).
template <class Call>
void trace_single_rays(const FrameRecord& frame, const Call& call, std::uint32_t* ids) {
  constexpr std::uint32_t kRays = kEyeStream * kEyeStream;
  const EyeDirections directions(frame);
  RTCRayHit rays[kRays] = {};
  for_each_part(frame, kEyeStream, kEyeStream, [&](std::uint32_t x, std::uint32_t y) {
    for (std::uint32_t i = 0; i < kRays; ++i) {
      const std::uint32_t column = x + i % kEyeStream, row = y + i / kEyeStream;
      rays[i].ray = {frame.eye[0],
                     frame.eye[1],
                     frame.eye[2],
                     0.0f,
                     directions.of(0, column, row),
                     directions.of(1, column, row),
                     directions.of(2, column, row),
                     0.0f,
                     frame.t_far,
                     ~0u,
                     i,
                     0};
      rays[i].hit.geomID = rays[i].hit.primID = rays[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    call(rays);
    for (std::uint32_t i = 0; i < kRays; ++i) {
      ids[std::size_t{y + i / kEyeStream} * frame.width + x + i % kEyeStream] = rays[i].hit.primID;
    }
  });
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

void EmbreeScene::build(EmbreeQuality quality, bool robust) {
  const RTCBuildQuality embree_quality = quality == EmbreeQuality::kLow      ? RTC_BUILD_QUALITY_LOW
                                         : quality == EmbreeQuality::kMedium ? RTC_BUILD_QUALITY_MEDIUM
                                                                             : RTC_BUILD_QUALITY_HIGH;
  if (state_->scene != nullptr) rtcReleaseScene(state_->scene);
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneBuildQuality(state_->scene, embree_quality);
  rtcSetSceneFlags(state_->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
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

void EmbreeScene::find_triangles(const FrameRecord& frame, EmbreeEyeCall call, bool is_coherent,
                                 std::span<std::uint32_t> ids) const {
  if (frame.width % kEyeTile != 0 || frame.height % kEyeTile != 0 ||
      ids.size() < std::size_t{frame.width} * frame.height) {
    std::fprintf(stderr, "the peer traces multiples of %u pixels only\n", kEyeTile);
    std::abort();
  }
  const RTCScene scene = state_->scene;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  constexpr std::uint32_t kStreamRays = kEyeStream * kEyeStream;
  switch (call) {
    case EmbreeEyeCall::kSingle:
      return trace_single_rays(
          frame,
          [&](RTCRayHit* rays) {
            for (std::uint32_t i = 0; i < kStreamRays; ++i) rtcIntersect1(scene, &context, rays + i);
          },
          ids.data());
    case EmbreeEyeCall::kStream:
      return trace_single_rays(
          frame, [&](RTCRayHit* rays) { rtcIntersect1M(scene, &context, rays, kStreamRays, sizeof *rays); },
          ids.data());
    case EmbreeEyeCall::kPacket8:
      return trace_packets<8, RTCRayHit8>(
          frame, [&](const int* valid, RTCRayHit8& packet) { rtcIntersect8(valid, scene, &context, &packet); },
          ids.data());
    case EmbreeEyeCall::kPacket16:
      return trace_packets<16, RTCRayHit16>(
          frame, [&](const int* valid, RTCRayHit16& packet) { rtcIntersect16(valid, scene, &context, &packet); },
          ids.data());
    case EmbreeEyeCall::kStream8:
      return trace_packet_streams<8, RTCRayHit8>(
          frame,
          [&](RTCRayHit8* packets) {
            rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets), 8, kStreamRays / 8,
                           sizeof *packets);
          },
          ids.data());
    case EmbreeEyeCall::kStream16:
      return trace_packet_streams<16, RTCRayHit16>(
          frame,
          [&](RTCRayHit16* packets) {
            rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets), 16, kStreamRays / 16,
                           sizeof *packets);
          },
          ids.data());
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
