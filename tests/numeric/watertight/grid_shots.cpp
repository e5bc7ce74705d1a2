// Shots through the grid: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/grid_shots.h"

#include <gridiron/base/accuracies.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/sim_memory.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>

#include "support/instrumented.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kWidth = 32;
constexpr std::uint32_t kPixels = kWidth * kWidth;
constexpr std::uint32_t kOracleStride = 16;  // frames
constexpr std::uint64_t kTurnStride = 23;    // frames: has no divisor with the turns in common
constexpr std::uint64_t kTurns = 12;
constexpr int kAttempts = 2000;

void require(bool is_so, const char* what) {
  if (!is_so) throw std::runtime_error(what);
}

// The rays of a frame.
struct PixelRays {
  float eye[3], corner[3], step_x[3], step_y[3];

  [[nodiscard]] float direction(int axis, std::uint32_t pixel) const {
    const auto x = static_cast<float>(pixel % kWidth), y = static_cast<float>(pixel / kWidth);
    return (corner[axis] + x * step_x[axis]) + y * step_y[axis];
  }
};

void store(float (&target)[3], const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) target[axis] = v[axis];
}

// Aims frames. @returns false where no origin inside was found.
class FrameAimer {
 public:
  FrameAimer(const PlacedSolid& solid, std::uint64_t seed) : solid_(solid), random_(seed) {}

  bool aim(PixelRays& rays) {
    Surroundings around{};
    if (!find_inside(around)) return false;
    store(rays.eye, origin_);
    const auto& order = solid_.tree().order();
    const auto count = static_cast<std::uint32_t>(order.size());
    const std::uint32_t id = random_.below(2) != 0 ? around.seen_triangle : order[random_.below(count)];
    const UVec3& t = solid_.mesh().triangles[id];
    const std::uint32_t first = random_.below(3);
    const auto corner = [&](std::uint32_t i) { return solid_.mesh().vertices[t[static_cast<int>((first + i) % 3)]]; };
    const Vec3 a = corner(0) - origin_, b = corner(1) - origin_, c = corner(2) - origin_;
    switch (random_.below(4)) {
      case 0:
        across(rays, a, b - a, c - a);
        break;
      case 1:
        around_direction(rays, a);
        break;
      case 2:
        around_direction(rays, a + random_.unit() * (b - a));
        break;
      default:
        over_field(rays);
        break;
    }
    // Cameras have directions of 1 to a few units; a power of two changes nothing else.
    const float size = std::max({std::fabs(rays.corner[0]), std::fabs(rays.corner[1]), std::fabs(rays.corner[2])});
    if (!(size > 0.0f)) return aim(rays);
    const int exponent = -std::ilogb(size);
    for (int axis = 0; axis < 3; ++axis) {
      for (float* component : {&rays.corner[axis], &rays.step_x[axis], &rays.step_y[axis]}) {
        *component = std::ldexp(*component, exponent);
      }
    }
    return true;
  }

 private:
  bool find_inside(Surroundings& around) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const DVec3 low(solid_.low()), high(solid_.high());
      const double x = double{random_.unit()}, y = double{random_.unit()}, z = double{random_.unit()};
      origin_ = Vec3(low + DVec3(x, y, z) * (high - low));
      around = solid_.look_around(origin_, random_);
      if (around.is_inside) return true;
    }
    return false;
  }
  static void across(PixelRays& rays, const Vec3& corner, const Vec3& along, const Vec3& beside) {
    store(rays.corner, corner);
    store(rays.step_x, along * (1.0f / kWidth));
    store(rays.step_y, beside * (1.0f / kWidth));
  }
  // One float of the largest component a column in one axis, a row in another; the direction itself in the middle.
  void around_direction(PixelRays& rays, const Vec3& direction) {
    const float size = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
    const float step = size > 0.0f ? std::ldexp(1.0f, std::ilogb(size) - 23) : 0.0f;
    const auto first = static_cast<int>(random_.below(3));
    Vec3 along(0.0f), beside(0.0f);
    along[first] = step;
    beside[(first + 1 + static_cast<int>(random_.below(2))) % 3] = step;
    const float half = kWidth / 2;
    store(rays.corner, direction - half * along - half * beside);
    store(rays.step_x, along);
    store(rays.step_y, beside);
  }
  void over_field(PixelRays& rays) {
    const auto any = [&] {
      const float x = random_.between(-1, 1), y = random_.between(-1, 1), z = random_.between(-1, 1);
      return Vec3(x, y, z);
    };
    const Vec3 corner = any();
    store(rays.corner, corner);
    store(rays.step_x, any() * (2.0f / kWidth));
    store(rays.step_y, any() * (2.0f / kWidth));
  }

  const PlacedSolid& solid_;
  TestRandom random_;
  Vec3 origin_{0.0f};
};

// A scene image in simulated memory, with a frame's record and planes behind it.
class GridScene {
 public:
  GridScene(const MeshView& mesh, TriangleFormat format) {
    const GridParameters parameters{.format = format};
    GridNeed need;
    require(count_scene_image(mesh, parameters, need) == Status::kOk, "a solid has no scene image");
    constexpr std::uint64_t kFrameBytes = 4 * kPixels * sizeof(std::uint32_t) + sizeof(FrameRecord) + 4096;
    memory_ = std::make_unique<sim::SimMemory>(need.image_bytes + kFrameBytes);
    const auto image = memory_->allocate(need.image_bytes);
    std::vector<std::uint64_t> scratch(need.scratch_bytes / 8 + 1);
    SceneImageError error;
    require(image &&
                build_scene_image(mesh, parameters, need, image->bytes, std::as_writable_bytes(std::span(scratch))) ==
                    Status::kOk &&
                open_scene_image(image->bytes, view_, error) == Status::kOk,
            "a scene image cannot be built");
    image_address_ = image->address;
    for (sim::MemoryRegion* region : {&color_, &depth_, &ids_}) {
      *region = memory_->allocate(kPixels * sizeof(std::uint32_t)).value();
    }
    record_ = memory_->allocate(sizeof(FrameRecord)).value();
  }

  // @returns the triangle ids of the frame's pixels.
  [[nodiscard]] std::vector<std::uint32_t> render(const PixelRays& rays, FrameSettings settings, bool with_depth,
                                                  const sim::ChipOptions& chip, const Machine& machine) {
    settings.width = settings.height = settings.tile_width = kWidth;
    settings.camera.eye = Vec3(rays.eye[0], rays.eye[1], rays.eye[2]);
    settings.camera.at = settings.camera.eye + Vec3(0, 0, std::fmax(1.0f, std::fabs(rays.eye[2])));
    settings.color = color_.address;
    settings.ids = ids_.address;
    if (with_depth) settings.depth = depth_.address;
    FrameRecord& frame = *new (record_.bytes.data()) FrameRecord;
    require(make_frame_record(settings, view_, image_address_, frame) == Status::kOk, "a frame is refused");
    std::memcpy(frame.corner, rays.corner, sizeof(frame.corner));
    std::memcpy(frame.step_x, rays.step_x, sizeof(frame.step_x));
    std::memcpy(frame.step_y, rays.step_y, sizeof(frame.step_y));
    std::memset(ids_.bytes.data(), 0xA5, ids_.bytes.size());
    // The chip's threads inherit the rules of floating point.
    const sim::ChipResult result = [&] {
      const RoundingGuard guard(machine);
      return test::render_in_test(*memory_, record_.address, chip);
    }();
    require(result.violations.empty(), "a frame breaks a rule of the platform");
    require(result.status == Status::kOk, "a frame cannot be rendered");
    std::vector<std::uint32_t> ids(kPixels);
    std::memcpy(ids.data(), ids_.bytes.data(), kPixels * sizeof(std::uint32_t));
    return ids;
  }

 private:
  std::unique_ptr<sim::SimMemory> memory_;
  SceneImageView view_{};
  MainAddress image_address_{};
  sim::MemoryRegion color_{}, depth_{}, ids_{}, record_{};
};

// Renders one frame at a time; a thread has its own.
class GridShooting {
 public:
  GridShooting(const PlacedSolid& solid, std::span<const Machine> machines, std::span<const Peer> peers, sim::Mode mode,
               const TallyOptions& options)
      : solid_(solid), machines_(machines), peers_(peers), mode_(mode), options_(options) {
    for (std::size_t p = 0; p < kProfileCount; ++p) {
      if (kProfiles[p].is_on_lattice != solid.is_on_lattice()) continue;
      const auto format = static_cast<std::size_t>(format_of(kProfiles[p].accuracy));
      if (scenes_[format] == nullptr) {
        scenes_[format] = std::make_unique<GridScene>(solid.mesh().view(), format_of(kProfiles[p].accuracy));
      }
    }
  }

  [[nodiscard]] Tally shoot(std::uint64_t frame) {
    Tally tally;
    tally.machines.resize(machines_.size());
    for (MachineTally& machine : tally.machines) machine.peer_misses.resize(peers_.size());
    const std::uint64_t seed = options_.first_seed + frame;
    PixelRays rays{};
    if (!FrameAimer(solid_, TestRandom(seed * 0x100000001B3u + 77).next()).aim(rays)) {
      tally.lost_packets = 1;
      return tally;
    }
    tally.packets = 1;
    tally.rays = kPixels;
    for (std::size_t p = 0; p < kProfileCount; ++p) {
      if (kProfiles[p].is_on_lattice == solid_.is_on_lattice()) shoot_profile(tally, seed, frame, rays, p);
    }
    shoot_peers(tally, rays);
    return tally;
  }

 private:
  void shoot_profile(Tally& tally, std::uint64_t seed, std::uint64_t frame, const PixelRays& rays, std::size_t p) {
    const Profile& profile = kProfiles[p];
    std::vector<std::uint32_t> first;
    for (std::size_t i = 0; i < machines_.size(); ++i) {
      const std::vector<std::uint32_t> ids = render(profile, machines_[i], rays, frame);
      if (i == 0) first = ids;
      const auto misses = static_cast<std::uint64_t>(std::ranges::count(ids, kNoTriangle));
      tally.machines[i].misses[p] += misses;
      if (!profile.is_watertight) continue;
      if (misses != 0) {
        fail(tally, seed, "a miss", profile.name, machines_[i].name,
             static_cast<std::uint32_t>(std::ranges::find(ids, kNoTriangle) - ids.begin()));
      }
      if (options_.oracle_stride != 0 && frame % kOracleStride == 0) ask_oracle(tally, seed, rays, ids, p, i);
    }
    if (!profile.is_watertight) return;
    for (std::uint64_t other = 1; frame % kTurnStride == 0 && other < kTurns; ++other) {
      hold_against(tally, seed, render(profile, machines_[0], rays, frame + other), first, p);
    }
  }

  // The triangles of a frame's pixels. @param turn  says which packets, lanes and planes it has.
  [[nodiscard]] std::vector<std::uint32_t> render(const Profile& profile, const Machine& machine, const PixelRays& rays,
                                                  std::uint64_t turn) {
    const bool has_small_packets = turn % 2 == 0;
    const bool with_depth = turn / 2 % 2 == 0;
    constexpr std::uint32_t kLanes[] = {4, 8, 16};
    sim::ChipOptions chip;
    chip.mode = mode_;
    chip.packet_width = has_small_packets ? 8 : 32;
    chip.lanes = std::min(kLanes[turn / 4 % 3], sim::widest_lanes());
    const FrameSettings settings{
        .camera = {},
        .accuracy = profile.accuracy,
        .shading = Shading::kNone,
        .techniques = kUseMailbox | kUseEmptySkip | (has_small_packets ? kUseCornerCulling : kUseSubpackets)};
    return scenes_[static_cast<std::size_t>(format_of(profile.accuracy))]->render(rays, settings, with_depth, chip,
                                                                                  machine);
  }

  void hold_against(Tally& tally, std::uint64_t seed, const std::vector<std::uint32_t>& ids,
                    const std::vector<std::uint32_t>& wanted, std::size_t p) {
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
      if (ids[pixel] == wanted[pixel]) continue;
      ++tally.machines[0].differences[p];
      fail(tally, seed, "another hit by another turn", kProfiles[p].name, machines_[0].name, pixel);
    }
  }

  // The rays are those that the machine makes: it rounds their directions, too.
  void ask_oracle(Tally& tally, std::uint64_t seed, const PixelRays& rays, const std::vector<std::uint32_t>& ids,
                  std::size_t p, std::size_t machine) {
    TestRandom random(seed);
    for (int i = 0; i < 64; ++i) {
      const std::uint32_t pixel = random.below(kPixels);
      OracleRay ray{{rays.eye[0], rays.eye[1], rays.eye[2]}, {}};
      {
        const RoundingGuard guard(machines_[machine]);
        for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = rays.direction(axis, pixel);
      }
      const NearestHit nearest = solid_.oracle().nearest(ray);
      const auto& ties = kProfiles[p].accuracy == Accuracy::kExact ? nearest.ties : nearest.float_ties;
      ++tally.asked_rays;
      if (ids[pixel] == (ties.empty() ? kNoTriangle : ties.front())) continue;
      ++tally.machines[machine].differences[p];
      fail(tally, seed, "not the oracle's hit", kProfiles[p].name, machines_[machine].name, pixel);
    }
  }

  void shoot_peers(Tally& tally, const PixelRays& rays) {
    for (std::size_t i = 0; i < machines_.size(); ++i) {
      const RoundingGuard guard(machines_[i]);
      for (std::uint32_t first = 0; first < kPixels && !peers_.empty(); first += watertight::kShotRays) {
        watertight::Shot shot{};
        shot.active = (1u << watertight::kShotRays) - 1u;
        for (int axis = 0; axis < 3; ++axis) {
          shot.origin[axis] = rays.eye[axis];
          for (std::uint32_t ray = 0; ray < watertight::kShotRays; ++ray) {
            shot.dir[axis][ray] = rays.direction(axis, first + ray);
          }
        }
        for (std::size_t p = 0; p < peers_.size(); ++p) {
          const std::uint32_t missed = shot.active & ~peers_[p](shot, 1);
          tally.machines[i].peer_misses[p] += static_cast<std::uint64_t>(std::popcount(missed));
        }
      }
    }
  }

  static void fail(Tally& tally, std::uint64_t seed, const char* what, const char* profile, const char* machine,
                   std::uint32_t pixel) {
    if (!tally.first_failure.empty()) return;
    std::ostringstream words;
    words << profile << ", through the grid, " << machine << ": " << what << ", seed " << seed << ", pixel " << pixel;
    tally.first_failure = words.str();
  }

  const PlacedSolid& solid_;
  std::span<const Machine> machines_;
  std::span<const Peer> peers_;
  sim::Mode mode_;
  const TallyOptions& options_;
  std::unique_ptr<GridScene> scenes_[4];  // by format
};

}  // namespace

std::vector<Machine> grid_machines() {
  std::vector<Machine> found;
  for (const Machine& machine : machines()) {
    if (machine.shoot == machines()[0].shoot) found.push_back(machine);
  }
  return found;
}

Tally shoot_through_grid(const PlacedSolid& solid, std::span<const Machine> machines, std::span<const Peer> peers,
                         sim::Mode mode, const TallyOptions& options) {
  const std::uint64_t frames = (options.rays + kPixels - 1) / kPixels;
  std::vector<Tally> parts(frames);
  std::atomic<std::uint64_t> next_frame = 0;
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&] {
    try {
      GridShooting shooting(solid, machines, peers, mode, options);
      for (std::uint64_t frame = next_frame++; frame < frames; frame = next_frame++) {
        parts[frame] = shooting.shoot(frame);
      }
    } catch (...) {
      const std::lock_guard lock(failing);
      if (failure == nullptr) failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < options.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure != nullptr) std::rethrow_exception(failure);
  Tally sum;
  for (const Tally& part : parts) sum.add(part);
  return sum;
}

}  // namespace gridiron::test
