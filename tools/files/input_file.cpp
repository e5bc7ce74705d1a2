// Input files. SPDX-License-Identifier: Apache-2.0
#include "input_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/content_hash.h"
#include "command_files.h"
#include "file_kind.h"
#include "interrupt.h"

namespace gridiron::tool {
namespace {

// Scans that are not in the repository.
constexpr std::array<std::string_view, 4> kFetchedScans = {"bunny.ply", "horse.ply", "armadillo.ply", "dragon.ply"};
constexpr std::array<std::string_view, 5> kOtherScans = {"conference.ply", "sponza_dabrovic.ply", "cornell_box.ply",
                                                         "armadillo_standin_345944.ply", "stanford_dragon_res2.ply"};

InputHash* input_hash = nullptr;

// Standard input by its usual names.
bool is_standard_input(const std::filesystem::path& path) {
  return path == "/dev/stdin" || path == "/dev/fd/0" || path == "/proc/self/fd/0";
}

// Waits if the path is a pipe without a writer.
int open_for_reading(const std::filesystem::path& path) {
  // Duplicates the descriptor itself: it may be a socket, which has no name to open, or be in the middle of a file.
  if (is_standard_input(path)) return ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
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
    message += "; it is not in the repository: 'tools/fetch_scenes --help' names its source";
  }
  throw Failure(ExitCode::kBadInput, message);
}

std::uint64_t joined_hash(std::uint64_t one, std::uint64_t other) {
  const std::uint64_t values[] = {one, other};
  return content_hash(std::as_bytes(std::span(values)));
}

// Passes bytes on piece by piece, each with its place, and then returns the piece's memory to the host.
template <class Action>
void for_each_piece(std::span<std::byte> bytes, Action action) {
  constexpr std::size_t kPieceBytes = std::size_t{16} << 20;
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  for (std::size_t place = 0; place < bytes.size(); place += kPieceBytes) {
    const std::span<std::byte> piece = bytes.subspan(place, std::min(kPieceBytes, bytes.size() - place));
    action(piece, place);
    // Whole pages only; the owner frees the rest.
    const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(piece.data());
    const std::uintptr_t begin = (first + page - 1) / page * page, end = (first + piece.size()) / page * page;
    if (begin < end) (void)::madvise(piece.data() + (begin - first), end - begin, MADV_DONTNEED);
  }
}

}  // namespace

InputReader::InputReader(std::filesystem::path path, std::string expected)
    : path_(std::move(path)), expected_(std::move(expected)) {
  note_input(path_);
  descriptor_ = open_for_reading(path_);
  try {
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) fail(path_, errno);
    if (S_ISDIR(status.st_mode)) {
      input_error(path_, "is a folder; " + expected_);
    }
    if (S_ISREG(status.st_mode)) file_bytes_ = static_cast<std::uint64_t>(status.st_size);
    head_.resize(kHeadBytes);
    head_.resize(read_some(head_));
  } catch (...) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw;
  }
}

InputReader::~InputReader() {
  ::close(descriptor_);
}

// Fills the target, or a part of it at the end of the input.
std::size_t InputReader::read_some(std::span<std::byte> target) const {
  std::size_t used = 0;
  while (used < target.size()) {
    stop_if_interrupted();
    const ssize_t got = ::read(descriptor_, target.data() + used, target.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path_, errno);
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  return used;
}

InputFile InputReader::read_all(std::size_t most_bytes) {
  if (file_bytes_ && *file_bytes_ > most_bytes) fail(path_, EFBIG);
  InputFile file = name_in_shortage(path_, "read it", [&] { return read_rest(most_bytes); });
  if (input_hash != nullptr) input_hash->value_ = joined_hash(input_hash->value_, content_hash(file.bytes));
  return file;
}

InputFile InputReader::read_rest(std::size_t most_bytes) const {
  // A pipe has no size: start small and grow. One byte more than the size lets the first read detect the end.
  constexpr std::size_t kReadBytes = std::size_t{16} << 20;
  std::size_t capacity = file_bytes_ ? static_cast<std::size_t>(*file_bytes_) + 1 : kReadBytes;
  capacity = std::max(capacity, head_.size() + 1);
  InputFile input{allocate_aligned(capacity), {}};
  std::memcpy(input.storage.get(), head_.data(), head_.size());
  std::size_t used = head_.size();
  while (true) {
    if (used > most_bytes) fail(path_, EFBIG);
    if (used == capacity) {
      AlignedBytes larger = allocate_aligned(capacity * 2);
      move_bytes({input.storage.get(), used}, larger.get());
      input.storage = std::move(larger);
      capacity *= 2;
    }
    const std::size_t got = read_some({input.storage.get() + used, std::min(capacity - used, kReadBytes)});
    if (got == 0) break;
    used += got;
  }
  input.bytes = {input.storage.get(), used};
  return input;
}

void InputReader::refuse_content() const {
  input_error(path_, words_of_content(head_, file_bytes_) + "; " + expected_);
}

InputHash::InputHash() {
  input_hash = this;
}

InputHash::~InputHash() {
  input_hash = nullptr;
}

void note_read_file(const std::filesystem::path& path, std::uint64_t content) {
  note_input(path);
  if (input_hash != nullptr) input_hash->value_ = joined_hash(input_hash->value_, content);
}

InputFile read_input_file(const std::filesystem::path& path, const std::string& expected, std::size_t most_bytes) {
  return InputReader(path, expected).read_all(most_bytes);
}

InputFile read_text_file(const std::filesystem::path& path, const std::string& expected, std::size_t most_bytes) {
  InputReader reader(path, expected);
  if (reader.head().empty() || words_of_marked_content(reader.head()) != nullptr) reader.refuse_content();
  return reader.read_all(most_bytes);
}

void move_bytes(std::span<std::byte> from, std::byte* target) {
  for_each_piece(from, [&](std::span<const std::byte> piece, std::size_t place) {
    std::memcpy(target + place, piece.data(), piece.size());
  });
}

void append_moved(std::vector<std::byte>& target, std::span<std::byte> from) {
  for_each_piece(from, [&](std::span<const std::byte> piece, std::size_t) {
    target.insert(target.end(), piece.begin(), piece.end());
  });
}

std::filesystem::path input_path(const std::filesystem::path& name) {
  return name == "-" ? std::filesystem::path("/dev/stdin") : name;
}

bool is_descriptor(const std::filesystem::path& path) {
  const std::string folder = path.parent_path().string();
  return is_standard_input(path) || folder == "/dev/fd" || folder == "/proc/self/fd";
}

bool is_stream(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  return is_descriptor(path) || std::filesystem::is_fifo(status) || std::filesystem::is_character_file(status) ||
         std::filesystem::is_socket(status);
}

bool share_a_stream(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (!is_stream(a) || !is_stream(b)) return false;
  if (a == b || (is_standard_input(a) && is_standard_input(b))) return true;
  struct stat one {
  }, other{};
  return ::stat(a.c_str(), &one) == 0 && ::stat(b.c_str(), &other) == 0 && one.st_dev == other.st_dev &&
         one.st_ino == other.st_ino;
}

std::filesystem::path folder_of_input(const std::filesystem::path& path) {
  return is_stream(path) ? std::filesystem::path() : path.parent_path();
}

}  // namespace gridiron::tool
