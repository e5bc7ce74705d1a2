// Triangle runs: where consecutive triangles lie in main memory, and which bytes around them a transfer moves.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

/// A run in main memory and in its buffer.
struct RunPlace {
  MainAddress begin;         ///< of the transfer
  std::uint32_t bytes;       ///< of the transfer
  std::uint32_t first_byte;  ///< where the run starts in its buffer
  std::uint32_t slack;       ///< bytes of the transfer before it
};

[[nodiscard]] GRIDIRON_INLINE bool is_on_lattice(const FrameHead& frame) {
  return frame.accuracy == static_cast<std::uint32_t>(Accuracy::kCompact);
}

/// @param first, count  triangles, count > 0.
[[nodiscard]] GRIDIRON_INLINE RunPlace run_place(const FrameRecord& frame, std::uint32_t first, std::uint32_t count) {
  static_assert(2 * sizeof(LatticeTriangle) == kTriangleRecordBytes);
  constexpr std::uint32_t kTransferStep = kPortableGranuleBytes;
  std::uint64_t offset = std::uint64_t{first} * kTriangleRecordBytes;
  std::uint32_t bytes = count * kTriangleRecordBytes;
  std::uint32_t slack = 0;
  if (is_on_lattice(frame)) {
    // Records of half the length start and end between the multiples of 16 bytes that a transfer moves.
    offset = offset / 2;
    slack = static_cast<std::uint32_t>(offset % kTransferStep);
    bytes = (slack + bytes / 2 + (kTransferStep - 1)) & ~(kTransferStep - 1);
  }
  const std::uint64_t begin = frame.engine.triangles_address + offset;
  const std::uint32_t first_byte = static_cast<std::uint32_t>(begin % kPortableCongruenceBytes);
  return {MainAddress{begin - slack}, bytes, first_byte, slack};
}

}  // namespace gridiron
