// The cached BVH's kinds of work. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/bvh_work.h>
#include <gridiron_counted/base/work_counters.h>

namespace gridiron_counted::bvh {

using gridiron::bvh::BvhWork;

}  // namespace gridiron_counted::bvh
