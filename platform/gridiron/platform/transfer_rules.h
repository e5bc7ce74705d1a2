// The rules of a single transfer that follow from a platform's limits, for ports that want to check them.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/platform/status.h>

#include <cstdint>

namespace gridiron {

/// Checks size, tag, alignment, congruence and boundary of one transfer. The port itself checks the rest: the ranges of
/// local and main memory, the queue, and other pending transfers.
///
/// @param local_address  numeric address of the local side.
/// @returns kTransferSize, kTransferTag, kTransferAlignment, kTransferBoundary (first that applies) or kOk.
[[nodiscard]] constexpr Status check_transfer(const PlatformLimits& limits, std::uint64_t local_address,
                                              MainAddress address, std::uint32_t bytes, Tag tag) {
  const auto is_multiple = [](std::uint64_t value, std::uint32_t step) { return step == 0 || value % step == 0; };
  if (bytes == 0 || bytes > limits.max_transfer_bytes || !is_multiple(bytes, limits.alignment_bytes)) {
    return Status::kTransferSize;
  }
  if (tag.index >= limits.tag_count) return Status::kTransferTag;
  if (!is_multiple(local_address, limits.alignment_bytes) || !is_multiple(address.value, limits.alignment_bytes) ||
      !is_multiple(local_address - address.value, limits.congruence_bytes)) {
    return Status::kTransferAlignment;
  }
  if (limits.boundary_bytes != 0 && address.value % limits.boundary_bytes + bytes > limits.boundary_bytes) {
    return Status::kTransferBoundary;
  }
  return Status::kOk;
}

}  // namespace gridiron
