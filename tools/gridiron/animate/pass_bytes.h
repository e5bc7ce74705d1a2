// Figures of passes as bytes, for other processes of the program.
// Memory: the caller's. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/value_bytes.h"
#include "frame_figures.h"

namespace gridiron::tool {

inline void add_passes(ByteWriter& writer, const std::vector<PassFigures>& passes) {
  writer.add(std::uint64_t{passes.size()});
  for (const PassFigures& pass : passes) {
    writer.add(pass.name);
    writer.add(pass.items);
    for (const double cycles : {pass.start_cycles, pass.run_cycles, pass.barrier_cycles}) writer.add(cycles);
    writer.add(pass.limits);
    writer.add(pass.bytes_in);
    writer.add(pass.bytes_out);
  }
}

inline void take_passes(ByteReader& reader, std::vector<PassFigures>& passes) {
  passes.resize(static_cast<std::size_t>(reader.take<std::uint64_t>()));
  for (PassFigures& pass : passes) {
    reader.take(pass.name);
    reader.take(pass.items);
    for (double* const cycles : {&pass.start_cycles, &pass.run_cycles, &pass.barrier_cycles}) reader.take(*cycles);
    reader.take(pass.limits);
    reader.take(pass.bytes_in);
    reader.take(pass.bytes_out);
  }
}

}  // namespace gridiron::tool
