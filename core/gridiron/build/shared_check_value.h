// The check value of a large image by several threads: each takes whole pieces.
// Internal header. Memory: values, 8 KB of stack. Threads: those that share the work.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/check_value.h>
#include <gridiron/build/shared_parts.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Does what check.add(bytes) does.
static inline void add_shared(ImageCheckValue& check, std::span<const std::byte> bytes,
                              [[maybe_unused]] const WorkSharing& sharing) {
  constexpr std::size_t kPieces = 1024, kPiece = ImageCheckValue::kPieceBytes;
  const std::size_t missing = check.missing_bytes();
  const std::uint32_t shares = shares_for(sharing);
  if (!kSharesWork || shares == 1 || bytes.size() < missing + 64 * kPiece) return check.add(bytes);
  check.add(bytes.first(missing));
  bytes = bytes.subspan(missing);
  while (bytes.size() >= kPiece) {
    const std::size_t left = bytes.size() / kPiece, count = left < kPieces ? left : kPieces;
    std::uint64_t values[kPieces];
    share(sharing, shares, [&](std::uint32_t i) {
      const Share part = share_of(count, shares, i);
      for (std::size_t piece = part.begin; piece < part.end; ++piece) {
        CheckValue value;
        value.add(bytes.subspan(piece * kPiece, kPiece));
        values[piece] = value.value();
      }
    });
    for (std::size_t piece = 0; piece < count; ++piece) check.add_piece(values[piece]);
    bytes = bytes.subspan(count * kPiece);
  }
  check.add(bytes);
}

}  // namespace gridiron
