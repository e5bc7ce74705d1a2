// Interrupt. SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <csignal>

#include "failure.h"

namespace gridiron::tool {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<bool> terminated{false};
StopFlag stop;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

extern "C" void note_interrupt(int signal) {
  if (signal == SIGTERM) terminated.store(true);
  interrupted.store(true);
  stop.raise();
}

}  // namespace

void watch_for_interrupt() {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = 0;  // no SA_RESTART: a call that blocks, on a pipe say, ends with EINTR
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

const std::atomic<bool>& interrupt_flag() {
  return interrupted;
}

const StopFlag& stop_flag() {
  return stop;
}

void stop_if_interrupted(const char* words) {
  if (!interrupted.load()) return;
  throw Failure(terminated.load() ? ExitCode::kTerminated : ExitCode::kInterrupted, words);
}

}  // namespace gridiron::tool
