// One entry point of the kernel, compiled several times: GRIDIRON_ENTRY_LANES and GRIDIRON_ENTRY_MODE (checked, plain
// or instrumented) come from the build.
// Memory: the core's arena. Threads: one core per call. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/sim/render_entry.h>
#include <gridiron/store/local_store.h>

#include <new>

namespace gridiron::sim {

namespace {

template <class Layout, Platform P>
Status render_in(std::byte* store, P& core, MainAddress frame) {
  return render_tiles<Lanes<GRIDIRON_ENTRY_LANES>>(*::new (static_cast<void*>(store)) LocalStore<Layout>, core, frame);
}

template <Platform P>
Status render(StoreSize size, std::uint32_t packet_width, std::byte* store, P& core, MainAddress frame) {
  const bool is_small = size == StoreSize::k64KB;
  switch (packet_width) {
    case 4:
      return is_small ? render_in<StoreLayout64K<4>>(store, core, frame)
                      : render_in<StoreLayout256K<4>>(store, core, frame);
    case 8:
      return is_small ? render_in<StoreLayout64K<8>>(store, core, frame)
                      : render_in<StoreLayout256K<8>>(store, core, frame);
    case 16:
      return is_small ? render_in<StoreLayout64K<16>>(store, core, frame)
                      : render_in<StoreLayout256K<16>>(store, core, frame);
    case 32:
      return is_small ? Status::kUnsupportedFrame : render_in<StoreLayout256K<32>>(store, core, frame);
    default:
      return Status::kUnsupportedFrame;
  }
}

}  // namespace

}  // namespace gridiron::sim

#define GRIDIRON_ENTRY_PASTE(mode, lanes) gridiron_sim_render_##mode##_lanes##lanes
#define GRIDIRON_ENTRY_NAME(mode, lanes) GRIDIRON_ENTRY_PASTE(mode, lanes)

gridiron::Status GRIDIRON_ENTRY_NAME(GRIDIRON_ENTRY_MODE,
                                     GRIDIRON_ENTRY_LANES)(gridiron::sim::StoreSize size, std::uint32_t packet_width,
                                                           std::byte* store, gridiron::sim::GRIDIRON_ENTRY_CORE& core,
                                                           gridiron::MainAddress frame) {
  return gridiron::sim::render(size, packet_width, store, core, frame);
}
