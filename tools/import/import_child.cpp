// Import child. SPDX-License-Identifier: Apache-2.0
#include "import/import_child.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "base/numbers.h"
#include "base/words.h"
#include "import/model_stream.h"

namespace gridiron::tool {
namespace {

bool write_all(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
  return true;
}

void set_limit(decltype(RLIMIT_AS) kind, std::uint64_t soft, std::uint64_t hard) {
  const rlimit limit{soft, hard};
  (void)::setrlimit(kind, &limit);
}

// Bytes of address space that the program has already.
std::uint64_t own_bytes() {
  unsigned long long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

// From here on the process can read files, and little else.
void limit_self(const ChildSettings& settings, std::uint64_t model_bytes) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != settings.parent) ::_exit(1);  // it has ended already
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  set_limit(RLIMIT_CORE, 0, 0);
  set_limit(RLIMIT_FSIZE, 0, 0);  // no file is written; a pipe is none
  set_limit(RLIMIT_CPU, settings.cpu_seconds, settings.cpu_seconds + 1u);
  const std::uint64_t bytes = own_bytes() + model_bytes + settings.memory_bytes;
  set_limit(RLIMIT_AS, bytes, bytes);
}

}  // namespace

std::vector<std::string> words_of(const ChildSettings& settings) {
  std::vector<std::string> words = {settings.path.string(),
                                    settings.ending,
                                    std::to_string(settings.memory_bytes),
                                    std::to_string(settings.cpu_seconds),
                                    std::to_string(settings.parent),
                                    "rest",
                                    settings.animation};
  if (settings.moment) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", *settings.moment);
    words[5] = text;
  }
  return words;
}

std::optional<ChildSettings> settings_of(std::span<const char* const> words) {
  constexpr std::size_t kCount = 7;
  if (words.size() != kCount) return std::nullopt;
  const auto number = [](const char* word) { return std::strtoull(word, nullptr, 10); };
  ChildSettings settings{.path = words[0],
                         .ending = words[1],
                         .memory_bytes = number(words[2]),
                         .cpu_seconds = static_cast<std::uint32_t>(number(words[3])),
                         .parent = static_cast<pid_t>(number(words[4])),
                         .moment = std::nullopt,
                         .animation = words[6]};
  if (std::strcmp(words[5], "rest") != 0) settings.moment = std::strtod(words[5], nullptr);
  return settings;
}

int run_import_child(const ChildSettings& settings) {
  struct stat status {};
  if (::fstat(STDIN_FILENO, &status) != 0) return 1;
  const auto size = static_cast<std::size_t>(status.st_size);
  limit_self(settings, size);
  std::string reason;
  bool is_written = false;
  try {
    std::span<const std::byte> bytes;
    if (size != 0) {
      const void* const place = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
      if (place == MAP_FAILED) throw std::bad_alloc();
      bytes = {static_cast<const std::byte*>(place), size};
    }
    is_written = write_model(read_with_assimp(bytes, settings), write_all);
  } catch (const std::bad_alloc&) {
    reason = "reading it needs more than " + words_of_bytes(settings.memory_bytes) + "; --import-memory allows more";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!reason.empty()) is_written = write_reason(reason, write_all);
  // Without destructors: a library's end cannot spoil an answer that is complete.
  ::_exit(is_written ? 0 : 1);
}

}  // namespace gridiron::tool
