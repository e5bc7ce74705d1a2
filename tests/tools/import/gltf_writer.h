// glTF writer: hand-written glTF files whose JSON a test spells out; buffer, views and accessors are counted here.
// Memory: strings. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "import/model_import.h"

namespace gridiron::test {

/// Component types of accessors.
inline constexpr int kGltfByte = 5120, kGltfUnsignedByte = 5121, kGltfShort = 5122, kGltfUnsignedShort = 5123,
                     kGltfUnsignedInt = 5125, kGltfFloat = 5126;

class GltfWriter {
 public:
  /// Adds bytes to the buffer as a view of their own. @returns the view's number.
  std::size_t add_view(const void* bytes, std::size_t size, const std::string& members = "");

  /// Adds values as a view and an accessor. @returns the accessor's number.
  template <class Value>
  std::size_t add(const std::vector<Value>& values, int component, const std::string& type, std::size_t count,
                  const std::string& members = "") {
    return add_accessor(add_view(values.data(), values.size() * sizeof(Value)), component, type, count, members);
  }
  std::size_t add_floats(const std::vector<float>& values, const std::string& type, std::size_t components) {
    return add(values, kGltfFloat, type, values.size() / components);
  }
  std::size_t add_accessor(std::size_t view, int component, const std::string& type, std::size_t count,
                           const std::string& members = "") {
    return add_accessor("\"bufferView\":" + std::to_string(view) + ",", component, type, count, members);
  }
  /// @param begin  members before the others, with their comma; empty: no view.
  std::size_t add_accessor(const std::string& begin, int component, const std::string& type, std::size_t count,
                           const std::string& members);

  /// @returns the file as text; members of the root without braces.
  [[nodiscard]] std::string text(const std::string& members) const;
  /// @returns the file as .glb.
  [[nodiscard]] std::string binary(const std::string& members) const;

 private:
  [[nodiscard]] std::string json(const std::string& members, const std::string& uri) const;

  std::string buffer_, views_, accessors_;
  std::size_t view_count_ = 0, accessor_count_ = 0;
};

/// @returns a model read from a file with that content.
tool::ImportedModel model_of(const std::string& name, const std::string& content,
                             const tool::ImportOptions& options = {});
/// @returns why it cannot be read.
std::string reason_of(const std::string& name, const std::string& content, const tool::ImportOptions& options = {});

/// @returns whether a report says that something is ignored, in these words.
bool ignores(const tool::ImportedModel& model, const std::string& words);

/// Expects corner `corner` of triangle `triangle` at a place.
void expect_corner(const tool::Mesh& mesh, std::size_t triangle, int corner, const Vec3& place, float most = 1e-5f);

/// Expects the colour of a corner.
void expect_color(const tool::Mesh& mesh, std::size_t triangle, int corner, const Vec3& color, float most = 1e-3f);

}  // namespace gridiron::test
