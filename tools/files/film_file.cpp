// Film file. SPDX-License-Identifier: Apache-2.0
#include "film_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/words.h"
#include "interrupt.h"

namespace gridiron::tool {
namespace {

constexpr int kFilmDescriptor = 3;  // of ffmpeg

// The program's path; empty if there is none.
std::string find_ffmpeg() {
  const char* const folders = std::getenv("PATH");
  std::string rest = folders != nullptr ? folders : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::string path = rest.substr(0, end) + "/ffmpeg";
    struct stat status {};
    const bool is_program = end != 0 && ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
    if (is_program && ::access(path.c_str(), X_OK) == 0) return path;
    rest.erase(0, end + 1);
  }
  return {};
}

// Words after the input. Most players need even sizes for 4:2:0, and take the colours of such films for BT.709.
std::vector<std::string> words_of_format(const std::filesystem::path& film) {
  if (has_ending(film, ".gif")) {  // a palette for each frame, so that frames need not be kept
    return {"-filter_complex", "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1", "-f", "gif"};
  }
  std::vector<std::string> words = {"-vf",
                                    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709,format=yuv420p",
                                    "-colorspace",
                                    "bt709",
                                    "-color_primaries",
                                    "bt709",
                                    "-color_trc",
                                    "bt709"};
  const std::vector<std::string> container = has_ending(film, ".webm")
                                                 ? std::vector<std::string>{"-b:v", "0", "-crf", "24", "-f", "webm"}
                                                 : std::vector<std::string>{"-movflags", "+faststart", "-f", "mp4"};
  words.insert(words.end(), container.begin(), container.end());
  return words;
}

void close_one(int& descriptor) {
  if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
}

}  // namespace

void require_ffmpeg(const std::filesystem::path& film) {
  if (!find_ffmpeg().empty()) return;
  input_error(film,
              "cannot write: no folder of PATH has ffmpeg, which makes films of pictures; without --film there "
              "are the pictures alone");
}

FilmMaker::FilmMaker(const AtomicFile& file, float frames_per_second)
    : name_(file.target().name), program_(find_ffmpeg()) {
  require_ffmpeg(name_);
  words_ = {program_, "-nostdin", "-hide_banner", "-loglevel",  "error",
            "-y",     "-f",       "image2pipe",   "-framerate", shortest_text(frames_per_second),
            "-c:v",   "png",      "-i",           "pipe:0"};
  for (std::string& word : words_of_format(file.target().name)) words_.push_back(std::move(word));
  words_.push_back("file:/dev/fd/" + std::to_string(kFilmDescriptor));
  start(file.descriptor());
}

FilmMaker::~FilmMaker() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  close_one(pictures_);
  close_one(messages_);
}

void FilmMaker::start(int film) {
  std::vector<char*> values;
  for (std::string& word : words_) values.push_back(word.data());
  values.push_back(nullptr);
  messages_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  int ends[2] = {-1, -1};
  if (messages_ < 0 || ::pipe2(ends, O_CLOEXEC) != 0) fail(std::strerror(errno));
  pictures_ = ends[1];
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ != 0) {
    const int error = errno;
    ::close(ends[0]);
    if (process_ < 0) fail(std::strerror(error));
    return;
  }
  // In the child only calls that are safe after a fork. It gets no signals of the terminal: this process decides.
  ::signal(SIGPIPE, SIG_DFL);
  ::signal(SIGXFSZ, SIG_DFL);
  (void)::setpgid(0, 0);
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const bool is_ready = ::getppid() == parent && ::dup2(ends[0], STDIN_FILENO) >= 0 &&
                        ::dup2(messages_, STDOUT_FILENO) >= 0 && ::dup2(messages_, STDERR_FILENO) >= 0 &&
                        ::dup2(film, kFilmDescriptor) >= 0 && ::fcntl(kFilmDescriptor, F_SETFD, 0) == 0;
  if (is_ready) ::execv(program_.c_str(), values.data());
  ::_exit(127);
}

void FilmMaker::add(std::span<const std::byte> png) {
  while (!png.empty()) {
    stop_if_interrupted();
    const ssize_t written = ::write(pictures_, png.data(), png.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == EPIPE) fail_as_ffmpeg(wait());
    if (written < 0) fail(std::strerror(errno));
    png = png.subspan(static_cast<std::size_t>(written));
  }
}

void FilmMaker::finish() {
  close_one(pictures_);
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail_as_ffmpeg(status);
}

int FilmMaker::wait() {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0) {
    stop_if_interrupted();
    if (errno != EINTR) fail(std::strerror(errno));
  }
  process_ = -1;
  return status;
}

void FilmMaker::fail(const std::string& reason) const {
  input_error(name_, "cannot write: " + reason);
}

// The last line of its messages says most.
void FilmMaker::fail_as_ffmpeg(int status) const {
  constexpr std::size_t kMostBytes = 4096;
  std::string text(kMostBytes, '\0');
  const off_t end = ::lseek(messages_, 0, SEEK_END);
  const ssize_t got = ::pread(messages_, text.data(), text.size(), std::max<off_t>(0, end - off_t{kMostBytes}));
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  text.erase(std::min(text.find_last_not_of(" \r\n") + 1, text.size()));
  const std::string line = text.substr(text.find_last_of("\r\n") + 1);
  const std::string how = WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                            : "signal " + std::to_string(WTERMSIG(status));
  fail("ffmpeg ended with " + how + (line.empty() ? "" : ": " + in_quotes(line)));
}

std::optional<std::vector<std::byte>> read_back(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) return std::nullopt;
  std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
  std::size_t used = 0;
  while (used < bytes.size()) {
    const ssize_t got = ::read(descriptor, bytes.data() + used, bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    used += static_cast<std::size_t>(got);
  }
  ::close(descriptor);
  return used == bytes.size() ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace gridiron::tool
