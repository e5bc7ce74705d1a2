// Model stream. SPDX-License-Identifier: Apache-2.0
#include "import/model_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace gridiron::tool {
namespace {

constexpr std::uint64_t kModelMagic = 0x316C646F6D697267u, kReasonMagic = 0x316E736165726967u;
constexpr std::uint64_t kEndMagic = 0x31646E656C646F6Du;
constexpr std::uint32_t kMostTextBytes = 4096, kMostTexts = 256, kMostNeighbours = 4096;
constexpr std::size_t kPieceItems = std::size_t{1} << 16;

// A material as it is sent, without padding.
struct SentMaterial {
  float color[3];
  float kd, ks, shine, transmittance, index_of_refraction;
  std::uint32_t smooth_normals;
};
static_assert(sizeof(SentMaterial) == 36 && sizeof(Vec3) == 12 && sizeof(UVec3) == 12);

[[noreturn]] void damaged(const char* reason) {
  throw ImportError(std::string("the answer of the process that reads it is damaged: ") + reason);
}

class Writer {
 public:
  explicit Writer(const ByteSink& sink) : sink_(sink) {}

  template <class Value>
  void value(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes(std::as_bytes(std::span(&value, 1)));
  }
  void text(std::string_view text) {
    text = text.substr(0, kMostTextBytes);
    value(static_cast<std::uint32_t>(text.size()));
    bytes(std::as_bytes(std::span(text)));
  }
  template <class Value>
  void array(const std::vector<Value>& values) {
    bytes(std::as_bytes(std::span(values)));
  }
  [[nodiscard]] bool is_good() const { return is_good_; }

 private:
  void bytes(std::span<const std::byte> bytes) { is_good_ = is_good_ && (bytes.empty() || sink_(bytes)); }

  const ByteSink& sink_;
  bool is_good_ = true;
};

class Reader {
 public:
  Reader(const ByteSource& source, std::uint64_t most_bytes) : source_(source), left_bytes_(most_bytes) {}

  template <class Value>
  Value value() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value{};
    bytes(std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }
  std::string text() {
    const auto size = value<std::uint32_t>();
    if (size > kMostTextBytes) damaged("a text is too long");
    std::string text(size, '\0');
    bytes(std::as_writable_bytes(std::span(text)));
    // It is printed: a file's own words must not steer a terminal.
    std::ranges::replace_if(
        text, [](char c) { return (c >= 0 && c < ' ') || c == 0x7F; }, '?');
    return text;
  }
  // Memory grows with what arrives.
  template <class Value>
  std::vector<Value> array(std::uint64_t count, std::uint64_t most) {
    if (count > most) damaged("a count is too large");
    if (count * sizeof(Value) > left_bytes_)
      throw ImportError("the mesh needs more memory than --import-memory allows");
    left_bytes_ -= count * sizeof(Value);
    std::vector<Value> values;
    while (values.size() < count) {
      const std::size_t place = values.size();
      const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(kPieceItems, count - place));
      if (values.capacity() < place + more) {
        values.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(count, std::max(place * 2, place + more))));
      }
      values.resize(place + more);
      bytes(std::as_writable_bytes(std::span(values).subspan(place)));
    }
    return values;
  }

 private:
  void bytes(std::span<std::byte> bytes) {
    if (!bytes.empty() && !source_(bytes)) damaged("it ends early");
  }

  const ByteSource& source_;
  std::uint64_t left_bytes_;
};

bool is_share(float value) {
  return value >= 0.0f && value <= 1.0f;
}

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

SceneMaterial material_of(const SentMaterial& sent) {
  for (const float share : {sent.color[0], sent.color[1], sent.color[2], sent.kd, sent.ks, sent.transmittance}) {
    if (!is_share(share)) damaged("a share of a material is not in 0..1");
  }
  const float index = sent.index_of_refraction;
  if (!(sent.shine >= 0.0f && sent.shine <= kMostShine)) damaged("an exponent is out of range");
  if (!(index >= kLeastRefraction && index <= kMostRefraction)) damaged("an index of refraction is out of range");
  if (sent.smooth_normals > 1) damaged("a flag is neither 0 nor 1");
  return {.color = Vec3(sent.color[0], sent.color[1], sent.color[2]),
          .kd = sent.kd,
          .ks = sent.ks,
          .shine = sent.shine,
          .transmittance = sent.transmittance,
          .index_of_refraction = index,
          .smooth_normals = sent.smooth_normals != 0};
}

// Indices of corners: in range, or kNoNormal three times where that is allowed.
void check_corners(const std::vector<UVec3>& corners, std::size_t count, bool may_be_none) {
  for (const UVec3& corner : corners) {
    if (corner.x < count && corner.y < count && corner.z < count) continue;
    const bool is_none = corner.x == kNoNormal && corner.y == kNoNormal && corner.z == kNoNormal;
    if (!may_be_none || !is_none) damaged("an index names nothing");
  }
}

void check_mesh(const Mesh& mesh) {
  const MeshSurface& surface = mesh.surface;
  if (!std::ranges::all_of(mesh.vertices, is_finite)) damaged("a coordinate is not finite");
  check_corners(mesh.triangles, mesh.vertices.size(), /*may_be_none=*/false);
  for (const std::uint16_t material : surface.triangle_materials) {
    if (material >= surface.materials.size()) damaged("an index names nothing");
  }
  constexpr float kTolerance = 1e-3f;
  for (const Vec3& normal : surface.normals) {
    const float square = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
    if (!(std::abs(square - 1.0f) < kTolerance)) damaged("a normal is not of length 1");
  }
  for (const Vec3& color : surface.colors) {
    if (!is_share(color.x) || !is_share(color.y) || !is_share(color.z)) damaged("a colour is not in 0..1");
  }
  check_corners(surface.triangle_normals, surface.normals.size(), /*may_be_none=*/true);
  check_corners(surface.triangle_colors, surface.colors.size(), /*may_be_none=*/true);
}

}  // namespace

bool write_model(const ImportedModel& model, const ByteSink& sink) {
  Writer writer(sink);
  writer.value(kModelMagic);
  const ImportReport& report = model.report;
  for (const std::string* text : {&report.format, &report.reader, &report.up}) writer.text(*text);
  writer.value(report.unit_metres);
  writer.value(report.meshes);
  writer.value(report.textures);
  const std::size_t animations = std::min<std::size_t>(report.animations.size(), kMostTexts);
  writer.value(static_cast<std::uint32_t>(animations));
  for (std::size_t i = 0; i < animations; ++i) {
    writer.text(report.animations[i].name);
    writer.value(report.animations[i].seconds);
  }
  const std::size_t ignored = std::min<std::size_t>(report.ignored.size(), kMostTexts);
  writer.value(static_cast<std::uint32_t>(ignored));
  for (std::size_t i = 0; i < ignored; ++i) writer.text(report.ignored[i]);
  const std::size_t neighbours = std::min<std::size_t>(model.neighbours.size(), kMostNeighbours);
  writer.value(static_cast<std::uint32_t>(neighbours));
  for (std::size_t i = 0; i < neighbours; ++i) {
    writer.text(model.neighbours[i].path);
    writer.value(model.neighbours[i].content);
  }
  const Mesh& mesh = model.mesh;
  const MeshSurface& surface = mesh.surface;
  for (const std::uint64_t count : std::array<std::uint64_t, 8>{
           mesh.vertices.size(), mesh.triangles.size(), surface.materials.size(), surface.triangle_materials.size(),
           surface.normals.size(), surface.triangle_normals.size(), surface.colors.size(),
           surface.triangle_colors.size()}) {
    writer.value(count);
  }
  writer.array(mesh.vertices);
  writer.array(mesh.triangles);
  for (const SceneMaterial& material : surface.materials) {
    writer.value(SentMaterial{{material.color.x, material.color.y, material.color.z},
                              material.kd,
                              material.ks,
                              material.shine,
                              material.transmittance,
                              material.index_of_refraction,
                              material.smooth_normals ? 1u : 0u});
  }
  writer.array(surface.triangle_materials);
  writer.array(surface.normals);
  writer.array(surface.triangle_normals);
  writer.array(surface.colors);
  writer.array(surface.triangle_colors);
  writer.value(kEndMagic);
  return writer.is_good();
}

bool write_reason(const std::string& reason, const ByteSink& sink) {
  Writer writer(sink);
  writer.value(kReasonMagic);
  writer.text(reason);
  return writer.is_good();
}

ImportedModel read_model(const ByteSource& source, std::uint64_t most_bytes) {
  Reader reader(source, most_bytes);
  const auto magic = reader.value<std::uint64_t>();
  if (magic == kReasonMagic) throw ImportError(reader.text());
  if (magic != kModelMagic) damaged("it does not begin as one");
  ImportedModel model;
  ImportReport& report = model.report;
  for (std::string* text : {&report.format, &report.reader, &report.up}) *text = reader.text();
  report.unit_metres = reader.value<double>();
  if (!(report.unit_metres >= 0.0 && report.unit_metres <= 1e9)) damaged("a unit is out of range");
  report.meshes = reader.value<std::uint64_t>();
  report.textures = reader.value<std::uint64_t>();
  const auto animations = reader.value<std::uint32_t>();
  if (animations > kMostTexts) damaged("a count is too large");
  for (std::uint32_t i = 0; i < animations; ++i) {
    std::string name = reader.text();
    const auto seconds = reader.value<double>();
    if (!(seconds >= 0.0 && seconds <= 1e9)) damaged("a time is out of range");
    report.animations.push_back({std::move(name), seconds});
  }
  const auto texts = reader.value<std::uint32_t>();
  if (texts > kMostTexts) damaged("a count is too large");
  for (std::uint32_t i = 0; i < texts; ++i) report.ignored.push_back(reader.text());
  const auto neighbours = reader.value<std::uint32_t>();
  if (neighbours > kMostNeighbours) damaged("a count is too large");
  for (std::uint32_t i = 0; i < neighbours; ++i) {
    std::string path = reader.text();
    model.neighbours.push_back({std::move(path), reader.value<std::uint64_t>()});
  }
  std::array<std::uint64_t, 8> counts{};
  for (std::uint64_t& count : counts) count = reader.value<std::uint64_t>();
  const std::uint64_t triangles = counts[1];
  for (const std::size_t each : {std::size_t{3}, std::size_t{5}, std::size_t{7}}) {
    if (counts[each] != 0 && counts[each] != triangles) damaged("a list has not one entry for each triangle");
  }
  constexpr std::uint64_t kMostCorners = std::uint64_t{3} * kMostSceneTriangles;
  Mesh& mesh = model.mesh;
  MeshSurface& surface = mesh.surface;
  mesh.vertices = reader.array<Vec3>(counts[0], kMostSceneVertices);
  mesh.triangles = reader.array<UVec3>(triangles, kMostSceneTriangles);
  for (const SentMaterial& sent : reader.array<SentMaterial>(counts[2], kMostSceneMaterials)) {
    surface.materials.push_back(material_of(sent));
  }
  surface.triangle_materials = reader.array<std::uint16_t>(counts[3], kMostSceneTriangles);
  surface.normals = reader.array<Vec3>(counts[4], kMostCorners);
  surface.triangle_normals = reader.array<UVec3>(counts[5], kMostSceneTriangles);
  surface.colors = reader.array<Vec3>(counts[6], kMostCorners);
  surface.triangle_colors = reader.array<UVec3>(counts[7], kMostSceneTriangles);
  if (reader.value<std::uint64_t>() != kEndMagic) damaged("it does not end as one");
  check_mesh(mesh);
  return model;
}

}  // namespace gridiron::tool
