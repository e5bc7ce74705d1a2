// The passes that build a tree, each on one simulated core of a small store, under every order in which five pending
// transfers can complete: the same calls and the same bytes; and a port that drops a wait is found.
// GRIDIRON_ALL_ORDERS=1: fives of every mix, where else it is those of three.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/sim/item_source.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "protocol/order_search.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

/// So small that few triangles make several runs, buckets and pieces.
struct OrderBuildLayout : BuildLayout64K {
  static constexpr std::uint32_t kRunTriangles = 64;
  static constexpr std::uint32_t kCacheLines = 8;
  static constexpr std::uint32_t kChunkTriangles = 4;
  static constexpr std::uint32_t kIndexWindow = 8;
  static constexpr std::uint32_t kSamples = 64;
  static constexpr std::uint32_t kBucketKeys = 64;
  static constexpr std::uint32_t kDigitBits = 4;
  static constexpr std::uint32_t kFewDigitBits = 4;
  static constexpr std::uint32_t kTopSamples = 32;
};

constexpr std::uint32_t kQueueDepth = 5;

/// One pass of a build on one core, again and again.
class OrderBuild {
 public:
  explicit OrderBuild(std::uint32_t pass) : pass_(pass) {
    TestMesh mesh = make_random_soup(150, 1.0f, 7);
    const TestMesh crowd = make_random_soup(1, 0.01f, 3);
    for (int i = 0; i < 40; ++i) mesh.append(crowd);
    BuildInput input;
    input.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
    input.triangle_count = input.record_room = static_cast<std::uint32_t>(mesh.triangles.size());
    input.leaf_triangles = 2;
    input.order = TreeOrder::kByNumber;
    input.node_room = static_cast<std::uint32_t>(most_tree_nodes(input.triangle_count, 2));
    input.is_tree_image = true;
    input.image = MainAddress{kLineBytes};
    input.image_room = kTreeImageHeadBytes + 48ull * input.triangle_count + 128 + sizeof(TreeNode) * input.node_room;
    const auto vertices = memory_.allocate(std::as_bytes(std::span(mesh.vertices)).size() + 16).value();
    const auto triangles = memory_.allocate(std::as_bytes(std::span(mesh.triangles)).size() + 16).value();
    std::ranges::copy(std::as_bytes(std::span(mesh.vertices)), vertices.bytes.begin());
    std::ranges::copy(std::as_bytes(std::span(mesh.triangles)), triangles.bytes.begin());
    // One region for all that is written.
    const std::uint64_t scratch_bytes = build_scratch_bytes<OrderBuildLayout>(input);
    const std::uint64_t image_bytes = round_up<std::uint64_t>(input.image_room, kLineBytes);
    written_ = memory_.allocate(image_bytes + kLineBytes + scratch_bytes).value();
    input.vertices = vertices.address;
    input.triangles = triangles.address;
    input.image = written_.address;
    input.result = written_.address.offset_by(image_bytes);
    input.scratch = input.result.offset_by(kLineBytes);
    if (plan_build<OrderBuildLayout>(input, plan_) != Status::kOk) throw std::runtime_error("no plan");
    before_.assign(written_.bytes.size(), std::byte{0x11});
    for (pass_ = 0; pass_ < pass; ++pass_) {
      const OrderOutcome outcome = run({});
      if (outcome.status != Status::kOk) throw std::runtime_error("pass " + std::to_string(pass_) + " fails");
      before_ = outcome.planes;
    }
  }

  [[nodiscard]] OrderOutcome run(const OrderPlan& plan) {
    std::ranges::copy(before_, written_.bytes.begin());
    const std::span<std::byte> bytes(reinterpret_cast<std::byte*>(store_.get()), sizeof(BuildStore<OrderBuildLayout>));
    std::ranges::fill(bytes, std::byte{0xC3});
    sim::ItemSource items(plan_.item_counts[pass_]);
    sim::SimFrame shared;
    shared.memory = &memory_;
    shared.tiles = &items;
    shared.writable = {{written_.address.value, written_.address.value + written_.bytes.size()}};
    shared.limits.queue_depth = kQueueDepth;
    shared.completion = sim::Completion::kLate;
    sim::SimCore core(shared, 0, bytes);
    OrderCore platform(core, bytes, plan);
    OrderOutcome outcome;
    outcome.status = run_build_pass(platform, *store_, plan_, static_cast<BuildPass>(pass_));
    core.finish(outcome.status == Status::kOk);
    if (!core.violations().empty()) outcome.violation = core.violations().front().detail;
    outcome.planes.assign(written_.bytes.begin(), written_.bytes.end());
    outcome.store.assign(bytes.begin(), bytes.end());
    outcome.calls = std::move(platform.calls);
    outcome.transfers = std::move(platform.transfers);
    outcome.waits = std::move(platform.waits);
    outcome.completions = std::move(platform.completions);
    outcome.most_pending = platform.most_pending;
    return outcome;
  }

 private:
  std::uint32_t pass_;
  sim::SimMemory memory_{std::uint64_t{4} << 20};
  sim::MemoryRegion written_{};
  BuildPlan plan_{};
  std::vector<std::byte> before_;  // what the pass finds in written_
  std::unique_ptr<BuildStore<OrderBuildLayout>> store_ = std::make_unique<BuildStore<OrderBuildLayout>>();
};

class BuildOrders : public testing::TestWithParam<std::uint32_t> {
 protected:
  void SetUp() override {
    ASSERT_EQ(reference_.status, Status::kOk) << reference_.violation;
    ASSERT_EQ(reference_.violation, "");
    ASSERT_LE(reference_.most_pending, kQueueDepth);
  }
  // Runs what is wrong in a process of its own, as it may read and write anywhere.
  bool is_found(const OrderPlan& plan) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      alarm(3);  // a run takes milliseconds
      std::freopen("/dev/null", "w", stderr);
      const OrderOutcome outcome = build_.run(plan);
      _exit(outcome.planes == reference_.planes && outcome.violation.empty() && outcome.status == Status::kOk ? 3 : 0);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
      ADD_FAILURE() << "no process for a wrong run";
      return false;
    }
    return !WIFEXITED(status) || WEXITSTATUS(status) != 3;
  }

  OrderBuild build_{GetParam()};
  const OrderOutcome reference_ = build_.run({});  // everything at its wait
};

// The most that are pending together, up to five: each order in which they complete.
TEST_P(BuildOrders, EveryOrderOfThoseThatArePendingGivesTheSame) {
  std::map<std::string, Window> windows;
  for (const LoggedTransfer& transfer : reference_.transfers) {
    Window window;
    window.members = pending_after(reference_, transfer.start_call);
    if (window.members.size() != reference_.most_pending) continue;
    for (const std::uint32_t number : window.members) {
      window.calls.push_back(reference_.transfers[number - 1].start_call);
      window.calls.push_back(reference_.transfers[number - 1].wait_call);
    }
    std::sort(window.calls.begin(), window.calls.end());
    window.calls.erase(std::unique(window.calls.begin(), window.calls.end()), window.calls.end());
    windows.emplace(purposes_of(reference_, window.members), window);
  }
  ASSERT_FALSE(windows.empty());
  std::size_t mixes = 0;
  for (const auto& found : windows) {
    // Clang 14 captures no structured binding.
    const auto& mix = found.first;
    const auto& window = found.second;
    if (++mixes > 3 && std::getenv("GRIDIRON_ALL_ORDERS") == nullptr) break;
    std::uint64_t same = 0;
    const std::uint64_t runs = run_orders(build_, window, [&](const OrderOutcome& outcome) {
      if (!outcome.is_as(reference_)) {
        ADD_FAILURE() << mix << ", order " << same << ": " << outcome.violation;
        return false;
      }
      ++same;
      return true;
    });
    ASSERT_FALSE(HasFailure());
    EXPECT_EQ(static_cast<double>(runs), count_orders(reference_, window)) << mix;
    std::printf("pass %u, %s: %llu orders\n", GetParam(), mix.c_str(), static_cast<unsigned long long>(runs));
  }
}

// Whatever is pending moves at once, after any one call.
TEST_P(BuildOrders, BytesMayComeAfterAnyCall) {
  for (std::uint32_t call = 0; call < reference_.calls.size(); ++call) {
    if (pending_after(reference_, call).empty()) continue;
    const auto last_first = [call](std::uint32_t now, std::span<const std::uint32_t> open) {
      return now == call && !open.empty() ? open.size() - 1 : open.size();
    };
    const OrderOutcome outcome = build_.run({.schedule = last_first});
    ASSERT_TRUE(outcome.is_as(reference_)) << "call " << call << ": " << outcome.violation;
  }
}

// A wait that is left out is found, unless a later one for the same tags ends what it would have ended.
TEST_P(BuildOrders, EveryForgottenWaitIsFound) {
  std::size_t found = 0, all = 0;
  for (const LoggedTransfer& transfer : reference_.transfers) ASSERT_NE(transfer.wait_call, kNoCall);
  std::vector<std::uint32_t> ends;
  for (const LoggedTransfer& transfer : reference_.transfers) ends.push_back(transfer.wait_call);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const std::uint32_t wait : ends) {
    ++all;
    if (is_found({.dropped_wait = wait})) {
      ++found;
      continue;
    }
    const auto tags = std::ranges::find(reference_.waits, wait, &LoggedWait::call);
    ASSERT_NE(tags, reference_.waits.end());
    EXPECT_TRUE(std::any_of(tags + 1, reference_.waits.end(),
                            [&](const LoggedWait& later) { return (later.tags & tags->tags) == tags->tags; }))
        << "call " << wait << ", the last for its tag";
  }
  EXPECT_GT(found * 2, all);
  std::printf("pass %u: %zu of %zu forgotten waits found\n", GetParam(), found, all);
}

INSTANTIATE_TEST_SUITE_P(Passes, BuildOrders, testing::Range(0u, kBuildPassCount));

}  // namespace
}  // namespace gridiron::test
