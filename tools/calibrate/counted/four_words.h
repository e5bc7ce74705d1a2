// Counted words: the interface of the cached BVH's four_words.h. Memory: values. Threads: the model's.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <counted/lanes.h>
#include <gridiron/bvh/four_words.h>

#include <cstdint>

namespace gridiron_counted::bvh {

struct FourWords {
  using Native = gridiron::bvh::FourWords;
  using Four = Lanes<4>;
  Native v;
  Node node;

  [[nodiscard]] static FourWords load(const Counted<std::uint32_t>* source) {
    const Native value = Native::load(&source->value);
    return {value, PipeModel::current().load_quad(source, Four::tie(value.v))};
  }
  void store(Counted<std::uint32_t>* target) const {
    v.store(&target->value);
    PipeModel::current().store_quad(target, node, Four::tie(v.v));
  }
  [[nodiscard]] static FourWords splat(std::uint32_t constant) { return {Native::splat(constant), 0}; }
  [[nodiscard]] static FourWords splat(const Counted<std::uint32_t>& word) {
    return {Native::splat(word.value), PipeModel::current().splat_of(&word.value, word.value)};
  }
  [[nodiscard]] static FourWords where(Four::Mask mask, std::uint32_t constant) {
    return make(OpClass::kFixed, Native::where(mask.v, constant), mask.node, 0);
  }
  [[nodiscard]] static FourWords select(Four::Mask mask, FourWords a, FourWords b) {
    const Native value = Native::select(mask.v, a.v, b.v);
    return {value, emit(OpClass::kFixed, Four::tie(value.v), mask.node, a.node, b.node)};
  }
  friend FourWords operator|(FourWords a, FourWords b) { return make(OpClass::kFixed, a.v | b.v, a.node, b.node); }
  friend FourWords operator&(FourWords a, FourWords b) { return make(OpClass::kFixed, a.v & b.v, a.node, b.node); }
  [[nodiscard]] Four::Mask equal(FourWords other) const { return compared(v.equal(other.v), other); }
  [[nodiscard]] Four::Mask less(FourWords other) const { return compared(v.less(other.v), other); }
  [[nodiscard]] Four::Mask less_but(FourWords other, FourWords turned) const {
    const Four::Mask lesser = less(other);
    const Four::Native::Mask mask = v.less_but(other.v, turned.v);
    return {mask, emit(OpClass::kFixed, Four::tie(mask.v), lesser.node, turned.node)};
  }
  /// A rotation.
  [[nodiscard]] Counted<std::uint32_t> word(const Counted<std::uint32_t>& index) const {
    const std::uint32_t value = v.word(index.value);
    return Counted<std::uint32_t>::made(value, emit(OpClass::kShuffle, value, node, node_of(index)));
  }
  /// A scalar lives in the first word of a register.
  [[nodiscard]] Counted<std::uint32_t> word(int index) const {
    const std::uint32_t value = v.word(static_cast<std::uint32_t>(index));
    return Counted<std::uint32_t>::made(value, index == 0 ? node : emit(OpClass::kShuffle, value, node));
  }
  [[nodiscard]] Four::Float floats() const { return {v.floats(), node}; }
  [[nodiscard]] static FourWords of(Four::Float floats) { return {Native::of(floats.v), floats.node}; }

 private:
  static FourWords make(OpClass op, Native value, Node a, Node b) {
    return {value, emit(op, Four::tie(value.v), a, b)};
  }
  Four::Mask compared(Four::Native::Mask mask, FourWords other) const {
    return {mask, emit(OpClass::kFixed, Four::tie(mask.v), node, other.node)};
  }
};

}  // namespace gridiron_counted::bvh
