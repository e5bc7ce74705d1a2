// Runs the contract's checks against every platform of the tree, and those with a queue at depths 1, 2 and 16.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/platform/fault_injection.h>
#include <gridiron/sim/plain_core.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/sim/sim_memory.h>

#include "contract_checks.h"
#include "host_board.h"
#include "template_port.h"

namespace gridiron::contract {
namespace {

/// Main memory, an arena and tiles, shared by all benches.
class HostBench {
 public:
  explicit HostBench(std::uint32_t queue_depth) : memory_(kMainBytes + 8192), tiles_(kItemCount) {
    region_ = *memory_.allocate(kMainBytes, 4096);
    limits_.queue_depth = queue_depth;
  }
  std::byte* local() { return arena_->bytes; }
  MainAddress main() { return region_.address; }
  void poke(std::uint32_t offset, std::byte value) { region_.bytes[offset] = value; }
  std::byte peek(std::uint32_t offset) { return region_.bytes[offset]; }

 protected:
  struct alignas(128) Arena {
    std::byte bytes[kLocalBytes] = {};
  };
  sim::SimMemory memory_;
  sim::MemoryRegion region_;
  std::unique_ptr<Arena> arena_ = std::make_unique<Arena>();
  sim::ItemSource tiles_;
  PlatformLimits limits_;
};

template <sim::Completion kCompletion, std::uint32_t kDepth>
class SimBench : public HostBench {
 public:
  using PlatformType = sim::SimCore;
  static constexpr bool kChecksRules = true, kChecksQueue = true, kChecksOverlap = true;

  SimBench() : HostBench(kDepth) {
    frame_.memory = &memory_;
    frame_.tiles = &tiles_;
    frame_.writable = {{region_.address.value, region_.address.value + kMainBytes}};
    frame_.limits = limits_;
    frame_.completion = kCompletion;
    frame_.seed = 20;
    core_ = std::make_unique<sim::SimCore>(frame_, 0, std::span(arena_->bytes));
  }
  sim::SimCore& platform() { return *core_; }

 private:
  sim::SimFrame frame_;
  std::unique_ptr<sim::SimCore> core_;
};

template <std::uint32_t kDepth>
class PlainBench : public HostBench {
 public:
  using PlatformType = sim::PlainCore;
  static constexpr bool kChecksRules = false, kChecksQueue = false, kChecksOverlap = false;

  PlainBench() : HostBench(kDepth), core_(memory_.base(), limits_, tiles_) {}
  sim::PlainCore& platform() { return core_; }

 private:
  sim::PlainCore core_;
};

template <std::uint32_t kDepth, std::uint32_t kPolls>
class TemplateBench : public HostBench {
 public:
  using PlatformType = port::TemplatePort<HostBoard, kDepth>;
  static constexpr bool kChecksRules = true, kChecksQueue = true, kChecksOverlap = false;

  TemplateBench() : HostBench(kDepth), board_(memory_, std::span(arena_->bytes), kItemCount), port_(board_) {
    board_.polls_per_command = kPolls;
  }
  ~TemplateBench() { EXPECT_EQ(board_.starts_while_busy, 0u); }
  TemplateBench(const TemplateBench&) = delete;
  TemplateBench& operator=(const TemplateBench&) = delete;
  PlatformType& platform() { return port_; }

 private:
  HostBoard board_;
  PlatformType port_;
};

/// The decorator around another bench's platform. With kDelayed every check has its second transfer started late.
template <class Inner, std::uint64_t kDelayed = 0>
class DecoratedBench {
 public:
  using PlatformType = FaultInjection<typename Inner::PlatformType>;
  static constexpr bool kChecksRules = Inner::kChecksRules && kDelayed == 0, kChecksQueue = Inner::kChecksQueue,
                        kChecksOverlap = Inner::kChecksOverlap;

  DecoratedBench() : platform_(inner_.platform(), FaultPlan{.transfer = kDelayed, .kind = FaultPlan::Kind::kDelay}) {}
  PlatformType& platform() { return platform_; }
  std::byte* local() { return inner_.local(); }
  MainAddress main() { return inner_.main(); }
  void poke(std::uint32_t offset, std::byte value) { inner_.poke(offset, value); }
  std::byte peek(std::uint32_t offset) { return inner_.peek(offset); }

 private:
  Inner inner_;
  PlatformType platform_;
};

template <class B>
class Contract : public testing::Test {};

using sim::Completion;
using Benches =
    testing::Types<SimBench<Completion::kEarly, 1>, SimBench<Completion::kEarly, 2>, SimBench<Completion::kEarly, 16>,
                   SimBench<Completion::kLate, 1>, SimBench<Completion::kLate, 2>, SimBench<Completion::kLate, 16>,
                   SimBench<Completion::kRandom, 1>, SimBench<Completion::kRandom, 2>,
                   SimBench<Completion::kRandom, 16>, PlainBench<1>, PlainBench<2>, PlainBench<16>, TemplateBench<1, 0>,
                   TemplateBench<2, 1>, TemplateBench<16, 2>, TemplateBench<16, 0>,
                   DecoratedBench<SimBench<Completion::kLate, 1>>, DecoratedBench<SimBench<Completion::kEarly, 16>>,
                   DecoratedBench<SimBench<Completion::kEarly, 16>, 2>, DecoratedBench<PlainBench<16>>,
                   DecoratedBench<TemplateBench<2, 1>>>;

class BenchNames {
 public:
  template <class B>
  static std::string GetName(int index) {
    return std::to_string(index);
  }
};
TYPED_TEST_SUITE(Contract, Benches, BenchNames);
static_assert(InPlaceReader<sim::PlainCore> && !InPlaceReader<sim::SimCore>);

TYPED_TEST(Contract, Holds) {
  static_assert(Bench<TypeParam>);
  std::uint32_t run_count = 0;
  for_each_check<TypeParam>([&](const char* name, Failure (*check)(TypeParam&), bool is_rule) {
    if (is_rule && !TypeParam::kChecksRules) return;
    ++run_count;
    TypeParam bench;
    const Failure failure = check(bench);
    EXPECT_EQ(failure, nullptr) << name << ": " << failure;
  });
  EXPECT_GE(run_count, 12u);
}

/// Lets its core transfer the second half of main memory alone.
class BoundedHostBoard : public HostBoard {
 public:
  BoundedHostBoard(sim::SimMemory& memory, std::span<std::byte> arena, std::uint64_t first, std::uint64_t byte_count)
      : HostBoard(memory, arena, kItemCount), first_(first), byte_count_(byte_count) {}

  [[nodiscard]] bool reaches(MainAddress address, std::uint32_t bytes) const {
    const std::uint64_t offset = address.value - first_;
    return offset <= byte_count_ && bytes <= byte_count_ - offset;
  }

 private:
  std::uint64_t first_, byte_count_;
};
static_assert(port::BoundedBoard<BoundedHostBoard> && !port::BoundedBoard<HostBoard>);

TEST(TemplatePort, StartsNothingThatABoundedBoardDoesNotReach) {
  sim::SimMemory memory(std::uint64_t{1} << 16);
  const auto region = memory.allocate(8192, 4096);
  ASSERT_TRUE(region);
  alignas(128) std::byte arena[1024];
  const std::uint64_t first = region->address.value + 4096;
  BoundedHostBoard board(memory, arena, first, 4096);
  port::TemplatePort<BoundedHostBoard> port(board);
  for (const std::uint64_t place : {first - 64, first + 4096, std::uint64_t{0}, ~std::uint64_t{0} - 127}) {
    EXPECT_EQ(port.get(arena, MainAddress{place}, 64, Tag{0}), Status::kTransferMainRange) << place;
    EXPECT_EQ(port.put(arena, MainAddress{place}, 64, Tag{0}), Status::kTransferMainRange) << place;
  }
  EXPECT_EQ(board.starts, 0u);
  for (const std::uint64_t place : {first, first + 4096 - 64}) {
    EXPECT_EQ(port.put(arena, MainAddress{place}, 64, Tag{0}), Status::kOk) << place;
  }
  EXPECT_EQ(port.wait(TagMask::of(Tag{0})), Status::kOk);
  EXPECT_EQ(board.starts, 2u);
}

}  // namespace
}  // namespace gridiron::contract
