// Runs on each core of the made-up chip: one call into the kernel, with the local store in the core's arena.
// template_firmware.h has the layout.
// Memory: the arena that the loader gives. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include "template_firmware.h"

#include <gridiron/render/tile_renderer.h>

namespace gridiron::port {

Status render_on_template_board(FirmwareStore& store, volatile EngineRegisters* engine, FrameControl* control,
                                std::uint32_t core_index, MainAddress frame) {
  TemplateBoard board(engine, control, reinterpret_cast<std::uintptr_t>(&store), sizeof store);
  TemplatePort<TemplateBoard> port(board);
  return render_tiles<FirmwareLanes>(store, port, frame, board.spill_region(core_index));
}

}  // namespace gridiron::port
