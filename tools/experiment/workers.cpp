// Workers. SPDX-License-Identifier: Apache-2.0
#include "experiment/workers.h"

#include <mutex>

namespace gridiron::experiment {

void share_work(std::uint32_t threads, std::size_t count, const std::function<void(std::size_t)>& work,
                const ResultBytes& results) {
  tool::Ranks& ranks = tool::ranks();
  if (ranks.count() == 1) return share_work(threads, count, work);
  std::mutex mutex;
  share_work(threads, static_cast<std::size_t>(ranks.share_of(count)), [&](std::size_t k) {
    work(ranks.piece(k));
    const std::lock_guard lock(mutex);
    ranks.attend();
  });
  tool::exchange_results(count, results.pack, results.unpack);
}

}  // namespace gridiron::experiment
