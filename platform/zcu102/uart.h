// UART0, as a place to write to.
// Memory: registers. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridiron::port {

/// Switches the transmitter on; baud rate and pins are as the boot loader left them.
void begin_uart();

}  // namespace gridiron::port
