// Model import: the parent's side. It starts the child, reads its answer, and finds out how it ended.
// SPDX-License-Identifier: Apache-2.0
#include "import/model_import.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <utility>

#include "base/failure.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "import/import_child.h"
#include "import/model_stream.h"

extern char** environ;

namespace gridiron::tool {
namespace {

using Clock = std::chrono::steady_clock;

// Set once main has offered to be the child: another program that links this must not start itself.
bool is_served = false;

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void close() {
    if (value_ >= 0) ::close(std::exchange(value_, -1));
  }
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_;
};

// A child that is killed if nobody has waited for it.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ > 0) (void)end();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Kills it unless it has ended. @returns its status as waitpid() gives it.
  int end() {
    ::kill(process_, SIGKILL);
    return wait();
  }
  int wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

 private:
  pid_t process_;
};

enum class Ending { kMore, kEnd, kLate };

// Waits for bytes of a pipe until a moment.
Ending wait_for(int descriptor, Clock::time_point last) {
  while (true) {
    stop_if_interrupted();
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(last - Clock::now()).count();
    if (left <= 0) return Ending::kLate;
    constexpr long long kLongestWait = 1000;
    pollfd wanted{descriptor, POLLIN, 0};
    const int found = ::poll(&wanted, 1, static_cast<int>(std::min<long long>(left, kLongestWait)));
    if (found > 0) return Ending::kMore;
  }
}

Ending fill(int descriptor, std::span<std::byte> target, Clock::time_point last) {
  while (!target.empty()) {
    if (wait_for(descriptor, last) == Ending::kLate) return Ending::kLate;
    const ssize_t got = ::read(descriptor, target.data(), target.size());
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got <= 0) return Ending::kEnd;
    target = target.subspan(static_cast<std::size_t>(got));
  }
  return Ending::kMore;
}

// The model's bytes as a file without a name, which the child maps.
Descriptor as_nameless_file(const InputFile& file, const std::filesystem::path& path) {
  const int descriptor = ::memfd_create("model", MFD_CLOEXEC);
  if (descriptor < 0)
    input_error(path, std::string("cannot be handed to the process that reads it: ") + std::strerror(errno));
  std::span<const std::byte> rest = file.bytes;
  while (!rest.empty()) {
    const ssize_t put = ::write(descriptor, rest.data(), std::min<std::size_t>(rest.size(), std::size_t{1} << 24));
    if (put < 0 && errno == EINTR) {
      stop_if_interrupted();
      continue;
    }
    if (put <= 0) {
      const int error = errno;
      ::close(descriptor);
      input_error(path, std::string("cannot be handed to the process that reads it: ") + std::strerror(error));
    }
    rest = rest.subspan(static_cast<std::size_t>(put));
  }
  return Descriptor(descriptor);
}

pid_t start_child(const ImportRequest& request, std::uint64_t memory_bytes, int model, int answer) {
  const ChildSettings settings{.path = request.path,
                               .ending = request.ending,
                               .memory_bytes = memory_bytes,
                               .cpu_seconds = request.options.most_seconds,
                               .parent = ::getpid(),
                               .moment = request.options.moment,
                               .animation = request.options.animation};
  std::vector<std::string> words = words_of(settings);
  words.insert(words.begin(), {"gridiron", kImportCommand});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  if (posix_spawn_file_actions_init(&files) != 0) throw std::bad_alloc();
  posix_spawn_file_actions_adddup2(&files, model, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, answer, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = -1;
  const int error = posix_spawn(&process, "/proc/self/exe", &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0)
    input_error(request.path, std::string("cannot start a process that reads it: ") + std::strerror(error));
  return process;
}

std::string words_of_signal(int signal, const ImportOptions& limits, std::uint64_t memory_bytes) {
  if (signal == SIGXCPU)
    return "reading it takes more than " + std::to_string(limits.most_seconds) + " s; --import-time allows more";
  const char* const name = ::sigabbrev_np(signal);
  return "the process that reads it was ended by SIG" + std::string(name != nullptr ? name : "?") +
         ": the file is damaged, or asks for more than " + words_of_bytes(memory_bytes) + " (--import-memory)";
}

std::uint64_t usual_memory_bytes() {
  const auto pages = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES)));
  const auto page_bytes = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
  return std::max(std::uint64_t{1} << 30, pages * page_bytes / 2);
}

}  // namespace

bool can_import() {
#ifdef GRIDIRON_HAS_ASSIMP
  return true;
#else
  return false;
#endif
}

std::string words_of_frame(const ImportReport& report) {
  std::string words;
  if (report.unit_metres > 0) {
    constexpr std::pair<double, const char*> kUnits[] = {
        {1.0, "metres"}, {0.01, "centimetres"}, {0.001, "millimetres"}, {0.0254, "inches"}, {0.3048, "feet"}};
    const auto is_same = [&report](const auto& unit) { return std::abs(report.unit_metres / unit.first - 1) < 1e-5; };
    const auto found = std::ranges::find_if(kUnits, is_same);
    char text[64];
    std::snprintf(text, sizeof text, "units of %g m", report.unit_metres);
    words = std::string("in ") + (found != std::end(kUnits) ? found->second : text);
  }
  if (!report.up.empty()) words += (words.empty() ? "" : ", ") + report.up + " up";
  return words;
}

std::string words_of_list(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    list += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return list;
}

ImportedModel import_model(InputFile file, const ImportRequest& request) {
  const ImportOptions& limits = request.options;
  if (!can_import() || !is_served) {
    std::string format = request.ending;
    std::ranges::transform(format, format.begin(),
                           [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
    input_error(request.path, format +
                                  ": this program was built without Assimp, which reads it (GRIDIRON_WITH_ASSIMP); " +
                                  "convert the file to PLY");
  }
  const std::uint64_t memory_bytes = limits.memory_bytes != 0 ? limits.memory_bytes : usual_memory_bytes();
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) input_error(request.path, std::string("cannot be read: ") + std::strerror(errno));
  const Descriptor input(ends[0]);
  Descriptor output(ends[1]);
  Descriptor model = as_nameless_file(file, request.path);
  file = {};
  Child child(start_child(request, memory_bytes, model.value(), output.value()));
  output.close();
  model.close();
  const Clock::time_point last = Clock::now() + std::chrono::seconds(limits.most_seconds);
  Ending ending = Ending::kMore;
  const ByteSource source = [&](std::span<std::byte> target) {
    ending = fill(input.value(), target, last);
    return ending == Ending::kMore;
  };
  try {
    ImportedModel result = read_model(source, memory_bytes);
    (void)child.end();
    return result;
  } catch (const ImportError& error) {
    stop_if_interrupted();  // Ctrl-C ends the child by itself
    if (ending == Ending::kLate) {
      (void)child.end();
      input_error(request.path, words_of_signal(SIGXCPU, limits, memory_bytes));
    }
    if (ending == Ending::kMore) input_error(request.path, error.what());
    // The child's end explains an answer that ends early.
    const int status = child.wait();
    if (WIFSIGNALED(status)) input_error(request.path, words_of_signal(WTERMSIG(status), limits, memory_bytes));
    input_error(request.path, "the process that reads it ended without an answer (exit code " +
                                  std::to_string(WEXITSTATUS(status)) + ")");
  }
}

std::optional<int> serve_import(int count, const char* const* values) {
  is_served = true;
  if (count < 2 || std::strcmp(values[1], kImportCommand) != 0) return std::nullopt;
  const std::optional<ChildSettings> settings =
      settings_of(std::span(values, static_cast<std::size_t>(count)).subspan(2));
  if (!settings) return static_cast<int>(ExitCode::kUsage);
  return run_import_child(*settings);
}

}  // namespace gridiron::tool
