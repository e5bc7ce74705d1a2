// Statistics of the caches, which cost nothing. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/rival/cache_counts.h>

namespace gridiron_counted::rival {

using gridiron::rival::CacheCounts;

}  // namespace gridiron_counted::rival
