// Compiled before core's own sources, which so become the counted kernel: other numbers, lanes and counters, another
// namespace, and branches that record where they are. Never part of a product: the language reserves its keywords, but
// GCC and clang let a macro replace them. Every standard header that core includes must be included here, above the
// macros. A new engine adds its kinds of work to the headers and names that stay as they are.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <copy_core.h>
#include <counted/counted.h>
#include <counted/four_words.h>
#include <counted/lanes.h>
#include <counted/quad_words.h>
#include <counted_kernel.h>
#include <gridiron/base/math.h>
#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/build/passes/build_work.h>
#include <gridiron/bvh/bvh_work.h>
#include <gridiron/bvh/cache_counts.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/platform/contract.h>

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <new>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

namespace gridiron_counted {

using gridiron::BuildWork;
using gridiron::CheckWork;
using gridiron::GridWork;
using gridiron::InPlaceReader;
using gridiron::ItemClaim;
using gridiron::kFloatMax;
using gridiron::kInfinity;
using gridiron::kPortableBoundaryBytes;
using gridiron::kPortableCongruenceBytes;
using gridiron::kPortableGranuleBytes;
using gridiron::kWorkKindCount;
using gridiron::Platform;
using gridiron::Stage;
using gridiron::Status;
using gridiron::TileWork;
using gridiron::Work;
using gridiron::WorkId;

/// Core's MainAddress with a counted value.
struct MainAddress {
  Counted<std::uint64_t> value;

  [[nodiscard]] MainAddress offset_by(const Counted<std::uint64_t>& bytes) const { return {value + bytes}; }
};

/// Reports work to the pipe model and keeps nothing; as large as core's, so that the local store has the same map.
struct WorkCounters {
  std::uint32_t counts[kWorkKindCount];
  void add(WorkId kind, std::uint32_t amount = 1) { PipeModel::current().add_units(kind, amount); }
  void add(WorkId kind, const Counted<std::uint32_t>& amount) { add(kind, amount.value); }
  void charge_to(WorkId kind) const { PipeModel::current().charge_to(kind); }
};

namespace bvh {
using gridiron::bvh::BvhWork;
using gridiron::bvh::CacheCounts;
}  // namespace bvh

}  // namespace gridiron_counted

// The kernel writes std::uint32_t, so what replaces it must be in std.
namespace std {
using counted_int32 = gridiron_counted::Counted<int32_t>;
using counted_int64 = gridiron_counted::Counted<int64_t>;
using counted_uint32 = gridiron_counted::Counted<uint32_t>;
using counted_uint64 = gridiron_counted::Counted<uint64_t>;
using gridiron_counted::counted_bit_cast;
}  // namespace std

#define gridiron gridiron_counted
#define float ::gridiron_counted::Counted<float>
#define double ::gridiron_counted::Counted<double>
#define int32_t counted_int32
#define int64_t counted_int64
#define uint32_t counted_uint32
#define uint64_t counted_uint64
#define bit_cast counted_bit_cast

// clang-format would part the keywords from their brackets.
// clang-format off
#define GRIDIRON_SITE (::gridiron_counted::file_number(__FILE__) * 65536u + __LINE__)
#define if(...) if (::gridiron_counted::branch_at(GRIDIRON_SITE, __VA_ARGS__))
#define while(...) while (::gridiron_counted::branch_at(GRIDIRON_SITE, __VA_ARGS__))
#define switch(...) switch (::gridiron_counted::switch_at(GRIDIRON_SITE, __VA_ARGS__))
#define for(...)                                                                                    \
  if constexpr (::gridiron_counted::CountedLoop counted_loop(GRIDIRON_SITE, __FILE__, #__VA_ARGS__); false) { \
  } else                                                                                            \
    for (__VA_ARGS__)                                                                               \
      if constexpr (const ::gridiron_counted::CountedTurn counted_turn(counted_loop); false) {      \
      } else
// clang-format on
// That a transfer fails is not counted as a branch: switch_at() leaves a Status alone.
#undef GRIDIRON_TRY
#define GRIDIRON_TRY(expression)                                    \
  {                                                                 \
    const ::gridiron_counted::Status counted_status = (expression); \
    switch (counted_status) {                                       \
      case ::gridiron_counted::Status::kOk:                         \
        break;                                                      \
      default:                                                      \
        return counted_status;                                      \
    }                                                               \
  }
