// Semihosting on RISC-V, AArch64 and Cortex-M. A block of arguments consists of words of the target.
// Memory: caller's, and a command line on the stack. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#include "semihost.h"

namespace gridiron::port {

namespace {

using Word = std::uintptr_t;

enum Operation : Word {
  kOpen = 0x01,
  kClose = 0x02,
  kWrite = 0x05,
  kCommandLine = 0x15,
  kExit = 0x20,
};

// Takes an operation and the address of its arguments; returns the first register.
Word call(Operation operation, const void* arguments) {
#if defined(__riscv)
  register Word answer asm("a0") = operation;
  register const void* block asm("a1") = arguments;
  // The call is these three instructions, uncompressed and on one page.
  asm volatile(
      ".option push\n.option norvc\n.balign 16\n"
      "slli zero, zero, 0x1f\nebreak\nsrai zero, zero, 7\n.option pop"
      : "+r"(answer)
      : "r"(block)
      : "memory");
#elif defined(__aarch64__)
  register Word answer asm("x0") = operation;
  register const void* block asm("x1") = arguments;
  asm volatile("hlt #0xf000" : "+r"(answer) : "r"(block) : "memory");
#elif defined(__arm__) && defined(__thumb__)
  register Word answer asm("r0") = operation;
  register const void* block asm("r1") = arguments;
  asm volatile("bkpt #0xab" : "+r"(answer) : "r"(block) : "memory");
#else
#error "no semihosting is known for this target"
#endif
  return answer;
}

Word address_of(const void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

Word length_of(const char* text) {
  Word length = 0;
  while (text[length] != '\0') ++length;
  return length;
}

// Whether text begins with start.
bool begins_with(const char* text, const char* start) {
  std::uint32_t i = 0;
  while (start[i] != '\0' && text[i] == start[i]) ++i;
  return start[i] == '\0';
}

}  // namespace

void exit_run(std::uint32_t code) {
  constexpr Word kApplicationExit = 0x20026;
  const Word arguments[] = {kApplicationExit, code};
  call(kExit, arguments);
  // The emulator does not respond, so stop here.
  for (;;) asm volatile("" ::: "memory");
}

bool write_host_file(const char* name, const void* bytes, std::uint64_t count) {
  constexpr Word kWriteBinary = 5, kFailed = ~Word{0};
  const Word open[] = {address_of(name), kWriteBinary, length_of(name)};
  const Word file = call(kOpen, open);
  if (file == kFailed) return false;
  const Word write[] = {file, address_of(bytes), static_cast<Word>(count)};
  const Word rest = call(kWrite, write);
  const Word close[] = {file};
  return call(kClose, close) == 0 && rest == 0;
}

std::uint64_t number_option(const char* name, std::uint64_t otherwise) {
  char line[201] = {};
  const Word arguments[] = {address_of(line), sizeof line - 1};
  if (call(kCommandLine, arguments) != 0) return otherwise;
  line[sizeof line - 1] = '\0';
  for (const char* word = line; *word != '\0'; ++word) {
    const bool is_start = word == line || word[-1] == ' ';
    if (!is_start || !begins_with(word, name)) continue;
    std::uint64_t number = 0;
    for (const char* digit = word + length_of(name); *digit >= '0' && *digit <= '9'; ++digit) {
      number = number * 10 + static_cast<std::uint64_t>(*digit - '0');
    }
    return number;
  }
  return otherwise;
}

}  // namespace gridiron::port
