// A program without an operating system's help: renders the frame that lies in its image, and ends. second_opinion
// counts its instructions. Build: GRIDIRON_PACKET_WIDTH and GRIDIRON_MEMORY, the file that gridiron_calibrate wrote.
// Memory: static. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include <new>

extern "C" {
extern std::byte gridiron_memory[];

void* memcpy(void* to, const void* from, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) {
    static_cast<volatile std::byte*>(to)[i] = static_cast<const std::byte*>(from)[i];
  }
  return to;
}
void* memset(void* to, int value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) static_cast<volatile std::byte*>(to)[i] = static_cast<std::byte>(value);
  return to;
}
}

asm(".data\n.balign 128\n.global gridiron_memory\ngridiron_memory:\n.incbin \"" GRIDIRON_MEMORY "\"\n.text\n");

namespace {

using namespace gridiron;
using Store = LocalStore<StoreLayout256K<GRIDIRON_PACKET_WIDTH>>;

// Marks 127 and 126 stand around what no core does: copies are a transfer engine's work.
inline void mark_copy() {
  asm volatile(GRIDIRON_MARK_TEXT : : "n"(127));
}
inline void mark_copied() {
  asm volatile(GRIDIRON_MARK_TEXT : : "n"(126));
}

[[noreturn]] void exit_with(long code) {
#ifdef __riscv
  register long value asm("a0") = code;
  register long call asm("a7") = 93;  // exit
  asm volatile("ecall" : : "r"(value), "r"(call));
#else
  register long value asm("x0") = code;
  register long call asm("x8") = 93;  // exit
  asm volatile("svc 0" : : "r"(value), "r"(call));
#endif
  __builtin_unreachable();
}

struct CopyCore {
  std::uint32_t next_tile = 0;
  std::uint32_t tile_count;

  [[nodiscard]] PlatformLimits limits() const { return {}; }
  __attribute__((noinline)) Status get(void* local, MainAddress address, std::uint32_t bytes, Tag) {
    mark_copy();
    memcpy(local, gridiron_memory + address.value, bytes);
    mark_copied();
    return Status::kOk;
  }
  __attribute__((noinline)) Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag) {
    mark_copy();
    memcpy(gridiron_memory + address.value, local, bytes);
    mark_copied();
    return Status::kOk;
  }
  [[nodiscard]] Status wait(TagMask) { return Status::kOk; }
  [[nodiscard]] TileClaim claim_tile() {
    if (next_tile == tile_count) return {TileClaim::Kind::kNone, 0};
    return {TileClaim::Kind::kTile, next_tile++};
  }
};

alignas(128) std::byte store_bytes[sizeof(Store)];

}  // namespace

extern "C" [[noreturn]] void _start() {
  mark_copy();
  const auto& frame = *reinterpret_cast<const FrameRecord*>(gridiron_memory);
  CopyCore core{.tile_count = frame.tiles_x * frame.tiles_y};
  Store& store = *::new (static_cast<void*>(store_bytes)) Store;
  const Status status = render_tiles<Lanes<4>>(store, core, MainAddress{0});
  exit_with(status == Status::kOk ? 0 : 1);
}
