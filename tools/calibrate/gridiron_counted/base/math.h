// What the kernel takes from core's math.h. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

namespace gridiron_counted {

using gridiron::kFloatMax;
using gridiron::kInfinity;

}  // namespace gridiron_counted
