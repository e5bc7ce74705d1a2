// Workers: pieces of work shared by host threads.
// Memory: one error a piece. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "base/ranks.h"
#include "base/share_work.h"

namespace gridiron::experiment {

using tool::share_work;

/// Results of pieces of work as bytes, for other ranks.
struct ResultBytes {
  std::function<tool::Bytes(std::size_t)> pack;                 ///< @returns the result of a piece
  std::function<void(std::size_t, const tool::Bytes&)> unpack;  ///< takes the result of a piece of another rank
};

/// As tool::share_work(), with the pieces divided among tool::ranks(). On return every rank has the results of all.
void share_work(std::uint32_t threads, std::size_t count, const std::function<void(std::size_t)>& work,
                const ResultBytes& results);

}  // namespace gridiron::experiment
