// Statistics of the caches, which cost nothing. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/cache_counts.h>

namespace gridiron_counted::bvh {

using gridiron::bvh::CacheCounts;

}  // namespace gridiron_counted::bvh
