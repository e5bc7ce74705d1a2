// The grid's kinds of work. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/engine/grid/grid_work.h>
#include <gridiron_counted/base/work_counters.h>

namespace gridiron_counted {

using gridiron::GridWork;

}  // namespace gridiron_counted
