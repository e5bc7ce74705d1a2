// Command files. SPDX-License-Identifier: Apache-2.0
#include "command_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "base/failure.h"
#include "overdue_exit.h"

namespace gridiron::tool {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFilmEndings[] = {".mp4", ".webm", ".gif"};

// Files by identity, with the names that messages use.
struct Ledger {
  std::mutex mutex;
  std::map<std::string, std::string> inputs, outputs;
  std::map<fs::path, OutputTarget> targets;
  std::size_t written_count = 0;
  int standard_output = -1;  ///< where it really goes, once an output uses it
};

std::unique_ptr<Ledger> ledger;

std::string quoted_name(const std::string& name) {
  return "'" + name + "'";
}

// The name of an output in messages: its option, or a file of a folder.
std::string words_of_output(const Output& output) {
  return output.option.empty() ? output.path.string() : output.option + " " + output.path.string();
}

[[noreturn]] void fail_as_input(const std::string& output, const fs::path& input) {
  usage_error(output + ": is the input " + quoted_name(input.string()) +
              " of this command; writing there would destroy it");
}

void check_ending(const Output& output, const OutputTarget& target) {
  if (output.kind == OutputKind::kFilm) {
    if (target.is_special) usage_error(words_of_output(output) + ": a film can only be a file");
    if (std::ranges::none_of(kFilmEndings, [&](const char* ending) { return has_ending(output.path, ending); })) {
      usage_error(words_of_output(output) + ": the name of a film must end in .mp4, .webm or .gif");
    }
  }
  if (target.is_special) return;  // a device has no ending
  const bool is_pfm = has_ending(output.path, ".pfm");
  if (output.kind == OutputKind::kPicture && !is_pfm && !has_ending(output.path, ".png")) {
    usage_error(words_of_output(output) + ": the name of a picture must end in .png or .pfm");
  }
  if (output.kind == OutputKind::kFloats && !is_pfm) {
    usage_error(words_of_output(output) + ": the name must end in .pfm");
  }
}

void check_terminal(const Output& output, const OutputTarget& target) {
  if (output.kind == OutputKind::kText || !is_terminal(target)) return;
  usage_error(words_of_output(output) + ": is a terminal, which cannot show it; name a file, or use a pipe");
}

// An output that is standard output has it alone: everything else that is printed goes to standard error.
void take_standard_output(OutputTarget& target) {
  if (target.descriptor != STDOUT_FILENO || ledger == nullptr) return;
  (void)std::fflush(stdout);
  ledger->standard_output = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  (void)::dup2(STDERR_FILENO, STDOUT_FILENO);
  target.descriptor = ledger->standard_output;
}

}  // namespace

CommandFiles::CommandFiles() {
  ledger = std::make_unique<Ledger>();
}

CommandFiles::~CommandFiles() {
  if (ledger->standard_output >= 0) {
    (void)std::fflush(stdout);
    (void)::dup2(ledger->standard_output, STDOUT_FILENO);
    (void)::close(ledger->standard_output);
  }
  ledger.reset();
}

void note_input(const fs::path& path) {
  if (ledger == nullptr) return;
  const std::string identity = identity_of_input(path);
  if (identity.empty()) return;
  const std::lock_guard lock(ledger->mutex);
  const bool is_new = ledger->inputs.emplace(identity, path.string()).second;
  const auto output = ledger->outputs.find(identity);
  if (is_new && output != ledger->outputs.end()) fail_as_input(output->second, path);
}

void declare_outputs(const std::vector<Output>& outputs) {
  for (const Output& output : outputs) {
    OutputTarget target = resolve_output(output.path);
    check_ending(output, target);
    check_terminal(output, target);
    if (ledger == nullptr) continue;
    // A device may be written to twice, but not through two names of one descriptor, where the parts could not be
    // separated.
    const std::string file = identity_of(target);
    const std::string descriptor = target.descriptor < 0 ? "" : "descriptor " + std::to_string(target.descriptor);
    const std::string words = words_of_output(output);
    const std::lock_guard lock(ledger->mutex);
    for (const std::string& identity : {descriptor, file}) {
      if (identity.empty()) continue;
      if (const auto input = ledger->inputs.find(identity); input != ledger->inputs.end()) {
        fail_as_input(words, input->second);
      }
      const auto [other, is_new] = ledger->outputs.emplace(identity, words);
      if (!is_new) usage_error(other->second + " and " + words + " are the same file");
    }
    take_standard_output(target);
    ledger->targets[output.path] = std::move(target);
  }
}

OutputTarget target_of(const fs::path& path) {
  if (ledger != nullptr) {
    const auto found = ledger->targets.find(path);
    if (found != ledger->targets.end()) return found->second;
  }
  return resolve_output(path);
}

void check_again(const OutputTarget& target) {
  if (target.is_special) return;
  std::error_code error;
  if (fs::is_directory(target.file, error)) {
    input_error(target.name, "cannot write: it has become a folder");
  }
  if (ledger == nullptr) return;
  const std::lock_guard lock(ledger->mutex);
  const auto input = ledger->inputs.find(identity_of(target));
  if (input == ledger->inputs.end()) return;
  input_error(target.name, "cannot write: it has become the input " + quoted_name(input->second) + " of this command");
}

void count_written_file() {
  if (ledger != nullptr) note_written_files(++ledger->written_count);
}

std::size_t written_file_count() {
  return ledger != nullptr ? ledger->written_count : 0;
}

}  // namespace gridiron::tool
