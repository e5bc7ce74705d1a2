// Scaling model. SPDX-License-Identifier: Apache-2.0
#include "scaling_model.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <queue>
#include <set>
#include <string_view>
#include <utility>

#include "base/failure.h"
#include "base/ranks.h"
#include "base/words.h"

namespace gridiron::scaling {
namespace {

constexpr double kWorthNaming = 0.05;  // of the time

double number_of(std::string_view text, const std::function<void(const std::string&)>& refuse) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number) || number < 0) {
    refuse(tool::in_quotes(text) + " is no number of 0 or more");
  }
  return number;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

double seconds_of_bytes(const Network& network, double bytes) {
  return network.bytes_per_second > 0 ? bytes / network.bytes_per_second : 0;
}

double broadcast_seconds(const Network& network, std::uint32_t ranks, double bytes) {
  if (bytes == 0) return 0;
  double seconds = 0;
  for (std::uint64_t reached = 1; reached < ranks; reached *= 2) {
    seconds += network.latency_seconds + seconds_of_bytes(network, bytes);
  }
  return seconds;
}

struct Message {
  double work = 0, bytes = 0;
  std::uint32_t pieces = 0;
};

// Of a rank other than 0.
struct Sender {
  std::vector<Message> messages;
  std::size_t next = 0;
  double begins = 0;  // work on the next message
  double free = 0;    // when the message before has left
};

std::vector<Message> messages_of(const Costs& costs, std::uint32_t rank, std::uint32_t ranks) {
  std::vector<Message> messages;
  Message gathered;
  for (std::uint64_t k = 0, i = rank; i < costs.pieces.size(); i = tool::piece_of_rank(++k, rank, ranks)) {
    gathered.work += costs.pieces[i].seconds;
    gathered.bytes += costs.pieces[i].bytes;
    ++gathered.pieces;
    const bool is_long = costs.message_seconds > 0 && gathered.work >= costs.message_seconds;
    if (gathered.pieces >= costs.message_pieces || is_long ||
        tool::piece_of_rank(k + 1, rank, ranks) >= costs.pieces.size()) {
      messages.push_back(std::exchange(gathered, {}));
    }
  }
  return messages;
}

// Rank 0 and the messages to it.
class Gathering {
 public:
  Gathering(const Costs& costs, const Network& network, std::uint32_t ranks, double begin)
      : costs_(costs), network_(network), ranks_(ranks), now_(begin), senders_(ranks) {
    for (std::uint32_t rank = 1; rank < ranks; ++rank) {
      senders_[rank].messages = messages_of(costs, rank, ranks);
      senders_[rank].begins = begin;
      announce(rank);
    }
  }

  // @returns when all pieces are there.
  double run() {
    for (std::uint64_t k = 0, i = 0; i < costs_.pieces.size(); i = tool::piece_of_rank(++k, 0, ranks_)) {
      now_ += costs_.pieces[i].seconds + costs_.own_take_seconds;
      take_arrived();
    }
    while (!heads_.empty() || !arriving_.empty()) {
      double next = HUGE_VAL;
      if (!heads_.empty()) next = heads_.top().first;
      if (!arriving_.empty()) next = std::min(next, arriving_.top().first);
      now_ = std::max(now_, next);
      take_arrived();
    }
    return now_;
  }

 private:
  template <class Value>
  using ByTime = std::priority_queue<std::pair<double, Value>, std::vector<std::pair<double, Value>>, std::greater<>>;

  // The head of the rank's next message comes once its work is done and the message before has left.
  void announce(std::uint32_t rank) {
    Sender& sender = senders_[rank];
    if (sender.next == sender.messages.size()) return;
    sender.begins = std::max(sender.begins + sender.messages[sender.next].work, sender.free);
    heads_.push({sender.begins + network_.latency_seconds, rank});
  }

  void take_arrived() {
    while (true) {
      if (!heads_.empty() && heads_.top().first <= now_) {
        // All messages come through rank 0's one link.
        const std::uint32_t rank = heads_.top().second;
        heads_.pop();
        Sender& sender = senders_[rank];
        const Message& message = sender.messages[sender.next++];
        link_free_ = std::max(link_free_, now_) + seconds_of_bytes(network_, message.bytes);
        sender.free = link_free_ + network_.latency_seconds;
        arriving_.push({sender.free, message.pieces});
        announce(rank);
      } else if (!arriving_.empty() && arriving_.top().first <= now_) {
        now_ += costs_.take_seconds * arriving_.top().second;
        arriving_.pop();
      } else {
        return;
      }
    }
  }

  const Costs& costs_;
  const Network& network_;
  std::uint32_t ranks_;
  double now_, link_free_ = 0;
  std::vector<Sender> senders_;
  ByTime<std::uint32_t> heads_;     // rank
  ByTime<std::uint32_t> arriving_;  // pieces
};

// When all pieces are there. Rank 0 sends the others their parts one by one.
double end_seconds(const Costs& costs, const Network& network, std::uint32_t ranks) {
  const double pieces = std::max(costs.end_pieces, 1.0), helpers = std::min<double>(ranks, pieces);
  const double most_pieces = std::ceil(pieces / helpers);
  double seconds = costs.end_seconds + costs.end_divided_seconds * most_pieces / pieces;
  if (helpers > 1 && costs.end_divided_seconds > 0) {
    seconds += (costs.scatter_seconds + seconds_of_bytes(network, costs.scatter_bytes)) * (helpers - 1) / helpers +
               network.latency_seconds * (helpers - 1);
  }
  return seconds + broadcast_seconds(network, ranks, costs.spread_bytes);
}

// The work scaled so that the rank with most has an even share.
Costs evenly_divided(Costs costs, std::uint32_t ranks) {
  double all = 0, most = 0;
  for (std::uint32_t rank = 0; rank < std::min<std::size_t>(ranks, costs.pieces.size()); ++rank) {
    double own = 0;
    for (std::uint64_t k = 0, i = rank; i < costs.pieces.size(); i = tool::piece_of_rank(++k, rank, ranks)) {
      own += costs.pieces[i].seconds;
    }
    all += own;
    most = std::max(most, own);
  }
  if (most > 0) {
    for (Piece& piece : costs.pieces) piece.seconds *= all / ranks / most;
  }
  return costs;
}

}  // namespace

Costs read_costs(const std::string& file, const std::string& text) {
  Costs costs;
  const std::pair<std::string_view, double Costs::*> keys[] = {
      {"start_seconds", &Costs::start_seconds},
      {"broadcast_bytes", &Costs::broadcast_bytes},
      {"message_pieces", &Costs::message_pieces},
      {"message_seconds", &Costs::message_seconds},
      {"take_seconds", &Costs::take_seconds},
      {"own_take_seconds", &Costs::own_take_seconds},
      {"end_divided_seconds", &Costs::end_divided_seconds},
      {"end_pieces", &Costs::end_pieces},
      {"scatter_seconds", &Costs::scatter_seconds},
      {"scatter_bytes", &Costs::scatter_bytes},
      {"end_seconds", &Costs::end_seconds},
      {"spread_bytes", &Costs::spread_bytes},
  };
  std::set<std::string, std::less<>> seen;
  std::uint64_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    const auto refuse = [&](const std::string& reason) { tool::input_error(file, line_number, reason); };
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = fields_of(line);
    const std::string_view key = fields.front();
    const std::size_t count = key == "piece" ? 3 : 2;
    if (fields.size() != count) {
      refuse(tool::in_quotes(key) + " needs " + std::to_string(count - 1) + (count == 2 ? " value" : " values"));
    }
    if (key == "piece") {
      costs.pieces.push_back({number_of(fields[1], refuse), number_of(fields[2], refuse)});
      continue;
    }
    if (!seen.insert(std::string(key)).second) refuse(tool::in_quotes(key) + " comes twice");
    if (key == "name") {
      costs.name = fields[1];
      continue;
    }
    const auto* const known = std::ranges::find(keys, key, [](const auto& entry) { return entry.first; });
    if (known == std::end(keys)) refuse("unknown key " + tool::in_quotes(key));
    costs.*known->second = number_of(fields[1], refuse);
  }
  if (costs.name.empty()) tool::input_error(file, line_number, "there is no name");
  if (costs.pieces.empty()) tool::input_error(file, line_number, "there is no piece");
  return costs;
}

double simulate(const Costs& costs, const Network& network, std::uint32_t ranks) {
  const double begin = costs.start_seconds + broadcast_seconds(network, ranks, costs.broadcast_bytes);
  return Gathering(costs, network, ranks, begin).run() + end_seconds(costs, network, ranks);
}

Prediction predict(const Costs& costs, const Network& network, std::uint32_t ranks) {
  Prediction prediction{.ranks = ranks, .limit = "none"};
  prediction.seconds = simulate(costs, network, ranks);
  const double alone = simulate(costs, network, 1);
  prediction.speed_up = prediction.seconds > 0 ? alone / prediction.seconds : 1;
  prediction.efficiency = prediction.speed_up / ranks;
  if (ranks == 1) return prediction;

  double most = kWorthNaming * prediction.seconds;
  const auto try_without = [&](const char* what, const Costs& changed, const Network& on) {
    const double saved = prediction.seconds - simulate(changed, on, ranks);
    if (saved <= most) return;
    most = saved;
    prediction.limit = what;
  };
  Costs changed = costs;
  changed.start_seconds = 0;
  try_without("start of rank 0", changed, network);
  changed = costs;
  changed.broadcast_bytes = changed.spread_bytes = 0;
  try_without("broadcast", changed, network);
  changed = costs;
  changed.take_seconds = changed.own_take_seconds = 0;
  try_without("rank 0 takes pieces", changed, network);
  changed = costs;
  changed.end_seconds = 0;
  try_without("end of rank 0", changed, network);
  changed = costs;
  changed.end_divided_seconds = changed.scatter_seconds = changed.scatter_bytes = 0;
  try_without("encoding", changed, network);
  changed = costs;
  for (Piece& piece : changed.pieces) piece.bytes *= 1e-9;
  try_without("bandwidth", changed, network);
  try_without("latency", costs, {.latency_seconds = 0, .bytes_per_second = network.bytes_per_second});
  try_without(ranks >= costs.pieces.size() ? "too few pieces" : "uneven shares", evenly_divided(costs, ranks), network);
  return prediction;
}

}  // namespace gridiron::scaling
