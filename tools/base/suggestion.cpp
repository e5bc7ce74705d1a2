// Suggestions. SPDX-License-Identifier: Apache-2.0
#include "suggestion.h"

#include <algorithm>
#include <cctype>
#include <limits>

namespace gridiron::tool {
namespace {

constexpr std::size_t kMostSuggestions = 3;
constexpr std::size_t kLeastPart = 3;  // letters; shorter words occur in too many others
constexpr std::size_t kMostLetters = 64;
constexpr std::size_t kPart = 1000;  // a part of the word, or it of the part: behind all that are near
constexpr std::size_t kFar = std::numeric_limits<std::size_t>::max();

std::string lower(std::string_view text) {
  std::string word(text.substr(0, kMostLetters));
  std::ranges::transform(word, word.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return word;
}

// Options are compared by what follows their dashes.
std::string_view without_dashes(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

// 0: the nearest. kFar: no plausible mistake.
std::size_t rank_of(std::string_view word, std::string_view candidate) {
  if (word.empty() || candidate.empty()) return kFar;
  const std::size_t distance = word_distance(word, candidate);
  const std::size_t letters = std::min(std::max(word.size(), candidate.size()), kMostLetters);
  if (distance <= std::max<std::size_t>(1, letters / 3)) return distance;
  const std::string a = lower(word), b = lower(candidate);
  const bool is_part =
      std::min(a.size(), b.size()) >= kLeastPart && (a.find(b) != std::string::npos || b.find(a) != std::string::npos);
  return is_part ? kPart : kFar;
}

}  // namespace

std::optional<std::string> word_in_capitals(std::string_view word, std::span<const std::string> known) {
  const auto found = std::ranges::find_if(
      known, [&](const std::string& each) { return each.size() == word.size() && lower(each) == lower(word); });
  return found == known.end() ? std::nullopt : std::optional(*found);
}

std::size_t word_distance(std::string_view first, std::string_view second) {
  const std::string a = lower(first), b = lower(second);
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before.swap(row);
    row.swap(next);
  }
  return row[b.size()];
}

std::vector<std::string> near_words(std::string_view word, std::span<const std::string> known) {
  std::vector<std::string> nearest;
  std::size_t least = kFar;
  for (const std::string& candidate : known) {
    const std::size_t rank = rank_of(without_dashes(word), without_dashes(candidate));
    if (rank == kFar || rank > least) continue;
    if (rank < least) nearest.clear();
    least = rank;
    nearest.push_back(candidate);
  }
  if (nearest.size() > kMostSuggestions) nearest.resize(kMostSuggestions);
  return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::vector<std::string> near = near_words(word, known);
  if (near.empty()) return "";
  std::string words = "; did you mean ";
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (i != 0) words += i + 1 == near.size() ? " or " : ", ";
    words += near[i];
  }
  return words + "?";
}

}  // namespace gridiron::tool
