// What every platform must do, as plain functions: run by contract_test.cpp on the host and by a port's own main()
// on a board. Needs no test framework, heap or exceptions.
// Memory: the bench's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/platform/status.h>

#include <cstddef>
#include <cstdint>

namespace gridiron::contract {

/// Sizes that a bench must offer. Local memory begins on 128 bytes, main memory on 4,096.
inline constexpr std::uint32_t kLocalBytes = 32 * 1024;
inline constexpr std::uint32_t kMainBytes = 64 * 1024;
inline constexpr std::uint32_t kItemCount = 7;

/// One core of a platform under test, with memory to play with. Fresh for every check.
///
/// platform    the object under test
/// local       kLocalBytes of the core's local memory
/// main        address of kMainBytes of main memory that gets may read and puts may write
/// poke, peek  the host's (or another master's) view of byte `offset` of that main memory
/// kChecksRules     whether the platform refuses transfers that break a rule of size, tag, alignment or boundary
/// kChecksQueue     whether it also refuses a command more than its queue holds; false where a call ends its transfer
/// kChecksOverlap   whether it also refuses overlapping transfers
template <class B>
concept Bench = requires(B& bench, std::uint32_t offset, std::byte value) {
  requires Platform<typename B::PlatformType>;
  { bench.platform() } -> std::same_as<typename B::PlatformType&>;
  { bench.local() } -> std::same_as<std::byte*>;
  { bench.main() } -> std::same_as<MainAddress>;
  { bench.poke(offset, value) } -> std::same_as<void>;
  { bench.peek(offset) } -> std::same_as<std::byte>;
  { B::kChecksRules } -> std::convertible_to<bool>;
  { B::kChecksQueue } -> std::convertible_to<bool>;
  { B::kChecksOverlap } -> std::convertible_to<bool>;
};

/// Why a check failed; null where it passed.
using Failure = const char*;

#define GRIDIRON_CONTRACT_REQUIRE(condition) \
  do {                                       \
    if (!(condition)) return #condition;     \
  } while (false)

/// A byte that depends on its place.
[[nodiscard]] constexpr std::byte pattern(std::uint32_t i) {
  return static_cast<std::byte>((i * 37u + (i >> 8) * 11u + 5u) & 0xFFu);
}
inline constexpr std::byte kUntouched{0x5E};

template <Bench B>
void fill_main(B& bench) {
  for (std::uint32_t i = 0; i < kMainBytes; ++i) bench.poke(i, pattern(i));
}
template <Bench B>
void fill_local(B& bench, std::byte value) {
  for (std::uint32_t i = 0; i < kLocalBytes; ++i) bench.local()[i] = value;
}

/// Transfers that are waited for at once. @returns whether call and wait succeeded.
template <Bench B>
bool get_now(B& bench, std::uint32_t to, std::uint32_t from, std::uint32_t bytes, Tag tag) {
  return bench.platform().get(bench.local() + to, bench.main().offset_by(from), bytes, tag) == Status::kOk &&
         bench.platform().wait(TagMask::of(tag)) == Status::kOk;
}
template <Bench B>
bool put_now(B& bench, std::uint32_t from, std::uint32_t to, std::uint32_t bytes, Tag tag) {
  return bench.platform().put(bench.local() + from, bench.main().offset_by(to), bytes, tag) == Status::kOk &&
         bench.platform().wait(TagMask::of(tag)) == Status::kOk;
}
/// Commands that may be under way, `most` of them where the queue has room.
template <Bench B>
std::uint32_t commands_at_once(B& bench, std::uint32_t most) {
  const std::uint32_t depth = bench.platform().limits().queue_depth;
  return depth < most ? depth : most;
}

// --- Function ---------------------------------------------------------------------------------------------------

template <Bench B>
Failure limits_allow_the_portable_subset(B& bench) {
  const PlatformLimits limits = bench.platform().limits();
  const auto divides = [](std::uint32_t limit, std::uint32_t portable) { return limit == 0 || portable % limit == 0; };
  GRIDIRON_CONTRACT_REQUIRE(divides(limits.alignment_bytes, kPortableGranuleBytes));
  GRIDIRON_CONTRACT_REQUIRE(divides(limits.congruence_bytes, kPortableCongruenceBytes));
  GRIDIRON_CONTRACT_REQUIRE(limits.boundary_bytes % kPortableBoundaryBytes == 0);
  GRIDIRON_CONTRACT_REQUIRE(limits.max_transfer_bytes >= kPortableBoundaryBytes);
  GRIDIRON_CONTRACT_REQUIRE(limits.tag_count == 32);
  GRIDIRON_CONTRACT_REQUIRE(limits.queue_depth >= 1);
  return nullptr;
}

/// Sizes from one granule to a whole boundary, at places that are congruent but not the same.
template <Bench B>
Failure get_brings_the_bytes_and_no_others(B& bench) {
  fill_main(bench);
  constexpr std::uint32_t kSizes[] = {16, 32, 48, 128, 496, 1024, 4096};
  for (const std::uint32_t bytes : kSizes) {
    const std::uint32_t from = bytes == 4096 ? 8192 : 8192 + 32 * 3 + 16;
    const std::uint32_t to = bytes == 4096 ? 4096 : 1024 + 16;
    fill_local(bench, kUntouched);
    GRIDIRON_CONTRACT_REQUIRE(get_now(bench, to, from, bytes, Tag{3}));
    for (std::uint32_t i = 0; i < kLocalBytes; ++i) {
      const bool is_inside = i >= to && i < to + bytes;
      GRIDIRON_CONTRACT_REQUIRE(bench.local()[i] == (is_inside ? pattern(from + i - to) : kUntouched));
    }
  }
  return nullptr;
}

template <Bench B>
Failure put_sends_the_bytes_and_no_others(B& bench) {
  constexpr std::uint32_t kSizes[] = {16, 32, 48, 128, 496, 1024, 4096};
  for (const std::uint32_t bytes : kSizes) {
    const std::uint32_t to = bytes == 4096 ? 8192 : 8192 + 32 * 3 + 16;
    const std::uint32_t from = bytes == 4096 ? 4096 : 1024 + 16;
    fill_main(bench);
    for (std::uint32_t i = 0; i < kLocalBytes; ++i) bench.local()[i] = pattern(i + 77);
    GRIDIRON_CONTRACT_REQUIRE(put_now(bench, from, to, bytes, Tag{4}));
    for (std::uint32_t i = 0; i < kMainBytes; ++i) {
      const bool is_inside = i >= to && i < to + bytes;
      GRIDIRON_CONTRACT_REQUIRE(bench.peek(i) == (is_inside ? pattern(from + i - to + 77) : pattern(i)));
    }
  }
  return nullptr;
}

/// At any place, and after a put too. Passes where nothing is read in place.
template <Bench B>
Failure what_is_read_in_place_is_main_memory(B& bench) {
  if constexpr (InPlaceReader<typename B::PlatformType>) {
    fill_main(bench);
    fill_local(bench, kUntouched);
    GRIDIRON_CONTRACT_REQUIRE(put_now(bench, 0, 8192, 64, Tag{2}));
    constexpr std::uint32_t kPlaces[] = {0, 1, 4096 - 16, 8192, kMainBytes - 64};
    for (const std::uint32_t from : kPlaces) {
      const std::byte* const there = bench.platform().in_place(bench.main().offset_by(from));
      if (there == nullptr) continue;
      for (std::uint32_t i = 0; i < 64; ++i) GRIDIRON_CONTRACT_REQUIRE(there[i] == bench.peek(from + i));
    }
  }
  return nullptr;
}

/// The bytes stored right before the call are sent, and after the wait the core may change the source again.
template <Bench B>
Failure put_sends_what_was_stored_before_it(B& bench) {
  for (std::uint32_t round = 0; round < 8; ++round) {
    for (std::uint32_t i = 0; i < 256; ++i) bench.local()[i] = static_cast<std::byte>((round * 16 + i) & 0xFF);
    GRIDIRON_CONTRACT_REQUIRE(put_now(bench, 0, 0, 256, Tag{0}));
    for (std::uint32_t i = 0; i < 256; ++i) bench.local()[i] = std::byte{0};
    for (std::uint32_t i = 0; i < 256; ++i) {
      GRIDIRON_CONTRACT_REQUIRE(bench.peek(i) == static_cast<std::byte>((round * 16 + i) & 0xFF));
    }
  }
  return nullptr;
}

/// The only order that holds: transfers that were waited for precede those that are started later.
template <Bench B>
Failure a_get_after_a_waited_put_sees_it(B& bench) {
  for (std::uint32_t round = 0; round < 8; ++round) {
    for (std::uint32_t i = 0; i < 512; ++i) bench.local()[i] = pattern(i + round);
    GRIDIRON_CONTRACT_REQUIRE(put_now(bench, 0, 0, 512, Tag{1}));
    GRIDIRON_CONTRACT_REQUIRE(get_now(bench, 1024, 0, 512, Tag{2}));
    for (std::uint32_t i = 0; i < 512; ++i) {
      GRIDIRON_CONTRACT_REQUIRE(bench.local()[1024 + i] == pattern(i + round));
    }
  }
  return nullptr;
}

template <Bench B>
Failure transfers_that_share_a_tag_end_together(B& bench) {
  fill_main(bench);
  const std::uint32_t count = commands_at_once(bench, 8);
  for (std::uint32_t round = 0; round < 3; ++round) {
    for (std::uint32_t i = 0; i < count; ++i) {
      GRIDIRON_CONTRACT_REQUIRE(bench.platform().get(bench.local() + i * 256,
                                                     bench.main().offset_by(i * 4096 + round * 32), 256,
                                                     Tag{5}) == Status::kOk);
    }
    GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask::of(Tag{5})) == Status::kOk);
    for (std::uint32_t i = 0; i < count * 256; ++i) {
      GRIDIRON_CONTRACT_REQUIRE(bench.local()[i] == pattern(i / 256 * 4096 + round * 32 + i % 256));
    }
  }
  return nullptr;
}

/// Tags are waited for in another order than that of the calls, one at a time.
template <Bench B>
Failure tags_can_be_waited_for_in_any_order(B& bench) {
  fill_main(bench);
  const std::uint32_t count = commands_at_once(bench, 8);
  for (std::uint32_t i = 0; i < count; ++i) {
    GRIDIRON_CONTRACT_REQUIRE(bench.platform().get(bench.local() + i * 128, bench.main().offset_by(i * 1024), 128,
                                                   Tag{static_cast<std::uint8_t>(i * 3)}) == Status::kOk);
  }
  for (std::uint32_t step = 0; step < count; ++step) {
    const std::uint32_t i = count - 1 - step;
    GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask::of(Tag{static_cast<std::uint8_t>(i * 3)})) == Status::kOk);
    for (std::uint32_t byte = 0; byte < 128; ++byte) {
      GRIDIRON_CONTRACT_REQUIRE(bench.local()[i * 128 + byte] == pattern(i * 1024 + byte));
    }
  }
  return nullptr;
}

template <Bench B>
Failure one_wait_takes_many_tags(B& bench) {
  fill_main(bench);
  const std::uint32_t count = commands_at_once(bench, 8);
  TagMask tags{};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Tag tag{static_cast<std::uint8_t>(31 - i)};
    tags = tags | TagMask::of(tag);
    GRIDIRON_CONTRACT_REQUIRE(bench.platform().get(bench.local() + i * 64, bench.main().offset_by(i * 512), 64, tag) ==
                              Status::kOk);
  }
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(tags) == Status::kOk);
  for (std::uint32_t i = 0; i < count * 64; ++i) {
    GRIDIRON_CONTRACT_REQUIRE(bench.local()[i] == pattern(i / 64 * 512 + i % 64));
  }
  return nullptr;
}

template <Bench B>
Failure waiting_for_nothing_ends_at_once(B& bench) {
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask{}) == Status::kOk);
  for (std::uint8_t tag = 0; tag < 32; ++tag) {
    GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask::of(Tag{tag})) == Status::kOk);
  }
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask{0xFFFFFFFFu}) == Status::kOk);
  return nullptr;
}

/// Gets and puts fill the queue to its last place, are waited for, and fill it again.
template <Bench B>
Failure the_whole_queue_can_be_used(B& bench) {
  fill_main(bench);
  const std::uint32_t count = commands_at_once(bench, 32);
  for (std::uint32_t round = 0; round < 3; ++round) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Tag tag{static_cast<std::uint8_t>(i % 32)};
      std::byte* const local = bench.local() + i * 128;
      if (i % 2 == 0) {
        const MainAddress from = bench.main().offset_by(i * 128);
        GRIDIRON_CONTRACT_REQUIRE(bench.platform().get(local, from, 128, tag) == Status::kOk);
      } else {
        for (std::uint32_t byte = 0; byte < 128; ++byte) local[byte] = pattern(byte + round * i);
        const MainAddress to = bench.main().offset_by(kMainBytes / 2 + i * 128);
        GRIDIRON_CONTRACT_REQUIRE(bench.platform().put(local, to, 128, tag) == Status::kOk);
      }
    }
    GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask{0xFFFFFFFFu}) == Status::kOk);
    for (std::uint32_t i = 0; i < count * 128; ++i) {
      const std::uint32_t slot = i / 128, byte = i % 128;
      if (slot % 2 == 0) {
        GRIDIRON_CONTRACT_REQUIRE(bench.local()[i] == pattern(i));
      } else {
        GRIDIRON_CONTRACT_REQUIRE(bench.peek(kMainBytes / 2 + i) == pattern(byte + round * slot));
      }
    }
  }
  return nullptr;
}

template <Bench B>
Failure every_item_is_claimed_once_then_none(B& bench) {
  std::uint32_t seen = 0;
  for (std::uint32_t i = 0; i < kItemCount; ++i) {
    const ItemClaim claim = bench.platform().claim_item();
    GRIDIRON_CONTRACT_REQUIRE(claim.kind == ItemClaim::Kind::kItem);
    GRIDIRON_CONTRACT_REQUIRE(claim.item < kItemCount);
    GRIDIRON_CONTRACT_REQUIRE((seen >> claim.item & 1) == 0);
    seen |= 1u << claim.item;
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    GRIDIRON_CONTRACT_REQUIRE(bench.platform().claim_item().kind == ItemClaim::Kind::kNone);
  }
  return nullptr;
}

// --- Rules ------------------------------------------------------------------------------------------------------

/// A transfer that breaks a rule: answered with `expected` for both directions, and nothing is started.
template <Bench B>
Failure is_refused(B& bench, std::uint32_t local_offset, std::uint32_t main_offset, std::uint32_t bytes, Tag tag,
                   Status expected) {
  fill_main(bench);
  fill_local(bench, kUntouched);
  std::byte* const local = bench.local() + local_offset;
  const MainAddress main = bench.main().offset_by(main_offset);
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().get(local, main, bytes, tag) == expected);
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().put(local, main, bytes, tag) == expected);
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask{0xFFFFFFFFu}) == Status::kOk);
  for (std::uint32_t i = 0; i < kLocalBytes; ++i) GRIDIRON_CONTRACT_REQUIRE(bench.local()[i] == kUntouched);
  for (std::uint32_t i = 0; i < kMainBytes; ++i) GRIDIRON_CONTRACT_REQUIRE(bench.peek(i) == pattern(i));
  return nullptr;
}

template <Bench B>
Failure a_size_of_0_is_refused(B& bench) {
  return is_refused(bench, 0, 0, 0, Tag{0}, Status::kTransferSize);
}

template <Bench B>
Failure a_size_that_is_no_multiple_is_refused(B& bench) {
  const std::uint32_t granule = bench.platform().limits().alignment_bytes;
  return granule <= 1 ? nullptr : is_refused(bench, 0, 0, granule + granule / 2, Tag{0}, Status::kTransferSize);
}

template <Bench B>
Failure a_size_above_the_limit_is_refused(B& bench) {
  const PlatformLimits limits = bench.platform().limits();
  const std::uint32_t granule = limits.alignment_bytes == 0 ? 1 : limits.alignment_bytes;
  return is_refused(bench, 0, 0, limits.max_transfer_bytes + granule, Tag{0}, Status::kTransferSize);
}

template <Bench B>
Failure a_misaligned_end_is_refused(B& bench) {
  const std::uint32_t granule = bench.platform().limits().alignment_bytes;
  if (granule <= 1) return nullptr;
  // Both ends by the same distance, so that they are congruent; then each alone.
  if (Failure failure = is_refused(bench, granule / 2, granule / 2, granule, Tag{0}, Status::kTransferAlignment)) {
    return failure;
  }
  if (Failure failure = is_refused(bench, granule / 2, 0, granule, Tag{0}, Status::kTransferAlignment)) return failure;
  return is_refused(bench, 0, granule / 2, granule, Tag{0}, Status::kTransferAlignment);
}

template <Bench B>
Failure ends_that_are_not_congruent_are_refused(B& bench) {
  const PlatformLimits limits = bench.platform().limits();
  if (limits.congruence_bytes <= limits.alignment_bytes) return nullptr;
  const std::uint32_t offset = limits.congruence_bytes / 2;
  if (Failure failure = is_refused(bench, offset, 0, 64, Tag{0}, Status::kTransferAlignment)) return failure;
  return is_refused(bench, 0, offset, 64, Tag{0}, Status::kTransferAlignment);
}

template <Bench B>
Failure crossing_a_boundary_is_refused(B& bench) {
  const std::uint32_t boundary = bench.platform().limits().boundary_bytes;
  if (boundary == 0 || boundary >= kMainBytes) return nullptr;
  return is_refused(bench, 0, boundary - 32, 64, Tag{0}, Status::kTransferBoundary);
}

template <Bench B>
Failure a_tag_out_of_range_is_refused(B& bench) {
  const std::uint8_t tag_count = static_cast<std::uint8_t>(bench.platform().limits().tag_count);
  if (Failure failure = is_refused(bench, 0, 0, 64, Tag{tag_count}, Status::kTransferTag)) return failure;
  return is_refused(bench, 0, 0, 64, Tag{255}, Status::kTransferTag);
}

template <Bench B>
Failure one_command_more_than_the_queue_is_refused(B& bench) {
  const std::uint32_t depth = bench.platform().limits().queue_depth;
  if (!B::kChecksQueue || depth > 64) return nullptr;
  fill_main(bench);
  for (std::uint32_t i = 0; i < depth; ++i) {
    GRIDIRON_CONTRACT_REQUIRE(
        bench.platform().get(bench.local() + i * 64, bench.main().offset_by(i * 64), 64, Tag{7}) == Status::kOk);
  }
  std::byte* const behind = bench.local() + depth * 64;
  for (std::uint32_t i = 0; i < 64; ++i) behind[i] = kUntouched;
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().get(behind, bench.main().offset_by(depth * 64), 64, Tag{8}) ==
                            Status::kTransferQueueFull);
  GRIDIRON_CONTRACT_REQUIRE(bench.platform().wait(TagMask{0xFFFFFFFFu}) == Status::kOk);
  for (std::uint32_t i = 0; i < depth * 64; ++i) GRIDIRON_CONTRACT_REQUIRE(bench.local()[i] == pattern(i));
  for (std::uint32_t i = 0; i < 64; ++i) GRIDIRON_CONTRACT_REQUIRE(behind[i] == kUntouched);
  return nullptr;
}

template <Bench B>
Failure overlapping_pending_transfers_are_refused(B& bench) {
  if (!B::kChecksOverlap || bench.platform().limits().queue_depth < 2) return nullptr;
  fill_main(bench);
  auto& platform = bench.platform();
  std::byte* const local = bench.local();
  const MainAddress main = bench.main();
  GRIDIRON_CONTRACT_REQUIRE(platform.get(local, main, 128, Tag{0}) == Status::kOk);
  // Two writes to local memory; then a read of bytes being written; then a write of bytes being read.
  GRIDIRON_CONTRACT_REQUIRE(platform.get(local + 96, main.offset_by(4096), 64, Tag{1}) == Status::kTransferOverlap);
  GRIDIRON_CONTRACT_REQUIRE(platform.put(local + 96, main.offset_by(4096), 64, Tag{1}) == Status::kTransferOverlap);
  GRIDIRON_CONTRACT_REQUIRE(platform.put(local + 1024, main.offset_by(96), 64, Tag{1}) == Status::kTransferOverlap);
  // Two reads of the same main memory are fine.
  GRIDIRON_CONTRACT_REQUIRE(platform.get(local + 1024, main, 128, Tag{1}) == Status::kOk);
  GRIDIRON_CONTRACT_REQUIRE(platform.wait(TagMask{3}) == Status::kOk);
  for (std::uint32_t i = 0; i < 128; ++i) GRIDIRON_CONTRACT_REQUIRE(local[1024 + i] == pattern(i));
  return nullptr;
}

#undef GRIDIRON_CONTRACT_REQUIRE

/// Calls run(name, check, is_rule) for every check; `check` takes a bench and returns a Failure.
template <Bench B, class Run>
constexpr void for_each_check(Run&& run) {
  run("limits_allow_the_portable_subset", limits_allow_the_portable_subset<B>, false);
  run("get_brings_the_bytes_and_no_others", get_brings_the_bytes_and_no_others<B>, false);
  run("put_sends_the_bytes_and_no_others", put_sends_the_bytes_and_no_others<B>, false);
  run("what_is_read_in_place_is_main_memory", what_is_read_in_place_is_main_memory<B>, false);
  run("put_sends_what_was_stored_before_it", put_sends_what_was_stored_before_it<B>, false);
  run("a_get_after_a_waited_put_sees_it", a_get_after_a_waited_put_sees_it<B>, false);
  run("transfers_that_share_a_tag_end_together", transfers_that_share_a_tag_end_together<B>, false);
  run("tags_can_be_waited_for_in_any_order", tags_can_be_waited_for_in_any_order<B>, false);
  run("one_wait_takes_many_tags", one_wait_takes_many_tags<B>, false);
  run("waiting_for_nothing_ends_at_once", waiting_for_nothing_ends_at_once<B>, false);
  run("the_whole_queue_can_be_used", the_whole_queue_can_be_used<B>, false);
  run("every_item_is_claimed_once_then_none", every_item_is_claimed_once_then_none<B>, false);
  run("a_size_of_0_is_refused", a_size_of_0_is_refused<B>, true);
  run("a_size_that_is_no_multiple_is_refused", a_size_that_is_no_multiple_is_refused<B>, true);
  run("a_size_above_the_limit_is_refused", a_size_above_the_limit_is_refused<B>, true);
  run("a_misaligned_end_is_refused", a_misaligned_end_is_refused<B>, true);
  run("ends_that_are_not_congruent_are_refused", ends_that_are_not_congruent_are_refused<B>, true);
  run("crossing_a_boundary_is_refused", crossing_a_boundary_is_refused<B>, true);
  run("a_tag_out_of_range_is_refused", a_tag_out_of_range_is_refused<B>, true);
  run("one_command_more_than_the_queue_is_refused", one_command_more_than_the_queue_is_refused<B>, true);
  run("overlapping_pending_transfers_are_refused", overlapping_pending_transfers_are_refused<B>, true);
}

/// How often for_each_check calls run: a report of fewer checks is one of a core that did not run them all.
template <Bench B>
consteval std::uint32_t check_count() {
  std::uint32_t count = 0;
  for_each_check<B>([&](const char*, auto, bool) { ++count; });
  return count;
}

}  // namespace gridiron::contract
