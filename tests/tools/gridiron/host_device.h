// A device played by the host: takes a job as firmware finds it in memory, and gives back what firmware would write.
// Memory: a simulated main memory in which the job lies at its own address. Threads: one.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace gridiron::test {

/// Renders a job with so many cores, one after the other, by the kernel as it is built for plain copies. Nothing of the
/// program's own reading of jobs is used.
///
/// @param job         a whole job file, its base address low enough for that much simulated memory to lie below it.
/// @param core_count  1..16; each takes the next share of the tiles, the last ones perhaps none.
/// @returns the result's bytes; stack and instructions are made up, from 1 on.
[[nodiscard]] std::string render_on_host_device(const std::string& job, std::uint32_t core_count);

}  // namespace gridiron::test
