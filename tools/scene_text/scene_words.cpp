// Words of a text scene. SPDX-License-Identifier: Apache-2.0
#include "scene_text/scene_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "base/numbers.h"
#include "base/words.h"
#include "scene_text/scene_description.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMostWordBytes = 4096;  // as long as a path may be
constexpr const char* kHoldsZero = "not a text file: it holds a byte 0";

bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}

bool is_white(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || is_line_end(c);
}

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < ' ' || byte == 0x7F;
}

bool starts_with_ignoring_case(std::string_view text, std::string_view lower) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; };
  return text.size() >= lower.size() &&
         std::equal(lower.begin(), lower.end(), text.begin(), [&](char b, char a) { return same(a, b); });
}

std::string name_of(const SceneEntity& entity) {
  std::string name(1, '\'');
  return name.append(entity.keyword.text).append("'");
}

std::string line_words(const SceneEntity& entity) {
  return " of line " + std::to_string(entity.keyword.line);
}

}  // namespace

bool looks_like_number(std::string_view word) {
  if (word.empty()) return false;
  const char first = word.front();
  if ((first >= '0' && first <= '9') || first == '+' || first == '-' || first == '.') return true;
  return starts_with_ignoring_case(word, "nan") || starts_with_ignoring_case(word, "inf");
}

std::string text_of_number(double value) {
  return shortest_text(static_cast<float>(value));
}

SceneWords::SceneWords(std::string_view text, const std::filesystem::path& path) : rest_(text), path_(path) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  advance();
}

void SceneWords::advance() {
  std::size_t at = 0;
  bool in_comment = false;
  for (; at < rest_.size(); ++at) {
    const char c = rest_[at];
    if (is_line_end(c)) {
      // The last line is that of the last character: a final line end does not start a new one.
      const bool is_pair = c == '\r' && at + 1 < rest_.size() && rest_[at + 1] == '\n';
      if (is_pair) ++at;
      if (at + 1 < rest_.size()) ++line_;
      in_comment = false;
    } else if (c == '#') {
      in_comment = true;
    } else if (!in_comment && !is_white(c)) {
      break;
    }
    if (c == '\0') fail(line_, kHoldsZero);
  }
  rest_.remove_prefix(at);
  std::size_t bytes = 0;
  while (bytes < rest_.size() && !is_white(rest_[bytes]) && rest_[bytes] != '#') {
    if (is_control(rest_[bytes])) {
      fail(line_, rest_[bytes] == '\0' ? kHoldsZero : "not a text file: it holds a control character");
    }
    if (++bytes > kMostWordBytes) fail(line_, "word of more than " + std::to_string(kMostWordBytes) + " bytes");
  }
  next_ = {rest_.substr(0, bytes), line_};
  rest_.remove_prefix(bytes);
}

SceneWord SceneWords::take() {
  const SceneWord word = next_;
  advance();
  return word;
}

SceneWord SceneWords::take_word(const SceneEntity& entity, const char* what) {
  if (next_.is_end()) {
    fail(next_.line, "the file ends inside " + name_of(entity) + line_words(entity) + ", before " + what);
  }
  return take();
}

SceneNumber SceneWords::take_number(SceneEntity& entity) {
  const auto which = [&entity] {
    return "number " + std::to_string(entity.taken + 1) + " of " + std::to_string(entity.wanted);
  };
  if (next_.is_end()) {
    fail(next_.line, "the file ends inside " + name_of(entity) + line_words(entity) + ": " + which() + " is missing");
  }
  SceneNumber number{0, next_};
  if (!looks_like_number(next_.text)) {
    fail(next_.line, in_quotes(next_.text) + " found where " + which() + " of " + name_of(entity) + line_words(entity) +
                         " is expected");
  }
  std::string_view text = next_.text;
  if (text.front() == '+' && text.size() > 1 && text[1] != '-') text.remove_prefix(1);  // from_chars knows no plus
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number.value);
  if (error == std::errc::result_out_of_range) {
    fail(next_.line,
         in_quotes(next_.text) + " is too large or too small a number (" + which() + " of " + name_of(entity) + ")");
  }
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number.value)) {
    fail(next_.line, in_quotes(next_.text) + " is not a finite number (" + which() + " of " + name_of(entity) + ")");
  }
  ++entity.taken;
  advance();
  return number;
}

double SceneWords::take_in_range(SceneEntity& entity, const char* name, double least, double most) {
  const SceneNumber number = take_number(entity);
  if (!(number.value >= least && number.value <= most)) {
    fail(number.word.line, std::string(name) + " of " + name_of(entity) + " must be from " + text_of_number(least) +
                               " to " + text_of_number(most) + ", not " + in_quotes(number.word.text));
  }
  return number.value;
}

std::uint32_t SceneWords::take_count(SceneEntity& entity, const char* name, std::uint32_t least, std::uint32_t most) {
  const SceneNumber number = take_number(entity);
  if (!(number.value >= least && number.value <= most) || number.value != std::floor(number.value)) {
    fail(number.word.line, std::string(name) + " of " + name_of(entity) + " must be a whole number from " +
                               std::to_string(least) + " to " + std::to_string(most) + ", not " +
                               in_quotes(number.word.text));
  }
  return static_cast<std::uint32_t>(number.value);
}

Vec3 SceneWords::take_point(SceneEntity& entity) {
  Vec3 point{};
  for (int axis = 0; axis < 3; ++axis) {
    point[axis] =
        static_cast<float>(take_in_range(entity, "a coordinate", -kMostSceneCoordinate, kMostSceneCoordinate));
  }
  return point;
}

Vec3 SceneWords::take_color(SceneEntity& entity, double most) {
  constexpr const char* kNames[3] = {"red", "green", "blue"};
  Vec3 color{};
  for (int channel = 0; channel < 3; ++channel) {
    color[channel] = static_cast<float>(take_in_range(entity, kNames[channel], 0, most));
  }
  return color;
}

bool SceneWords::take_switch(const SceneEntity& entity) {
  const SceneWord word = take_word(entity, "'on' or 'off'");
  if (word.text != "on" && word.text != "off") {
    fail(word.line, name_of(entity) + " takes 'on' or 'off', not " + in_quotes(word.text));
  }
  return word.text == "on";
}

}  // namespace gridiron::tool
