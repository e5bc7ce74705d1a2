// Completions: what the scripts of all shells share. SPDX-License-Identifier: Apache-2.0
#include "completions.h"

#include <algorithm>

namespace gridiron::tool {

std::string short_help(const OptionFacts& option) {
  const std::vector<std::string>& choices = option.offer.words;
  // "checked (default): every rule ..."
  if (!choices.empty() && option.help.starts_with(choices.front())) return "one of " + joined(choices, ", ");
  return option.help.substr(0, std::min(option.help.find("; "), option.help.find(" (default")));
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

}  // namespace gridiron::tool
