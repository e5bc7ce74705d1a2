// PLY files as meshes. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include <string>

#include "base/failure.h"
#include "base/words.h"
#include "files/interrupt.h"
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

}  // namespace

Mesh read_ply_mesh(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  // Counts first: a header may promise more than the file holds, and memory is allocated for the actual content.
  const PlyResult counted = count_ply(bytes);
  if (counted.error != PlyError::kNone) fail(path, counted);
  stop_if_interrupted();
  Mesh mesh;
  mesh.vertices.resize(counted.counts.vertices);
  mesh.triangles.resize(counted.counts.triangles);
  const PlyResult result = read_ply(bytes, mesh.vertices, mesh.triangles);
  if (result.error != PlyError::kNone) fail(path, result);
  return mesh;
}

Mesh read_ply_mesh(const std::filesystem::path& path) {
  const InputFile file = read_input_file(path, "expected a PLY mesh");
  return name_in_shortage(path, "read it", [&] { return read_ply_mesh(file.bytes, path); });
}

}  // namespace gridiron::tool
