// Input files. SPDX-License-Identifier: Apache-2.0
#include "input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "command_files.h"
#include "failure.h"
#include "interrupt.h"

namespace gridiron::tool {
namespace {

// Scans that the repository does not carry.
constexpr std::array<std::string_view, 4> kFetchedScans = {"bunny.ply", "horse.ply", "armadillo.ply", "dragon.ply"};
constexpr std::array<std::string_view, 5> kOtherScans = {"conference.ply", "sponza_dabrovic.ply", "cornell_box.ply",
                                                         "armadillo_standin_345944.ply", "stanford_dragon_res2.ply"};

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_;
};

// Waits where the path is a pipe that nobody writes to yet.
int open_for_reading(const std::filesystem::path& path) {
  while (true) {
    stop_if_interrupted();
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor >= 0 || errno != EINTR) return descriptor;
  }
}

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  std::string message = path.string() + ": " + std::strerror(error);
  const std::string name = path.filename().string();
  const auto is_one_of = [&name](const auto& names) { return std::ranges::find(names, name) != names.end(); };
  if (error == ENOENT && is_one_of(kFetchedScans)) {
    message += "; " + name + " is a public scan that this repository does not carry: tools/fetch_scenes gets it";
  } else if (error == ENOENT && is_one_of(kOtherScans)) {
    message += "; this repository does not carry it: 'tools/fetch_scenes --help' says where it comes from";
  }
  throw Failure(ExitCode::kBadInput, message);
}

}  // namespace

InputFile read_input_file(const std::filesystem::path& path, std::size_t most_bytes) {
  note_input(path);
  const Descriptor file(open_for_reading(path));
  struct stat status {};
  if (file.value() < 0 || ::fstat(file.value(), &status) != 0) fail(path, errno);
  if (S_ISDIR(status.st_mode)) fail(path, EISDIR);

  // A pipe has no size: start small and grow. One byte more than the size lets the first read meet the end.
  constexpr std::size_t kReadBytes = std::size_t{16} << 20;
  std::size_t capacity = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : kReadBytes;
  InputFile input{allocate_aligned(capacity), {}};
  std::size_t used = 0;
  while (true) {
    stop_if_interrupted();
    if (used == capacity) {
      AlignedBytes larger = allocate_aligned(capacity * 2);
      std::memcpy(larger.get(), input.storage.get(), used);
      input.storage = std::move(larger);
      capacity *= 2;
    }
    const ssize_t got = ::read(file.value(), input.storage.get() + used, std::min(capacity - used, kReadBytes));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, errno);
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
    if (used > most_bytes) fail(path, EFBIG);
  }
  input.bytes = {input.storage.get(), used};
  return input;
}

}  // namespace gridiron::tool
