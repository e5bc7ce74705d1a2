// glTF writer. SPDX-License-Identifier: Apache-2.0
#include "gltf_writer.h"

#include "base/failure.h"
#include "model_files.h"
#include "support/test_headers.h"
#include "temporary_folder.h"

namespace gridiron::test {

std::size_t GltfWriter::add_view(const void* bytes, std::size_t size, const std::string& members) {
  while (buffer_.size() % 4 != 0) buffer_ += '\0';
  views_ += (views_.empty() ? "" : ",") + std::string("{\"buffer\":0,\"byteOffset\":") +
            std::to_string(buffer_.size()) + ",\"byteLength\":" + std::to_string(size) + members + "}";
  buffer_.append(static_cast<const char*>(bytes), size);
  return view_count_++;
}

std::size_t GltfWriter::add_accessor(const std::string& begin, int component, const std::string& type,
                                     std::size_t count, const std::string& members) {
  accessors_ += (accessors_.empty() ? "" : ",") + std::string("{") + begin +
                "\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(count) +
                ",\"type\":\"" + type + "\"" + members + "}";
  return accessor_count_++;
}

std::string GltfWriter::json(const std::string& members, const std::string& uri) const {
  return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"accessors\":[" + accessors_ + "],\"bufferViews\":[" + views_ +
         "],\"buffers\":[{\"byteLength\":" + std::to_string(buffer_.size()) +
         (uri.empty() ? "" : ",\"uri\":\"" + uri + "\"") + "}]," + members + "}";
}

std::string GltfWriter::text(const std::string& members) const {
  return json(members, "data:application/octet-stream;base64," + base64(buffer_));
}

std::string GltfWriter::binary(const std::string& members) const {
  return glb_of(json(members, ""), buffer_);
}

tool::ImportedModel model_of(const std::string& name, const std::string& content, const tool::ImportOptions& options) {
  const TemporaryFolder folder(name, content);
  return import_file(folder.path(name), options);
}

std::string reason_of(const std::string& name, const std::string& content, const tool::ImportOptions& options) {
  try {
    (void)model_of(name, content, options);
  } catch (const tool::Failure& failure) {
    return failure.what();
  }
  return "";
}

bool ignores(const tool::ImportedModel& model, const std::string& words) {
  return std::ranges::find(model.report.ignored, words) != model.report.ignored.end();
}

void expect_corner(const tool::Mesh& mesh, std::size_t triangle, int corner, const Vec3& place, float most) {
  ASSERT_LT(triangle, mesh.triangles.size());
  const Vec3& got = mesh.vertices.at(mesh.triangles[triangle][corner]);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(got[axis], place[axis], most) << "axis " << axis;
}

void expect_color(const tool::Mesh& mesh, std::size_t triangle, int corner, const Vec3& color, float most) {
  ASSERT_LT(triangle, mesh.surface.triangle_colors.size());
  const std::uint32_t index = mesh.surface.triangle_colors[triangle][corner];
  ASSERT_LT(index, mesh.surface.colors.size());
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(mesh.surface.colors[index][axis], color[axis], most) << axis;
}

}  // namespace gridiron::test
