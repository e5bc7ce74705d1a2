// Machine files: the text form of a machine profile. SPDX-License-Identifier: Apache-2.0
#include "machine_file.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/failure.h"
#include "base/suggestion.h"
#include "base/words.h"
#include "files/input_file.h"
#include "gridiron/device/machine_keys.h"

namespace gridiron::tool {
namespace {

using sim::MachineProfile;

constexpr std::size_t kMaxFileBytes = 1 << 20;
constexpr std::size_t kMaxLineBytes = 1000;
constexpr std::size_t kMaxNameBytes = 64;
constexpr const char* kExpectedMachine = "expected a machine file: text as 'gridiron machines cell-ps3' prints it";
constexpr std::string_view kEditedSuffix = "-edited";

// A profile and the text it points to.
struct OwnedMachine {
  std::string name, description;
  MachineProfile profile{};
};

// Suggestions for an unknown machine: the nearest name and all names.
std::string words_of_built_in_machines(std::string_view name) {
  std::string list;
  std::vector<std::string> names;
  for (const MachineProfile& machine : sim::machine_profiles()) {
    names.emplace_back(machine.name);
    list += (list.empty() ? "; there are " : ", ") + names.back();
  }
  return did_you_mean(name, names) + list;
}

constexpr std::string_view kBlanks = " \t";

// @returns text without blanks at both ends.
std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

bool is_key(std::string_view word) {
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.'; };
  return word.size() <= kMaxNameBytes && std::ranges::all_of(word, fits);
}

bool is_name(std::string_view word) {
  const auto fits = [](char c) { return c > ' ' && c < 0x7F && c != '#'; };
  return !word.empty() && word.size() <= kMaxNameBytes && std::ranges::all_of(word, fits);
}

// @returns why a terminal or JSON cannot show the text unchanged, null if they can.
const char* text_defect(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(at++);
    if (first < 0x80) {
      if (first == 0x7F) return "has a control character";
      continue;
    }
    // Unicode, table 3-7: the number of following bytes, and the range of the first of these.
    const std::size_t followers = first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
    if (first < 0xC2 || first > 0xF4 || text.size() - at < followers) return "is not UTF-8";
    const unsigned second = byte(at);
    const unsigned least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
    const unsigned most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
    if (second < least || second > most) return "is not UTF-8";
    if (first == 0xC2 && second < 0xA0) return "has a control character";  // C1: U+0080 to U+009F
    for (std::size_t i = 1; i < followers; ++i) {
      if (byte(at + i) < 0x80 || byte(at + i) > 0xBF) return "is not UTF-8";
    }
    at += followers;
  }
  return nullptr;
}

// @returns whether both machines are the same but for their names.
bool has_same_values(MachineProfile a, const MachineProfile& b) {
  a.name = b.name;
  a.description = b.description;
  return a == b;
}

// Reads one file, line by line.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path)
      : path_(path), machine_(std::make_shared<OwnedMachine>()), keys_(file_keys(machine_->profile)) {
    is_given_.resize(keys_.size());
  }

  Machine read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    while (!text.empty()) {
      ++line_number_;
      const std::size_t end = std::min(text.find('\n'), text.size());
      read_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    finish();
    return Machine(machine_, &machine_->profile);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    const std::size_t number = std::max<std::size_t>(line_number_, 1);
    input_error(path_, number, reason);
  }

  void read_line(std::string_view line) {
    if (line.size() > kMaxLineBytes) fail("line of more than " + std::to_string(kMaxLineBytes) + " bytes");
    if (line.ends_with('\r')) line.remove_suffix(1);
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t'; };
    if (std::ranges::any_of(line, is_control)) fail("not a text file");
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) return;
    const std::string_view key = line.substr(0, std::min(line.find_first_of(kBlanks), line.size()));
    read_value(key, trimmed(line.substr(key.size())));
    is_first_key_ = false;
  }

  void read_value(std::string_view key, std::string_view value) {
    if (!is_key(key)) fail("unknown key; keys are words of a to z, 0 to 9, _ and .");
    const std::string quoted = in_quotes(key);
    if (key == "based_on") return read_base(value);
    if (key == "name" || key == "description") {
      std::string& target = key == "name" ? machine_->name : machine_->description;
      if (!target.empty()) fail("second " + quoted);
      if (value.empty()) fail(quoted + " has no value");
      if (key == "name" && !is_name(value)) fail("'name' takes one word of at most 64 printable characters");
      if (const char* defect = text_defect(value)) fail(quoted + " " + defect);
      target = value;
      return;
    }
    const auto known = std::ranges::find(keys_, key, &MachineKey::name);
    if (known == keys_.end()) {
      std::vector<std::string> keys = {"based_on", "name", "description"};
      for (const MachineKey& each : keys_) keys.push_back(each.name);
      fail("unknown key " + quoted + did_you_mean(key, keys) + "; 'gridiron machines cell-ps3' shows all of them");
    }
    const auto index = static_cast<std::size_t>(known - keys_.begin());
    if (is_given_[index]) fail("second " + quoted);
    if (const auto defect = set_number(*known, value)) fail(*defect);
    is_given_[index] = true;
  }

  void read_base(std::string_view value) {
    if (has_base_) fail("second 'based_on'");
    if (!is_first_key_) fail("'based_on' must be the first key");
    const MachineProfile* base = sim::find_machine_profile(value);
    if (base == nullptr) {
      fail(in_quotes(value) + " is no built-in machine" + words_of_built_in_machines(value));
    }
    machine_->profile = *base;
    has_base_ = true;
  }

  void finish() {
    if (!has_base_) {
      for (std::size_t i = 0; i < keys_.size(); ++i) {
        if (!is_given_[i]) fail("the file ends without '" + keys_[i].name + "', and has no 'based_on' to take it from");
      }
    }
    // A base provides its figures, not its name; a report must not show other figures under a built-in machine's name.
    const auto is_taken = [this](std::string_view name) {
      const MachineProfile* built_in = sim::find_machine_profile(name);
      return built_in != nullptr && !has_same_values(machine_->profile, *built_in);
    };
    if (machine_->name.empty()) {
      const std::string stem = path_.stem().string();
      machine_->name = is_name(stem) && !is_taken(stem) && !is_descriptor(path_) ? stem : "unnamed";
    } else if (is_taken(machine_->name)) {
      machine_->name += kEditedSuffix;
    }
    // An edited copy must not keep a description of the figures that it has changed.
    const auto is_of_original = [this](const MachineProfile& built_in) {
      return built_in.description == machine_->description && !has_same_values(machine_->profile, built_in);
    };
    const auto original = std::ranges::find_if(sim::machine_profiles(), is_of_original);
    if (original != sim::machine_profiles().end()) {
      machine_->description = "edited copy of " + std::string(original->name);
    }
    if (machine_->description.empty()) {
      machine_->description = has_base_ ? "based on " : "from a machine file";
      if (has_base_) machine_->description += machine_->profile.name;
    }
    machine_->profile.name = machine_->name;
    machine_->profile.description = machine_->description;
  }

  const std::filesystem::path& path_;
  std::shared_ptr<OwnedMachine> machine_;
  std::vector<MachineKey> keys_;
  std::vector<bool> is_given_;
  std::size_t line_number_ = 0;
  bool is_first_key_ = true;
  bool has_base_ = false;
};

}  // namespace

Machine read_machine_file(const std::filesystem::path& path) {
  const InputFile file = read_text_file(path, kExpectedMachine, kMaxFileBytes);
  return Reader(path).read({reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()});
}

Machine find_machine(const std::string& name_or_file) {
  if (const MachineProfile* built_in = sim::find_machine_profile(name_or_file)) {
    return Machine(Machine{}, built_in);  // constants: nothing to own
  }
  const std::filesystem::path path = input_path(name_or_file);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw Failure(ExitCode::kBadInput, name_or_file + ": no such file, and no built-in machine of that name" +
                                           words_of_built_in_machines(name_or_file));
  }
  return read_machine_file(path);
}

sim::StoreSize largest_store(const MachineProfile& machine) {
  sim::StoreSize largest = sim::StoreSize::k16KB;  // what a machine has at least
  for (const sim::StoreSize store : sim::kEveryStoreSize) {
    if (sim::arena_bytes(store) <= machine.local_store_bytes) largest = store;
  }
  return largest;
}

std::string machine_text(const MachineProfile& machine) {
  MachineProfile copy = machine;
  const std::vector<MachineKey> keys = file_keys(copy);
  std::size_t width = std::string_view("description").size();
  for (const MachineKey& key : keys) width = std::max(width, key.name.size());
  std::string text;
  const auto add = [&text, width](const std::string& key, const std::string& value) {
    text += key + std::string(width + 1 - key.size(), ' ') + value + "\n";
  };
  add("name", std::string(machine.name));
  add("description", std::string(machine.description));
  for (const MachineKey& key : keys) add(key.name, text_of(key));
  return text;
}

}  // namespace gridiron::tool
