// Ranks. SPDX-License-Identifier: Apache-2.0
#include "ranks.h"

#include <utility>

#include "failure.h"
#include "patience.h"

namespace gridiron::tool {
namespace {

constexpr char kToItself[] = "one process sends itself a message";

class SingleRank final : public Ranks {
 public:
  [[nodiscard]] std::uint32_t rank() const override { return 0; }
  [[nodiscard]] std::uint32_t count() const override { return 1; }
  void tell_first(Bytes) override { throw Failure(ExitCode::kCheckFailed, kToItself); }
  [[nodiscard]] bool has_told() override { return true; }
  [[nodiscard]] std::optional<RankMessage> poll() override { return std::nullopt; }
  void tell(std::uint32_t, Bytes) override { throw Failure(ExitCode::kCheckFailed, kToItself); }
  [[nodiscard]] Bytes hear() override { throw Failure(ExitCode::kCheckFailed, kToItself); }
  void attend() override {}
  void broadcast(Bytes&) override {}
  void share_bytes(std::span<std::byte>, const char*,
                   const std::function<void(std::uint64_t, std::span<std::byte>)>&) override {}
  [[nodiscard]] std::uint32_t usual_threads(std::uint32_t host_threads) const override { return host_threads; }
};

Ranks* in_use = nullptr;

}  // namespace

RankMessage Ranks::wait_message() {
  Patience patience;
  while (true) {
    if (std::optional<RankMessage> message = poll()) return std::move(*message);
    attend();
    patience.pause();
  }
}

std::vector<Bytes> Ranks::exchange(Bytes own) {
  std::vector<Bytes> all(count());
  Bytes joined;
  if (is_first()) {
    all[0] = std::move(own);
    for (std::uint32_t i = 1; i < count(); ++i) {
      RankMessage message = wait_message();
      all[message.rank] = std::move(message.bytes);
    }
    if (count() == 1) return all;
    ByteWriter writer;
    for (const Bytes& bytes : all) writer.add(bytes);
    joined = writer.take();
    broadcast(joined);
    return all;
  }
  tell_first(std::move(own));
  broadcast(joined);
  ByteReader reader(joined);
  for (Bytes& bytes : all) reader.take(bytes);
  return all;
}

Ranks& ranks() {
  static SingleRank single;
  return in_use != nullptr ? *in_use : single;
}

RanksInUse::RanksInUse(Ranks& used) {
  in_use = &used;
}

RanksInUse::~RanksInUse() {
  in_use = nullptr;
}

void exchange_results(std::size_t count, const std::function<Bytes(std::size_t)>& pack,
                      const std::function<void(std::size_t, const Bytes&)>& unpack) {
  Ranks& all = ranks();
  if (all.count() == 1) return;
  ByteWriter own;
  for (std::uint64_t k = 0; k < all.share_of(count); ++k) own.add(pack(all.piece(k)));
  const std::vector<Bytes> results = all.exchange(own.take());
  for (std::uint32_t rank = 0; rank < all.count(); ++rank) {
    if (rank == all.rank()) continue;
    ByteReader reader(results[rank]);
    for (std::uint64_t k = 0, i = rank; i < count; i = piece_of_rank(++k, rank, all.count())) {
      Bytes bytes;
      reader.take(bytes);
      unpack(i, bytes);
    }
  }
}

}  // namespace gridiron::tool
