// The platform contract: what a chip must offer so that core can run on one of its cores.
// Memory: a platform is an object the caller places; core borrows it by reference. Threads: one core per object.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/status.h>

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace gridiron {

/// A byte address in main memory. Opaque to core: it may be offset and its low bits compared, never dereferenced.
struct MainAddress {
  std::uint64_t value = 0;  ///< bytes from address 0 on

  /// Same address.
  friend constexpr bool operator==(MainAddress, MainAddress) = default;
  /// @returns the address `bytes` further on.
  [[nodiscard]] constexpr MainAddress offset_by(std::uint64_t bytes) const { return {value + bytes}; }
};

/// Names a group of transfers that are waited for together. 0 <= index < PlatformLimits::tag_count.
struct Tag {
  std::uint8_t index = 0;  ///< bit of a TagMask
};

/// A set of tags: bit i stands for Tag{i}.
struct TagMask {
  std::uint32_t bits = 0;  ///< bit i: Tag{i}

  /// @returns the set of one tag.
  [[nodiscard]] static constexpr TagMask of(Tag tag) { return {std::uint32_t{1} << tag.index}; }
  /// The tags of either.
  friend constexpr TagMask operator|(TagMask a, TagMask b) { return {a.bits | b.bits}; }
};

/// Limits of a platform's transfers. Core keeps to the portable subset (see kPortable...) on every platform, and to
/// queue_depth; the platform checks the other limits.
struct PlatformLimits {
  std::uint32_t alignment_bytes = 16;      ///< both ends, and the size, are multiples of this
  std::uint32_t congruence_bytes = 32;     ///< both ends are congruent modulo this
  std::uint32_t max_transfer_bytes = 16384;///< largest single transfer
  std::uint32_t boundary_bytes = 4096;     ///< the main-memory side may not cross a multiple of this; 0: it may
  std::uint32_t tag_count = 32;            ///< 1..32
  std::uint32_t queue_depth = 16;          ///< commands that may be pending at once; 1 is legal
};

/// The transfers that core starts, the same on every target, so that counters agree on all boards: at most 4,096 bytes
/// and a multiple of 16, both ends congruent modulo 32, the main-memory side crossing no multiple of 4,096.
inline constexpr std::uint32_t kPortableGranuleBytes = 16;
inline constexpr std::uint32_t kPortableCongruenceBytes = 32;     ///< both ends are congruent modulo this
inline constexpr std::uint32_t kPortableMaxTransferBytes = 4096;  ///< largest transfer
inline constexpr std::uint32_t kPortableBoundaryBytes = 4096;     ///< no transfer crosses a multiple in main memory

/// Answer of claim_item().
struct ItemClaim {
  /// What the core has to do.
  enum class Kind : std::uint8_t {
    kItem,      ///< work on `item`
    kNone,      ///< no item is left
    kAborted,   ///< the frame was asked to stop
    kDeadline,  ///< the frame's deadline has passed
  };
  Kind kind = Kind::kNone;  ///< an item, or why there is none
  std::uint32_t item = 0;   ///< below the pass's number of items; meaningful for kItem only
};

/// One core of a chip, as seen by the code that runs on it.
///
/// get   starts a copy of `bytes` from main memory to local memory. The destination is undefined until the wait.
/// put   starts a copy of `bytes` from local memory to main memory. The bytes stored before the call are sent; the
///       source must not change until the wait.
/// wait  blocks until every transfer of the tags in the mask has ended; afterwards loads see the data. A tag without
///       pending transfers is legal and ends at once. Returns kTransferFailed / kTransferTimedOut if one of them did
///       not succeed; all transfers of the mask have ended even then.
/// claim_item   next item of the pass, or why there is none. Each item is handed out exactly once per pass.
///
/// A frame is a list of passes. A pass is one kernel and a number of items that cores claim; it begins when all items
/// of the pass before it are done and their puts have ended, which the platform sees to. Rendering is one pass whose
/// items are the tiles of the picture, row-major, 0 = top left.
///
/// Rules: a size of 0 is an error (kTransferSize); a transfer that a limit forbids is an error and starts nothing;
/// several transfers may share a tag; there is no order between transfers but through wait; two pending transfers
/// that overlap, at least one writing, are an error in the program.
template <class P>
concept Platform = requires(P& platform, const P& constant, void* local, const void* source, MainAddress address,
                            std::uint32_t bytes, Tag tag, TagMask tags) {
  { constant.limits() } -> std::same_as<PlatformLimits>;
  { platform.get(local, address, bytes, tag) } -> std::same_as<Status>;
  { platform.put(source, address, bytes, tag) } -> std::same_as<Status>;
  { platform.wait(tags) } -> std::same_as<Status>;
  { platform.claim_item() } -> std::same_as<ItemClaim>;
};

/// A platform that also receives the amount of work between its calls (the simulator's clock). Core calls it before
/// every get, put, wait and claim_item; `counts` has `count` entries, owned by core, which only grow within a pass.
/// Optional: a board leaves it out and pays nothing.
template <class P>
concept WorkObserver = requires(P& platform, const std::uint32_t* counts, std::uint32_t count) {
  { platform.note_work(counts, count) } -> std::same_as<void>;
};

/// A platform that also receives the stage of a core. Core calls it when the stage changes, within an item; every item
/// begins and ends with stage 0. `stage` is a Stage (base/stages.h) as a number. Optional, as above.
template <class P>
concept StageObserver = requires(P& platform, std::uint8_t stage) {
  { platform.note_stage(stage) } -> std::same_as<void>;
};

/// A platform that also reads main memory where it lies: a host that simulates no local memory. Core then leaves out
/// copies of what it reads and never changes. Null where it does not after all. Optional, as above.
template <class P>
concept InPlaceReader = requires(const P& platform, MainAddress address) {
  { platform.in_place(address) } -> std::same_as<const std::byte*>;
};

}  // namespace gridiron
