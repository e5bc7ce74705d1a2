// One entry point of the kernel, compiled several times. The build defines GRIDIRON_ENTRY_NAME (the function's),
// GRIDIRON_ENTRY_LANES, GRIDIRON_ENTRY_CORE (the platform), GRIDIRON_ENTRY_LAYOUTS (a list of layouts).
// Memory: the core's arena. Threads: one core per call. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/base/one_lane.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/sim/compiled_layouts.h>
#include <gridiron/sim/render_entry.h>
#include <gridiron/store/local_store.h>

#include <new>
#include <type_traits>

namespace gridiron::sim {

namespace {

template <class Layout, Platform P>
Status render_in(std::byte* store, P& core, MainAddress frame, SpillRegion spill) {
  return render_tiles<Lanes<GRIDIRON_ENTRY_LANES>>(*::new (static_cast<void*>(store)) LocalStore<Layout>, core, frame,
                                                   spill);
}

template <Platform P>
Status render(LayoutChoice layout, std::byte* store, P& core, MainAddress frame, SpillRegion spill) {
  Status status = Status::kUnsupportedFrame;
  visit_layout(GRIDIRON_ENTRY_LAYOUTS{}, layout, [&]<class Layout>() {
    if constexpr (GRIDIRON_ENTRY_LANES <= most_lanes<Layout>()) {
      constexpr bool kIsPlain = std::is_same_v<P, PlainCore>;
      using Used = typename decltype(used_layout<Layout, kIsPlain, GRIDIRON_ENTRY_LANES>())::type;
      status = render_in<Used>(store, core, frame, spill);
    }
  });
  return status;
}

}  // namespace

}  // namespace gridiron::sim

gridiron::Status GRIDIRON_ENTRY_NAME(gridiron::sim::LayoutChoice layout, std::byte* store,
                                     gridiron::sim::GRIDIRON_ENTRY_CORE& core, gridiron::MainAddress frame,
                                     gridiron::SpillRegion spill) {
  return gridiron::sim::render(layout, store, core, frame, spill);
}
