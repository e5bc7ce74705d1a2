// Model files. SPDX-License-Identifier: Apache-2.0
#include "model_files.h"

#include <glm/common.hpp>

#include "files/file_kind.h"
#include "files/png_file.h"

namespace gridiron::test {
namespace {

template <class Value>
void put(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string text_of(float value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
  return text;
}

std::string text_of(const Vec3& v) {
  return text_of(v.x) + " " + text_of(v.y) + " " + text_of(v.z);
}

void pad(std::string& bytes, char filler = '\0') {
  while (bytes.size() % 4 != 0) bytes += filler;
}

struct View {
  std::size_t offset = 0, bytes = 0;
};

// The buffer and where its parts lie.
struct Buffer {
  std::string bytes;
  std::vector<View> views;

  template <class Value>
  void add(const std::vector<Value>& values) {
    const std::size_t begin = bytes.size();
    for (const Value& value : values) put(bytes, value);
    views.push_back({begin, bytes.size() - begin});
    pad(bytes);
  }
};

Buffer buffer_of(const TestMesh& mesh, const GltfParts& parts) {
  Buffer buffer;
  buffer.add(mesh.vertices);
  buffer.add(mesh.triangles);
  buffer.add(parts.normals);
  buffer.add(parts.uvs);
  buffer.add(parts.colors);
  buffer.add(std::vector<char>(parts.picture.begin(), parts.picture.end()));
  buffer.add(std::vector<char>(parts.extra.begin(), parts.extra.end()));
  return buffer;
}

std::string json_of(const TestMesh& mesh, const GltfParts& parts, const std::string& buffer_uri) {
  const Buffer buffer = buffer_of(mesh, parts);
  std::string views, accessors, attributes = "\"POSITION\":0";
  for (const View& view : buffer.views) {  // parts have fixed numbers, so an empty one has a view too
    views += (views.empty() ? "" : ",") + std::string("{\"buffer\":0,\"byteOffset\":") +
             std::to_string(view.bytes == 0 ? 0 : view.offset) +
             ",\"byteLength\":" + std::to_string(std::max<std::size_t>(view.bytes, 1)) + "}";
  }
  const auto accessor = [&](std::size_t view, int component, std::size_t count, const std::string& type) {
    accessors += (accessors.empty() ? "" : ",") + std::string("{\"bufferView\":") + std::to_string(view) +
                 ",\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(count) +
                 ",\"type\":\"" + type + "\"}";
    return std::to_string(std::count(accessors.begin(), accessors.end(), '{') - 1);
  };
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3& v : mesh.vertices) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  (void)accessor(0, 5126, mesh.vertices.size(), "VEC3");
  const auto list = [](const Vec3& v) { return "[" + text_of(v.x) + "," + text_of(v.y) + "," + text_of(v.z) + "]"; };
  accessors.pop_back();
  accessors += ",\"min\":" + list(low) + ",\"max\":" + list(high) + "}";
  const std::string indices = accessor(1, 5125, 3 * mesh.triangles.size(), "SCALAR");
  if (!parts.normals.empty()) attributes += ",\"NORMAL\":" + accessor(2, 5126, parts.normals.size(), "VEC3");
  if (!parts.uvs.empty()) attributes += ",\"TEXCOORD_0\":" + accessor(3, 5126, parts.uvs.size(), "VEC2");
  if (!parts.colors.empty()) attributes += ",\"COLOR_0\":" + accessor(4, 5126, parts.colors.size(), "VEC3");
  std::string json = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{" +
                     parts.node + "}],\"meshes\":[{\"primitives\":[{\"attributes\":{" + attributes +
                     "},\"indices\":" + indices + (parts.material.empty() ? "" : ",\"material\":0") + "}]}]";
  if (!parts.material.empty()) json += ",\"materials\":[{" + parts.material + "}]";
  if (!parts.picture.empty()) {
    json += ",\"textures\":[{\"source\":0}],\"images\":[{\"bufferView\":5,\"mimeType\":\"image/png\"}]";
  }
  json += ",\"accessors\":[" + accessors + "],\"bufferViews\":[" + views + "],\"buffers\":[{\"byteLength\":" +
          std::to_string(buffer.bytes.size()) + (buffer_uri.empty() ? "" : ",\"uri\":\"" + buffer_uri + "\"") + "}]";
  return json + parts.more + "}";
}

}  // namespace

tool::ImportedModel import_file(const std::filesystem::path& path, const tool::ImportOptions& options) {
  tool::InputReader reader(path, "expected a model");
  const std::string ending = tool::model_ending(reader.head(), path, reader.file_bytes());
  if (ending.empty()) reader.refuse_content();
  return tool::import_model(reader.read_all(), {.path = path, .ending = ending, .options = options});
}

TestMesh rounded(TestMesh mesh) {
  for (Vec3& v : mesh.vertices) v = glm::round(v * 64.0f) / 64.0f + 0.0f;
  return mesh;
}

std::string obj_text(const TestMesh& mesh) {
  std::string text = "# a mesh\n";
  for (const Vec3& v : mesh.vertices) text += "v " + text_of(v) + "\n";
  for (const UVec3& t : mesh.triangles) {
    text += "f " + std::to_string(t.x + 1) + " " + std::to_string(t.y + 1) + " " + std::to_string(t.z + 1) + "\n";
  }
  return text;
}

std::string stl_text(const TestMesh& mesh) {
  std::string text = "solid part\n";
  for (const UVec3& t : mesh.triangles) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (int i = 0; i < 3; ++i) text += "vertex " + text_of(mesh.vertices[t[i]]) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

std::string stl_bytes(const TestMesh& mesh) {
  std::string bytes(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const UVec3& t : mesh.triangles) {
    put(bytes, Vec3(0, 0, 1));
    for (int i = 0; i < 3; ++i) put(bytes, mesh.vertices[t[i]]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string gltf_buffer(const TestMesh& mesh, const GltfParts& parts) {
  return buffer_of(mesh, parts).bytes;
}

std::string gltf_text(const TestMesh& mesh, const GltfParts& parts) {
  const std::string uri = !parts.buffer_uri.empty()
                              ? parts.buffer_uri
                              : "data:application/octet-stream;base64," + base64(gltf_buffer(mesh, parts));
  return json_of(mesh, parts, uri);
}

std::string glb_of(std::string json, std::string buffer) {
  pad(json, ' ');
  pad(buffer);
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  put(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

std::string glb_bytes(const TestMesh& mesh, const GltfParts& parts) {
  return glb_of(json_of(mesh, parts, parts.buffer_uri), gltf_buffer(mesh, parts));
}

std::string png_bytes(std::uint32_t width, std::uint32_t height,
                      const std::vector<std::array<std::uint8_t, 3>>& texels) {
  tool::Picture<std::uint32_t> picture{width, height, {}};
  for (const auto& texel : texels) {
    picture.pixels.push_back(0xFF000000u | texel[0] | std::uint32_t{texel[1]} << 8 | std::uint32_t{texel[2]} << 16);
  }
  const std::vector<std::byte> bytes = tool::encode_stored_png(picture);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

}  // namespace gridiron::test
