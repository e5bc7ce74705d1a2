// The four memory functions that GCC calls in freestanding programs, for images that link no C library.
// Memory: caller's. Threads: any. Compiled without the pass that would turn these loops into calls of these functions.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

namespace {

using Word [[gnu::may_alias]] = std::uint64_t;

bool are_aligned(const void* a, const void* b) {
  return ((reinterpret_cast<std::uintptr_t>(a) | reinterpret_cast<std::uintptr_t>(b)) % sizeof(Word)) == 0;
}

void copy_up(unsigned char* to, const unsigned char* from, std::size_t count) {
  if (are_aligned(to, from)) {
    for (; count >= sizeof(Word); count -= sizeof(Word), to += sizeof(Word), from += sizeof(Word)) {
      *reinterpret_cast<Word*>(to) = *reinterpret_cast<const Word*>(from);
    }
  }
  for (; count != 0; --count) *to++ = *from++;
}

}  // namespace

extern "C" {

void* memcpy(void* to, const void* from, std::size_t count);
void* memmove(void* to, const void* from, std::size_t count);
void* memset(void* to, int value, std::size_t count);
int memcmp(const void* a, const void* b, std::size_t count);

void* memcpy(void* to, const void* from, std::size_t count) {
  copy_up(static_cast<unsigned char*>(to), static_cast<const unsigned char*>(from), count);
  return to;
}

void* memmove(void* to, const void* from, std::size_t count) {
  auto* target = static_cast<unsigned char*>(to);
  const auto* source = static_cast<const unsigned char*>(from);
  if (reinterpret_cast<std::uintptr_t>(target) - reinterpret_cast<std::uintptr_t>(source) >= count) {
    copy_up(target, source, count);
  } else {
    for (; count != 0; --count) target[count - 1] = source[count - 1];
  }
  return to;
}

void* memset(void* to, int value, std::size_t count) {
  auto* target = static_cast<unsigned char*>(to);
  const auto byte = static_cast<unsigned char>(value);
  if (are_aligned(target, target)) {
    const Word word = byte * std::uint64_t{0x0101010101010101};
    for (; count >= sizeof(Word); count -= sizeof(Word), target += sizeof(Word)) {
      *reinterpret_cast<Word*>(target) = word;
    }
  }
  for (; count != 0; --count) *target++ = byte;
  return to;
}

int memcmp(const void* a, const void* b, std::size_t count) {
  const auto* left = static_cast<const unsigned char*>(a);
  const auto* right = static_cast<const unsigned char*>(b);
  for (std::size_t i = 0; i < count; ++i) {
    if (left[i] != right[i]) return left[i] < right[i] ? -1 : 1;
  }
  return 0;
}

}  // extern "C"
