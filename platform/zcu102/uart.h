// UART0, as a place to write to.
// Memory: registers. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridiron::port {

/// Switches the transmitter on; baud rate and pins are as the boot loader left them.
void begin_uart();

/// From now on this core alone is heard: words of others that come later are lost, lest they mix with its own.
/// @returns whether it is: the first one to ask is.
[[nodiscard]] bool take_uart();

}  // namespace gridiron::port
