// Decorator that makes a chosen transfer or claim of any platform fail: refused, failed, timed out, late.
// Memory: values; borrows the platform. Threads: one core per object. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

/// What fails, and when. By default nothing does.
struct FaultPlan {
  /// How the transfer fails.
  enum class Kind : std::uint8_t {
    kRefuse,  ///< get or put returns `status` and starts nothing
    kReport,  ///< no byte moves, the wait for its tag returns `status`
    kDelay,   ///< the transfer starts only when its tag is waited for; no error
  };
  std::uint64_t transfer = 0;  ///< gets and puts are counted together from 1; 0: none fails
  Kind kind = Kind::kReport;   ///< how it goes wrong
  Status status = Status::kTransferFailed;  ///< of kRefuse and kReport

  std::uint64_t claim = 0;  ///< claims are counted from 1; from this one on all are answered claim_answer; 0: never
  ItemClaim::Kind claim_answer = ItemClaim::Kind::kAborted;  ///< kAborted, kDeadline or kNone
};

/// Passes every call on to the platform it wraps, except where the plan makes it fail.
template <Platform P>
class FaultInjection {
 public:
  /// Borrows `inner` for as long as this lives.
  FaultInjection(P& inner, const FaultPlan& plan) : inner_(inner), plan_(plan) {}

  /// The wrapped platform's limits.
  [[nodiscard]] PlatformLimits limits() const { return inner_.limits(); }

  /// As of Platform; counted, and fails if it is the chosen transfer.
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return transfer({local, nullptr, address, bytes, tag});
  }

  /// As of Platform; counted, and fails if it is the chosen transfer.
  Status put(const void* source, MainAddress address, std::uint32_t bytes, Tag tag) {
    return transfer({nullptr, source, address, bytes, tag});
  }

  /// As of Platform; reports the chosen transfer's failure, or starts it late.
  Status wait(TagMask tags) {
    const bool is_due = held_ && (tags.bits & TagMask::of(command_.tag).bits) != 0;
    if (is_due) held_ = false;
    const Status started = is_due && plan_.kind == FaultPlan::Kind::kDelay ? start(command_) : Status::kOk;
    // The others of the mask must have ended even if one of them failed.
    const Status waited = inner_.wait(tags);
    if (started != Status::kOk) return started;
    return is_due && plan_.kind == FaultPlan::Kind::kReport ? plan_.status : waited;
  }

  /// As of Platform, until the plan ends the claims.
  ItemClaim claim_item() {
    ++claims_;
    if (plan_.claim != 0 && claims_ >= plan_.claim) return {plan_.claim_answer, 0};
    return inner_.claim_item();
  }

  /// As of WorkObserver.
  void note_work(const std::uint32_t* counts, std::uint32_t count) requires WorkObserver<P> {
    inner_.note_work(counts, count);
  }

  /// As of StageObserver.
  void note_stage(std::uint8_t stage) requires StageObserver<P> { inner_.note_stage(stage); }

  /// Gets and puts so far, refused ones included.
  [[nodiscard]] std::uint64_t transfers() const { return transfers_; }

 private:
  struct Command {
    void* target = nullptr;        ///< of a get, else null
    const void* source = nullptr;  ///< of a put, else null
    MainAddress address;
    std::uint32_t bytes = 0;
    Tag tag;
  };

  Status start(const Command& command) {
    return command.target != nullptr ? inner_.get(command.target, command.address, command.bytes, command.tag)
                                     : inner_.put(command.source, command.address, command.bytes, command.tag);
  }

  Status transfer(const Command& command) {
    ++transfers_;
    if (transfers_ != plan_.transfer) return start(command);
    if (plan_.kind == FaultPlan::Kind::kRefuse) return plan_.status;
    command_ = command;
    held_ = true;
    return Status::kOk;
  }

  P& inner_;
  FaultPlan plan_;
  Command command_;
  bool held_ = false;
  std::uint64_t transfers_ = 0;
  std::uint64_t claims_ = 0;
};

}  // namespace gridiron
