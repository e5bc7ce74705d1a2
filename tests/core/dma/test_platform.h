// A platform for the kernel's own tests: it moves bytes when they must have moved and no sooner, keeps a list of
// everything asked of it, and says which rule was broken. Main addresses are offsets into its memory.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include "support/test_headers.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// One call of a kernel.
struct Command {
  enum class Kind : std::uint8_t { kGet, kPut, kWait, kClaim };
  Kind kind;
  const std::byte* local = nullptr;
  std::uint64_t address = 0;
  std::uint32_t bytes = 0;
  std::uint32_t tags = 0;  ///< of a wait: its mask; of a transfer: its tag's bit
};

/// When a transfer's bytes move: at the call, not before the wait, or in between, each at any time and in any order;
/// until then a get's destination holds garbage.
enum class Moves : std::uint8_t { kAtOnce, kAtTheWait, kAtAnyTime };

class TestPlatform {
 public:
  /// @param seed  of Moves::kAtAnyTime.
  TestPlatform(std::uint32_t queue_depth, Moves moves, std::uint64_t memory_bytes, std::uint64_t seed = 1)
      : moves_(moves), random_(seed), memory_(memory_bytes + 256) {
    limits_.queue_depth = queue_depth;
  }

  /// Main memory; address 0 is a line's start, and byte 0 is never given out, as 0 means "off" in a frame.
  [[nodiscard]] std::byte* at(std::uint64_t address) {
    const auto start = reinterpret_cast<std::uintptr_t>(memory_.data());
    return memory_.data() + (128 - start % 128) % 128 + address;
  }
  [[nodiscard]] const std::vector<Command>& commands() const { return commands_; }
  [[nodiscard]] std::uint32_t most_pending() const { return most_pending_; }
  [[nodiscard]] std::size_t pending() const { return pending_.size(); }
  /// The first broken rule in words; empty where all were kept.
  [[nodiscard]] const std::string& violation() const { return violation_; }
  void forget_commands() { commands_.clear(); }

  std::vector<ItemClaim> claims;               ///< answers to claim_item, the last one for ever
  std::optional<std::size_t> failing_command;  ///< index of the command that fails
  Status failure = Status::kTransferFailed;

  // The contract.
  [[nodiscard]] PlatformLimits limits() const { return limits_; }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return start(Command::Kind::kGet, static_cast<std::byte*>(local), address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    // The bytes are only read.
    return start(Command::Kind::kPut, const_cast<std::byte*>(static_cast<const std::byte*>(local)), address, bytes,
                 tag);
  }
  Status wait(TagMask tags) {
    const bool fails = fails_now();
    commands_.push_back({Command::Kind::kWait, nullptr, 0, 0, tags.bits});
    move_some();
    std::vector<Pending> rest;
    for (const Pending& transfer : pending_) {
      if ((transfer.command.tags & tags.bits) == 0) {
        rest.push_back(transfer);
      } else if (!transfer.has_moved) {
        move(transfer);
      } else if (transfer.command.kind == Command::Kind::kPut &&
                 std::memcmp(transfer.local, transfer.sent.data(), transfer.sent.size()) != 0) {
        violate("the source of a put changed before its wait");
      }
    }
    pending_ = std::move(rest);
    return fails ? failure : Status::kOk;
  }
  ItemClaim claim_item() {
    commands_.push_back({Command::Kind::kClaim});
    if (claims.empty()) return {};
    const ItemClaim claim = claims.front();
    if (claims.size() > 1) claims.erase(claims.begin());
    return claim;
  }

 private:
  struct Pending {
    Command command;
    std::byte* local;
    std::vector<std::byte> sent;  ///< a put's bytes at the call
    bool has_moved;
  };

  // Of the transfers under way about a quarter arrive with each command.
  void move_some() {
    if (moves_ != Moves::kAtAnyTime) return;
    for (Pending& transfer : pending_) {
      if (transfer.has_moved || random_.below(4) != 0) continue;
      move(transfer);
      transfer.has_moved = true;
    }
  }

  Status start(Command::Kind kind, std::byte* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    const bool fails = fails_now();
    const Command command{kind, local, address.value, bytes, std::uint32_t{1} << tag.index};
    commands_.push_back(command);
    const auto place = reinterpret_cast<std::uintptr_t>(local);
    if (bytes == 0 || bytes % kPortableGranuleBytes != 0) violate("size");
    if (bytes > kPortableMaxTransferBytes) violate("more than 4,096 bytes");
    if (place % kPortableGranuleBytes != 0 || address.value % kPortableGranuleBytes != 0) violate("alignment");
    if ((place - address.value) % kPortableCongruenceBytes != 0) violate("ends not congruent");
    if (address.value / kPortableBoundaryBytes != (address.value + bytes - 1) / kPortableBoundaryBytes) {
      violate("crosses a 4 KB boundary");
    }
    if (address.value + bytes > memory_.size() - 128) violate("beyond main memory");
    if (pending_.size() >= limits_.queue_depth) violate("queue depth");
    for (const Pending& other : pending_) {
      const bool apart = other.local + other.command.bytes <= local || local + bytes <= other.local;
      if (!apart && (kind == Command::Kind::kGet || other.command.kind == Command::Kind::kGet)) violate("overlap");
    }
    if (!violation_.empty()) return Status::kTransferFailed;
    if (fails) return failure;
    move_some();
    Pending transfer{command, local, {}, moves_ == Moves::kAtOnce};
    if (kind == Command::Kind::kPut) transfer.sent.assign(local, local + bytes);
    if (moves_ == Moves::kAtOnce) {
      move(transfer);
    } else if (kind == Command::Kind::kGet) {
      std::memset(local, 0xCD, bytes);
    }
    pending_.push_back(std::move(transfer));
    most_pending_ = pending_.size() > most_pending_ ? static_cast<std::uint32_t>(pending_.size()) : most_pending_;
    return Status::kOk;
  }

  void move(const Pending& transfer) {
    if (transfer.command.kind == Command::Kind::kGet) {
      std::memcpy(transfer.local, at(transfer.command.address), transfer.command.bytes);
      return;
    }
    if (std::memcmp(transfer.local, transfer.sent.data(), transfer.sent.size()) != 0) {
      violate("the source of a put changed before its wait");
    }
    std::memcpy(at(transfer.command.address), transfer.sent.data(), transfer.sent.size());
  }

  void violate(const char* rule) {
    if (violation_.empty()) violation_ = std::string(rule) + ", command " + std::to_string(commands_.size() - 1);
  }

  bool fails_now() { return failing_command && *failing_command == commands_.size(); }

  PlatformLimits limits_;
  Moves moves_;
  TestRandom random_;
  std::vector<std::byte> memory_;
  std::vector<Pending> pending_;
  std::vector<Command> commands_;
  std::uint32_t most_pending_ = 0;
  std::string violation_;
};

static_assert(Platform<TestPlatform>);

}  // namespace gridiron::test
