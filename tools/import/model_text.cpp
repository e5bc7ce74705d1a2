// Model text. SPDX-License-Identifier: Apache-2.0
#include "import/model_text.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

namespace gridiron::tool {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// Whether a line holds numbers alone, in which # can be nothing but a comment.
bool has_numbers(std::string_view line) {
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  constexpr std::string_view kWords[] = {"v",  "vt", "vn", "f",  "l", "p",  "Kd",   "Ks",
                                         "Ka", "Ke", "Ns", "Ni", "d", "Tr", "illum"};
  return std::ranges::find(kWords, word) != std::end(kWords);
}

// A number that begins with its point gets a 0 before it.
std::string with_zeros(std::string_view line) {
  std::string text;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '.' && i != 0 && (line[i - 1] == ' ' || line[i - 1] == '\t')) text += '0';
    text += line[i];
  }
  return text;
}

// Words of curves and levels of detail, whose first letter Assimp takes for that of a vertex, a face, a line or points.
bool is_mistaken(std::string_view line) {
  constexpr std::string_view kWords[] = {"vp", "lod", "parm"};
  return std::ranges::find(kWords, line.substr(0, line.find_first_of(" \t"))) != std::end(kWords);
}

std::optional<std::vector<std::byte>> readable_lines(std::string_view text, bool is_obj) {
  std::string readable, numbers;
  bool is_changed = false, is_continued = false, are_numbers = false, is_left_out = false;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size() - 1) + 1;
    if (text[end - 1] == '\r' && end < text.size() && text[end] == '\n') ++end;
    const std::string_view whole = text.substr(begin, end - begin);
    std::string_view line = whole;
    std::string_view line_end = line.substr(std::min(line.find_last_not_of("\r\n") + 1, line.size()));
    line.remove_suffix(line_end.size());
    if (!is_continued) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      are_numbers = has_numbers(line);
      is_left_out = is_obj && is_mistaken(line);
    }
    if (are_numbers) {
      line = line.substr(0, line.find('#'));
      if (line.find(" .") != std::string_view::npos || line.find("\t.") != std::string_view::npos) {
        numbers = with_zeros(line);
        line = numbers;
      }
    }
    is_continued = line.ends_with('\\');
    if (is_left_out) line = {};
    if (!is_changed && (line.data() != whole.data() || line.size() + line_end.size() != whole.size())) {
      is_changed = true;
      readable.reserve(text.size());
      readable = text.substr(0, begin);
    }
    if (is_changed) readable.append(line).append(line_end);
    begin = end;
  }
  if (!is_changed) return std::nullopt;
  return bytes_of(readable);
}

std::optional<std::vector<std::byte>> readable_stl(std::span<const std::byte> bytes) {
  constexpr std::size_t kHeadBytes = 84, kTriangleBytes = 50, kCountPlace = 80;
  constexpr std::string_view kSolid = "solid";
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  std::uint64_t needed = 0;
  if (bytes.size() >= kHeadBytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kCountPlace, sizeof count);
    needed = kHeadBytes + std::uint64_t{kTriangleBytes} * count;
  }
  if (needed == bytes.size()) return std::nullopt;
  const std::string_view first = text.substr(0, kSolid.size());
  if (std::ranges::equal(first, kSolid, {}, small)) {
    if (first == kSolid) return std::nullopt;
    std::string readable(text);
    std::ranges::transform(readable, readable.begin(), small);
    return bytes_of(readable);
  }
  const bool is_text = text.substr(0, text.find_first_not_of(" \t\r\n") + kSolid.size()).ends_with(kSolid);
  if (is_text || needed <= kHeadBytes || needed > bytes.size()) return std::nullopt;
  return std::vector<std::byte>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(needed));
}

}  // namespace

std::optional<std::vector<std::byte>> readable_bytes(std::span<const std::byte> bytes, std::string_view ending) {
  if (ending == "stl") return readable_stl(bytes);
  if (ending != "obj" && ending != "mtl") return std::nullopt;
  return readable_lines({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, ending == "obj");
}

}  // namespace gridiron::tool
