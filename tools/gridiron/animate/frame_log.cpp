// Frame log. SPDX-License-Identifier: Apache-2.0
#include "frame_log.h"

#include <fcntl.h>
#include <gridiron/version.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/words.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "files/film_file.h"

namespace gridiron::tool {
namespace {

constexpr std::string_view kTitle = "gridiron animation ";
constexpr std::string_view kComment =
    "# For gridiron animate --resume: the options, and a line for each complete picture.\n";
constexpr std::string_view kOption = "option ", kFrame = "frame ";
constexpr std::string_view kNothing = "-";

std::string title_of_this() {
  return std::string(kTitle) + kVersion + "\n";
}

template <class Number>
std::string text_of(const std::optional<Number>& number) {
  return number ? shortest_text(*number) : std::string(kNothing);
}

std::string line_of(std::size_t i, const LoggedFrame& frame) {
  const FrameFigures& figures = frame.figures;
  std::string line = std::string(kFrame) + shortest_text(i);
  for (const std::string& word :
       {shortest_text(frame.source.content), shortest_text(frame.source.view), shortest_text(frame.picture),
        shortest_text(figures.triangles), text_of(figures.lambda),
        text_of(figures.build ? std::optional(figures.build->cycles) : std::nullopt),
        text_of(figures.build ? std::optional(figures.build->seconds) : std::nullopt),
        text_of(figures.is_timed ? std::optional(figures.render_cycles) : std::nullopt),
        text_of(figures.is_timed ? std::optional(figures.render_seconds) : std::nullopt),
        shortest_text(figures.hash)}) {
    line += " " + word;
  }
  if (!figures.build || figures.build->builder == Builder::kMaster) return line + "\n";
  line += " " + shortest_text(figures.build->passes.size());
  for (const PassFigures& pass : figures.build->passes) {
    line += " " + pass.name + " " + shortest_text(pass.items);
    for (const double cycles : {pass.start_cycles, pass.run_cycles, pass.barrier_cycles}) {
      line += " " + shortest_text(cycles);
    }
    for (const double cycles : pass.limits) line += " " + shortest_text(cycles);
    line += " " + shortest_text(pass.bytes_in) + " " + shortest_text(pass.bytes_out);
  }
  return line + "\n";
}

// Takes the words of a line one by one, and remembers whether each was a number.
class Words {
 public:
  explicit Words(std::string_view rest) : rest_(rest) {}

  template <class Number>
  Number take() {
    Number number{};
    const std::string_view word = take_word();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    is_whole_ = is_whole_ && !word.empty() && error == std::errc{} && end == word.data() + word.size();
    return number;
  }

  template <class Number>
  std::optional<Number> take_optional() {
    if (!rest_.starts_with(kNothing) || !(rest_.size() == 1 || rest_[1] == ' ')) return take<Number>();
    (void)take_word();
    return std::nullopt;
  }

  std::string take_name() {
    const std::string_view word = take_word();
    is_whole_ = is_whole_ && !word.empty();
    return std::string(word);
  }

  [[nodiscard]] bool has_more() const { return is_whole_ && !rest_.empty(); }
  [[nodiscard]] bool are_whole() const { return is_whole_ && rest_.empty(); }

 private:
  std::string_view take_word() {
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return word;
  }

  std::string_view rest_;
  bool is_whole_ = true;
};

void take_passes(Words& words, BuildCost& build) {
  build.builder = Builder::kCores;
  const auto count = words.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && words.has_more(); ++i) {
    PassFigures& pass = build.passes.emplace_back();
    pass.name = words.take_name();
    pass.items = words.take<std::uint32_t>();
    for (double* const cycles : {&pass.start_cycles, &pass.run_cycles, &pass.barrier_cycles}) {
      *cycles = words.take<double>();
    }
    for (double& cycles : pass.limits) cycles = words.take<double>();
    pass.bytes_in = words.take<std::uint64_t>();
    pass.bytes_out = words.take<std::uint64_t>();
  }
}

std::optional<std::pair<std::size_t, LoggedFrame>> frame_of(std::string_view text, std::uint64_t line) {
  Words words(text);
  LoggedFrame frame{.line = line, .source = {}, .picture = 0, .figures = {}};
  const auto i = words.take<std::size_t>();
  frame.source.content = words.take<std::uint64_t>();
  frame.source.view = words.take<std::uint64_t>();
  frame.picture = words.take<std::uint64_t>();
  FrameFigures& figures = frame.figures;
  figures.triangles = words.take<std::uint64_t>();
  figures.lambda = words.take_optional<float>();
  const auto build_cycles = words.take_optional<double>();
  const auto build_seconds = words.take_optional<double>();
  if (build_cycles && build_seconds) figures.build = BuildCost{*build_cycles, *build_seconds, Builder::kMaster, {}};
  const auto render_cycles = words.take_optional<double>();
  const auto render_seconds = words.take_optional<double>();
  figures.is_timed = render_cycles && render_seconds;
  figures.render_cycles = render_cycles.value_or(0);
  figures.render_seconds = render_seconds.value_or(0);
  figures.hash = words.take<std::uint64_t>();
  if (figures.build && words.has_more()) take_passes(words, *figures.build);
  return words.are_whole() ? std::optional(std::pair(i, frame)) : std::nullopt;
}

}  // namespace

FrameLog::FrameLog(std::filesystem::path path, std::map<std::string, std::string> options)
    : path_(std::move(path)), options_(std::move(options)) {}

FrameLog::~FrameLog() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool FrameLog::exists() const {
  std::error_code error;
  return std::filesystem::exists(path_, error);
}

void FrameLog::refuse(std::uint64_t line, const std::string& reason) const {
  input_error(path_, line, "cannot be resumed: " + reason + "; without --resume the animation begins anew");
}

const std::map<std::size_t, LoggedFrame>& FrameLog::read() {
  const std::optional<std::vector<std::byte>> bytes = read_back(path_);
  if (!bytes) input_error(path_, "cannot be resumed: it cannot be read");
  std::string_view rest(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  std::map<std::string, std::string> options;
  std::map<std::string, std::uint64_t> lines;
  std::uint64_t number = 0;
  for (std::size_t end = 0; (end = rest.find('\n')) != std::string_view::npos; rest.remove_prefix(end + 1)) {
    const std::string_view line = rest.substr(0, end);
    ++number;
    if (number == 1 && !line.starts_with(kTitle)) refuse(number, "it is no log of gridiron animate");
    if (number == 1 && std::string(line) + "\n" != title_of_this()) {
      refuse(number, "it is of version " + std::string(line.substr(kTitle.size())) + ", this is " + kVersion);
    }
    if (number == 1 || line.starts_with('#')) continue;
    if (line.starts_with(kOption)) {
      const std::string_view words = line.substr(kOption.size());
      const std::size_t space = std::min(words.find(' '), words.size());
      const std::string name(words.substr(0, space));
      options[name] = words.substr(std::min(space + 1, words.size()));
      lines[name] = number;
    } else if (const auto frame =
                   line.starts_with(kFrame) ? frame_of(line.substr(kFrame.size()), number) : std::nullopt) {
      frames_[frame->first] = frame->second;
    } else {
      refuse(number, in_quotes(line) + " is no line of its log");
    }
  }
  if (number == 0) refuse(1, "it is no log of gridiron animate");
  for (const auto& [name, value] : options) {
    const auto now = options_.find(name);
    if (now == options_.end()) refuse(lines[name], name + " was " + in_quotes(value) + " and is not given now");
    if (now->second != value) {
      refuse(lines[name], name + " was " + in_quotes(value) + " and is " + in_quotes(now->second) + " now");
    }
  }
  for (const auto& [name, value] : options_) {
    if (!options.contains(name)) refuse(1, name + " was not given and is " + in_quotes(value) + " now");
  }
  return frames_;
}

void FrameLog::begin() {
  if (descriptor_ >= 0) return;
  AtomicFile file(path_);
  file.write(title_of_this());
  file.write(kComment);
  for (const auto& [name, value] : options_) file.write(std::string(kOption) + name + " " + value + "\n");
  for (const auto& [i, frame] : frames_) file.write(line_of(i, frame));
  check_again(file.target());
  file.commit(/*is_counted=*/false);
  descriptor_ = ::open(file.target().file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) input_error(path_, std::string("cannot write: ") + std::strerror(errno));
}

void FrameLog::add(std::size_t i, const LoggedFrame& frame) {
  const std::string line = line_of(i, frame);
  if (!frames_.empty() && frames_.rbegin()->first > i) is_in_order_ = false;
  frames_[i] = frame;
  errno = 0;
  const ssize_t written = ::write(descriptor_, line.data(), line.size());  // a file takes a short line at once
  if (written == static_cast<ssize_t>(line.size())) return;
  input_error(path_, std::string("cannot write: ") + (errno != 0 ? std::strerror(errno) : "the disk is full"));
}

void FrameLog::put_in_order() {
  if (is_in_order_) return;
  ::close(std::exchange(descriptor_, -1));
  begin();
  is_in_order_ = true;
}

}  // namespace gridiron::tool
