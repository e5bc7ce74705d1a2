// Secondary rays of a picture: see the header. SPDX-License-Identifier: Apache-2.0
#include "bench/ray_sets.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "support/test_mesh.h"

namespace gridiron::bench {
namespace {

constexpr std::uint32_t kPictureWidth = 1024, kTileWidth = 64, kBlockWidth = 4;
constexpr std::uint32_t kBlockPixels = kBlockWidth * kBlockWidth;
constexpr double kLift = 1e-4, kNearShare = 0.1, kPi = 3.14159265358979;

peer::PeerRay make_ray(const Vec3& origin, const Vec3& dir, float t) {
  return {{origin.x, origin.y, origin.z}, {dir.x, dir.y, dir.z}, t};
}

double dot_of(const DVec3& a, const DVec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

DVec3 cross_of(const DVec3& a, const DVec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

DVec3 unit_of(const DVec3& a) {
  return a / std::sqrt(dot_of(a, a));
}

// Eye rays in the order of tiles, blocks and pixels.
std::vector<peer::PeerRay> make_eye_rays(const Camera& camera) {
  FrameSettings settings{.camera = camera, .width = kPictureWidth, .height = kPictureWidth};
  settings.color = MainAddress{kPlaneAlignment};  // required; nothing is written
  FrameHead frame{};
  std::vector<peer::PeerRay> rays;
  if (make_frame_head(settings, frame) != Status::kOk) return rays;
  const Vec3 eye(frame.eye[0], frame.eye[1], frame.eye[2]);
  const auto add_block = [&](std::uint32_t left, std::uint32_t top) {
    for (std::uint32_t i = 0; i < kBlockPixels; ++i) {
      const auto x = static_cast<float>(left + i % kBlockWidth), y = static_cast<float>(top + i / kBlockWidth);
      Vec3 dir;
      for (int axis = 0; axis < 3; ++axis) {
        dir[axis] = (frame.corner[axis] + x * frame.step_x[axis]) + y * frame.step_y[axis];
      }
      rays.push_back(make_ray(eye, dir, kFloatMax));
    }
  };
  for (std::uint32_t top = 0; top < kPictureWidth; top += kTileWidth) {
    for (std::uint32_t left = 0; left < kPictureWidth; left += kTileWidth) {
      for (std::uint32_t y = 0; y < kTileWidth; y += kBlockWidth) {
        for (std::uint32_t x = 0; x < kTileWidth; x += kBlockWidth) add_block(left + x, top + y);
      }
    }
  }
  return rays;
}

DVec3 cosine_dir(const DVec3& normal, test::TestRandom& random) {
  const DVec3 u =
      unit_of(std::fabs(normal.x) > 0.5 ? cross_of(normal, DVec3(0, 1, 0)) : cross_of(normal, DVec3(1, 0, 0)));
  const DVec3 v = cross_of(normal, u);
  const double angle = 2 * kPi * double{random.unit()}, square = double{random.unit()};
  const double radius = std::sqrt(square);
  return radius * std::cos(angle) * u + radius * std::sin(angle) * v + std::sqrt(1 - square) * normal;
}

// The rays of the points of one block, which have a random sequence of their own: the same rays whatever is sampled.
void add_block_rays(RayKind kind, std::span<const HitPoint> points, double diagonal, const Vec3& light,
                    std::vector<peer::PeerRay>& rays) {
  switch (kind) {
    case RayKind::kOcclusion:
    case RayKind::kNearOcclusion: {
      test::TestRandom random(points.front().block);
      const float t = kind == RayKind::kOcclusion ? kFloatMax : static_cast<float>(kNearShare * diagonal);
      for (std::uint32_t i = 0; i < kOcclusionRays; ++i) {
        for (const HitPoint& hit : points) {
          rays.push_back(make_ray(hit.point, Vec3(cosine_dir(DVec3(hit.normal), random)), t));
        }
      }
      break;
    }
    case RayKind::kMirror:
      for (const HitPoint& hit : points) {
        const DVec3 dir(hit.dir), normal(hit.normal);
        rays.push_back(make_ray(hit.point, Vec3(dir - 2 * dot_of(dir, normal) * normal), kFloatMax));
      }
      break;
    case RayKind::kShadow:
      for (const HitPoint& hit : points) rays.push_back(make_ray(hit.point, light - hit.point, 1.0f));
      break;
  }
}

}  // namespace

const char* name_of(RayKind kind) {
  switch (kind) {
    case RayKind::kOcclusion:
      return "occlusion";
    case RayKind::kNearOcclusion:
      return "near occlusion";
    case RayKind::kMirror:
      return "mirror";
    case RayKind::kShadow:
      break;
  }
  return "shadow";
}

bool are_neighbors(RayKind kind) {
  return kind == RayKind::kMirror || kind == RayKind::kShadow;
}

bool wants_any_hit(RayKind kind) {
  return kind != RayKind::kMirror;
}

std::vector<HitPoint> find_hit_points(const MeshView& mesh, const Camera& camera, double diagonal,
                                      const peer::EmbreeRays& scene) {
  const std::vector<peer::PeerRay> rays = make_eye_rays(camera);
  peer::EmbreeRayBatch batch(peer::EmbreeCall::kPacket16, false);
  batch.fill(rays);
  scene.trace(batch, kBlockPixels, true);
  std::vector<HitPoint> points;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!batch.is_hit(i)) continue;
    const UVec3& corners = mesh.triangles[batch.triangle(i)];
    const DVec3 a(mesh.vertices[corners.x]), b(mesh.vertices[corners.y]), c(mesh.vertices[corners.z]);
    const DVec3 eye(rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]);
    const DVec3 way = DVec3(rays[i].dir[0], rays[i].dir[1], rays[i].dir[2]) * double{batch.t(i)};
    DVec3 normal = unit_of(cross_of(b - a, c - a));
    if (dot_of(normal, way) > 0) normal = -normal;
    const double lift = kLift * std::min(diagonal, std::sqrt(dot_of(way, way)));
    points.push_back({Vec3(eye + way + lift * normal), Vec3(normal), Vec3(unit_of(way)),
                      static_cast<std::uint32_t>(i / kBlockPixels)});
  }
  return points;
}

std::vector<peer::PeerRay> make_rays(RayKind kind, const std::vector<HitPoint>& points, double diagonal,
                                     const Vec3& light, std::uint32_t batch_rays, std::size_t most_batches) {
  // Points with rays: those that turn away from a light need none.
  std::vector<HitPoint> used;
  std::copy_if(points.begin(), points.end(), std::back_inserter(used), [&](const HitPoint& hit) {
    return kind != RayKind::kShadow || dot_of(DVec3(light) - DVec3(hit.point), DVec3(hit.normal)) > 0;
  });
  const bool is_occlusion = kind == RayKind::kOcclusion || kind == RayKind::kNearOcclusion;
  const std::size_t rays_per_point = is_occlusion ? kOcclusionRays : 1;
  const std::size_t batches = used.size() * rays_per_point / batch_rays;
  const std::size_t step = std::max<std::size_t>(1, (batches + most_batches - 1) / most_batches);

  std::vector<peer::PeerRay> rays, block_rays;
  const auto is_taken = [&](std::size_t batch) { return batch < batches && batch % step == 0; };
  for (std::size_t first = 0, end = 0; first < used.size(); first = end) {
    while (end < used.size() && used[end].block == used[first].block) ++end;
    const std::size_t first_ray = first * rays_per_point, end_ray = end * rays_per_point;
    bool is_needed = false;
    for (std::size_t batch = first_ray / batch_rays; batch <= (end_ray - 1) / batch_rays; ++batch) {
      is_needed = is_needed || is_taken(batch);
    }
    if (!is_needed) continue;
    block_rays.clear();
    add_block_rays(kind, std::span(used).subspan(first, end - first), diagonal, light, block_rays);
    for (std::size_t i = 0; i < block_rays.size(); ++i) {
      if (is_taken((first_ray + i) / batch_rays)) rays.push_back(block_rays[i]);
    }
  }
  return rays;
}

}  // namespace gridiron::bench
