// Output target. SPDX-License-Identifier: Apache-2.0
#include "output_target.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include "base/failure.h"

namespace gridiron::tool {
namespace {

namespace fs = std::filesystem;

Failure cannot_write(const fs::path& name, const std::string& reason) {
  return {ExitCode::kBadInput, name.string() + ": cannot write: " + reason};
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// The number N of /dev/fd/N and its other names, which lie in a folder of the process itself.
std::optional<int> descriptor_of(const fs::path& path) {
  const std::string name = path.filename().string();
  if (name.empty() || name.size() > 6 || name.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  std::error_code error;
  const std::string folder = fs::canonical(folder_of(path), error).string();
  const std::string process = "/proc/" + std::to_string(::getpid());
  const bool is_own = folder == process + "/fd" || (folder.starts_with(process + "/task/") && folder.ends_with("/fd"));
  if (error || !is_own) return std::nullopt;
  return std::stoi(name);
}

OutputTarget descriptor_target(const fs::path& name, int descriptor) {
  const int flags = ::fcntl(descriptor, F_GETFD), mode = ::fcntl(descriptor, F_GETFL);
  // Descriptors that the program opened close on exec; inherited ones do not.
  if (flags < 0 || mode < 0 || (flags & FD_CLOEXEC) != 0) throw cannot_write(name, std::strerror(EBADF));
  if ((mode & O_ACCMODE) == O_RDONLY) throw cannot_write(name, "it is not open for writing");
  return {name, {}, descriptor, true};
}

bool is_special_file(const struct stat& status) {
  return !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

// Whether the folder lets only the owner of a file replace it, as /tmp does, and the file belongs to somebody else.
bool is_protected_by_folder(const struct stat& folder, const struct stat& file) {
  const uid_t user = ::geteuid();
  return (folder.st_mode & S_ISVTX) != 0 && user != 0 && user != folder.st_uid && user != file.st_uid;
}

void check_folder(const OutputTarget& target, struct stat& status) {
  const fs::path folder = folder_of(target.file);
  const auto fail = [&target, &folder](const std::string& reason) {
    throw cannot_write(target.name, "folder " + folder.string() + reason);
  };
  if (::stat(folder.c_str(), &status) != 0) {
    fail(errno == ENOENT ? " does not exist" : ": " + std::string(std::strerror(errno)));
  }
  if (!S_ISDIR(status.st_mode)) throw cannot_write(target.name, folder.string() + " is not a folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(": " + std::string(std::strerror(errno)));
}

// Devices and sockets have no content that a second writer could destroy.
std::string identity_of(const struct stat& status) {
  if (S_ISCHR(status.st_mode) || S_ISSOCK(status.st_mode)) return "";
  return "file " + std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

std::string identity_of_name(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return identity_of(status);
  std::error_code error;
  return "name " + fs::weakly_canonical(fs::absolute(path, error), error).string();
}

}  // namespace

OutputTarget resolve_output(const fs::path& name) {
  if (name == "-") return descriptor_target("standard output", STDOUT_FILENO);
  constexpr int kMostLinks = 40;
  OutputTarget target{name, name};
  struct stat status {};
  bool exists = false;
  for (int link = 0;; ++link) {
    if (const std::optional<int> descriptor = descriptor_of(target.file)) return descriptor_target(name, *descriptor);
    exists = ::stat(target.file.c_str(), &status) == 0;
    if (!exists && errno != ENOENT && errno != ENOTDIR && errno != EACCES) {
      throw cannot_write(name, std::strerror(errno));
    }
    std::error_code error;
    if (!fs::is_symlink(target.file, error)) break;
    fs::path next = fs::read_symlink(target.file, error);
    if (error || link == kMostLinks) throw cannot_write(name, error ? error.message() : std::strerror(ELOOP));
    if (next.is_relative()) next = folder_of(target.file) / next;
    struct stat next_status {};
    if (exists && ::stat(next.c_str(), &next_status) != 0) {
      target.is_special = true;  // a link whose text is no path: a pipe or an open file of another process
      return target;
    }
    target.file = next;
  }
  if (exists && S_ISSOCK(status.st_mode)) throw cannot_write(name, "it is a socket");
  target.is_special = exists && is_special_file(status);
  if (target.is_special) return target;
  if (exists && S_ISDIR(status.st_mode)) throw cannot_write(name, "it is a folder");
  if (!target.file.has_filename()) throw cannot_write(name, "not a file name");
  struct stat folder {};
  check_folder(target, folder);
  if (exists && ::access(target.file.c_str(), W_OK) != 0) {
    throw cannot_write(name, errno == EACCES ? "the file is write-protected" : std::strerror(errno));
  }
  if (exists && is_protected_by_folder(folder, status)) {
    throw cannot_write(name, "the file is another user's, and only its owner may replace it in this folder");
  }
  return target;
}

bool has_ending(const fs::path& path, std::string_view ending) {
  return std::ranges::equal(path.extension().string(), ending,
                            [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

bool is_terminal(const OutputTarget& target) {
  if (target.descriptor >= 0) return ::isatty(target.descriptor) == 1;
  std::error_code error;
  if (!target.is_special || !fs::is_character_file(target.file, error)) return false;
  const int descriptor = ::open(target.file.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  const bool is = descriptor >= 0 && ::isatty(descriptor) == 1;
  if (descriptor >= 0) ::close(descriptor);
  return is;
}

std::string identity_of(const OutputTarget& target) {
  if (target.descriptor < 0) return identity_of_name(target.file);
  struct stat status {};
  return ::fstat(target.descriptor, &status) == 0 ? identity_of(status) : "";
}

std::string identity_of_input(const fs::path& path) {
  struct stat status {};
  if (path == "-") return ::fstat(STDIN_FILENO, &status) == 0 ? identity_of(status) : "";
  return identity_of_name(path);
}

}  // namespace gridiron::tool
