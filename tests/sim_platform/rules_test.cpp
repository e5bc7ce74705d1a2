// For every rule of the contract, a core that breaks it: the simulator names the rule, the core and the tile.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/core_runner.h>

#include "program_bench.h"

namespace gridiron::sim {
namespace {

constexpr Tag kTag{1}, kOtherTag{2};
constexpr TagMask kBoth{0b110};

/// What a program has at hand: the bench's addresses, its core, its data.
struct At {
  const ProgramBench& bench;
  SimCore& core;
  std::byte* data;

  [[nodiscard]] MainAddress in(std::uint64_t offset = 0) const { return bench.input(offset); }
  [[nodiscard]] MainAddress out(std::uint64_t offset = 0) const { return bench.output(offset); }
  /// Starts a transfer of the bytes that lie `local` bytes from the data's start.
  [[nodiscard]] Status get(std::ptrdiff_t local, MainAddress main, std::uint32_t bytes = 64, Tag tag = kTag) const {
    return core.get(data + local, main, bytes, tag);
  }
  [[nodiscard]] Status put(std::ptrdiff_t local, MainAddress main, std::uint32_t bytes = 64, Tag tag = kTag) const {
    return core.put(data + local, main, bytes, tag);
  }
  /// Waits for transfers that were started one after the other.
  [[nodiscard]] Status wait_for(std::initializer_list<Status> started) const {
    for (const Status status : started) GRIDIRON_TRY(status);
    return core.wait(kBoth);
  }
};
using Program = Status (*)(At at);

/// A program that is wrong inside tile 2, and what the simulator must say.
struct WrongCore {
  const char* name;
  Status rule;
  const char* words;  ///< part of the violation's detail
  Program in_tile;

  friend std::ostream& operator<<(std::ostream& stream, const WrongCore& core) { return stream << core.name; }
};

const WrongCore kWrongCores[] = {
    {"size_0_get", Status::kTransferSize, "size is 0", [](At at) { return at.get(0, at.in(), 0); }},
    {"size_0_put", Status::kTransferSize, "size is 0", [](At at) { return at.put(0, at.out(), 0); }},
    {"size_8", Status::kTransferSize, "multiple of 16", [](At at) { return at.get(0, at.in(), 8); }},
    {"size_72", Status::kTransferSize, "multiple of 16", [](At at) { return at.put(0, at.out(), 72); }},
    {"size_too_large", Status::kTransferSize, "above 16384", [](At at) { return at.get(0, at.in(), 16400); }},
    {"tag_32", Status::kTransferTag, "32 tags", [](At at) { return at.get(0, at.in(), 64, Tag{32}); }},
    {"local_misaligned", Status::kTransferAlignment, "local address", [](At at) { return at.get(8, at.in()); }},
    {"main_misaligned", Status::kTransferAlignment, "main address", [](At at) { return at.put(0, at.out(4)); }},
    {"not_congruent", Status::kTransferAlignment, "congruent modulo 32", [](At at) { return at.get(16, at.in()); }},
    {"crosses_4_kb", Status::kTransferBoundary, "crosses a multiple of 4096",
     [](At at) { return at.get(0, at.in(4096 - 32)); }},
    {"local_behind_data", Status::kTransferLocalRange, "not inside the arena",
     [](At at) { return at.get(ProgramBench::kDataBytes - 32, at.in()); }},
    {"local_before_data", Status::kTransferLocalRange, "arena-0x20", [](At at) { return at.put(-32, at.out()); }},
    {"main_not_allocated", Status::kTransferMainRange, "allocated",
     [](At at) { return at.get(0, at.out(ProgramBench::kPartBytes)); }},
    {"main_address_0", Status::kTransferMainRange, "allocated", [](At at) { return at.get(0, MainAddress{0}); }},
    {"main_address_wraps", Status::kTransferMainRange, "allocated",
     [](At at) { return at.get(0, MainAddress{~std::uint64_t{0} - 127}); }},
    {"put_to_read_only", Status::kTransferMainRange, "may write", [](At at) { return at.put(0, at.in()); }},
    {"queue_overflow", Status::kTransferQueueFull, "16 commands",
     [](At at) -> Status {
       for (std::uint32_t i = 0; i < 17; ++i) GRIDIRON_TRY(at.get(i * 64, at.in(i * 64)));
       return at.core.wait(kBoth);
     }},
    {"get_over_get_local", Status::kTransferOverlap, "local side",
     [](At at) {
       return at.wait_for({at.get(0, at.in()), at.get(32, at.in(1024), 64, kOtherTag)});
     }},
    {"put_from_get_local", Status::kTransferOverlap, "local side",
     [](At at) {
       return at.wait_for({at.get(0, at.in()), at.put(0, at.out(), 16, kOtherTag)});
     }},
    {"get_over_put_local", Status::kTransferOverlap, "local side",
     [](At at) {
       return at.wait_for({at.put(0, at.out()), at.get(32, at.in())});
     }},
    {"put_over_put_main", Status::kTransferOverlap, "main side",
     [](At at) {
       return at.wait_for({at.put(0, at.out()), at.put(1024, at.out(), 64, kOtherTag)});
     }},
    {"get_of_put_main", Status::kTransferOverlap, "main side",
     [](At at) {
       return at.wait_for({at.put(0, at.out()), at.get(1024, at.out(), 64, kOtherTag)});
     }},
    {"put_of_get_main", Status::kTransferOverlap, "main side",
     [](At at) {
       return at.wait_for({at.get(0, at.out()), at.put(1024, at.out(), 64, kOtherTag)});
     }},
    {"source_changed_before_wait", Status::kTransferOverlap, "changed byte 5 of the source",
     [](At at) -> Status {
       GRIDIRON_TRY(at.put(0, at.out()));
       at.data[5] = std::byte{0x77};
       return at.core.wait(kBoth);
     }},
    {"destination_written_before_wait", Status::kTransferOverlap, "byte 6 of the destination",
     [](At at) -> Status {
       GRIDIRON_TRY(at.get(0, at.in()));
       at.data[6] = static_cast<std::byte>(~static_cast<unsigned>(at.data[6]) & 0xFF);
       return at.core.wait(kBoth);
     }},
    {"never_waited_for", Status::kTransferPending, "never waited for", [](At at) { return at.get(0, at.in()); }},
    {"wrote_behind_data", Status::kBadAccess, "byte 32768 from the arena's start",
     [](At at) -> Status {
       at.data[ProgramBench::kDataBytes] = std::byte{1};
       return Status::kOk;
     }},
    {"wrote_before_arena", Status::kBadAccess, "byte -1 from the arena's start",
     [](At at) -> Status {
       at.data[-1] = std::byte{1};
       return Status::kOk;
     }},
};

struct HowToRun {
  Completion completion;
  std::uint32_t threads;
};
constexpr HowToRun kRuns[] = {{Completion::kEarly, 1}, {Completion::kLate, 1},   {Completion::kRandom, 1},
                              {Completion::kEarly, 3}, {Completion::kRandom, 3}, {Completion::kLate, 6}};

/// Renders nothing in five tiles, but does the wrong thing in tile 2.
ChipResult run_wrong(ProgramBench& bench, const WrongCore& wrong, bool is_wrong = true) {
  bench.shape.tile_count = 5;
  return bench.run([&](SimCore& core, std::span<std::byte> data) {
    return for_each_tile(core, [&](std::uint32_t tile) {
      return tile == 2 && is_wrong ? wrong.in_tile({bench, core, data.data()}) : Status::kOk;
    });
  });
}

class Rules : public testing::TestWithParam<WrongCore> {};

TEST_P(Rules, ABrokenRuleIsNamedWithItsTile) {
  const WrongCore& wrong = GetParam();
  for (const HowToRun& how : kRuns) {
    SCOPED_TRACE(testing::Message() << "completion " << static_cast<int>(how.completion) << ", threads "
                                    << how.threads);
    ProgramBench bench;
    bench.options.completion = how.completion;
    bench.options.threads = how.threads;
    bench.options.seed = 7;
    const ChipResult result = run_wrong(bench, wrong);
    EXPECT_EQ(result.status, wrong.rule) << words(result);
    ASSERT_EQ(result.violations.size(), 1u) << words(result);
    const Violation& violation = result.violations[0];
    EXPECT_EQ(violation.rule, wrong.rule);
    EXPECT_EQ(violation.core, result.failed_core);
    EXPECT_EQ(violation.tile_id, wrong.rule == Status::kBadAccess ? kNoTile : 2u);
    EXPECT_EQ(result.failed_tile, violation.tile_id);
    EXPECT_NE(violation.detail.find(wrong.words), std::string::npos) << violation.detail;
  }
}

INSTANTIATE_TEST_SUITE_P(WrongCore, Rules, testing::ValuesIn(kWrongCores),
                         [](const auto& wrong) { return std::string(wrong.param.name); });

TEST(RulesBench, WithoutTheWrongTileNothingIsSaid) {
  ProgramBench bench;
  const ChipResult result = run_wrong(bench, kWrongCores[0], false);
  EXPECT_EQ(result.status, Status::kOk);
  EXPECT_TRUE(result.violations.empty()) << words(result);
}

TEST(RulesBench, OtherLimitsGiveOtherRules) {
  ProgramBench bench;
  bench.options.limits = {.alignment_bytes = 64,
                          .congruence_bytes = 64,
                          .max_transfer_bytes = 1024,
                          .boundary_bytes = 0,
                          .tag_count = 4,
                          .queue_depth = 2};
  const auto status_of = [&](Program program) {
    return bench.run([&](SimCore& core, std::span<std::byte> data) {
                  return program({bench, core, data.data()});
                })
        .status;
  };
  EXPECT_EQ(status_of([](At at) { return at.get(0, at.in(), 32); }), Status::kTransferSize);
  EXPECT_EQ(status_of([](At at) { return at.get(0, at.in(), 1088); }), Status::kTransferSize);
  EXPECT_EQ(status_of([](At at) { return at.get(0, at.in(32)); }), Status::kTransferAlignment);
  EXPECT_EQ(status_of([](At at) { return at.get(0, at.in(), 64, Tag{4}); }), Status::kTransferTag);
  EXPECT_EQ(status_of([](At at) { return at.core.wait(TagMask{0x10}); }), Status::kTransferTag);
  // No boundary here.
  EXPECT_EQ(status_of([](At at) { return at.wait_for({at.get(0, at.in(4096 - 64), 128)}); }), Status::kOk);
  EXPECT_EQ(status_of([](At at) {
              return at.wait_for({at.get(0, at.in()), at.get(64, at.in()), at.get(128, at.in())});
            }),
            Status::kTransferQueueFull);
}

// --- Use before wait, without instrumentation -------------------------------------------------------------------

TEST(InFlight, DestinationsArePoisonedUntilTheWait) {
  for (const Completion completion : {Completion::kLate, Completion::kRandom}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      ProgramBench bench;
      bench.options.completion = completion;
      bench.options.seed = seed;
      const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
        GRIDIRON_TRY(core.get(data.data(), bench.input(), 64, kTag));
        for (std::uint32_t i = 0; i < 64; ++i) {
          EXPECT_EQ(data[i], i % 2 == 0 ? std::byte{0xA5} : std::byte{0xFF}) << "seed " << seed;
        }
        GRIDIRON_TRY(core.wait(kBoth));
        for (std::uint32_t i = 0; i < 64; ++i) EXPECT_EQ(data[i], ProgramBench::input_byte(i)) << "seed " << seed;
        return Status::kOk;
      });
      EXPECT_EQ(result.status, Status::kOk) << words(result);
    }
  }
}

TEST(InFlight, EarlyBytesAreThereAtOnceAndLatePutsReadTheirSourceAtTheWait) {
  ProgramBench bench;
  const auto put_and_look = [&](Completion completion) {
    bench.options.completion = completion;
    std::byte seen{};
    const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
      data[0] = std::byte{9};
      GRIDIRON_TRY(core.put(data.data(), bench.output(), 16, kTag));
      seen = bench.output_bytes()[0];
      return core.wait(kBoth);
    });
    EXPECT_EQ(result.status, Status::kOk);
    EXPECT_EQ(bench.output_bytes()[0], std::byte{9});
    bench.output_bytes()[0] = std::byte{0};
    return seen;
  };
  EXPECT_EQ(put_and_look(Completion::kEarly), std::byte{9});
  EXPECT_EQ(put_and_look(Completion::kLate), std::byte{0});
}

TEST(InFlight, RandomCompletionDependsOnItsSeedAndOnNothingElse) {
  // Order in which four puts reach main memory, seen after each of four more calls.
  const auto observe = [](std::uint64_t seed) {
    ProgramBench bench;
    bench.options.completion = Completion::kRandom;
    bench.options.seed = seed;
    std::string seen;
    const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        data[i * 64] = std::byte{1};
        GRIDIRON_TRY(core.put(&data[i * 64], bench.output(i * 64), 16, kTag));
      }
      for (std::uint32_t call = 0; call < 4; ++call) {
        GRIDIRON_TRY(core.wait(TagMask{}));
        for (std::uint32_t i = 0; i < 4; ++i) seen += bench.output_bytes()[i * 64] == std::byte{1} ? '1' : '0';
      }
      return core.wait(kBoth);
    });
    EXPECT_EQ(result.status, Status::kOk) << words(result);
    return seen;
  };
  std::vector<std::string> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    seen.push_back(observe(seed));
    EXPECT_EQ(seen.back(), observe(seed)) << "seed " << seed;
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_GT(std::unique(seen.begin(), seen.end()) - seen.begin(), 5);
}

// --- Across cores -----------------------------------------------------------------------------------------------

/// Each of `tiles` tiles puts and gets what `act` says.
ChipResult run_tiles(ProgramBench& bench, std::uint32_t threads,
                     const std::function<Status(SimCore&, std::byte*, std::uint32_t)>& act) {
  bench.shape.tile_count = 8;
  bench.options.threads = threads;
  return bench.run([&](SimCore& core, std::span<std::byte> data) {
    return for_each_tile(core, [&](std::uint32_t tile) -> Status {
      GRIDIRON_TRY(act(core, data.data(), tile));
      return core.wait(kBoth);
    });
  });
}

TEST(AcrossTiles, DisjointTilesAreFine) {
  for (const std::uint32_t threads : {1u, 4u}) {
    ProgramBench bench;
    const ChipResult result = run_tiles(bench, threads, [&](SimCore& core, std::byte* data, std::uint32_t tile) {
      GRIDIRON_TRY(core.put(data, bench.output(tile * 256), 256, kTag));
      GRIDIRON_TRY(core.wait(kBoth));
      GRIDIRON_TRY(core.get(data, bench.output(tile * 256), 256, kTag));  // a tile may read its own pixels
      return core.get(data + 1024, bench.input(), 256, kOtherTag);
    });
    EXPECT_EQ(result.status, Status::kOk) << words(result);
  }
}

TEST(AcrossTiles, TwoTilesThatPutToTheSameBytesAreFoundForAnyNumberOfThreads) {
  for (const std::uint32_t threads : {1u, 2u, 4u}) {
    ProgramBench bench;
    const ChipResult result = run_tiles(bench, threads, [&](SimCore& core, std::byte* data, std::uint32_t tile) {
      return core.put(data, bench.output(tile == 6 ? 3 * 256 + 128 : tile * 256), 256, kTag);
    });
    EXPECT_EQ(result.status, Status::kTransferOverlap);
    ASSERT_EQ(result.violations.size(), 2u) << words(result);  // 6 with 3, and 6 with 4
    EXPECT_EQ(result.violations[0].tile_id, 6u) << words(result);
    EXPECT_NE(result.violations[0].detail.find("tile 3 puts"), std::string::npos) << words(result);
    EXPECT_EQ(result.violations[1].tile_id, 4u) << words(result);
    EXPECT_NE(result.violations[1].detail.find("tile 6 puts"), std::string::npos) << words(result);
  }
}

TEST(AcrossTiles, ATileThatGetsWhatAnotherPutsIsFoundForAnyNumberOfThreads) {
  for (const std::uint32_t threads : {1u, 2u, 4u}) {
    ProgramBench bench;
    const ChipResult result = run_tiles(bench, threads, [&](SimCore& core, std::byte* data, std::uint32_t tile) {
      if (tile == 5) return core.get(data, bench.output(2 * 256 + 64), 64, kTag);
      return core.put(data, bench.output(tile * 256), 256, kTag);
    });
    EXPECT_EQ(result.status, Status::kTransferOverlap);
    ASSERT_EQ(result.violations.size(), 1u) << words(result);
    EXPECT_EQ(result.violations[0].tile_id, 5u) << words(result);
    EXPECT_NE(result.violations[0].detail.find("tile 2 puts"), std::string::npos) << words(result);
  }
}

TEST(WholePicture, TilesThatNobodyClaimedOrPutAreTold) {
  for (const std::uint32_t threads : {1u, 2u, 4u}) {
    ProgramBench bench;
    bench.shape.is_picture = true;
    bench.shape.writable[0].end = bench.shape.writable[0].begin + 8 * 256;
    const auto put_parts = [&](std::uint32_t bytes_of_tile_6) {
      return run_tiles(bench, threads, [&](SimCore& core, std::byte* data, std::uint32_t tile) {
        GRIDIRON_TRY(core.put(data, bench.output(tile * 256), 128, kTag));
        GRIDIRON_TRY(core.wait(kBoth));
        const std::uint32_t rest = tile == 6 ? bytes_of_tile_6 : 128;
        return rest == 0 ? Status::kOk : core.put(data, bench.output(tile * 256 + 128), rest, kTag);
      });
    };
    EXPECT_EQ(put_parts(128).status, Status::kOk) << words(put_parts(128));
    for (const std::uint32_t rest : {0u, 112u}) {
      const ChipResult result = put_parts(rest);
      EXPECT_EQ(result.status, Status::kIncompleteFrame);
      ASSERT_EQ(result.violations.size(), 1u) << words(result);
      EXPECT_EQ(result.violations[0].tile_id, 6u);
      EXPECT_NE(result.violations[0].detail.find("of the tile's 256 bytes"), std::string::npos) << words(result);
    }
    // Bytes that are put twice are not counted twice.
    const ChipResult twice = run_tiles(bench, threads, [&](SimCore& core, std::byte* data, std::uint32_t tile) {
      GRIDIRON_TRY(core.put(data, bench.output(tile * 256), 128, kTag));
      GRIDIRON_TRY(core.wait(kBoth));
      return core.put(data, bench.output(tile * 256), 128, kTag);
    });
    EXPECT_EQ(twice.status, Status::kIncompleteFrame) << words(twice);

    bench.shape.tile_count = 8;
    const ChipResult nobody = bench.run([](SimCore&, std::span<std::byte>) { return Status::kOk; });
    EXPECT_EQ(nobody.status, Status::kIncompleteFrame);
    EXPECT_EQ(nobody.failed_tile, 0u);
    EXPECT_NE(words(nobody).find("no core claimed"), std::string::npos) << words(nobody);
  }
}

/// The sweep against every pair compared, on random footprints.
TEST(AcrossTiles, TheSweepFindsWhatComparingAllPairsFinds) {
  std::uint32_t with_clash = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    std::uint64_t state = seed * 0x9E3779B97F4A7C15u;
    const auto draw = [&](std::uint64_t count) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      return (state >> 33) % count;
    };
    std::vector<TileFootprint> tiles(2 + draw(4));
    for (std::uint32_t i = 0; i < tiles.size(); ++i) {
      tiles[i].tile_id = i;
      for (std::uint64_t n = draw(3); n > 0; --n) {
        const std::uint64_t begin = draw(60);
        (draw(2) == 0 ? tiles[i].gets : tiles[i].puts).push_back({begin, begin + 1 + draw(8)});
      }
    }
    bool expected = false;
    for (const TileFootprint& a : tiles) {
      for (const TileFootprint& b : tiles) {
        if (a.tile_id == b.tile_id) continue;
        for (const MainRange& put : a.puts) {
          for (const auto* others : {&b.puts, &b.gets}) {
            for (const MainRange& other : *others) expected |= put.begin < other.end && other.begin < put.end;
          }
        }
      }
    }
    with_clash += expected;
    EXPECT_EQ(!check_across_tiles(tiles).empty(), expected) << "seed " << seed;
  }
  EXPECT_GT(with_clash, 200u);
  EXPECT_LT(with_clash, 1800u);
}

}  // namespace
}  // namespace gridiron::sim
