// Judge: compares answers with the oracle, by the promises of a profile.
// Memory: borrows. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {

/// Counts what differs and lets the running test fail by it, with the first ray of it in full.
class Judge {
 public:
  /// The parts of an answer besides the triangle.
  enum class Form : std::uint8_t {
    kDistance,  ///< in units of the direction
    kDepth,     ///< times the direction's length
    kTriangle,  ///< nothing
  };

  Judge(const Target& target, Grade grade);

  /// The oracle's answers for the rays that are checked next.
  void set_truth(std::span<const NearestHit> truth) { truth_ = truth; }

  /// @param only  indices of the rays that the answers belong to; empty: all. @param way  in words.
  void check(const Rays& rays, std::span<const Answer> answers, std::span<const std::size_t> only, Form form,
             const std::string& way);

  [[nodiscard]] std::uint64_t checked() const { return checked_; }
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  /// Answers whose triangle is not the oracle's; where only C is promised, no failure.
  [[nodiscard]] std::uint64_t differing() const { return differing_; }
  /// The largest relative error of a distance, among answers whose triangle is the oracle's.
  [[nodiscard]] double largest_error() const { return largest_error_; }

 private:
  // Why an answer breaks the promise; null where it does not.
  [[nodiscard]] const char* fault_of(const Rays& rays, std::size_t ray, const Answer& answer, Form form);
  [[nodiscard]] std::uint32_t true_id(const NearestHit& truth) const;

  const Target& target_;
  Grade grade_;
  bool overflows_;  // products of three coordinates leave the floats, so that those of `fast` say nothing
  std::span<const NearestHit> truth_;
  std::uint64_t checked_ = 0, failures_ = 0, differing_ = 0;
  double largest_error_ = 0.0;
};

}  // namespace gridiron::test::hard
