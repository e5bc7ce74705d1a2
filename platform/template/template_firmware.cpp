// What runs on each core of the made-up chip: one call into the kernel, with the local store in the core's arena. The
// build gives GRIDIRON_PACKET_WIDTH, the rays along a packet's edge.
// Memory: the arena that the loader gives. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include "template_board.h"

namespace gridiron::port {

using FirmwareStore = LocalStore<StoreLayout256K<GRIDIRON_PACKET_WIDTH>>;

/// Renders the core's share of a frame.
///
/// @param store    start of the core's arena, kLineBytes-aligned, sizeof(FirmwareStore) bytes.
/// @param frame    the FrameRecord in main memory.
/// Errors: those of render_tiles; the caller stores the status where the host looks for it.
Status render_on_template_board(FirmwareStore& store, volatile EngineRegisters* engine, FrameControl* control,
                                MainAddress frame);

Status render_on_template_board(FirmwareStore& store, volatile EngineRegisters* engine, FrameControl* control,
                                MainAddress frame) {
  TemplateBoard board(engine, control, reinterpret_cast<std::uintptr_t>(&store), sizeof store);
  TemplatePort<TemplateBoard> port(board);
  return render_tiles<Lanes<4>>(store, port, frame);
}

}  // namespace gridiron::port
