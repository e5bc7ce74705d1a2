// Frames that are hard for packets of their pixels: narrow, wide, far away, huge, tiny, flat, degenerate.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

#include "core/ray/packet_cases.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// What is hard about a frame's pixels.
enum class FrameKind : std::uint32_t {
  kOrdinary,    // a camera as people have them
  kExact,       // axis-aligned, everything a small multiple of a power of two
  kNarrow,      // pixels that rounding moves
  kWide,        // a packet sees up to almost half of the world
  kFarOrigin,   // vertices keep few bits beside the eye's coordinates
  kScaled,      // directions and places of any size
  kFlat,        // steps almost parallel, or the picture almost edge-on
  kDegenerate,  // no picture at all: steps parallel or 0, or a corner in their plane
  kCount
};

/// A frame of 8192 x 8192 pixels: eye, corner and steps, nothing of a scene.
inline FrameRecord make_frame(TestRandom& random, FrameKind kind) {
  FrameRecord frame{};
  frame.t_far = kFloatMax;
  frame.width = frame.height = 8192;
  Vec3 right = random_vec(random, 1.0f);
  Vec3 down = random_vec(random, 1.0f);
  const Vec3 normal(right.y * down.z - right.z * down.y, right.z * down.x - right.x * down.z,
                    right.x * down.y - right.y * down.x);
  down = Vec3(normal.y * right.z - normal.z * right.y, normal.z * right.x - normal.x * right.z,
              normal.x * right.y - normal.y * right.x);
  const auto unit = [](Vec3 v) { return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); };
  right = unit(right);
  down = unit(down);
  Vec3 forward = unit(normal);
  Vec3 eye = random_vec(random, 4.0f);
  float pixel = std::ldexp(1.0f + random.unit(), -8 - static_cast<int>(random.below(3)));
  float half = 0.5f;  // tangent from the middle to the left and upper side
  float scale = 1.0f;
  if (kind == FrameKind::kExact) {
    right = {1, 0, 0};
    down = {0, -1, 0};
    forward = {0, 0, -1};
    eye = random.below(2) == 0 ? Vec3(0.0f) : Vec3(3.0f, -5.0f, 0.5f);
    pixel = std::ldexp(1.0f, -6 - static_cast<int>(random.below(5)));
  } else if (kind == FrameKind::kNarrow) {
    pixel = std::ldexp(1.0f + random.unit(), -12 - static_cast<int>(random.below(14)));
    half = random.below(2) == 0 ? 0.5f : 64.0f * pixel;
  } else if (kind == FrameKind::kWide) {
    pixel = std::ldexp(1.0f + random.unit(), -static_cast<int>(random.below(6)));
    half = random.below(2) == 0 ? 16.0f * pixel : 2.0f;
  } else if (kind == FrameKind::kFarOrigin) {
    eye = random_vec(random, std::ldexp(1.0f, 10 + static_cast<int>(random.below(16))));
  } else if (kind == FrameKind::kScaled) {
    scale = std::ldexp(1.0f + random.unit(), static_cast<int>(random.below(161)) - 80);
    pixel = std::ldexp(pixel, -static_cast<int>(random.below(8)));
    eye = random.below(2) == 0 ? eye * scale : eye;
  } else if (kind == FrameKind::kFlat) {
    const float least = std::ldexp(random.unit(), -static_cast<int>(random.below(20)));
    if (random.below(2) == 0) {
      down = right + least * down;
    } else {
      forward = right + least * forward;
    }
  } else if (kind == FrameKind::kDegenerate) {
    right = {1, 2, -3};
    const std::uint32_t way = random.below(4);
    down = way == 0 ? -2.0f * right : way == 1 ? Vec3(0.0f) : Vec3(2, 1, 1);
    forward = way == 2 ? 16.0f * right + 4.0f * down : Vec3(1, 1, 1);
    if (way == 3) forward = Vec3(0.0f);
    pixel = 0x1p-8f;
  }
  for (int axis = 0; axis < 3; ++axis) {
    frame.eye[axis] = eye[axis];
    frame.step_x[axis] = right[axis] * pixel * scale;
    frame.step_y[axis] = down[axis] * pixel * scale;
    frame.corner[axis] = (forward[axis] - half * (right[axis] + down[axis])) * scale;
  }
  return frame;
}

}  // namespace gridiron::test
