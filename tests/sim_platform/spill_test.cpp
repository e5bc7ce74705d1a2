// Spill memory: each core has its own slice, a tile gets only what it has put there, traces contain one slice only.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/core_runner.h>

#include <atomic>

#include "program_bench.h"
#include "support/trace_steps.h"

namespace gridiron::sim {
namespace {

constexpr Tag kTag{1};
constexpr std::uint32_t kSliceBytes = 8192;

/// A bench with spill memory for up to eight cores.
class SpillBench : public ProgramBench {
 public:
  SpillBench() : region_(*memory().allocate(8 * kSliceBytes, kSpillAlignment)) {
    options.spill = {region_.address, kSliceBytes - 100};
    shape.tile_count = 12;
  }
  [[nodiscard]] MainAddress spill_address() const { return region_.address; }

  using Act = std::function<Status(SimCore&, std::byte*, std::uint32_t)>;

  /// Every tile does what `act` says and waits.
  ChipResult run_tiles(const Act& act) {
    return run([&](SimCore& core, std::span<std::byte> data) {
      return for_each_tile(core, [&](std::uint32_t tile) -> Status {
        GRIDIRON_TRY(act(core, data.data(), tile));
        return core.wait(TagMask::of(kTag));
      });
    });
  }

 private:
  MemoryRegion region_;
};

/// Puts 64 bytes at an offset of the core's slice, waits, gets them back and looks at them.
Status put_and_get(SimCore& core, std::byte* data, std::uint32_t tile, std::uint64_t offset) {
  for (std::uint32_t i = 0; i < 64; ++i) data[i] = static_cast<std::byte>(tile * 7 + i);
  GRIDIRON_TRY(core.put(data, core.spill().address.offset_by(offset), 64, kTag));
  GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
  GRIDIRON_TRY(core.get(data + 128, core.spill().address.offset_by(offset), 64, kTag));
  GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
  for (std::uint32_t i = 0; i < 64; ++i) {
    if (data[128 + i] != static_cast<std::byte>(tile * 7 + i)) return Status::kBadAccess;
  }
  return Status::kOk;
}

TEST(Spill, EachCoreHasASliceOfWholePages) {
  SpillBench bench;
  bench.options.threads = 3;
  std::vector<SpillRegion> regions(3);
  std::atomic<std::uint32_t> next{0};
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte>) {
    regions[next++] = core.spill();
    return for_each_tile(core, [](std::uint32_t) { return Status::kOk; });
  });
  EXPECT_EQ(result.status, Status::kOk) << words(result);
  std::set<std::uint64_t> begins;
  for (const SpillRegion& region : regions) {
    EXPECT_EQ(region.bytes, kSliceBytes);
    begins.insert(region.address.value - bench.spill_address().value);
  }
  EXPECT_EQ(begins, (std::set<std::uint64_t>{0, kSliceBytes, 2 * kSliceBytes}));
}

TEST(Spill, TracesAreTheSameWhicheverCoreRendersATile) {
  for (const Completion completion : {Completion::kEarly, Completion::kLate, Completion::kRandom}) {
    for (const std::uint32_t threads : {1u, 3u, 8u}) {
      SpillBench bench;
      bench.options.threads = threads;
      bench.options.completion = completion;
      const ChipResult result = bench.run_tiles([](SimCore& core, std::byte* data, std::uint32_t tile) {
        return put_and_get(core, data, tile, 4096 + tile * 64);
      });
      ASSERT_EQ(result.status, Status::kOk) << words(result);
      for (const TileTrace& packed : result.trace.tiles) {
        const test::UnpackedTrace tile(packed);
        ASSERT_EQ(tile.events.size(), 5u);
        for (const std::size_t transfer : {0u, 2u}) {
          EXPECT_EQ(tile.events[transfer].address, bench.spill_address().value + 4096 + tile.tile_id * 64);
        }
      }
    }
  }
}

/// A core other than the first does so whatever tile it has.
TEST(Spill, AnotherCoresSliceIsNotTheCores) {
  for (const bool is_get : {false, true}) {
    SpillBench bench;
    bench.options.threads = 2;
    const ChipResult result = bench.run_tiles([&](SimCore& core, std::byte* data, std::uint32_t) -> Status {
      const std::uint64_t own = core.spill().address.value - bench.spill_address().value;
      const MainAddress other = bench.spill_address().offset_by(kSliceBytes - own);
      return is_get ? core.get(data, other, 64, kTag) : core.put(data, other, 64, kTag);
    });
    EXPECT_EQ(result.status, Status::kTransferMainRange);
    ASSERT_EQ(result.violations.size(), 1u) << words(result);
    EXPECT_EQ(result.failed_tile, 0u);
    EXPECT_NE(result.violations[0].detail.find("own slice"), std::string::npos) << words(result);
  }
}

TEST(Spill, BehindTheSlicesNothingMayBePut) {
  SpillBench bench;
  bench.options.threads = 1;
  const auto put_at = [&](std::uint64_t offset) {
    return bench.run_tiles([&](SimCore& core, std::byte* data, std::uint32_t) {
      return core.put(data, bench.spill_address().offset_by(offset), 64, kTag);
    });
  };
  EXPECT_EQ(put_at(kSliceBytes - 64).status, Status::kOk);
  const ChipResult result = put_at(kSliceBytes);
  EXPECT_EQ(result.status, Status::kTransferMainRange);
  EXPECT_NE(words(result).find("may write"), std::string::npos) << words(result);
}

TEST(Spill, ATileGetsOnlyWhatItHasPut) {
  using Act = SpillBench::Act;
  const auto spill_at = [](SimCore& core, std::uint64_t offset) { return core.spill().address.offset_by(offset); };
  const Act never_put = [&](SimCore& core, std::byte* data, std::uint32_t) {
    return core.get(data, spill_at(core, 256), 64, kTag);
  };
  // The second half of this get has never been put.
  const Act half_put = [&](SimCore& core, std::byte* data, std::uint32_t) -> Status {
    GRIDIRON_TRY(core.put(data, spill_at(core, 256), 64, kTag));
    GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
    return core.get(data, spill_at(core, 256), 128, kTag);
  };
  for (const Act& act : {never_put, half_put}) {
    SpillBench bench;
    const ChipResult result = bench.run_tiles(act);
    EXPECT_EQ(result.status, Status::kTransferMainRange);
    EXPECT_EQ(result.failed_tile, 0u);
    EXPECT_NE(words(result).find("has not put byte"), std::string::npos) << words(result);
  }

  // What the tile before left there.
  SpillBench bench;
  const ChipResult result = bench.run_tiles([&](SimCore& core, std::byte* data, std::uint32_t tile) {
    return tile == 0 ? core.put(data, spill_at(core, 0), 64, kTag) : core.get(data, spill_at(core, 0), 64, kTag);
  });
  EXPECT_EQ(result.status, Status::kTransferMainRange);
  EXPECT_EQ(result.failed_tile, 1u);
  // What the core put before its first tile.
  const ChipResult prologue = bench.run([&](SimCore& core, std::span<std::byte> data) -> Status {
    GRIDIRON_TRY(core.put(data.data(), spill_at(core, 0), 64, kTag));
    GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
    return for_each_tile(core, [&](std::uint32_t) -> Status {
      GRIDIRON_TRY(core.get(data.data(), spill_at(core, 0), 64, kTag));
      return core.wait(TagMask::of(kTag));
    });
  });
  EXPECT_EQ(prologue.status, Status::kTransferMainRange);
  EXPECT_EQ(prologue.failed_tile, 0u);
}

TEST(Spill, IsNoPartOfThePicture) {
  for (const bool is_whole : {true, false}) {
    SpillBench bench;
    bench.shape.is_picture = true;
    bench.shape.tile_count = 8;
    bench.shape.writable[0].end = bench.shape.writable[0].begin + 8 * 64;
    const ChipResult result = bench.run_tiles([&](SimCore& core, std::byte* data, std::uint32_t tile) -> Status {
      GRIDIRON_TRY(put_and_get(core, data, tile, 0));
      return is_whole || tile != 5 ? core.put(data, bench.output(tile * 64), 64, kTag) : Status::kOk;
    });
    EXPECT_EQ(result.status, is_whole ? Status::kOk : Status::kIncompleteFrame) << words(result);
  }
}

TEST(Spill, SizesAndPlacesAreChecked) {
  SpillBench bench;
  bench.options.threads = 2;
  const auto status_of = [&](SpillMemory spill) {
    bench.options.spill = spill;
    return bench.run_tiles([](SimCore&, std::byte*, std::uint32_t) { return Status::kOk; }).status;
  };
  const MainAddress address = bench.spill_address();
  EXPECT_EQ(status_of({address, 1}), Status::kOk);
  EXPECT_EQ(status_of({address, 4 * kSliceBytes}), Status::kOk);
  EXPECT_EQ(status_of({address, 4 * kSliceBytes + 1}), Status::kBadParameter) << "the second slice is not allocated";
  EXPECT_EQ(status_of({address.offset_by(2048), 4096}), Status::kBadParameter);
  EXPECT_EQ(status_of({MainAddress{0}, 4096}), Status::kBadParameter);
  EXPECT_EQ(status_of({bench.output(), 4096}), Status::kBadParameter) << "part of what the frame writes";
  EXPECT_EQ(status_of({MainAddress{~std::uint64_t{0} - 4095}, 4096}), Status::kBadParameter);
  for (const std::uint64_t bytes : {~std::uint64_t{0}, std::uint64_t{1} << 63, std::uint64_t{1} << 52}) {
    EXPECT_EQ(status_of({address, bytes}), Status::kBadParameter);
  }
}

TEST(Spill, OfNoBytesIsNone) {
  for (const MainAddress address : {MainAddress{0}, MainAddress{5}, SpillBench().spill_address()}) {
    SpillBench bench;
    bench.options.spill = {address, 0};
    const ChipResult result = bench.run_tiles([&](SimCore& core, std::byte* data, std::uint32_t) {
      EXPECT_EQ(core.spill().bytes, 0u);
      EXPECT_EQ(core.spill().address, MainAddress{});
      return core.put(data, bench.spill_address(), 64, kTag);
    });
    EXPECT_EQ(result.status, Status::kTransferMainRange);
    EXPECT_NE(words(result).find("may write"), std::string::npos) << words(result);
  }
}

}  // namespace
}  // namespace gridiron::sim
