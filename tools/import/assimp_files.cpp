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
#include "import/model_text.h"

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

// "mtl" of "a.MTL".
std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return ending.empty() ? ending : ending.substr(1);
}

}  // namespace

std::string without_percents(const std::string& text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
      plain += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
      i += 2;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

AssimpFiles::AssimpFiles(std::string name, std::span<const std::byte> bytes)
    : name_(std::move(name)), readable_(readable_bytes(bytes, ending_of(name_))), bytes_(bytes) {
  if (readable_) bytes_ = *readable_;
}

bool AssimpFiles::Exists(const char* path) const {
  if (path == name_) return true;
  struct stat status {};
  for (const std::string& each : {std::string(path), without_percents(path)}) {
    if (::stat(each.c_str(), &status) == 0 && S_ISREG(status.st_mode)) return true;
  }
  return false;
}

std::optional<std::span<const std::byte>> AssimpFiles::read(const std::string& path) {
  if (path == name_) return bytes_;
  for (const std::string& each : {path, without_percents(path)}) {
    auto found = files_.find(each);
    if (found == files_.end()) {
      std::optional<std::vector<std::byte>> bytes = read_plain_file(each);
      if (!bytes) continue;
      const std::uint64_t content = content_hash(*bytes);
      if (auto readable = readable_bytes(*bytes, ending_of(each))) bytes = std::move(readable);
      found = files_.emplace(each, File{std::move(*bytes), content}).first;
    }
    return std::span<const std::byte>(found->second.bytes);
  }
  constexpr std::size_t kMostListed = 1000;
  if (missing_.size() < kMostListed) missing_.insert(path);
  return std::nullopt;
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
  for (const auto& [path, file] : files_) list.push_back({path, file.content});
  return list;
}

}  // namespace gridiron::tool
