// Assimp files. SPDX-License-Identifier: Apache-2.0
#include "import/assimp_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cerrno>
#include <cstring>

#include "base/content_hash.h"

namespace gridiron::tool {
namespace {

class MemoryFile final : public Assimp::IOStream {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::size_t Read(void* target, std::size_t item_bytes, std::size_t count) override {
    if (item_bytes == 0 || count == 0) return 0;
    const std::size_t items = std::min(count, (bytes_.size() - place_) / item_bytes);
    if (items != 0) std::memcpy(target, bytes_.data() + place_, items * item_bytes);
    place_ += items * item_bytes;
    return items;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    std::size_t target = offset;
    if (origin == aiOrigin_CUR) target = place_ + offset;
    if (origin == aiOrigin_END) target = bytes_.size() - offset;
    if (target > bytes_.size()) return aiReturn_FAILURE;
    place_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return place_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::span<const std::byte> bytes_;
  std::size_t place_ = 0;
};

// A plain file's bytes; a folder, a pipe or a device is none.
std::optional<std::vector<std::byte>> read_plain_file(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return std::nullopt;
  struct stat status {};
  std::optional<std::vector<std::byte>> bytes;
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)) {
    bytes.emplace(static_cast<std::size_t>(status.st_size));
    std::size_t used = 0;
    while (used < bytes->size()) {
      const ssize_t got = ::read(descriptor, bytes->data() + used, bytes->size() - used);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      used += static_cast<std::size_t>(got);
    }
    bytes->resize(used);
  }
  ::close(descriptor);
  return bytes;
}

}  // namespace

bool AssimpFiles::Exists(const char* path) const {
  if (path == name_) return true;
  struct stat status {};
  return ::stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

std::optional<std::span<const std::byte>> AssimpFiles::read(const std::string& path) {
  if (path == name_) return bytes_;
  auto found = files_.find(path);
  if (found == files_.end()) {
    std::optional<std::vector<std::byte>> bytes = read_plain_file(path);
    if (!bytes) {
      constexpr std::size_t kMostListed = 1000;
      if (missing_.size() < kMostListed) missing_.insert(path);
      return std::nullopt;
    }
    found = files_.emplace(path, std::move(*bytes)).first;
  }
  return std::span<const std::byte>(found->second);
}

Assimp::IOStream* AssimpFiles::Open(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
  const std::optional<std::span<const std::byte>> bytes = read(path);
  return bytes ? new MemoryFile(*bytes) : nullptr;
}

void AssimpFiles::Close(Assimp::IOStream* file) {
  delete file;
}

std::vector<NeighbourFile> AssimpFiles::neighbours() const {
  std::vector<NeighbourFile> list;
  for (const auto& [path, bytes] : files_) list.push_back({path, content_hash(bytes)});
  return list;
}

}  // namespace gridiron::tool
