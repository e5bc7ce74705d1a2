// Programs of a core that are compiled with instrumentation, as the kernel is: one right, the others wrong.
// Memory: the core's data. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include "access_programs.h"

namespace gridiron::sim::access {

namespace {

constexpr Tag kTag{1};
constexpr TagMask kTags{2};

// Constant data that a program may read, and data that it may not touch.
const std::uint32_t kConstants[8] = {3, 1, 4, 1, 5, 9, 2, 6};
std::uint32_t not_local[8] = {};

// A pointer of which the compiler knows nothing: accesses that it knows to be inside a global are not instrumented,
// which is why isolation_test.cmake checks that the kernel has no such data.
template <class T>
T* unknown(T* pointer) {
  __asm__("" : "+r"(pointer));
  return pointer;
}
std::uint32_t load(const std::byte* p) {
  return *reinterpret_cast<const volatile std::uint32_t*>(p);
}
void store(std::byte* p, std::uint32_t value) {
  *reinterpret_cast<volatile std::uint32_t*>(p) = value;
}

}  // namespace

Status run(Which which, Env& env, SimCore& core, std::byte* data) {
  switch (which) {
    case Which::kRight: {
      volatile std::uint32_t on_stack[64];
      GRIDIRON_TRY(core.get(data, env.input, 64, kTag));
      for (std::uint32_t i = 0; i < 64; ++i) on_stack[i] = unknown(kConstants)[i % 8];
      store(data + 64, on_stack[7]);
      GRIDIRON_TRY(core.wait(kTags));
      store(data + 64, load(data) + on_stack[3]);
      GRIDIRON_TRY(core.put(data + 64, env.output, 64, kTag));
      store(data + 128, load(data + 64));  // a source may be read while it is on its way
      return core.wait(kTags);
    }
    case Which::kLoadBeforeWait: {
      GRIDIRON_TRY(core.get(data, env.input, 64, kTag));
      const std::uint32_t value = load(data + 60);
      GRIDIRON_TRY(core.wait(kTags));
      store(data + 64, value);
      return Status::kOk;
    }
    case Which::kStoreToDestinationBeforeWait:
      GRIDIRON_TRY(core.get(data, env.input, 64, kTag));
      store(data, env.same_as_input);
      return core.wait(kTags);
    case Which::kStoreToSourceBeforeWait:
      GRIDIRON_TRY(core.put(data, env.output, 64, kTag));
      store(data + 16, 0);  // what is there already
      return core.wait(kTags);
    case Which::kLoadBehindData:
      store(data, load(data + env.data_bytes));
      return core.wait(kTags);
    case Which::kLoadAcrossTheEnd:
      store(data, load(data + env.data_bytes - 2));
      return core.wait(kTags);
    case Which::kStoreBeforeData:
      // The data begins with the environment; this is the very pattern that lies in front of it.
      store(reinterpret_cast<std::byte*>(&env) - 4, 0xC9C9C9C9u);
      return core.wait(kTags);
    case Which::kLoadFromHeap:
      store(data, *env.heap);
      return core.wait(kTags);
    case Which::kStoreToGlobal:
      *unknown(&not_local[3]) = 5;
      return core.wait(kTags);
    case Which::kLoadFromGlobal:
      store(data, *unknown(&not_local[2]));
      return core.wait(kTags);
    case Which::kLoadFromMainMemory:
      store(data, *reinterpret_cast<const volatile std::uint32_t*>(env.host_of_input));
      return core.wait(kTags);
    case Which::kBlockCopyBehindData:
      __builtin_memcpy(data, data + env.data_bytes - 64, env.copy_bytes);
      return core.wait(kTags);
  }
  return Status::kBadParameter;
}

}  // namespace gridiron::sim::access
