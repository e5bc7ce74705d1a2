// Camera files: the text form of a view. SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <string>
#include <vector>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/words.h"
#include "files/input_file.h"
#include "view.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMaxFileBytes = 1 << 16;
constexpr const char* kExpectedCamera = "expected a camera file: text with lines 'eye x y z' and 'at x y z'";

struct Line {
  const std::filesystem::path& path;
  std::size_t number;

  [[noreturn]] void fail(const std::string& reason) const { input_error(path, number, reason); }
};

// Words of a line without its comment.
std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text.substr(0, text.find('#')));
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::vector<float> parse_values(const std::vector<std::string>& words, std::size_t wanted, const Line& line) {
  if (words.size() - 1 != wanted) {
    line.fail("'" + words[0] + "' takes " + std::to_string(wanted) + (wanted == 1 ? " number" : " numbers") + ", not " +
              std::to_string(words.size() - 1));
  }
  std::vector<float> values;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::optional<float> value = parse_float(words[i]);
    if (!value) line.fail(in_quotes(words[i]) + " is not a finite number");
    values.push_back(*value);
  }
  return values;
}

}  // namespace

ViewRequest read_camera_file(const std::filesystem::path& path) {
  const InputFile file = read_text_file(path, kExpectedCamera, kMaxFileBytes);
  std::istringstream stream(std::string(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()));
  ViewRequest view;
  std::size_t number = 0;
  for (std::string text; std::getline(stream, text);) {
    const Line line{path, ++number};
    const std::vector<std::string> words = split(text);
    if (words.empty()) continue;
    const std::string& key = words[0];
    if (key == "fov") {
      if (view.fov_degrees) line.fail("second 'fov'");
      view.fov_degrees = parse_values(words, 1, line)[0];
      if (!fov_is_possible(*view.fov_degrees)) line.fail("fov must be from 0.001 to below 180 degrees");
      continue;
    }
    std::optional<Vec3>* target = key == "eye" ? &view.eye : key == "at" ? &view.at : key == "up" ? &view.up : nullptr;
    if (target == nullptr) line.fail("unknown word " + in_quotes(key) + "; expected eye, at, up or fov");
    if (*target) line.fail("second '" + key + "'");
    const std::vector<float> values = parse_values(words, 3, line);
    *target = Vec3(values[0], values[1], values[2]);
  }
  const Line last{path, number == 0 ? 1 : number};
  if (!view.eye) last.fail("the file ends without a line 'eye x y z'");
  if (!view.at) last.fail("the file ends without a line 'at x y z'");
  if (const char* defect = view_defect(*view.eye, *view.at, view.up.value_or(Vec3(0, 1, 0)))) last.fail(defect);
  return view;
}

}  // namespace gridiron::tool
