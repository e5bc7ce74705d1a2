// Enumerates and counts orders in which the transfers of a frame may move.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/order_core.h"
#include "protocol/order_frame.h"

namespace gridiron::test {

/// Counts through all answers to a series of questions, the last one fastest.
class Odometer {
 public:
  /// @returns an answer below `count`.
  [[nodiscard]] std::size_t ask(std::size_t count) {
    if (position_ == digits_.size()) digits_.push_back({0, count});
    return digits_[position_++].value;
  }
  /// Goes to the next series; false after the last.
  [[nodiscard]] bool advance() {
    position_ = 0;
    while (!digits_.empty() && digits_.back().value + 1 == digits_.back().count) digits_.pop_back();
    if (digits_.empty()) return false;
    ++digits_.back().value;
    return true;
  }

 private:
  struct Digit {
    std::size_t value, count;
  };
  std::vector<Digit> digits_;
  std::size_t position_ = 0;
};

/// Transfers that move in every order, all others at their waits; and the calls after which they may move.
struct Window {
  std::vector<std::uint32_t> members;  ///< numbers, rising
  std::vector<std::uint32_t> calls;    ///< rising

  [[nodiscard]] bool has(std::uint32_t number) const {
    return std::binary_search(members.begin(), members.end(), number);
  }
  [[nodiscard]] bool opens(std::uint32_t call) const { return std::binary_search(calls.begin(), calls.end(), call); }
};

[[nodiscard]] inline bool is_pending(const LoggedTransfer& transfer, std::uint32_t call) {
  return transfer.start_call <= call && call < transfer.wait_call;
}

/// Numbers of the transfers that are pending after a call.
[[nodiscard]] inline std::vector<std::uint32_t> pending_after(const OrderOutcome& frame, std::uint32_t call) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < frame.transfers.size(); ++i) {
    if (is_pending(frame.transfers[i], call)) numbers.push_back(i + 1);
  }
  return numbers;
}

/// Every transfer after every call.
[[nodiscard]] inline Window whole_frame(const OrderOutcome& frame) {
  Window window;
  for (std::uint32_t i = 0; i < frame.transfers.size(); ++i) window.members.push_back(i + 1);
  for (std::uint32_t call = 0; call < frame.calls.size(); ++call) window.calls.push_back(call);
  return window;
}

/// Orders of a window, without running any: sums the ways to every set of moved transfers, call by call.
[[nodiscard]] inline double count_orders(const OrderOutcome& frame, const Window& window) {
  std::map<std::vector<std::uint32_t>, double> ways{{{}, 1.0}};  // by what has moved and was not waited for
  for (const std::uint32_t call : window.calls) {
    std::vector<std::uint32_t> open;
    for (const std::uint32_t number : window.members) {
      if (is_pending(frame.transfers[number - 1], call)) open.push_back(number);
    }
    std::map<std::vector<std::uint32_t>, double> next;
    for (const auto& [moved, count] : ways) {
      std::vector<std::uint32_t> kept, rest;
      for (const std::uint32_t number : open) {
        (std::binary_search(moved.begin(), moved.end(), number) ? kept : rest).push_back(number);
      }
      for (std::uint32_t set = 0; set < 1u << rest.size(); ++set) {
        std::vector<std::uint32_t> state = kept;
        double sequences = 1.0;
        std::uint32_t chosen = 0;
        for (std::uint32_t i = 0; i < rest.size(); ++i) {
          if ((set >> i & 1u) == 0) continue;
          state.push_back(rest[i]);
          sequences *= ++chosen;
        }
        std::sort(state.begin(), state.end());
        next[state] += count * sequences;
      }
    }
    ways = std::move(next);
  }
  double sum = 0.0;
  for (const auto& [moved, count] : ways) sum += count;
  return sum;
}

/// Runs every order of a window; each(outcome) is given all of them. @returns how many.
/// @param frame  OrderFrame, or what else has its run().
template <class Frame, class Each>
std::uint64_t run_orders(Frame& frame, const Window& window, Each&& each) {
  Odometer odometer;
  std::uint64_t orders = 0;
  OrderPlan plan;
  plan.schedule = [&](std::uint32_t call, std::span<const std::uint32_t> open) {
    if (!window.opens(call)) return open.size();
    std::size_t places[32];
    std::size_t count = 0;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (window.has(open[i])) places[count++] = i;
    }
    if (count == 0) return open.size();
    const std::size_t answer = odometer.ask(count + 1);
    return answer == 0 ? open.size() : places[answer - 1];
  };
  do {
    ++orders;
    if (!each(frame.run(plan))) break;
  } while (odometer.advance());
  return orders;
}

/// What transfers are for, sorted: "bbrrr".
[[nodiscard]] inline std::string purposes_of(const OrderOutcome& frame, std::span<const std::uint32_t> numbers) {
  std::string text;
  for (const std::uint32_t number : numbers) text += static_cast<char>(frame.transfers[number - 1].purpose);
  std::sort(text.begin(), text.end());
  return text;
}

/// Most transfers of one purpose that are pending at once.
[[nodiscard]] inline std::uint32_t most_pending_of(const OrderOutcome& frame, Purpose purpose) {
  std::uint32_t most = 0;
  for (const LoggedTransfer& transfer : frame.transfers) {
    std::uint32_t count = 0;
    for (const std::uint32_t number : pending_after(frame, transfer.start_call)) {
      count += frame.transfers[number - 1].purpose == purpose ? 1u : 0u;
    }
    most = std::max(most, count);
  }
  return most;
}

/// The first moment at which five of each mix of purposes are pending together. Their calls: those that start or end
/// one of them, as the core's other calls do not concern them.
[[nodiscard]] inline std::map<std::string, std::vector<Window>> find_fives(const OrderOutcome& frame) {
  std::map<std::string, std::vector<Window>> fives;
  for (const LoggedTransfer& transfer : frame.transfers) {
    Window window;
    window.members = pending_after(frame, transfer.start_call);
    if (window.members.size() != 5) continue;
    for (const std::uint32_t number : window.members) {
      window.calls.push_back(frame.transfers[number - 1].start_call);
      window.calls.push_back(frame.transfers[number - 1].wait_call);
    }
    std::sort(window.calls.begin(), window.calls.end());
    // One wait can end several: two pieces of a record, or nodes and leaves whose slots share a tag.
    window.calls.erase(std::unique(window.calls.begin(), window.calls.end()), window.calls.end());
    fives[purposes_of(frame, window.members)].push_back(window);
  }
  return fives;
}

}  // namespace gridiron::test
