// Services of an emulator or a debugger by semihosting: end with an exit code, write a file, read the command line.
// Source: Semihosting for AArch32 and AArch64 (Arm), RISC-V Semihosting 1.0.
// Memory: caller's. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

/// Ends the run; the emulator's exit code is `code`, 0..255.
[[noreturn]] void exit_run(std::uint32_t code);

/// Writes a file on the host, in the emulator's working directory, and replaces an old one.
/// @returns whether all bytes were written.
[[nodiscard]] bool write_host_file(const char* name, const void* bytes, std::uint64_t count);

/// Value of the command line's word NAME=VALUE, in decimal, else `otherwise`. Reads a value up to the first character
/// that is no digit. A command line longer than 200 characters counts as empty.
/// @param name  with the =, "seed=".
[[nodiscard]] std::uint64_t number_option(const char* name, std::uint64_t otherwise);

}  // namespace gridiron::port
