// The benchmark program: see bench.h. SPDX-License-Identifier: Apache-2.0
#include "bench/bench.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>

#include "bench/tree_lists.h"

namespace gridiron::bench {
namespace {

std::map<std::string, BenchFunction, std::less<>>& registry() {
  static std::map<std::string, BenchFunction, std::less<>> functions;
  return functions;
}

double seconds_now(Clock clock) {
  timespec now{};
  clock_gettime(clock == Clock::kWall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const Candidate& candidate, Clock clock) {
  if (candidate.prepare) candidate.prepare();
  const double start = seconds_now(clock);
  candidate.run();
  return seconds_now(clock) - start;
}

int usage() {
  std::printf("usage: gridiron_bench [--rounds N] [--quick] [--scenes DIR] [--batch RAYS] [NAME...]\nnames:");
  for (const auto& [name, function] : registry()) std::printf(" %s", name.c_str());
  std::printf("\n");
  return 2;
}

[[nodiscard]] bool parse(std::string_view value, unsigned& number) {
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  return error == std::errc() && end == value.data() + value.size();
}

int run(std::span<char*> arguments) {
  BenchOptions options;
  if (const char* scenes = std::getenv("GRIDIRON_SCENES"); scenes != nullptr) options.scenes = scenes;
  std::vector<std::string_view> wanted;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string_view argument = arguments[i];
    const bool has_value = i + 1 < arguments.size();
    if (argument == "--quick") {
      options.quick = true;
    } else if (argument == "--rounds" && has_value) {
      if (!parse(arguments[++i], options.rounds) || options.rounds == 0) return usage();
    } else if (argument == "--batch" && has_value) {
      unsigned& rays = options.batch_rays;
      if (!parse(arguments[++i], rays) || rays == 0 || rays % 16 != 0 || rays > kMaxBatchRays) return usage();
    } else if (argument == "--scenes" && has_value) {
      options.scenes = arguments[++i];
    } else if (registry().contains(argument)) {
      wanted.push_back(argument);
    } else {
      return usage();
    }
  }
  bool all_within = true;
  for (const auto& [name, function] : registry()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    std::printf("== %s\n", name.c_str());
    all_within = function(options) && all_within;
    std::fflush(stdout);
  }
  std::printf("%s\n", all_within ? "all within limits" : "SOME LIMITS EXCEEDED");
  return all_within ? 0 : 3;
}

}  // namespace

std::vector<double> least_seconds(std::span<const Candidate> candidates, unsigned rounds, Clock clock) {
  std::vector<double> least;
  for (const Candidate& candidate : candidates) least.push_back(seconds_of(candidate, clock));
  for (unsigned round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      least[i] = std::min(least[i], seconds_of(candidates[i], clock));
    }
  }
  return least;
}

bool report_ratio(std::string_view label, double ours_seconds, double peer_seconds, double limit) {
  const double ratio = ours_seconds / peer_seconds;
  const bool within = ratio <= limit;
  std::printf("%-44.*s %9.3f ms / %9.3f ms = %6.2f  (limit %.2f)%s\n", static_cast<int>(label.size()), label.data(),
              1e3 * ours_seconds, 1e3 * peer_seconds, ratio, limit, within ? "" : "  EXCEEDED");
  return within;
}

Registration::Registration(std::string_view name, BenchFunction function) {
  registry().emplace(name, function);
}

}  // namespace gridiron::bench

int main(int argument_count, char** arguments) {
  return gridiron::bench::run(std::span(arguments, static_cast<std::size_t>(argument_count)));
}
