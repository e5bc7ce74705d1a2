// Patience: pauses between looks at something that another process does, short at first.
// Memory: none. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <algorithm>

namespace gridiron::tool {

class Patience {
 public:
  void pause() {
    (void)::usleep(microseconds_);
    microseconds_ = std::min<useconds_t>(2 * microseconds_, kLongest);
  }

 private:
  static constexpr useconds_t kLongest = 5000;
  useconds_t microseconds_ = 50;
};

}  // namespace gridiron::tool
