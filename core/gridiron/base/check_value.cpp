// Check value: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/check_value.h>

#include <bit>

namespace gridiron {
namespace {

static_assert(std::endian::native == std::endian::little, "scene images are little-endian, and so are their makers");

constexpr std::uint64_t kOffsetBasis = 0xcbf29ce484222325u;
constexpr std::uint64_t kPrime = 0x100000001b3u;

}  // namespace

CheckValue::CheckValue() {
  for (std::uint64_t& stream : streams_) stream = kOffsetBasis;
}

void CheckValue::add(std::span<const std::byte> bytes) {
  std::uint64_t states[kStreamCount];
  for (int i = 0; i < kStreamCount; ++i) states[i] = streams_[i];
  for (std::size_t offset = 0; offset + kGroupBytes <= bytes.size(); offset += kGroupBytes) {
    std::uint64_t words[kStreamCount];
    __builtin_memcpy(words, bytes.data() + offset, kGroupBytes);
    for (int i = 0; i < kStreamCount; ++i) states[i] = (states[i] ^ words[i]) * kPrime;
  }
  for (int i = 0; i < kStreamCount; ++i) streams_[i] = states[i];
}

std::uint64_t CheckValue::value() const {
  std::uint64_t hash = kOffsetBasis;
  for (const std::uint64_t stream : streams_) hash = (hash ^ stream) * kPrime;
  return hash;
}

}  // namespace gridiron
