// Words of a text scene: split at white space, without comments, numbers parsed, every error with its line.
// Memory: borrows text and path. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/failure.h"

namespace gridiron::tool {

/// A word of the text. Empty at the end of the text, with its last line.
struct SceneWord {
  std::string_view text;
  std::uint64_t line = 1;

  [[nodiscard]] bool is_end() const { return text.empty(); }
};

/// @returns whether a word is meant as a number: starts with a digit, a sign or a point, or is nan or inf.
[[nodiscard]] bool looks_like_number(std::string_view word);

/// A number and the word that it was.
struct SceneNumber {
  double value = 0;
  SceneWord word;
};

/// The entity whose numbers are being read, for messages.
struct SceneEntity {
  SceneWord keyword;
  std::uint64_t wanted = 0;  ///< numbers that it has
  std::uint64_t taken = 0;   ///< numbers read so far
};

/// Reads a text from its first word to its last. White space is blank, tab, line feed, vertical tab, form feed and
/// carriage return; `#` opens a comment that goes to the end of its line. Lines end with LF, CR or both.
///
/// Errors, of all functions: Failure (kBadInput), `file:line: reason`.
class SceneWords {
 public:
  SceneWords(std::string_view text, const std::filesystem::path& path);

  /// @returns the next word without taking it.
  [[nodiscard]] const SceneWord& next() const { return next_; }

  /// Takes the next word.
  SceneWord take();

  /// Takes a word that must be there. @param what  as in "the file ends before WHAT".
  SceneWord take_word(const SceneEntity& entity, const char* what);

  /// Takes one of the entity's numbers: any finite double.
  SceneNumber take_number(SceneEntity& entity);

  /// Takes a number from least to most. @param name  its name in messages.
  double take_in_range(SceneEntity& entity, const char* name, double least, double most);

  /// Takes a whole number from least to most.
  std::uint32_t take_count(SceneEntity& entity, const char* name, std::uint32_t least, std::uint32_t most);

  /// Takes three coordinates, each at most kMostSceneCoordinate away from 0.
  Vec3 take_point(SceneEntity& entity);

  /// Takes three values from 0 to most.
  Vec3 take_color(SceneEntity& entity, double most);

  /// Takes `on` or `off`. @returns true for `on`.
  bool take_switch(const SceneEntity& entity);

  [[noreturn]] void fail(std::uint64_t line, const std::string& reason) const { input_error(path_, line, reason); }

 private:
  void advance();

  std::string_view rest_;
  const std::filesystem::path& path_;
  SceneWord next_;
  std::uint64_t line_ = 1;
};

/// @returns the shortest decimal that reads back as the same float.
[[nodiscard]] std::string text_of_number(double value);

}  // namespace gridiron::tool
