// Three small passes over numbers in main memory, as a builder has them: many items, one item, and a number of items
// that is only known when the second pass has ended. What tests of passes share.
// Memory: owns main memory. Threads: one caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/dma/transfers.h>
#include <gridiron/platform/contract.h>
#include <gridiron/sim/passes.h>

#include "support/test_headers.h"

namespace gridiron::sim {

/// Local store of these kernels.
struct NumbersStore {
  static constexpr std::uint32_t kCount = 64;

  WorkCounters work;
  alignas(128) std::uint32_t in[kCount];
  alignas(128) std::uint32_t out[kCount];
  alignas(128) std::uint32_t head[4];
};

/// Claims items and calls act(item) -> Status for each, until there is none or one is no kOk.
template <Platform P, class Act>
Status for_each_item(Transfers<P>& transfers, Act&& act) {
  for (;;) {
    const ItemClaim claim = transfers.claim_item();
    if (claim.kind == ItemClaim::Kind::kAborted) return Status::kAborted;
    if (claim.kind == ItemClaim::Kind::kDeadline) return Status::kDeadline;
    if (claim.kind == ItemClaim::Kind::kNone) return Status::kOk;
    GRIDIRON_TRY(act(claim.item));
  }
}

/// `chunks` chunks of 64 numbers are doubled; one item lists those that 3 divides, and counts them; the listed ones are
/// squared, 64 an item.
class NumberPasses {
 public:
  static constexpr std::uint32_t kChunkBytes = NumbersStore::kCount * 4;

  explicit NumberPasses(std::uint32_t chunks) : chunks_(chunks), memory_(std::uint64_t{1} << 22) {
    const std::uint64_t bytes = std::uint64_t{chunks + 1} * kChunkBytes;
    for (MemoryRegion* const region : {&input_, &doubled_, &listed_, &squared_}) {
      *region = *memory_.allocate(bytes, 4096);
    }
    head_ = *memory_.allocate(128, 4096);
    for (std::uint32_t i = 0; i < chunks * NumbersStore::kCount; ++i) store(input_, i, number(i));
  }

  [[nodiscard]] static std::uint32_t number(std::uint32_t i) { return i * 2654435761u >> 12; }

  /// @param wrap  (pass, core, kernel) -> Status: calls kernel(platform) with the core, or with something around it.
  template <class Wrap>
  [[nodiscard]] std::vector<Pass> passes(Wrap wrap) const {
    const auto of = [&](std::uint32_t pass, auto kernel) {
      return [pass, kernel, wrap](auto& core, std::span<std::byte> data) {
        auto& local = *::new (static_cast<void*>(data.data())) NumbersStore{};
        return wrap(pass, core, [&](auto& platform) { return kernel(platform, local); });
      };
    };
    const NumberPasses& p = *this;
    return {
        {.name = "double",
         .items = {p.chunks_},
         .data_bytes = sizeof(NumbersStore),
         .writable = {range(doubled_)},
         .kernel = of(0, [&p](auto& platform, NumbersStore& local) { return p.double_them(platform, local); })},
        {.name = "list",
         .items = {1},
         .data_bytes = sizeof(NumbersStore),
         .writable = {range(listed_), range(head_)},
         .kernel = of(1, [&p](auto& platform, NumbersStore& local) { return p.list_them(platform, local); })},
        {.name = "square",
         .items = {p.chunks_, head_.address, NumbersStore::kCount},
         .data_bytes = sizeof(NumbersStore),
         .writable = {range(squared_)},
         .kernel = of(2, [&p](auto& platform, NumbersStore& local) { return p.square_them(platform, local); })},
    };
  }
  [[nodiscard]] std::vector<Pass> passes() const {
    return passes([](std::uint32_t, auto& core, auto kernel) { return kernel(core); });
  }

  /// Whether main memory holds what `passes_done` passes leave there, and zeros where later ones write.
  void expect_done(std::uint32_t passes_done, const std::string& what) {
    std::vector<std::uint32_t> doubled, listed, squared;
    for (std::uint32_t i = 0; i < chunks_ * NumbersStore::kCount; ++i) {
      doubled.push_back(2 * number(i));
      if (doubled.back() % 3 == 0) listed.push_back(doubled.back());
    }
    for (const std::uint32_t value : listed) squared.push_back(value * value);
    squared.resize((listed.size() + NumbersStore::kCount - 1) / NumbersStore::kCount * NumbersStore::kCount);
    const auto expect = [&](const MemoryRegion& region, const std::vector<std::uint32_t>& numbers, bool is_done) {
      const std::span<const std::uint32_t> found = numbers_of(region);
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i], is_done && i < numbers.size() ? numbers[i] : 0u) << what << ", number " << i;
      }
    };
    expect(doubled_, doubled, passes_done > 0);
    expect(listed_, listed, passes_done > 1);
    EXPECT_EQ(numbers_of(head_)[0], passes_done > 1 ? listed.size() : 0u) << what;
    expect(squared_, squared, passes_done > 2);
  }

  /// Whether nothing has been put where a pass puts.
  [[nodiscard]] bool is_clear(std::size_t pass) const {
    const MemoryRegion* const regions[] = {&doubled_, &listed_, &squared_};
    const std::span<const std::byte> bytes = regions[pass]->bytes;
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte byte) { return byte == std::byte{0}; });
  }

  void clear_results() {
    for (const MemoryRegion* const region : {&doubled_, &listed_, &squared_, &head_}) {
      std::fill(region->bytes.begin(), region->bytes.end(), std::byte{0});
    }
  }

  /// Items of each pass.
  [[nodiscard]] std::vector<std::uint32_t> items() const {
    std::uint32_t listed = 0;
    for (std::uint32_t i = 0; i < chunks_ * NumbersStore::kCount; ++i) listed += 2 * number(i) % 3 == 0 ? 1u : 0u;
    return {chunks_, 1, (listed + NumbersStore::kCount - 1) / NumbersStore::kCount};
  }

  [[nodiscard]] SimMemory& memory() { return memory_; }
  [[nodiscard]] const MemoryRegion& head() const { return head_; }
  [[nodiscard]] const MemoryRegion& doubled() const { return doubled_; }

  [[nodiscard]] static MainRange range(const MemoryRegion& region) {
    return {region.address.value, region.address.value + region.bytes.size()};
  }

 private:
  template <Platform P>
  Status double_them(P& platform, NumbersStore& local) const {
    Transfers<P> transfers(platform, local.work);
    return for_each_item(transfers, [&](std::uint32_t item) -> Status {
      GRIDIRON_TRY(get_chunk(transfers, local, input_, item));
      for (std::uint32_t i = 0; i < NumbersStore::kCount; ++i) local.out[i] = 2 * local.in[i];
      local.work.add(Work::kRayGenerated, 10 + item);
      return put_chunk(transfers, local, doubled_, item);
    });
  }

  template <Platform P>
  Status list_them(P& platform, NumbersStore& local) const {
    Transfers<P> transfers(platform, local.work);
    return for_each_item(transfers, [&](std::uint32_t) -> Status {
      std::uint32_t count = 0;
      for (std::uint32_t chunk = 0; chunk < chunks_; ++chunk) {
        GRIDIRON_TRY(get_chunk(transfers, local, doubled_, chunk));
        local.work.add(Work::kCullTest, NumbersStore::kCount);
        for (const std::uint32_t value : local.in) {
          if (value % 3 != 0) continue;
          local.out[count % NumbersStore::kCount] = value;
          if (++count % NumbersStore::kCount == 0) {
            GRIDIRON_TRY(put_chunk(transfers, local, listed_, count / NumbersStore::kCount - 1));
          }
        }
      }
      for (std::uint32_t i = count % NumbersStore::kCount; i < NumbersStore::kCount; ++i) local.out[i] = 0;
      GRIDIRON_TRY(put_chunk(transfers, local, listed_, count / NumbersStore::kCount));
      local.head[0] = count;
      GRIDIRON_TRY(transfers.put(local.head, head_.address, sizeof local.head, kFirstMacroTag));
      return transfers.wait(kFirstMacroTag);
    });
  }

  template <Platform P>
  Status square_them(P& platform, NumbersStore& local) const {
    Transfers<P> transfers(platform, local.work);
    return for_each_item(transfers, [&](std::uint32_t item) -> Status {
      GRIDIRON_TRY(get_chunk(transfers, local, listed_, item));
      for (std::uint32_t i = 0; i < NumbersStore::kCount; ++i) local.out[i] = local.in[i] * local.in[i];
      local.work.add(Work::kTriangleSetup, 7);
      return put_chunk(transfers, local, squared_, item);
    });
  }

  template <Platform P>
  static Status get_chunk(Transfers<P>& transfers, NumbersStore& local, const MemoryRegion& from,
                          std::uint32_t chunk) {
    GRIDIRON_TRY(transfers.get(local.in, from.address.offset_by(std::uint64_t{chunk} * kChunkBytes), kChunkBytes,
                               kFirstTriangleTag));
    return transfers.wait(kFirstTriangleTag);
  }
  template <Platform P>
  static Status put_chunk(Transfers<P>& transfers, NumbersStore& local, const MemoryRegion& to, std::uint32_t chunk) {
    GRIDIRON_TRY(transfers.put(local.out, to.address.offset_by(std::uint64_t{chunk} * kChunkBytes), kChunkBytes,
                               kFirstMacroTag));
    return transfers.wait(kFirstMacroTag);
  }

  [[nodiscard]] static std::span<std::uint32_t> numbers_of(const MemoryRegion& region) {
    return {reinterpret_cast<std::uint32_t*>(region.bytes.data()), region.bytes.size() / 4};
  }
  static void store(const MemoryRegion& region, std::uint32_t i, std::uint32_t value) {
    numbers_of(region)[i] = value;
  }

  std::uint32_t chunks_;
  SimMemory memory_;
  MemoryRegion input_, doubled_, listed_, squared_, head_;
};

}  // namespace gridiron::sim
