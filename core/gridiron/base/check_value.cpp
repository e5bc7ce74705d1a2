// Check value: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/check_value.h>

#include <bit>

namespace gridiron {

static_assert(std::endian::native == std::endian::little, "scene images are little-endian, and so are their makers");

CheckValue::CheckValue() {
  for (std::uint64_t& stream : streams_) stream = kOffsetBasis;
}

void CheckValue::add(std::span<const std::byte> bytes) {
  const std::byte* place = bytes.data();
  const std::byte* const end = place + bytes.size() / kGroupBytes * kGroupBytes;
  const auto next = [&place](std::uint64_t stream, int i) {
    std::uint64_t word;
    __builtin_memcpy(&word, place + i * std::ptrdiff_t{8}, sizeof word);
    return (stream ^ word) * kPrime;
  };
  // By name: an array's elements would not stay in registers.
  static_assert(kStreamCount == 8);
  std::uint64_t s0 = streams_[0], s1 = streams_[1], s2 = streams_[2], s3 = streams_[3];
  std::uint64_t s4 = streams_[4], s5 = streams_[5], s6 = streams_[6], s7 = streams_[7];
  for (; place != end; place += kGroupBytes) {
    s0 = next(s0, 0);
    s1 = next(s1, 1);
    s2 = next(s2, 2);
    s3 = next(s3, 3);
    s4 = next(s4, 4);
    s5 = next(s5, 5);
    s6 = next(s6, 6);
    s7 = next(s7, 7);
  }
  const std::uint64_t states[kStreamCount] = {s0, s1, s2, s3, s4, s5, s6, s7};
  for (int i = 0; i < kStreamCount; ++i) streams_[i] = states[i];
}

std::uint64_t CheckValue::value() const {
  std::uint64_t hash = kOffsetBasis;
  for (const std::uint64_t stream : streams_) hash = (hash ^ stream) * kPrime;
  return hash;
}

void ImageCheckValue::add(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::size_t room = kPieceBytes - piece_bytes_, count = bytes.size() < room ? bytes.size() : room;
    piece_.add(bytes.first(count));
    bytes = bytes.subspan(count);
    piece_bytes_ += count;
    if (piece_bytes_ < kPieceBytes) continue;
    add_piece(piece_.value());
    piece_ = CheckValue();
    piece_bytes_ = 0;
  }
}

std::uint64_t ImageCheckValue::value() const {
  ImageCheckValue all = *this;
  if (piece_bytes_ > 0) all.add_piece(piece_.value());
  return all.value_;
}

}  // namespace gridiron
