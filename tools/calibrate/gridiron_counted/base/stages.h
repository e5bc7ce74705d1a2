// Stages are told to nobody here. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/stages.h>

namespace gridiron_counted {

using gridiron::Stage;

}  // namespace gridiron_counted
