// The cached BVH's kinds of work, told to the pipe model by the counters that carry them.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/bvh_work.h>
#include <gridiron_counted/base/work_counters.h>

namespace gridiron_counted::bvh {

using gridiron::bvh::BvhWork;
using gridiron::bvh::carrier_of;

}  // namespace gridiron_counted::bvh
