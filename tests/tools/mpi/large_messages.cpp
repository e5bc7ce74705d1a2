// Two ranks exchange more bytes than an int counts: a broadcast, a message, and memory that a node shares.
// Memory: 6.5 GB. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include "mpi_ranks.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kBytes = (std::size_t{1} << 31) + 12345;

std::byte byte_at(std::size_t i) {
  return static_cast<std::byte>((i * 0x9E3779B97F4A7C15u) >> 56);
}

Bytes make_bytes() {
  Bytes bytes(kBytes);
  for (std::size_t i = 0; i < kBytes; ++i) bytes[i] = byte_at(i);
  return bytes;
}

void require_same(std::span<const std::byte> bytes, std::size_t begin, const char* what) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == byte_at(begin + i)) continue;
    throw Failure(ExitCode::kCheckFailed, std::string(what) + ": byte " + std::to_string(begin + i) + " is wrong");
  }
}

void require_size(std::size_t size, const char* what) {
  if (size != kBytes) throw Failure(ExitCode::kCheckFailed, std::string(what) + ": " + std::to_string(size) + " bytes");
}

void exchange(MpiRanks& ranks) {
  Bytes bytes = ranks.is_first() ? make_bytes() : Bytes();
  ranks.broadcast(bytes);
  require_size(bytes.size(), "broadcast");
  require_same(bytes, 0, "broadcast");

  if (ranks.is_first()) {
    bytes = {};
    RankMessage message = ranks.wait_message();
    require_size(message.bytes.size(), "message");
    require_same(message.bytes, 0, "message");
    bytes = std::move(message.bytes);
  } else {
    ranks.tell_first(std::move(bytes));
    while (!ranks.has_told()) ranks.attend();
    bytes = Bytes(kBytes);
  }

  std::size_t shared_bytes = 0;
  ranks.share_bytes(bytes, "a message", [&shared_bytes](std::uint64_t begin, std::span<std::byte> shared) {
    require_same(shared, static_cast<std::size_t>(begin), "shared memory");
    shared_bytes += shared.size();
  });
  require_size(shared_bytes, "shared memory");
  ranks.finish();
}

}  // namespace
}  // namespace gridiron::tool

int main() {
  using namespace gridiron::tool;
  try {
    MpiRanks ranks;
    const RanksInUse in_use(ranks);
    exchange(ranks);
    if (ranks.is_first()) std::puts("exchanged");
    return 0;
  } catch (const Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    MpiRanks::abort(static_cast<int>(failure.code()));
  }
}
