// Content hash: one number for the bytes of a file, by which a changed file is noticed.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/check_value.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace gridiron::tool {

/// @returns the check value of the bytes, zeros up to a whole group, and a group with their number.
[[nodiscard]] inline std::uint64_t content_hash(std::span<const std::byte> bytes) {
  using Group = std::array<std::byte, CheckValue::kGroupBytes>;
  const std::size_t whole = bytes.size() / sizeof(Group) * sizeof(Group);
  Group tail{}, count{};
  if (bytes.size() > whole) std::memcpy(tail.data(), bytes.data() + whole, bytes.size() - whole);
  const std::uint64_t byte_count = bytes.size();
  std::memcpy(count.data(), &byte_count, sizeof byte_count);
  CheckValue value;
  value.add(bytes.first(whole));
  value.add(tail);
  value.add(count);
  return value.value();
}

}  // namespace gridiron::tool
