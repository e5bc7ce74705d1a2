// glTF text: the JSON of a glTF file and the numbers of its accessors, for what Assimp leaves out or reads wrongly.
// Nothing in it is trusted: what is missing, of another kind or out of range is nothing.
// Memory: owns the document; borrows the file. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "import/assimp_files.h"

namespace gridiron::tool {

using Json = nlohmann::json;

class GltfText {
 public:
  /// @returns nothing if the bytes are no glTF 2.0 file, as text or binary, or its JSON is damaged.
  /// @param bytes, files  outlive the result. @param fault  then says which, for words behind the file's name.
  [[nodiscard]] static std::optional<GltfText> parse(std::span<const std::byte> bytes, AssimpFiles& files,
                                                     std::string& fault);

  [[nodiscard]] const Json& root() const { return root_; }

  /// @returns an object of a list at the root, such as "nodes"; null if there is none.
  [[nodiscard]] const Json* item(const char* list, std::optional<std::size_t> index) const;

  /// @returns all numbers of an accessor, element after element, as floats: integers that are normalized as their
  /// share, sparse elements replaced. Nothing if it is damaged or its elements have another count of components.
  [[nodiscard]] std::optional<std::vector<float>> numbers(std::optional<std::size_t> accessor,
                                                          unsigned components) const;

  /// @returns whether Assimp takes the accessor's bytes for what they are not: integers that stand for shares or
  /// coordinates, or sparse elements in an interleaved buffer.
  [[nodiscard]] bool is_misread(std::optional<std::size_t> accessor) const;

  /// Throws ImportError if the file requires an extension without which its triangles would be others, or has a skin
  /// that crashes Assimp.
  void require_readable() const;

  /// @returns extensions that the file uses and that make no difference here.
  [[nodiscard]] std::vector<std::string> unused_extensions() const;

 private:
  struct View {
    std::span<const std::byte> bytes;
    std::size_t stride = 0;  ///< 0: elements lie side by side
  };

  explicit GltfText(AssimpFiles& files) : files_(&files) {}
  [[nodiscard]] std::optional<View> view(const Json& owner, const char* key) const;
  [[nodiscard]] std::optional<std::span<const std::byte>> buffer(std::size_t index) const;
  [[nodiscard]] bool replace_sparse(const Json& sparse, const Json& accessor, unsigned components,
                                    std::vector<float>& numbers) const;

  AssimpFiles* files_;
  Json root_;
  std::span<const std::byte> chunk_;                               // of a binary file, buffer 0
  mutable std::map<std::size_t, std::vector<std::byte>> decoded_;  // of data URIs
};

/// @returns a member that is a whole number from 0 on.
[[nodiscard]] std::optional<std::size_t> index_in(const Json& object, const char* key);
/// @returns a member that is an object or an array, null if there is none.
[[nodiscard]] const Json* member(const Json* object, const char* key);
/// @returns a member that is a number, or another one in its place.
[[nodiscard]] double number_in(const Json& object, const char* key, double otherwise);
/// @returns the numbers of an array; nothing if it has another count.
[[nodiscard]] std::optional<std::vector<double>> numbers_in(const Json& object, const char* key, std::size_t count);
/// @returns the words of a member that is a text, else nothing in them.
[[nodiscard]] std::string words_in(const Json& object, const char* key);

}  // namespace gridiron::tool
