// The rival's kinds of work, told to the pipe model by the counters that carry them.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/rival/rival_work.h>
#include <gridiron_counted/base/work_counters.h>

namespace gridiron_counted::rival {

using gridiron::rival::carrier_of;
using gridiron::rival::RivalWork;

}  // namespace gridiron_counted::rival
