// An image for the made-up chip whose sizes the linker checks: a local store, and the call of template_firmware.cpp.
// Memory: static, all of one core's arena. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "image_budgets.h"
#include "template_firmware.h"

template struct gridiron::port::ImageBudgets<gridiron::port::FirmwareLayout>;

namespace {

// Addresses of the made-up chip: the core's engine, the memory that all cores share, the frame record in main memory.
constexpr std::uintptr_t kEngine = 0x40000000, kControl = 0x50000000, kFrame = 0x60000000;

gridiron::port::FirmwareStore store;

#ifdef EXAMPLE_OWN_BYTES
volatile std::byte own_variables[EXAMPLE_OWN_BYTES];
#endif

}  // namespace

/// The core's start code calls this on the stack of the arena.
extern "C" void example_start();

extern "C" void example_start() {
  using namespace gridiron::port;
  auto* control = reinterpret_cast<FrameControl*>(kControl);
  const gridiron::Status status = render_on_template_board(store, reinterpret_cast<volatile EngineRegisters*>(kEngine),
                                                           control, 0, gridiron::MainAddress{kFrame});
  control->stop = static_cast<std::uint32_t>(status);
#ifdef EXAMPLE_OWN_BYTES
  own_variables[control->core_count % EXAMPLE_OWN_BYTES] = std::byte{1};
#endif
}
