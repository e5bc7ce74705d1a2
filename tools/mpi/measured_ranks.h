// Measured ranks: passes calls on to other ranks and records the processor time in them and between them.
// Memory: a record a call. Threads: as the ranks'. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/ranks.h"

namespace gridiron::tool {

/// Of one rank: what it does between messages. Meant for `--threads 1`: times are those of the whole process.
class MeasuredRanks final : public Ranks {
 public:
  /// @param file  is written by write(); ".RANK.csv" follows.
  MeasuredRanks(Ranks& measured, std::string file) : ranks_(measured), file_(std::move(file)) {}

  [[nodiscard]] std::uint32_t rank() const override { return ranks_.rank(); }
  [[nodiscard]] std::uint32_t count() const override { return ranks_.count(); }
  void tell_first(Bytes message) override;
  [[nodiscard]] bool has_told() override { return ranks_.has_told(); }
  [[nodiscard]] std::optional<RankMessage> poll() override;
  void tell(std::uint32_t rank, Bytes message) override;
  [[nodiscard]] Bytes hear() override;
  void attend() override;
  void broadcast(Bytes& bytes) override;
  void share_bytes(std::span<std::byte> bytes, const char* what,
                   const std::function<void(std::uint64_t begin, std::span<std::byte> shared)>& place) override;
  [[nodiscard]] std::uint32_t usual_threads(std::uint32_t host) const override { return ranks_.usual_threads(host); }

  /// Writes the records: a line `call,bytes,before_seconds,seconds` each; the last call is `end`. `before` is the time
  /// since the call before. Errors: Failure (kBadInput).
  void write();

 private:
  struct Record {
    const char* call;
    std::uint64_t bytes;
    double before, inside;
  };
  void begin();
  void end(const char* call, std::uint64_t bytes);

  Ranks& ranks_;
  std::string file_;
  std::vector<Record> records_;
  double begin_ = 0, end_ = 0;
};

}  // namespace gridiron::tool
