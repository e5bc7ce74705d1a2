// Overdue exit. SPDX-License-Identifier: Apache-2.0
#include "overdue_exit.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <utility>

namespace gridiron::tool {
namespace {

constexpr long kPatienceNanoseconds = 250'000'000;  // before the first look
constexpr long kAgainNanoseconds = 10'000'000;      // between looks while something undivided is done

std::atomic<bool> has_timer{false}, is_expected{false}, is_complete{false}, is_on_terminal{false};
std::atomic<int> exit_code{0}, undivided_count{0}, leaving_count{0};
std::atomic<unsigned> written_count{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

timer_t timer;
std::mutex list_mutex;               // locked by changes of the list; the handler reads it while none is made
Leftover* first_leftover = nullptr;  // the newest, so that files go before their folder

void arm(long nanoseconds) {
  itimerspec after{};
  after.it_value.tv_nsec = nanoseconds;
  (void)::timer_settime(timer, 0, &after, nullptr);
}

std::atomic<int> words_descriptor{STDERR_FILENO};

// Prints as main does, without memory or locks.
void say_interrupted() {
  char words[96] = "";
  char digits[12] = "";
  char* digit = digits + sizeof digits - 1;
  const unsigned count = written_count.load();
  for (unsigned rest = count; rest != 0; rest /= 10) *--digit = static_cast<char>('0' + rest % 10);
  std::strcat(words, is_on_terminal.load() ? "\r\033[Kinterrupted; " : "interrupted; ");
  std::strcat(words, count == 0 ? "no file was written" : digit);
  if (count != 0) {
    std::strcat(words, count == 1 ? " file was written before that and is kept"
                                  : " files were written before that and are kept");
  }
  std::strcat(words, "\n");
  (void)!::write(words_descriptor.load(), words, std::strlen(words));
}

}  // namespace

void remove_leftovers() {
  for (const Leftover* leftover = first_leftover; leftover != nullptr; leftover = leftover->next_) {
    const char* const path = leftover->path_.c_str();
    if (::unlink(path) != 0) (void)::rmdir(path);
  }
}

namespace {

extern "C" void leave_if_overdue(int) {
  const int error = errno;
  // An Undivided that begins after this line waits; this waits for those that began before.
  ++leaving_count;
  const bool is_busy = undivided_count.load() != 0;
  if (!is_busy && !is_complete.load()) {
    remove_leftovers();
    say_interrupted();
    ::_exit(exit_code.load());
  }
  --leaving_count;
  if (is_busy) arm(kAgainNanoseconds);
  errno = error;
}

}  // namespace

void begin_overdue_exit() {
  struct sigaction action {};
  action.sa_handler = leave_if_overdue;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // where the program stays, no call ends early
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  const bool can_watch =
      ::sigaction(SIGALRM, &action, nullptr) == 0 && ::timer_create(CLOCK_MONOTONIC, &event, &timer) == 0;
  is_on_terminal.store(::isatty(STDERR_FILENO) == 1);
  has_timer.store(can_watch);
}

void expect_exit(int code) {
  exit_code.store(code);
  // A second signal does not delay it.
  if (has_timer.load() && !is_expected.exchange(true)) arm(kPatienceNanoseconds);
}

Undivided::Undivided() {
  ++undivided_count;
  while (leaving_count.load() != 0) (void)::usleep(100);
}

Undivided::~Undivided() {
  --undivided_count;
}

Leftover::~Leftover() {
  if (path_.empty()) return;
  const Undivided step;
  forget();
}

void Leftover::remember(std::string path) {
  path_ = std::move(path);
  const std::scoped_lock lock(list_mutex);
  next_ = first_leftover;
  first_leftover = this;
}

void Leftover::forget() {
  const std::scoped_lock lock(list_mutex);
  Leftover** link = &first_leftover;
  while (*link != nullptr && *link != this) link = &(*link)->next_;
  if (*link == this) *link = next_;
  path_.clear();
}

void note_written_files(std::size_t count) {
  written_count.store(static_cast<unsigned>(count));
}

void outputs_are_complete() {
  is_complete.store(true);
}

void say_overdue_exits_on(int descriptor) {
  words_descriptor.store(descriptor);
}

void say_last_words(const char* words) {
  const Undivided step;
  std::fputs(words, stderr);
  outputs_are_complete();  // the remaining work is quick, or it is the host's
}

}  // namespace gridiron::tool
