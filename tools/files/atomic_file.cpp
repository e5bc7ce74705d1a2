// AtomicFile. SPDX-License-Identifier: Apache-2.0
#include "atomic_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include "base/failure.h"
#include "command_files.h"
#include "interrupt.h"

namespace gridiron::tool {
namespace {

namespace fs = std::filesystem;

// A signal may come between a check of the flag and a call that blocks, so no call may block for longer than this.
constexpr int kPatienceMilliseconds = 100;

// Waits if the target is a pipe without a reader.
int open_special(const fs::path& file) {
  struct stat status {};
  const bool is_pipe = ::stat(file.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
  while (true) {
    stop_if_interrupted();
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | (is_pipe ? O_NONBLOCK : 0));
    if (descriptor >= 0 || (errno != EINTR && !(is_pipe && errno == ENXIO))) return descriptor;
    (void)::poll(nullptr, 0, kPatienceMilliseconds / 10);
  }
}

// Writes all bytes or returns false with errno set. Errors: Failure if a signal ends the wait for a pipe's reader.
bool write_all(int descriptor, std::span<const std::byte> bytes, bool can_block) {
  constexpr std::size_t kUnblockedBytes = 4096;  // a pipe that is ready takes this many at once
  // Signals do not end a write to a file, which may wait for the disk: a gigabyte takes seconds.
  constexpr std::size_t kMostFileBytes = std::size_t{8} << 20;
  while (!bytes.empty()) {
    stop_if_interrupted();  // a signal also ends a partial write
    if (can_block) {
      pollfd ready{descriptor, POLLOUT, 0};
      if (::poll(&ready, 1, kPatienceMilliseconds) == 0) continue;
    }
    const std::size_t most = std::min(bytes.size(), can_block ? kUnblockedBytes : kMostFileBytes);
    const ssize_t written = ::write(descriptor, bytes.data(), most);
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

// The name does not contain the target's, which may have the maximum length.
std::string pattern_of_temporary(const fs::path& target) {
  return target.parent_path() / ".gridiron.XXXXXX";
}

// A file without a name vanishes with its process, however that ends. @returns -1 where there are none.
int open_nameless(const fs::path& target) {
  const fs::path folder = target.parent_path().empty() ? fs::path(".") : target.parent_path();
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor < 0) return -1;
  // A name is given through /proc, which a container may lack.
  if (::access(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), F_OK) == 0) return descriptor;
  (void)::close(descriptor);
  return -1;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : target_(target_of(path)) {
  if (!target_.is_special) open_temporary();
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  const Undivided step;
  ::unlink(temporary_.c_str());
  leftover_.forget();
}

void AtomicFile::open_temporary() {
  descriptor_ = open_nameless(target_.file);
  is_nameless_ = descriptor_ >= 0;
  if (!is_nameless_) {
    std::string name = pattern_of_temporary(target_.file);
    const Undivided step;
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ < 0) fail("create a temporary file in its folder: ");
    temporary_ = name;
    leftover_.remember(name);
  }

  // The file is private; give it the rights of the file it replaces, or of any new file.
  struct stat replaced {};
  const bool replaces = ::stat(target_.file.c_str(), &replaced) == 0 && S_ISREG(replaced.st_mode);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  const mode_t rights = replaces ? replaced.st_mode & 0777u : 0666u & ~mask;
  if (::fchmod(descriptor_, rights) != 0) fail("set its rights: ");
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (target_.is_special) {
    deferred_.insert(deferred_.end(), bytes.begin(), bytes.end());
  } else if (!write_all(descriptor_, bytes, /*can_block=*/false)) {
    fail("");
  }
}

void AtomicFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text.data(), text.size())));
}

void AtomicFile::name_temporary() {
  constexpr int kMostTries = 100;
  const std::string file = "/proc/self/fd/" + std::to_string(descriptor_);
  const Undivided step;
  for (int i = 0; i < kMostTries; ++i) {
    std::string name = pattern_of_temporary(target_.file);
    std::random_device random;
    std::generate(name.end() - 6, name.end(), [&random] { return "0123456789abcdefghijklmnopqrstuv"[random() % 32]; });
    if (::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      temporary_ = name;
      leftover_.remember(name);
      is_nameless_ = false;
      return;
    }
    if (errno != EEXIST) break;
  }
  fail("name its temporary file: ");
}

void AtomicFile::finish() {
  if (descriptor_ < 0) return;
  if (is_nameless_) name_temporary();
  // Some file systems report a full disk only here. The descriptor is closed even after a signal.
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed != 0 && errno != EINTR) fail("close: ");
}

void AtomicFile::write_through() {
  const bool is_own = target_.descriptor < 0;
  const int descriptor = is_own ? descriptor_ = open_special(target_.file) : target_.descriptor;
  if (descriptor < 0 || !write_all(descriptor, deferred_, /*can_block=*/true)) fail("");
  finish();
}

void AtomicFile::commit(bool is_counted) {
  if (target_.is_special) {
    write_through();
    return;
  }
  finish();
  const Undivided step;
  if (::rename(temporary_.c_str(), target_.file.c_str()) != 0) fail("rename into place: ");
  temporary_.clear();
  leftover_.forget();
  if (is_counted) count_written_file();
}

void AtomicFile::fail(const char* action) {
  const std::string reason = std::strerror(errno);
  input_error(target_.name, std::string("cannot write: ") + action + reason);
}

AtomicFile& AtomicFiles::begin(const fs::path& path) {
  stop_if_interrupted();
  return files_.emplace_back(path);
}

void AtomicFiles::commit() {
  stop_if_interrupted();
  for (const AtomicFile& file : files_) check_again(file.target());
  for (AtomicFile& file : files_) {
    if (file.target().is_special) file.commit();
  }
  stop_if_interrupted();
  const Undivided all;
  for (AtomicFile& file : files_) {
    if (!file.target().is_special) file.commit();
  }
}

void AtomicFiles::commit_at_end() {
  const Undivided all;
  commit();
  outputs_are_complete();
}

}  // namespace gridiron::tool
