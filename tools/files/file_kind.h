// File kind: the content of a file, by its first bytes and never by its name alone.
// Memory: borrows the bytes. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace gridiron::tool {

/// First bytes of a file that decide its kind; the whole file if it is shorter.
inline constexpr std::size_t kHeadBytes = std::size_t{1} << 16;

/// Kinds of scenes that the program reads. A mesh is a PLY file or a model that model_ending() names.
enum class SceneKind : std::uint8_t { kUnknown, kMesh, kText, kPacked };

/// @returns whether a file begins with a magic word.
[[nodiscard]] bool starts_with_word(std::span<const std::byte> head, std::uint32_t magic);

/// @returns the kind of scene in a file. Text with an unknown first word is a text scene if the name ends with .nff, so
/// that the reader of text scenes can name the wrong line.
/// @param head  the first bytes, kHeadBytes if the file has that many.
/// @param file_bytes  size of the whole file, if it is known: a binary STL file is recognised by it.
[[nodiscard]] SceneKind scene_kind_of(std::span<const std::byte> head, const std::filesystem::path& path,
                                      std::optional<std::uint64_t> file_bytes = std::nullopt);

/// @returns the format of a model that is read with Assimp, as a lower-case ending without a dot: "obj", "stl",
/// "gltf", "glb" and others. The content decides, else the name; empty for all other files.
[[nodiscard]] std::string model_ending(std::span<const std::byte> head, const std::filesystem::path& path,
                                       std::optional<std::uint64_t> file_bytes);

/// @returns the kind of scene that a name's ending stands for: .ply and those of models, .nff, .gri.
[[nodiscard]] SceneKind scene_kind_by_ending(const std::filesystem::path& path);

/// @returns the content of a file, for messages: "is empty", "is a PNG picture", "begins with 'abc'".
/// @param file_bytes  size of the whole file, if it is known.
[[nodiscard]] std::string words_of_content(std::span<const std::byte> head, std::optional<std::uint64_t> file_bytes);

/// @returns the same for a kind with characteristic first bytes, such as pictures and meshes; null for others,
/// including text.
[[nodiscard]] const char* words_of_marked_content(std::span<const std::byte> head);

}  // namespace gridiron::tool
