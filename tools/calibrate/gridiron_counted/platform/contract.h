// The platform's contract as it is, but for addresses, which the kernel computes.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron_counted/base/counted.h>

#include <cstdint>

namespace gridiron_counted {

using gridiron::kPortableBoundaryBytes;
using gridiron::kPortableCongruenceBytes;
using gridiron::kPortableGranuleBytes;
using gridiron::Platform;
using gridiron::Status;
using gridiron::TileClaim;

struct MainAddress {
  Counted<std::uint64_t> value;

  [[nodiscard]] MainAddress offset_by(const Counted<std::uint64_t>& bytes) const { return {value + bytes}; }
};

}  // namespace gridiron_counted
