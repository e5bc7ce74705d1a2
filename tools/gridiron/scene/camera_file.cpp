// Camera files and camera paths: the text forms of a view and of one that moves. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/words.h"
#include "camera_path.h"
#include "files/input_file.h"
#include "view.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMaxCameraBytes = 1 << 16, kMaxPathBytes = 1 << 26;
constexpr const char* kExpectedCamera = "expected a camera file: text with lines 'eye x y z' and 'at x y z'";
constexpr const char* kExpectedPath = "expected a camera path: text with lines 'frame N', 'eye x y z' and 'at x y z'";

struct Line {
  const std::filesystem::path& path;
  std::uint64_t number;

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

Vec3 parse_point(const std::vector<std::string>& words, const Line& line) {
  const std::vector<float> values = parse_values(words, 3, line);
  return {values[0], values[1], values[2]};
}

float parse_fov(const std::vector<std::string>& words, const Line& line) {
  const float fov = parse_values(words, 1, line)[0];
  if (!fov_is_possible(fov)) line.fail("fov must be from 0.001 to below 180 degrees");
  return fov;
}

// Sets a part that a line gives for the first time.
template <class Value>
void set_once(std::optional<Value>& part, const Value& value, const std::string& key, const Line& line) {
  if (part) line.fail("second '" + key + "'");
  part = value;
}

// Calls visit(words, line) for every line with words. @returns the last line, or the first if there is none.
template <class Visit>
Line for_each_line(const std::filesystem::path& path, const char* expected, std::size_t most_bytes, Visit visit) {
  const InputFile file = read_text_file(path, expected, most_bytes);
  std::istringstream stream(std::string(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()));
  Line line{path, 0};
  for (std::string text; std::getline(stream, text);) {
    ++line.number;
    const std::vector<std::string> words = split(text);
    if (!words.empty()) visit(words, line);
  }
  line.number = std::max(line.number, std::uint64_t{1});
  return line;
}

// The parts that the lines of one key give.
struct KeyParts {
  std::uint64_t line = 0;
  std::uint32_t frame = 0;
  std::optional<Vec3> eye{}, at{}, direction{}, up{};
  std::optional<float> fov_degrees{};
};

KeyParts begin_key(const std::vector<std::string>& words, const Line& line, const std::vector<KeyParts>& keys) {
  const std::optional<std::uint32_t> frame = words.size() == 2 ? parse_count(words[1]) : std::nullopt;
  if (!frame || *frame >= kMostFrames) {
    line.fail("'frame' takes a whole number below " + std::to_string(kMostFrames));
  }
  if (keys.empty() && *frame != 0) line.fail("the first key is 'frame 0', not " + std::to_string(*frame));
  if (!keys.empty() && *frame <= keys.back().frame) {
    line.fail("frame " + std::to_string(*frame) + " does not come after frame " + std::to_string(keys.back().frame) +
              " of line " + std::to_string(keys.back().line));
  }
  return {.line = line.number, .frame = *frame};
}

void add_part(KeyParts& key, const std::vector<std::string>& words, const Line& line) {
  const std::string& word = words[0];
  if (word == "fov") return set_once(key.fov_degrees, parse_fov(words, line), word, line);
  std::optional<Vec3>* const part = word == "eye"         ? &key.eye
                                    : word == "at"        ? &key.at
                                    : word == "direction" ? &key.direction
                                    : word == "up"        ? &key.up
                                                          : nullptr;
  if (part == nullptr) {
    line.fail("unknown word " + in_quotes(word) + "; expected frame, eye, at, direction, up or fov");
  }
  set_once(*part, parse_point(words, line), word, line);
  if (key.at && key.direction) line.fail("at and direction: both say where this key looks");
}

double distance(const Vec3& eye, const Vec3& at) {
  return glm::length(DVec3(at) - DVec3(eye));
}

// How far from its eye a key with a direction looks, before any key has an `at`: as far as the first one that has.
double first_distance(const std::vector<KeyParts>& keys) {
  std::optional<Vec3> eye;
  for (const KeyParts& key : keys) {
    if (key.eye) eye = key.eye;
    if (eye && key.at) return distance(*eye, *key.at);
  }
  return eye ? std::max(1.0, glm::length(DVec3(*eye))) : 1.0;
}

// Parts that a key does not give are those of the key before. Directions become points as far away as those of keys
// with an `at`, so that the view turns evenly between the two.
CameraPath complete_keys(const std::filesystem::path& path, const std::vector<KeyParts>& keys) {
  CameraPath result{path, {}};
  KeyParts now;
  double reach = first_distance(keys);
  for (const KeyParts& key : keys) {
    now.line = key.line;
    now.frame = key.frame;
    if (key.at || key.direction) {
      now.at = key.at;
      now.direction = key.direction;
    }
    if (key.eye) now.eye = key.eye;
    if (key.up) now.up = key.up;
    if (key.fov_degrees) now.fov_degrees = key.fov_degrees;
    if (!now.eye) input_error(path, key.line, "the first key has no line 'eye x y z'");
    if (!now.at && !now.direction) {
      input_error(path, key.line, "the first key has no line 'at x y z' or 'direction x y z'");
    }
    if (now.direction == Vec3(0.0f)) input_error(path, key.line, "direction has length 0");
    const Vec3 at = now.at ? *now.at : Vec3(DVec3(*now.eye) + reach * glm::normalize(DVec3(*now.direction)));
    if (now.at) reach = distance(*now.eye, at);
    const Vec3 up = now.up.value_or(Vec3(0, 1, 0));
    if (const char* defect = view_defect(*now.eye, at, up)) input_error(path, key.line, defect);
    result.keys.push_back({now.frame, now.line, *now.eye, at, up, now.fov_degrees.value_or(kDefaultFovDegrees)});
  }
  return result;
}

}  // namespace

ViewRequest read_camera_file(const std::filesystem::path& path) {
  ViewRequest view;
  const Line last = for_each_line(path, kExpectedCamera, kMaxCameraBytes, [&view](const auto& words, const Line& line) {
    const std::string& key = words[0];
    if (key == "fov") return set_once(view.fov_degrees, parse_fov(words, line), key, line);
    std::optional<Vec3>* target = key == "eye" ? &view.eye : key == "at" ? &view.at : key == "up" ? &view.up : nullptr;
    if (target == nullptr) line.fail("unknown word " + in_quotes(key) + "; expected eye, at, up or fov");
    set_once(*target, parse_point(words, line), key, line);
  });
  if (!view.eye) last.fail("the file ends without a line 'eye x y z'");
  if (!view.at) last.fail("the file ends without a line 'at x y z'");
  if (const char* defect = view_defect(*view.eye, *view.at, view.up.value_or(Vec3(0, 1, 0)))) last.fail(defect);
  return view;
}

CameraPath read_camera_path(const std::filesystem::path& path) {
  std::vector<KeyParts> keys;
  const Line last = for_each_line(path, kExpectedPath, kMaxPathBytes, [&keys](const auto& words, const Line& line) {
    if (words[0] == "frame") {
      keys.push_back(begin_key(words, line, keys));
    } else if (keys.empty()) {
      line.fail("begins with " + in_quotes(words[0]) + "; expected 'frame 0' before the parts of the first key");
    } else {
      add_part(keys.back(), words, line);
    }
  });
  if (keys.empty()) last.fail("the file ends without a line 'frame 0'");
  return complete_keys(path, keys);
}

}  // namespace gridiron::tool
