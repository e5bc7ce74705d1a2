// Reads SVG and HTML that the program wrote: strict about what makes a document well formed.
// Memory: strings. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::test {

/// One element in the order in which it was opened.
struct MarkupElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  ///< directly inside it, entities resolved

  /// @returns the attribute as a number; a test failure if there is none.
  [[nodiscard]] double number(const std::string& attribute) const;
};

/// @returns the elements of a document; a test failure where tags do not match, an attribute is not quoted or stands
/// twice, an entity is not one of XML's five, or there is not exactly one root. A leading <!DOCTYPE html> is skipped.
std::vector<MarkupElement> parse_markup(std::string_view document);

/// @returns those with that name.
std::vector<MarkupElement> elements_named(const std::vector<MarkupElement>& elements, std::string_view name);

}  // namespace gridiron::test
