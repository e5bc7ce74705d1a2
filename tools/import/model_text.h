// Model text: bytes of OBJ, MTL and STL files as Assimp can read them, where it refuses or skips what their formats
// allow. Memory: owns what it returns. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gridiron::tool {

/// OBJ and MTL: lines that begin with blanks, which Assimp skips, begin without them; comments behind the numbers of a
/// line are cut off; words of curves, which it takes for faces, are left out; .5, which it does not count as a number,
/// becomes 0.5. STL: words in capitals become small ones; bytes behind the last triangle are cut off.
///
/// @param ending  of the file, without its dot. @returns nothing where Assimp can read the bytes as they are.
[[nodiscard]] std::optional<std::vector<std::byte>> readable_bytes(std::span<const std::byte> bytes,
                                                                   std::string_view ending);

}  // namespace gridiron::tool
