// Functions that the compiler's kernel-address instrumentation calls at each load and store of the instrumented kernel.
// Memory: none. Threads: each thread checks for its own core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/sim_core.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

// The compiler chooses these names, which start with two underscores.
#define GRIDIRON_ACCESS_HOOK(kind, bytes, is_store)                                                      \
  extern "C" void __asan_##kind##bytes##_noabort(std::uintptr_t address);                                \
  extern "C" void __asan_##kind##bytes##_noabort(std::uintptr_t address) {                               \
    gridiron::sim::SimCore::check_access(address, bytes, is_store,                                       \
                                         reinterpret_cast<std::uintptr_t>(__builtin_return_address(0))); \
  }

GRIDIRON_ACCESS_HOOK(load, 1, false)
GRIDIRON_ACCESS_HOOK(load, 2, false)
GRIDIRON_ACCESS_HOOK(load, 4, false)
GRIDIRON_ACCESS_HOOK(load, 8, false)
GRIDIRON_ACCESS_HOOK(load, 16, false)
GRIDIRON_ACCESS_HOOK(store, 1, true)
GRIDIRON_ACCESS_HOOK(store, 2, true)
GRIDIRON_ACCESS_HOOK(store, 4, true)
GRIDIRON_ACCESS_HOOK(store, 8, true)
GRIDIRON_ACCESS_HOOK(store, 16, true)

extern "C" void __asan_loadN_noabort(std::uintptr_t address, std::uintptr_t bytes);
extern "C" void __asan_loadN_noabort(std::uintptr_t address, std::uintptr_t bytes) {
  gridiron::sim::SimCore::check_access(address, bytes, false,
                                       reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)));
}

extern "C" void __asan_storeN_noabort(std::uintptr_t address, std::uintptr_t bytes);
extern "C" void __asan_storeN_noabort(std::uintptr_t address, std::uintptr_t bytes) {
  gridiron::sim::SimCore::check_access(address, bytes, true,
                                       reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)));
}

// Called before functions that do not return. The instrumentation of the stack is off, so nothing needs to be done.
extern "C" void __asan_handle_no_return();
extern "C" void __asan_handle_no_return() {}

// Block operations of instrumented code; the build renames its calls.

static void check_block(const void* address, std::size_t bytes, bool is_store, const void* code) {
  gridiron::sim::SimCore::check_access(reinterpret_cast<std::uintptr_t>(address), bytes, is_store,
                                       reinterpret_cast<std::uintptr_t>(code));
}

extern "C" void* gridiron_sim_checked_memcpy(void* target, const void* source, std::size_t bytes);
extern "C" void* gridiron_sim_checked_memcpy(void* target, const void* source, std::size_t bytes) {
  check_block(source, bytes, false, __builtin_return_address(0));
  check_block(target, bytes, true, __builtin_return_address(0));
  return std::memcpy(target, source, bytes);
}

extern "C" void* gridiron_sim_checked_memmove(void* target, const void* source, std::size_t bytes);
extern "C" void* gridiron_sim_checked_memmove(void* target, const void* source, std::size_t bytes) {
  check_block(source, bytes, false, __builtin_return_address(0));
  check_block(target, bytes, true, __builtin_return_address(0));
  return std::memmove(target, source, bytes);
}

extern "C" void* gridiron_sim_checked_memset(void* target, int value, std::size_t bytes);
extern "C" void* gridiron_sim_checked_memset(void* target, int value, std::size_t bytes) {
  check_block(target, bytes, true, __builtin_return_address(0));
  return std::memset(target, value, bytes);
}
