// File kind. SPDX-License-Identifier: Apache-2.0
#include "file_kind.h"

#include <gridiron/base/records.h>
#include <gridiron/firmware/frame_job.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/words.h"

namespace gridiron::tool {
namespace {

using std::string_view_literals::operator""sv;

static_assert(std::endian::native == std::endian::little, "magic words are compared as they lie in the file");

// The first bytes of a kind of file, and its description.
struct Magic {
  std::string_view bytes;
  const char* words;
  bool may_be_model = false;
};

constexpr auto kMagics = std::to_array<Magic>({
    {"\x89PNG", "is a PNG picture"},
    {"\xFF\xD8\xFF", "is a JPEG picture"},
    {"GIF8", "is a GIF picture"},
    {"II*\0"sv, "is a TIFF picture"},
    {"MM\0*"sv, "is a TIFF picture"},
    {"\x76\x2F\x31\x01", "is an OpenEXR picture"},
    {"#?RADIANCE", "is a Radiance picture"},
    {"PF\n", "is a PFM picture"},
    {"Pf\n", "is a PFM picture"},
    {"P3\n", "is a PPM picture"},
    {"P6\n", "is a PPM picture"},
    {"%PDF", "is a PDF document"},
    {"\x1F\x8B", "is compressed with gzip; unpack it first"},
    {"BZh", "is compressed with bzip2; unpack it first"},
    {"\xFD"
     "7zXZ",
     "is compressed with xz; unpack it first"},
    {"\x28\xB5\x2F\xFD", "is compressed with zstd; unpack it first"},
    {"PK\x03\x04", "is a zip archive; unpack it first", true},
    {"glTF", "is a glTF scene", true},
    {"Kaydara FBX", "is an FBX scene", true},
    {"BLENDER", "is a Blender scene", true},
    {"#VRML", "is a VRML scene", true},
    {"<?xml", "is XML text", true},
    {"<!DOCTYPE html", "is a web page"},
    {"<!doctype html", "is a web page"},
    {"<html", "is a web page"},
    {"version https://git-lfs", "is a pointer of Git LFS, without the file itself"},
    {"\x7F"
     "ELF",
     "is a program"},
});

// Endings of models that are read with Assimp. Those of animations alone and of whole worlds are left out.
constexpr auto kModelEndings = std::to_array<std::string_view>(
    {"obj", "stl", "gltf",  "glb",     "off", "dae",  "fbx",  "3ds", "3mf",     "amf", "ac",
     "ase", "b3d", "blend", "cob",     "dxf", "hmp",  "iqm",  "irr", "irrmesh", "lwo", "lws",
     "lxo", "md2", "md3",   "md5mesh", "mdl", "ms3d", "ogex", "pk3", "pmx",     "q3o", "q3s",
     "scn", "sib", "smd",   "ter",     "uc",  "vta",  "x",    "x3d", "xgl",     "zae", "zgl"});

std::string_view text_of(std::span<const std::byte> head) {
  return {reinterpret_cast<const char*>(head.data()), head.size()};
}

bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

// Takes the next word from the front of a text, skipping blanks and comments; empty at the end.
std::string_view take_word(std::string_view& text) {
  while (!text.empty() && (is_blank(text.front()) || text.front() == '#')) {
    text.remove_prefix(text.front() == '#' ? std::min(text.find_first_of("\r\n"), text.size()) : 1);
  }
  const auto end = std::ranges::find_if(text, [](char c) { return is_blank(c) || c == '#'; });
  const std::string_view word = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(word.size());
  return word;
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

bool is_binary(std::span<const std::byte> head) {
  return std::ranges::find(head, std::byte{0}) != head.end();  // which text never has
}

bool may_be_number(std::string_view word) {
  if (!word.empty() && (word.front() == '+' || word.front() == '-')) word.remove_prefix(1);
  if (!word.empty() && word.front() == '.') word.remove_prefix(1);
  return !word.empty() && word.front() >= '0' && word.front() <= '9';
}

bool is_mesh(std::span<const std::byte> head) {
  const std::string_view text = text_of(head);
  return text.starts_with("ply") && (text.size() == 3 || is_blank(text[3]));
}

// Checks the first entity of a text scene as far as needed to exclude other formats whose lines begin with a letter.
bool is_text_scene(std::span<const std::byte> head) {
  std::string_view text = text_of(head);
  // A damaged line further on is for the reader to name.
  if (is_binary(head.first(std::min(head.size(), text.find('\n'))))) return false;
  const std::string_view first = take_word(text), second = take_word(text);
  if (first == "v") {
    return second.empty() || is_one_of(second, {"from", "at", "up", "angle", "hither", "resolution"});
  }
  if (is_one_of(first, {"sn", "sh"})) return is_one_of(second, {"on", "off", ""});
  if (is_one_of(first, {"m", "e"})) return true;
  if (!is_one_of(first, {"b", "l", "f", "p", "pp", "c", "s", "la", "ao", "ms", "d"})) return false;
  return second.empty() || (may_be_number(second) && second.find('/') == std::string_view::npos);
}

// @returns the description of text in a known format, else null.
const char* words_of_text(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") != std::string_view::npos && text[text.find_first_not_of(" \t\r\n")] == '{') {
    return text.find("\"asset\"") != std::string_view::npos ? "is a glTF scene" : "is JSON text";
  }
  const std::string_view first = take_word(text), second = take_word(text);
  if (first.empty()) return "holds nothing but blanks and comments";
  if (first == "solid") return "is an STL mesh";
  if (is_one_of(first, {"OFF", "COFF", "NOFF"})) return "is an OFF mesh";
  if (is_one_of(first, {"mtllib", "usemtl", "o", "g", "vn", "vt"})) return "is an OBJ mesh";
  if (is_one_of(first, {"v", "s"}) && (may_be_number(second) || second == "off")) return "is an OBJ mesh";
  if (is_one_of(first, {"eye", "at", "up", "fov"})) return "is a camera file";
  if (is_one_of(first, {"based_on", "name", "description", "core_count"})) return "is a machine file";
  return nullptr;
}

// Binary STL has no magic: 80 bytes of anything, the count of triangles, 50 bytes for each.
bool is_binary_stl(std::span<const std::byte> head, std::optional<std::uint64_t> file_bytes) {
  constexpr std::size_t kHeaderBytes = 84, kCountPlace = 80, kTriangleBytes = 50;
  if (!file_bytes || head.size() < kHeaderBytes) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, head.data() + kCountPlace, sizeof count);
  return *file_bytes == kHeaderBytes + std::uint64_t{count} * kTriangleBytes;
}

// With a byte order mark or, in two characters of ASCII, without.
bool is_utf16(std::span<const std::byte> head) {
  const std::string_view text = text_of(head);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  const auto is_text = [&](std::size_t i) { return is_blank(text[i]) || (text[i] > ' ' && text[i] <= '~'); };
  if (text.size() < 4) return false;
  return (is_text(0) && text[1] == 0 && is_text(2) && text[3] == 0) ||
         (text[0] == 0 && is_text(1) && text[2] == 0 && is_text(3));
}

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return ending;
}

const Magic* magic_of(std::span<const std::byte> head) {
  const auto magic =
      std::ranges::find_if(kMagics, [&](const Magic& each) { return text_of(head).starts_with(each.bytes); });
  return magic != kMagics.end() ? &*magic : nullptr;
}

// The ending that the content itself asks for, whatever the name is; empty: none.
std::string_view ending_by_content(std::span<const std::byte> head, std::optional<std::uint64_t> file_bytes) {
  const std::string_view text = text_of(head);
  if (text.starts_with("glTF")) return "glb";
  if (text.starts_with("Kaydara FBX")) return "fbx";
  if (text.starts_with("BLENDER")) return "blend";
  if (magic_of(head) != nullptr) return "";
  if (is_binary_stl(head, file_bytes)) return "stl";
  return "";
}

std::string_view ending_by_words(std::span<const std::byte> head) {
  if (is_binary(head) || is_text_scene(head)) return "";
  const char* const words = words_of_text(text_of(head));
  if (words == nullptr) return "";
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kWords = {
      {{"is a glTF scene", "gltf"}, {"is an STL mesh", "stl"}, {"is an OFF mesh", "off"}, {"is an OBJ mesh", "obj"}}};
  const auto found = std::ranges::find(kWords, std::string_view(words), [](const auto& each) { return each.first; });
  return found != kWords.end() ? found->second : "";
}

}  // namespace

std::string model_ending(std::span<const std::byte> head, const std::filesystem::path& path,
                         std::optional<std::uint64_t> file_bytes) {
  if (head.empty() || is_mesh(head) || starts_with_word(head, kImageMagic)) return "";
  if (const std::string_view own = ending_by_content(head, file_bytes); !own.empty()) return std::string(own);
  const std::string ending = lower_ending(path);
  if (std::ranges::find(kModelEndings, ending) != kModelEndings.end()) {
    // Assimp converts it for formats that are XML and some others, and finds nothing in these.
    if (is_one_of(ending, {"obj", "stl", "gltf", "glb"}) && is_utf16(head)) return "";
    const Magic* const magic = magic_of(head);
    return magic == nullptr || magic->may_be_model ? ending : "";
  }
  return ending == "nff" ? "" : std::string(ending_by_words(head));
}

bool starts_with_word(std::span<const std::byte> head, std::uint32_t magic) {
  return head.size() >= sizeof magic && std::memcmp(head.data(), &magic, sizeof magic) == 0;
}

SceneKind scene_kind_by_ending(const std::filesystem::path& path) {
  const std::string ending = lower_ending(path);
  if (ending == "ply" || std::ranges::find(kModelEndings, ending) != kModelEndings.end()) return SceneKind::kMesh;
  if (ending == "nff") return SceneKind::kText;
  if (ending == "gri") return SceneKind::kPacked;
  return SceneKind::kUnknown;
}

SceneKind scene_kind_of(std::span<const std::byte> head, const std::filesystem::path& path,
                        std::optional<std::uint64_t> file_bytes) {
  if (is_mesh(head) || !model_ending(head, path, file_bytes).empty()) return SceneKind::kMesh;
  if (starts_with_word(head, kImageMagic)) return SceneKind::kPacked;
  if (is_text_scene(head)) return SceneKind::kText;
  const bool is_named_text = scene_kind_by_ending(path) == SceneKind::kText && !head.empty() && !is_binary(head);
  return is_named_text && words_of_text(text_of(head)) == nullptr ? SceneKind::kText : SceneKind::kUnknown;
}

const char* words_of_marked_content(std::span<const std::byte> head) {
  if (is_mesh(head)) return "is a PLY mesh";
  if (starts_with_word(head, kImageMagic)) return "is a packed scene";
  if (starts_with_word(head, port::kFrameJobMagic)) return "is a job";
  if (starts_with_word(head, port::kFrameResultMagic)) return "is the result of a job";
  const Magic* const magic = magic_of(head);
  return magic != nullptr ? magic->words : nullptr;
}

std::string words_of_content(std::span<const std::byte> head, std::optional<std::uint64_t> file_bytes) {
  if (head.empty()) return "is empty";
  if (const char* words = words_of_marked_content(head)) return words;
  const std::string_view text = text_of(head);
  if (is_binary_stl(head, file_bytes)) return "is an STL mesh";
  if (is_utf16(head)) return "is UTF-16 text; save it as UTF-8";
  if (is_text_scene(head)) return "is a text scene";
  if (!is_binary(head)) {
    if (const char* words = words_of_text(text)) return words;
  }
  constexpr std::size_t kShownBytes = 8;
  return "is of no known kind: it begins with " + in_quotes(text.substr(0, std::min(text.find('\n'), kShownBytes)));
}

}  // namespace gridiron::tool
