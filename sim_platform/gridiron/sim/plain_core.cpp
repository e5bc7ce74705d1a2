// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/plain_core.h>

#include <cstring>

namespace gridiron::sim {

void copy_bytes(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }

}  // namespace gridiron::sim
