// AtomicFile. SPDX-License-Identifier: Apache-2.0
#include "atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "failure.h"
#include "interrupt.h"

namespace gridiron::tool {
namespace {

namespace fs = std::filesystem;

Failure cannot_write(const fs::path& path, const std::string& reason) {
  return {ExitCode::kBadInput, path.string() + ": cannot write: " + reason};
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

bool is_special_file(const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// Waits where the target is a pipe that nobody reads from yet.
int open_for_writing(const fs::path& target) {
  while (true) {
    stop_if_interrupted();
    const int descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor >= 0 || errno != EINTR) return descriptor;
  }
}

// Writes all bytes or returns false with errno set. Errors: Failure where a signal ends the wait for a pipe's reader.
bool write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    stop_if_interrupted();  // a signal also ends a write of which a part is done
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

fs::path resolve_target(const fs::path& path) {
  constexpr int kMostLinks = 40;
  fs::path target = path;
  std::error_code error;
  for (int link = 0; link < kMostLinks && fs::is_symlink(target, error); ++link) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
    target = next.is_absolute() ? next : folder_of(target) / next;
  }
  return target;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::is_character_file(a, error)) return false;
  if (fs::equivalent(a, b, error)) return true;
  const auto target = [&error](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(resolve_target(path), error), error);
  };
  return !target(a).empty() && target(a) == target(b);
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)), target_(resolve_target(path_)) {
  check_can_write(path_);
  if (is_special_file(target_)) {
    is_special_ = true;
    return;
  }
  std::string hidden_name(1, '.');
  hidden_name.append(target_.filename().string()).append(".XXXXXX");
  std::string name = (folder_of(target_) / hidden_name).string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("create a temporary file beside it");
  temporary_ = name;

  // mkostemp makes the file private; give it the rights any new file would have.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  if (::fchmod(descriptor_, 0666 & ~mask) != 0) fail("set its rights");
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (is_special_) {
    deferred_.insert(deferred_.end(), bytes.begin(), bytes.end());
  } else if (!write_all(descriptor_, bytes)) {
    fail("write");
  }
}

void AtomicFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text.data(), text.size())));
}

void AtomicFile::commit() {
  if (is_special_) {
    descriptor_ = open_for_writing(target_);
    if (descriptor_ < 0 || !write_all(descriptor_, deferred_)) fail("write");
  }
  // Some file systems report a full disk only here. After a signal the descriptor is closed all the same.
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed != 0 && errno != EINTR) fail("close");
  if (is_special_) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("rename into place");
  temporary_.clear();
}

void AtomicFile::fail(const char* action) {
  const std::string reason = std::strerror(errno);
  throw cannot_write(path_, std::string(action) + ": " + reason);
}

AtomicFile& AtomicFiles::open(const fs::path& path) {
  stop_if_interrupted();
  return files_.emplace_back(path);
}

void AtomicFiles::commit() {
  stop_if_interrupted();
  for (AtomicFile& file : files_) {
    if (file.is_special()) file.commit();
  }
  for (AtomicFile& file : files_) {
    if (!file.is_special()) file.commit();
  }
}

void check_can_write(const fs::path& path) {
  if (!path.has_filename()) throw cannot_write(path, "not a file name");
  const fs::path target = resolve_target(path);
  std::error_code error;
  if (fs::is_directory(target, error)) throw cannot_write(path, "it is a folder");
  const fs::path folder = folder_of(target);
  if (!fs::exists(folder, error)) throw cannot_write(path, "folder " + folder.string() + " does not exist");
  if (!fs::is_directory(folder, error)) throw cannot_write(path, folder.string() + " is not a folder");
  if (is_special_file(target)) return;
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    const std::string reason = std::strerror(errno);
    throw cannot_write(path, "folder " + folder.string() + ": " + reason);
  }
}

}  // namespace gridiron::tool
