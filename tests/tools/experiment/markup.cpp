// Markup. SPDX-License-Identifier: Apache-2.0
#include "markup.h"

#include <cctype>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

bool is_name_letter(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-' || letter == ':' || letter == '_';
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  std::vector<MarkupElement> read() {
    skip_spaces();
    if (text_.substr(at_).starts_with("<!DOCTYPE html>")) at_ += 15;
    skip_spaces();
    while (at_ < text_.size() && ok_) {
      if (text_[at_] == '<') {
        read_tag();
      } else {
        read_text();
      }
    }
    if (ok_ && !open_.empty()) fail("not closed: " + elements_[open_.back()].name);
    if (ok_ && root_count_ != 1) fail(std::to_string(root_count_) + " roots");
    return elements_;
  }

 private:
  void fail(const std::string& reason) {
    if (ok_) ADD_FAILURE() << "byte " << at_ << ": " << reason << " near '" << text_.substr(at_, 40) << "'";
    ok_ = false;
    at_ = text_.size();
  }

  void skip_spaces() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  std::string read_name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name_letter(text_[at_])) ++at_;
    if (begin == at_) fail("no name");
    return std::string(text_.substr(begin, at_ - begin));
  }

  // Text up to one of `ends`.
  std::string read_until(std::string_view ends) {
    std::string value;
    while (ok_ && at_ < text_.size() && ends.find(text_[at_]) == std::string_view::npos) {
      if (text_[at_] != '&') {
        value += text_[at_++];
        continue;
      }
      bool known = false;
      for (const auto& [entity, letter] :
           {std::pair{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}) {
        if (!text_.substr(at_).starts_with(entity)) continue;
        value += letter;
        at_ += std::string_view(entity).size();
        known = true;
        break;
      }
      if (!known) fail("unknown entity");
    }
    return value;
  }

  void read_text() {
    const std::string words = read_until("<");
    if (!open_.empty()) {
      elements_[open_.back()].text += words;
    } else if (words.find_first_not_of(" \n\r\t") != std::string::npos) {
      fail("text outside the root");
    }
  }

  void read_tag() {
    ++at_;
    if (at_ < text_.size() && text_[at_] == '/') {
      ++at_;
      const std::string name = read_name();
      if (open_.empty() || elements_[open_.back()].name != name) return fail("closes what is not open: " + name);
      if (at_ >= text_.size() || text_[at_] != '>') return fail("no >");
      ++at_;
      open_.pop_back();
      return;
    }
    MarkupElement element;
    element.name = read_name();
    for (skip_spaces(); ok_ && at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/'; skip_spaces()) {
      const std::string key = read_name();
      if (!text_.substr(at_).starts_with("=\"")) return fail("attribute without a quoted value: " + key);
      at_ += 2;
      const std::string value = read_until("\"<");
      if (at_ >= text_.size() || text_[at_] != '"') return fail("value does not end: " + key);
      ++at_;
      if (!element.attributes.emplace(key, value).second) return fail("attribute twice: " + key);
    }
    if (open_.empty()) ++root_count_;
    elements_.push_back(std::move(element));
    if (text_.substr(at_).starts_with("/>")) {
      at_ += 2;
    } else if (text_.substr(at_).starts_with(">")) {
      ++at_;
      open_.push_back(elements_.size() - 1);
    } else {
      fail("tag does not end");
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<MarkupElement> elements_;
  std::vector<std::size_t> open_;
  int root_count_ = 0;
  bool ok_ = true;
};

}  // namespace

double MarkupElement::number(const std::string& attribute) const {
  const auto found = attributes.find(attribute);
  if (found == attributes.end()) {
    ADD_FAILURE() << name << " has no " << attribute;
    return 0;
  }
  return std::stod(found->second);
}

std::vector<MarkupElement> parse_markup(std::string_view document) {
  return Reader(document).read();
}

std::vector<MarkupElement> elements_named(const std::vector<MarkupElement>& elements, std::string_view name) {
  std::vector<MarkupElement> named;
  for (const MarkupElement& element : elements) {
    if (element.name == name) named.push_back(element);
  }
  return named;
}

}  // namespace gridiron::test
