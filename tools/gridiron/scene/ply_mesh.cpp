// PLY files as meshes. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include <cmath>
#include <string>
#include <string_view>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "import/srgb.h"
#include "scene_input.h"

namespace gridiron::tool {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const PlyResult& result) {
  const PlyPosition& position = result.position;
  std::string message = path.string() + ":";
  message += position.line != 0 ? std::to_string(position.line) : "byte " + std::to_string(position.byte_offset);
  message += std::string(": ") + words_of(result.error);
  if (position.element_index != kPlyNoElement) {
    message += std::string(" (element ") + position.element_name + ", row " + std::to_string(position.row) + ")";
  }
  throw Failure(ExitCode::kBadInput, message);
}

// Normals as directions. A triangle with a corner without one has none.
void keep_normals(Mesh& mesh) {
  std::vector<bool> is_normal(mesh.surface.normals.size());
  for (std::size_t i = 0; i < is_normal.size(); ++i) {
    Vec3& normal = mesh.surface.normals[i];
    const double x = normal.x, y = normal.y, z = normal.z;
    const double length = std::sqrt(x * x + y * y + z * z);
    is_normal[i] = length > 0;
    normal = length > 0
                 ? Vec3(static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length))
                 : Vec3(0, 0, 1);
  }
  mesh.surface.triangle_normals = mesh.triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const UVec3& corners = mesh.triangles[i];
    if (is_normal[corners.x] && is_normal[corners.y] && is_normal[corners.z]) continue;
    mesh.surface.triangle_normals[i] = UVec3(kNoNormal);
  }
}

// Colours of PLY files are shown as they are, which is sRGB.
void keep_colors(Mesh& mesh) {
  for (Vec3& color : mesh.surface.colors) {
    color = Vec3(linear_of_srgb(color.x), linear_of_srgb(color.y), linear_of_srgb(color.z));
  }
  mesh.surface.triangle_colors = mesh.triangles;
}

}  // namespace

Mesh read_ply_mesh(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  // Counts first: a header may promise more than the file holds, and memory is allocated for the actual content.
  const PlyResult counted = count_ply(bytes);
  if (counted.error != PlyError::kNone) fail(path, counted);
  stop_if_interrupted();
  Mesh mesh;
  mesh.vertices.resize(counted.counts.vertices);
  mesh.triangles.resize(counted.counts.triangles);
  const bool has_normals = counted.header.has_normals && !mesh.triangles.empty();
  const bool has_colors = counted.header.has_colors && !mesh.triangles.empty();
  if (has_normals) mesh.surface.normals.resize(mesh.vertices.size());
  if (has_colors) mesh.surface.colors.resize(mesh.vertices.size());
  const PlyResult result = read_ply(bytes, {mesh.vertices, mesh.triangles, mesh.surface.normals, mesh.surface.colors});
  if (result.error != PlyError::kNone) fail(path, result);
  if (has_normals) keep_normals(mesh);
  if (has_colors) keep_colors(mesh);
  return mesh;
}

std::uint64_t count_ply_lines(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string_view header = text.substr(0, text.find("end_header"));
  constexpr std::string_view kEdges = "\nelement edge ";
  const std::size_t begin = header.find(kEdges);
  if (begin == std::string_view::npos) return 0;
  const std::string_view row = header.substr(begin + kEdges.size());
  return parse_count(row.substr(0, row.find_first_of("\r\n"))).value_or(0);
}

Mesh read_ply_mesh(const std::filesystem::path& path) {
  const InputFile file = read_input_file(path, "expected a PLY mesh");
  return name_in_shortage(path, "read it", [&] { return read_ply_mesh(file.bytes, path); });
}

}  // namespace gridiron::tool
