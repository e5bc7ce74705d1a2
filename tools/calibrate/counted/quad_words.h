// Counted points: the interface of core's build/quad_words.h, and of what it needs of a mesh.
// Memory: values. Threads: the model's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <counted/lanes.h>
#include <gridiron/base/math.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace gridiron {
bool decide_zero_area(const Vec3& a, const Vec3& b, const Vec3& c);  // of build/triangle_records.h
}

namespace gridiron_counted {

struct Vec3 {
  Counted<float> x, y, z;
  Vec3(Counted<float> of_x, Counted<float> of_y, Counted<float> of_z) : x(of_x), y(of_y), z(of_z) {}
};
struct UVec3 {
  Counted<std::uint32_t> x, y, z;
};
static_assert(sizeof(Vec3) == 12 && sizeof(UVec3) == 12);

template <class A, class B>
[[nodiscard]] constexpr auto round_up(const A& value, const B& step) {
  return (value + step - 1) & ~(step - 1);
}

using CornerQuad = Lanes<4>::Float;

/// Read and written as one quadword.
struct alignas(16) StoredQuad {
  Counted<float> words[4];

  StoredQuad() = default;
  StoredQuad(const StoredQuad& other) { *this = CornerQuad(other); }
  StoredQuad(const CornerQuad& quad) { *this = quad; }  // NOLINT: core's is a CornerQuad
  StoredQuad& operator=(const StoredQuad& other) { return *this = CornerQuad(other); }
  StoredQuad& operator=(const CornerQuad& quad) {
    quad.store(words);
    return *this;
  }
  operator CornerQuad() const { return CornerQuad::load(words); }  // NOLINT: the same
};
static_assert(sizeof(StoredQuad) == 16);

/// The two quadwords that four words lie in, and a shuffle; one quadword where they are aligned.
[[nodiscard]] inline CornerQuad quad_at(const void* words) {
  float values[4];
  std::memcpy(values, words, sizeof values);
  Lanes<4>::Native::Float value{};
  std::memcpy(&value.v, values, sizeof values);
  const std::uint64_t tied = Lanes<4>::tie(value.v);
  const auto address = reinterpret_cast<std::uintptr_t>(words);
  const auto* const first = reinterpret_cast<const void*>(address / 16 * 16);
  const Node low = PipeModel::current().load_quad(first, tied);
  if (address % 16 == 0) return {value, low};
  const Node high = PipeModel::current().load_quad(static_cast<const std::byte*>(first) + 16, tied);
  return {value, emit(OpClass::kShuffle, tied, low, high)};
}
/// A point anywhere: the pattern of the shuffle, which sets the last lane to 0, comes from a table by the address.
[[nodiscard]] inline CornerQuad quad_of(const Vec3& point) {
  Lanes<4>::Native::Float value{};
  const float values[4] = {point.x.value, point.y.value, point.z.value, 0.0f};
  std::memcpy(&value.v, values, sizeof values);
  const std::uint64_t tied = Lanes<4>::tie(value.v);
  const auto* const first = reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(&point) / 16 * 16);
  const Node low = PipeModel::current().load_quad(first, tied);
  const Node high = PipeModel::current().load_quad(static_cast<const std::byte*>(first) + 16, tied);
  const Node place = emit(OpClass::kFixed, tied);
  const Node pattern = emit(OpClass::kLoad, tied, place);
  return {value, emit(OpClass::kShuffle, tied + 1, low, high, pattern)};
}
[[nodiscard]] inline CornerQuad inner_quad(std::span<const Vec3> points, std::size_t index) {
  return quad_at(points.data() + index);
}
/// As of an address that only the core knows: pattern, both quadwords merged.
inline void store_at(const CornerQuad& quad, void* words) {
  const auto address = reinterpret_cast<std::uintptr_t>(words);
  const std::uint64_t tied = Lanes<4>::tie(quad.v.v);
  const Node pattern = emit(OpClass::kShuffle, tied);
  for (const std::uintptr_t part : {address / 16 * 16, address / 16 * 16 + 16}) {
    const auto* const place = reinterpret_cast<const void*>(part);
    const Node before = PipeModel::current().load_quad(place, tied + part % 32);
    const Node turned = emit(OpClass::kShuffle, tied + 1 + part % 32, quad.node, pattern);
    PipeModel::current().store_quad(place, emit(OpClass::kFixed, tied + 2, before, turned, pattern), tied);
  }
  std::memcpy(words, &quad.v.v, 16);
}
/// A scalar lives in the first word of a register.
[[nodiscard]] inline Counted<float> lane_of(const CornerQuad& quad, int lane) {
  const float value = quad.v.v[lane];
  return Counted<float>::made(value, lane == 0 ? quad.node : emit(OpClass::kShuffle, bits_of(value), quad.node));
}
[[nodiscard]] inline Counted<float> lane_of(const CornerQuad& quad, const Counted<std::int32_t>& lane) {
  return lane_of(quad, static_cast<int>(lane.value));
}
[[nodiscard]] inline Vec3 vec3_of(const CornerQuad& quad) {
  return {lane_of(quad, 0), lane_of(quad, 1), lane_of(quad, 2)};
}
/// A shuffle for each word that is not known before.
[[nodiscard]] inline Lanes<4>::Int words_quad(const Counted<std::uint32_t>& a, const Counted<std::uint32_t>& b,
                                              const Counted<std::uint32_t>& c, const Counted<std::uint32_t>& d) {
  Lanes<4>::Int words{Lanes<4>::Native::Int::splat(0), 0};
  int lane = 0;
  for (const Counted<std::uint32_t>* word : {&a, &b, &c, &d}) {
    words.v.v[lane++] = static_cast<std::int32_t>(word->value);
    const Node node = node_of(*word);
    if (node != 0) words.node = emit(OpClass::kShuffle, word->value, words.node, node);
  }
  return words;
}
/// What floats leave open is decided in doubles or integers: so rare that it is not counted.
[[nodiscard]] inline bool has_zero_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto plain_of = [](const Vec3& p) { return gridiron::Vec3(p.x.value, p.y.value, p.z.value); };
  return gridiron::decide_zero_area(plain_of(a), plain_of(b), plain_of(c));
}

}  // namespace gridiron_counted
