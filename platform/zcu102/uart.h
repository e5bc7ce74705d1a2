// UART0, for writing.
// Memory: registers. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridiron::port {

/// Switches the transmitter on; baud rate and pins are as the boot loader left them.
void begin_uart();

/// From now on only this core may print; later output of others is dropped, lest it mix with this one's.
/// @returns whether it may: the first one to ask may.
[[nodiscard]] bool take_uart();

}  // namespace gridiron::port
