// Whole tiles by the kernel on a simulated core, under every order in which up to five pending transfers can complete:
// the same calls, the same picture and work; and a port that drops a wait is found, whichever it drops.
// GRIDIRON_ALL_ORDERS=1: up to eight fives of every mix, where else it is the first of some.
// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>
#include <unistd.h>

#include "protocol/order_frame.h"
#include "protocol/order_scenes.h"
#include "protocol/order_search.h"

namespace gridiron::test {
namespace {

bool runs_all() { return std::getenv("GRIDIRON_ALL_ORDERS") != nullptr; }

const std::vector<OrderCase>& cases() {
  static const std::vector<OrderCase> kCases = order_cases();
  return kCases;
}

class CompletionOrders : public testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    ASSERT_EQ(reference_.status, Status::kOk) << reference_.violation;
    ASSERT_EQ(reference_.violation, "");
  }
  // Numbers of those of `numbers` whose bits are set.
  static std::vector<std::uint32_t> chosen(const std::vector<std::uint32_t>& numbers, std::uint32_t set) {
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if ((set >> i & 1u) != 0) some.push_back(numbers[i]);
    }
    return some;
  }

  // Runs what is wrong in a process of its own, as it may read and write anywhere.
  bool is_found(const OrderPlan& plan) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      alarm(20);
      std::freopen("/dev/null", "w", stderr);
      _exit(frame_.run(plan).is_as(reference_) ? 3 : 0);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
      ADD_FAILURE() << "no process for a wrong run";
      return false;
    }
    return !WIFEXITED(status) || WEXITSTATUS(status) != 3;
  }

  // A call after which the bytes of a get are used, and not before: a wait for its tag, so that bytes that come then
  // are in time and bytes that come with the next call are not. @param after  the wait is later than this call.
  // @returns kNoCall: none is shown to be one.
  std::uint32_t used_after(std::uint32_t number, std::uint32_t after) {
    const LoggedTransfer& transfer = reference_.transfers[number - 1];
    if (transfer.is_put) return kNoCall;
    for (const LoggedWait& wait : reference_.waits) {
      if (wait.call <= after || wait.call < transfer.wait_call || (wait.tags >> transfer.tag & 1u) == 0) continue;
      if (is_found({.held_transfer = number, .held_until = wait.call})) return kNoCall;  // used before
      if (is_found({.held_transfer = number, .held_until = wait.call + 1})) return wait.call;
    }
    return kNoCall;
  }
  // Whether no byte of a get is ever used: they may come as late as with the last call.
  bool is_never_used(std::uint32_t number) {
    const auto last_call = static_cast<std::uint32_t>(reference_.calls.size() - 1);
    return !reference_.transfers[number - 1].is_put && !is_found({.held_transfer = number, .held_until = last_call});
  }

  // The tag of the buffer that is fetched next, of the same kind; the transfer's own: there is no other.
  std::uint8_t next_tag(const LoggedTransfer& transfer) const {
    const OrderSettings& settings = case_.settings;
    std::uint32_t first = kFirstOutputTag, depth = settings.output_depth;
    if (transfer.purpose == Purpose::kBlock) first = kFirstMacroTag, depth = settings.macro_depth;
    if (transfer.purpose == Purpose::kRun) first = kFirstTriangleTag, depth = settings.triangle_depth;
    if (transfer.purpose == Purpose::kRecord) first = kFirstTriangleTag, depth = settings.fetch_depth;
    const bool is_in_cache = transfer.purpose == Purpose::kBlock || transfer.purpose == Purpose::kRun;
    const bool goes_through_tree = case_.scene.has_effects() || settings.engine == EngineId::kTree;
    if (!goes_through_tree || !is_in_cache) {
      return static_cast<std::uint8_t>(first + (transfer.tag - first + 1) % depth);
    }
    // Nodes and leaves lie where there is room, so their tags are in no order.
    const auto place = static_cast<std::size_t>(&transfer - reference_.transfers.data());
    for (std::size_t i = 1; i < reference_.transfers.size(); ++i) {
      const LoggedTransfer& other = reference_.transfers[(place + i) % reference_.transfers.size()];
      if (other.purpose == transfer.purpose && other.tag != transfer.tag) return other.tag;
    }
    return transfer.tag;
  }

  const OrderCase& case_ = cases()[GetParam()];
  OrderFrame frame_{case_.scene, case_.settings};
  const OrderOutcome reference_ = frame_.run({});  // everything at its wait
};

// Moves `first` after a call and `second` after the next one.
Schedule two_steps(std::uint32_t at, const std::vector<std::uint32_t>& first,
                   const std::vector<std::uint32_t>& second) {
  return [at, &first, &second](std::uint32_t call, std::span<const std::uint32_t> open) {
    if (call != at && call != at + 1) return open.size();
    const auto& wanted = call == at ? first : second;
    const auto next = std::find_first_of(open.begin(), open.end(), wanted.begin(), wanted.end());
    return static_cast<std::size_t>(next - open.begin());
  };
}

TEST_P(CompletionOrders, FiveArePendingAndNeverMore) {
  EXPECT_EQ(reference_.most_pending, 5u);
  const auto fives = find_fives(reference_);
  for (const std::string& mix : case_.mixes) EXPECT_TRUE(fives.contains(mix)) << mix;
  if (case_.settings.queue_depth == 5) {  // then it is the queue that has no room for more
    OrderSettings longer = case_.settings;
    longer.queue_depth = 16;
    EXPECT_GT(OrderFrame(case_.scene, longer).run({}).most_pending, 5u);
  }
  std::printf("%s: %zu calls, %zu transfers, %.3g orders\n", case_.name.c_str(), reference_.calls.size(),
              reference_.transfers.size(), count_orders(reference_, whole_frame(reference_)));
}

// Five that are pending together: each order in which they complete, between all calls that start one or wait for one.
TEST_P(CompletionOrders, EveryOrderOfFiveGivesTheSame) {
  const auto fives = find_fives(reference_);
  for (const auto& five : fives) {
    const std::string& mix = five.first;
    const std::vector<Window>& windows = five.second;
    const bool is_wanted = std::find(case_.mixes.begin(), case_.mixes.end(), mix) != case_.mixes.end();
    if (!runs_all() && !is_wanted) continue;
    std::uint64_t all_runs = 0;
    // Late fives of a mix differ from early ones in what lies in the buffers only.
    const std::size_t count = std::min(windows.size(), std::size_t{runs_all() ? 8u : 1u});
    for (const Window& window : std::span(windows).first(count)) {
      const std::uint32_t fifth_start = reference_.transfers[window.members.back() - 1].start_call;
      std::set<std::vector<std::uint32_t>> orders, orders_at_five;
      std::uint64_t same = 0;
      const std::uint64_t runs = run_orders(frame_, window, [&](const OrderOutcome& outcome) {
        if (!outcome.is_as(reference_)) {
          ADD_FAILURE() << mix << ", order " << same << ": " << outcome.violation;
          return false;
        }
        ++same;
        std::vector<std::uint32_t> order;
        bool is_at_five = true;
        for (const Completion& completion : outcome.completions) {
          if (!window.has(completion.number)) continue;
          order.push_back(completion.number);
          is_at_five = is_at_five && completion.call == fifth_start;
        }
        orders.insert(order);
        if (is_at_five) orders_at_five.insert(order);
        return true;
      });
      ASSERT_FALSE(HasFailure());
      EXPECT_EQ(static_cast<double>(runs), count_orders(reference_, window)) << mix;
      EXPECT_EQ(orders.size(), 120u) << mix;
      EXPECT_EQ(orders_at_five.size(), 120u) << mix;
      all_runs += runs;
    }
    std::printf("%s, %s: %llu orders\n", case_.name.c_str(), mix.c_str(), static_cast<unsigned long long>(all_runs));
  }
}

// Every step that any order of the frame is made of: whatever has moved by a call, whatever moves after the next one.
TEST_P(CompletionOrders, EveryStepFromEveryCallGivesTheSame) {
  std::uint64_t steps = 0;
  for (std::uint32_t call = 0; call + 1 < reference_.calls.size(); ++call) {
    const std::vector<std::uint32_t> open = pending_after(reference_, call);
    const std::vector<std::uint32_t> open_then = pending_after(reference_, call + 1);
    if (open.empty() && open_then.empty()) continue;
    for (std::uint32_t set = 0; set < 1u << open.size(); ++set) {
      const std::vector<std::uint32_t> first = chosen(open, set);
      for (std::uint32_t then = 0; then < 1u << open_then.size(); ++then) {
        const std::vector<std::uint32_t> second = chosen(open_then, then);
        if (std::find_first_of(second.begin(), second.end(), first.begin(), first.end()) != second.end()) continue;
        ++steps;
        const OrderOutcome outcome = frame_.run({.schedule = two_steps(call, first, second)});
        ASSERT_TRUE(outcome.is_as(reference_)) << "call " << call << ", sets " << set << " and " << then << ": "
                                               << outcome.violation;
      }
    }
  }
  EXPECT_GE(steps, 243u);  // those from one call with five pending to the next
  std::printf("%s: %llu steps\n", case_.name.c_str(), static_cast<unsigned long long>(steps));
}

// The store's bytes at every call, but where gets are pending: whatever has moved by a call; in short all or nothing.
TEST_P(CompletionOrders, TheStoreIsTheSameAtEveryCall) {
  const OrderOutcome reference = frame_.run({.reads_store = true});
  EXPECT_NE(reference.calls, reference_.calls);
  for (std::uint32_t call = 0; call < reference.calls.size(); ++call) {
    const std::vector<std::uint32_t> open = pending_after(reference, call), none;
    const std::uint32_t all = (1u << open.size()) - 1u;
    for (std::uint32_t set = runs_all() ? 1 : all; set <= all && set != 0; ++set) {
      const std::vector<std::uint32_t> moving = chosen(open, set);
      const OrderOutcome outcome = frame_.run({.schedule = two_steps(call, moving, none), .reads_store = true});
      ASSERT_TRUE(outcome.is_as(reference)) << "call " << call << ", set " << set << ": " << outcome.violation;
    }
  }
}

// A port that forgets a wait. What was waited for ends at the next wait for its tag, or never; of set-up and tiles the
// next one can be soon enough to do no harm. Slots of nodes and leaves share tags, so a wait for one of them can also
// end another's transfer, long before that one's own wait: then what it ends is used after its own wait alone.
TEST_P(CompletionOrders, EveryForgottenWaitIsFound) {
  std::map<std::uint32_t, Purpose> waits;
  for (const LoggedTransfer& transfer : reference_.transfers) waits.emplace(transfer.wait_call, transfer.purpose);
  ASSERT_FALSE(waits.contains(kNoCall));
  std::size_t found = 0;
  for (const auto& [wait, purpose] : waits) {
    if (is_found({.dropped_wait = wait})) {
      ++found;
      continue;
    }
    const auto tags = std::ranges::find(reference_.waits, wait, &LoggedWait::call);
    ASSERT_NE(tags, reference_.waits.end());
    EXPECT_TRUE(std::any_of(tags + 1, reference_.waits.end(),
                            [&](const LoggedWait& later) { return (later.tags & tags->tags) == tags->tags; }))
        << "call " << wait << ", the last for its tag";
    if (purpose == Purpose::kSetup || purpose == Purpose::kTile) continue;
    ASSERT_TRUE(purpose == Purpose::kBlock || purpose == Purpose::kRun) << "call " << wait;
    for (std::uint32_t number = 1; number <= reference_.transfers.size(); ++number) {
      if (reference_.transfers[number - 1].wait_call != wait) continue;
      EXPECT_NE(used_after(number, wait), kNoCall) << "call " << wait << ", transfer " << number;
    }
  }
  std::printf("%s: %zu of %zu forgotten waits found\n", case_.name.c_str(), found, waits.size());
}

// A transfer that goes out under the tag of the next buffer: a wait for its own does not wait for it. If the bytes are
// used after the wait for that tag, or never, that does no harm, which is shown of each swap that is not found.
TEST_P(CompletionOrders, EverySwappedTagIsFound) {
  std::uint32_t found = 0, early = 0, unused = 0;
  for (std::uint32_t number = 1; number <= reference_.transfers.size(); ++number) {
    const LoggedTransfer& transfer = reference_.transfers[number - 1];
    if (transfer.purpose == Purpose::kSetup || transfer.purpose == Purpose::kSpill) continue;
    const std::uint8_t next = next_tag(transfer);
    if (next == transfer.tag) continue;
    const auto ends = std::find_if(reference_.waits.begin(), reference_.waits.end(), [&](const LoggedWait& wait) {
      return transfer.start_call < wait.call && (wait.tags >> next & 1u) != 0;
    });
    const std::uint32_t end = ends == reference_.waits.end() ? kNoCall : ends->call;
    if (end < transfer.wait_call) continue;
    if (is_found({.swapped_transfer = number, .swapped_tag = next})) {
      ++found;
      continue;
    }
    ASSERT_NE(end, kNoCall) << "transfer " << number;
    if (is_never_used(number)) {
      ++unused;  // a root without a ray, or the part of a record behind a boundary that nothing is taken from
      continue;
    }
    ++early;
    EXPECT_NE(used_after(number, end), kNoCall) << "transfer " << number;
  }
  std::printf("%s: %u swapped tags found, %u in time, %u unused\n", case_.name.c_str(), found, early, unused);
}

INSTANTIATE_TEST_SUITE_P(Frames, CompletionOrders, testing::Range(std::size_t{0}, cases().size()),
                         [](const auto& frame) { return cases()[frame.param].name; });

// Each order of all transfers of a frame, between all its calls, five of them pending at once.
TEST(CompletionOrdersOfAFrame, AllGiveTheSame) {
  for (const OrderCase& small : cases()) {
    const bool is_short = small.name == "triangles_at_5";
    if (!is_short && !(runs_all() && small.name == "environment")) continue;
    OrderFrame frame(small.scene, small.settings);
    const OrderOutcome reference = frame.run({});
    ASSERT_EQ(reference.status, Status::kOk);
    ASSERT_EQ(reference.most_pending, 5u);
    const Window whole = whole_frame(reference);
    std::uint64_t same = 0;
    const std::uint64_t runs = run_orders(frame, whole, [&](const OrderOutcome& outcome) {
      const bool is_same = outcome.is_as(reference);
      same += is_same ? 1u : 0u;
      return is_same;
    });
    EXPECT_EQ(same, runs);
    EXPECT_EQ(static_cast<double>(runs), count_orders(reference, whole));
    EXPECT_GT(runs, 200000u);
    std::printf("%s: %zu calls, %llu orders\n", small.name.c_str(), reference.calls.size(),
                static_cast<unsigned long long>(runs));
  }
}

// What one level has pending at most: as many as it has buffers, so up to a depth of 4 five are a sum over levels.
// Set-up and spilled rays are waited for at once.
TEST(CompletionOrdersOfAFrame, ALevelHasItsDepthPending) {
  const auto most = [](const char* name, const OrderSettings& settings, Purpose purpose) {
    const OrderOutcome outcome = OrderFrame(order_case(name).scene, settings).run({});
    EXPECT_EQ(outcome.status, Status::kOk) << name;
    EXPECT_EQ(most_pending_of(outcome, Purpose::kSetup), 1u) << name;
    return most_pending_of(outcome, purpose);
  };
  for (std::uint32_t depth = 1; depth <= 5; ++depth) {
    SCOPED_TRACE(depth);
    EXPECT_EQ(most("triangles_at_5", {.triangle_depth = depth}, Purpose::kRun), depth);
    EXPECT_EQ(most("blocks_at_5", {.macro_depth = depth}, Purpose::kBlock), depth);
    EXPECT_EQ(most("tiles", {.width = 40, .output_depth = depth}, Purpose::kTile), depth);
    EXPECT_EQ(most("leaves", {.width = 2, .height = 1, .fetch_depth = depth}, Purpose::kRun), depth);
    EXPECT_EQ(most("surfaces", {.width = 6, .height = 1, .fetch_depth = depth}, Purpose::kRecord), depth);
    EXPECT_EQ(most("spilling", {.width = 8, .height = 4, .fetch_depth = depth}, Purpose::kSpill), 1u);
  }
}

}  // namespace
}  // namespace gridiron::test
