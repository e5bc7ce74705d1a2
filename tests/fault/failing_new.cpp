// Failing new: a file of its own, so that no operator is inlined into who calls it.
// SPDX-License-Identifier: Apache-2.0
#include "failing_new.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> failing{0}, allocation_count{0};

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (++allocation_count == failing) throw std::bad_alloc();
  const std::size_t whole = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, whole);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) {
  return allocate(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace gridiron::test {

void fail_allocation(std::uint64_t n) {
  allocation_count = 0;
  failing = n;
}

std::uint64_t end_of_failing() {
  failing = 0;
  return allocation_count;
}

}  // namespace gridiron::test
