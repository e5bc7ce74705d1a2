// File kind: what a file holds, by its first bytes and never by its name alone.
// Memory: borrows the bytes. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace gridiron::tool {

/// First bytes of a file that tell its kind; all of it where it is shorter.
inline constexpr std::size_t kHeadBytes = std::size_t{1} << 16;

/// Kinds of scenes that the program reads.
enum class SceneKind : std::uint8_t { kUnknown, kMesh, kText, kPacked };

/// @returns what kind of scene a file holds. Text whose first word is unknown is a text scene where its name ends with
/// .nff, so that the reader of text scenes can name the line that is wrong.
/// @param head  the first bytes, kHeadBytes where the file has that many.
[[nodiscard]] SceneKind scene_kind_of(std::span<const std::byte> head, const std::filesystem::path& path);

/// @returns the kind of scene that a name promises by its ending: .ply, .nff, .gri.
[[nodiscard]] SceneKind scene_kind_by_ending(const std::filesystem::path& path);

/// @returns what a file holds, for people: "is empty", "is a PNG picture", "begins with 'abc'".
/// @param file_bytes  size of the whole file, where it is known.
[[nodiscard]] std::string words_of_content(std::span<const std::byte> head, std::optional<std::uint64_t> file_bytes);

/// @returns the same for a kind that begins with bytes of its own, as pictures and meshes do; null for all others,
/// which text that people write is among.
[[nodiscard]] const char* words_of_marked_content(std::span<const std::byte> head);

}  // namespace gridiron::tool
