// Interrupt. SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <csignal>

#include "base/failure.h"
#include "overdue_exit.h"

namespace gridiron::tool {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<int> last_signal{SIGINT};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

ExitCode exit_code_of(int signal) {
  if (signal == SIGTERM) return ExitCode::kTerminated;
  return signal == SIGHUP ? ExitCode::kHungUp : ExitCode::kInterrupted;
}

extern "C" void note_interrupt(int signal) {
  last_signal.store(signal);
  interrupted.store(true);
  expect_exit(static_cast<int>(exit_code_of(signal)));
}

}  // namespace

void watch_for_interrupt() {
  begin_overdue_exit();
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = 0;  // no SA_RESTART: a blocked call, on a pipe for example, ends with EINTR
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction inherited {};
    sigaction(signal, nullptr, &inherited);
    // Signals that the parent ignores stay ignored: nohup does so with SIGHUP, shells with SIGINT of background jobs.
    if (inherited.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& interrupt_flag() {
  return interrupted;
}

void stop_if_interrupted() {
  if (!interrupted.load()) return;
  throw Failure(exit_code_of(last_signal.load()), "interrupted");
}

}  // namespace gridiron::tool
