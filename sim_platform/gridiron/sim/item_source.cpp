// Item source: functions that may throw, in code built with exceptions, which the kernel's builds are not.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/item_source.h>

namespace gridiron::sim {

void ItemSource::item_done() {
  if (!progress_) return;
  const std::scoped_lock lock(progress_mutex_);
  ++done_;
  progress_(done_, total_);
}

}  // namespace gridiron::sim
