// Measured ranks. SPDX-License-Identifier: Apache-2.0
#include "measured_ranks.h"

#include <ctime>
#include <fstream>
#include <utility>

#include "base/failure.h"

namespace gridiron::tool {
namespace {

// Finer than std::clock().
double processor_seconds() {
  timespec time{};
  (void)::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

void MeasuredRanks::begin() {
  begin_ = processor_seconds();
}

void MeasuredRanks::end(const char* call, std::uint64_t bytes) {
  const double before = begin_ - end_;
  end_ = processor_seconds();
  records_.push_back({call, bytes, before, end_ - begin_});
}

void MeasuredRanks::tell_first(Bytes message) {
  begin();
  const std::uint64_t bytes = message.size();
  ranks_.tell_first(std::move(message));
  end("tell", bytes);
}

std::optional<RankMessage> MeasuredRanks::poll() {
  begin();
  std::optional<RankMessage> message = ranks_.poll();
  end("poll", message ? message->bytes.size() : 0);
  return message;
}

void MeasuredRanks::tell(std::uint32_t rank, Bytes message) {
  begin();
  const std::uint64_t bytes = message.size();
  ranks_.tell(rank, std::move(message));
  end("tell_rank", bytes);
}

Bytes MeasuredRanks::hear() {
  begin();
  Bytes message = ranks_.hear();
  end("hear", message.size());
  return message;
}

void MeasuredRanks::attend() {
  begin();
  ranks_.attend();
  end("attend", 0);
}

void MeasuredRanks::broadcast(Bytes& bytes) {
  begin();
  ranks_.broadcast(bytes);
  end("broadcast", bytes.size());
}

void MeasuredRanks::share_bytes(std::span<std::byte> bytes, const char* what,
                                const std::function<void(std::uint64_t begin, std::span<std::byte> shared)>& place) {
  begin();
  ranks_.share_bytes(bytes, what, place);
  end("share", bytes.size());
}

void MeasuredRanks::write() {
  begin();
  end("end", 0);
  std::ofstream file(file_ + "." + std::to_string(rank()) + ".csv");
  file.precision(9);
  file << "call,bytes,before_seconds,seconds\n";
  for (const Record& record : records_) {
    file << record.call << ',' << record.bytes << ',' << record.before << ',' << record.inside << '\n';
  }
  if (!file.flush()) input_error(file_, "cannot be written");
}

}  // namespace gridiron::tool
