// glTF text. SPDX-License-Identifier: Apache-2.0
#include "import/gltf_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/words.h"
#include "import/model_stream.h"

namespace gridiron::tool {
namespace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;

std::size_t bytes_of_component(int type) {
  if (type == kByte || type == kUnsignedByte) return 1;
  if (type == kShort || type == kUnsignedShort) return 2;
  return type == kUnsignedInt || type == kFloat ? 4 : 0;
}

template <class Value>
Value value_at(const std::byte* place) {
  Value value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

// Source of the shares: glTF 2.0, section 3.6.2.2.
float component_at(const std::byte* place, int type, bool is_share) {
  const auto integer = [is_share](double value, double most) {
    return static_cast<float>(is_share ? std::max(value / most, -1.0) : value);
  };
  switch (type) {
    case kByte:
      return integer(value_at<std::int8_t>(place), 127);
    case kUnsignedByte:
      return integer(value_at<std::uint8_t>(place), 255);
    case kShort:
      return integer(value_at<std::int16_t>(place), 32767);
    case kUnsignedShort:
      return integer(value_at<std::uint16_t>(place), 65535);
    case kUnsignedInt:
      return integer(value_at<std::uint32_t>(place), 4294967295.0);
    default:
      return value_at<float>(place);
  }
}

std::uint32_t whole_number_at(const std::byte* place, int type) {
  if (type == kUnsignedByte) return value_at<std::uint8_t>(place);
  return type == kUnsignedShort ? value_at<std::uint16_t>(place) : value_at<std::uint32_t>(place);
}

unsigned components_of(const std::string& type) {
  constexpr std::array<std::string_view, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto found = std::ranges::find(kTypes, type);
  return found == kTypes.end() ? 0 : static_cast<unsigned>(found - kTypes.begin()) + 1;
}

int type_in(const Json& object) {
  return static_cast<int>(index_in(object, "componentType").value_or(0) & 0xFFFF);
}

bool is_normalized(const Json& accessor) {
  const auto found = accessor.find("normalized");
  return found != accessor.end() && found->is_boolean() && found->get<bool>();
}

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    std::uint32_t digit = 0;
    if (c >= 'A' && c <= 'Z') {
      digit = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      digit = static_cast<std::uint32_t>(c - 'a') + 26;
    } else if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0') + 52;
    } else if (c == '+' || c == '/') {
      digit = c == '+' ? 62 : 63;
    } else if (c == '=') {
      break;
    } else {
      return std::nullopt;
    }
    bits = bits << 6 | digit;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> count & 0xFF));
  }
  return bytes;
}

// The chunks of a binary file: its JSON, and the bytes of buffer 0.
bool find_chunks(std::span<const std::byte> file, std::span<const std::byte>& json,
                 std::span<const std::byte>& buffer) {
  constexpr std::size_t kHeadBytes = 12, kChunkHeadBytes = 8;
  constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBufferChunk = 0x004E4942;
  std::size_t place = kHeadBytes;
  while (place + kChunkHeadBytes <= file.size()) {
    const auto bytes = value_at<std::uint32_t>(file.data() + place);
    const auto kind = value_at<std::uint32_t>(file.data() + place + 4);
    place += kChunkHeadBytes;
    if (bytes > file.size() - place) break;
    if (kind == kJsonChunk && json.empty()) json = file.subspan(place, bytes);
    if (kind == kBufferChunk && buffer.empty()) buffer = file.subspan(place, bytes);
    place += bytes;
    place += (4 - place % 4) % 4;
  }
  return !json.empty();
}

// Extensions that are read, or that make no difference to a picture made here.
constexpr std::array<std::string_view, 10> kReadExtensions = {"KHR_draco_mesh_compression",
                                                              "KHR_lights_punctual",
                                                              "KHR_materials_ior",
                                                              "KHR_materials_pbrSpecularGlossiness",
                                                              "KHR_materials_transmission",
                                                              "KHR_materials_unlit",
                                                              "KHR_mesh_quantization",
                                                              "KHR_texture_transform",
                                                              "KHR_xmp_json_ld",
                                                              "KHR_xmp"};
// Extensions of looks: without them a file shows the same triangles.
constexpr std::array<std::string_view, 6> kLookPrefixes = {"KHR_materials_", "EXT_materials_", "KHR_texture_",
                                                           "EXT_texture_",   "MSFT_texture_",  "KHR_animation_pointer"};

std::vector<std::string> names_in(const Json& root, const char* key) {
  std::vector<std::string> names;
  const Json* const list = member(&root, key);
  if (list == nullptr || !list->is_array()) return names;
  for (const Json& name : *list) {
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

bool is_read(const std::string& extension) {
  return std::ranges::find(kReadExtensions, extension) != kReadExtensions.end();
}

}  // namespace

std::optional<std::size_t> index_in(const Json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::size_t>();
}

const Json* member(const Json* object, const char* key) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found != object->end() && found->is_structured() ? &*found : nullptr;
}

double number_in(const Json& object, const char* key, double otherwise) {
  if (!object.is_object()) return otherwise;
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

std::optional<std::vector<double>> numbers_in(const Json& object, const char* key, std::size_t count) {
  const Json* const list = member(&object, key);
  if (list == nullptr || !list->is_array() || list->size() != count) return std::nullopt;
  std::vector<double> numbers;
  for (const Json& number : *list) {
    if (!number.is_number()) return std::nullopt;
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

std::string words_in(const Json& object, const char* key) {
  if (!object.is_object()) return "";
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<GltfText> GltfText::parse(std::span<const std::byte> bytes, AssimpFiles& files, std::string& fault) {
  GltfText result(files);
  std::span<const std::byte> json = bytes;
  if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
    json = {};
    if (!find_chunks(bytes, json, result.chunk_)) {
      fault = "is no whole binary glTF of version 2";
      return std::nullopt;
    }
  }
  const char* const begin = reinterpret_cast<const char*>(json.data());
  // A file may end in zeros, which are no JSON.
  std::size_t size = json.size();
  while (size != 0 && begin[size - 1] == '\0') --size;
  try {
    result.root_ = Json::parse(begin, begin + size);
  } catch (const Json::parse_error& error) {
    const std::size_t place = std::min(error.byte, size);
    const auto line = 1 + std::count(begin, begin + place, '\n');
    fault = place == size ? "its JSON ends early" : "its JSON is wrong in line " + std::to_string(line);
    return std::nullopt;
  }
  if (!result.root_.is_object()) {
    fault = "its JSON is no object";
    return std::nullopt;
  }
  return result;
}

const Json* GltfText::item(const char* list, std::optional<std::size_t> index) const {
  const Json* const items = member(&root_, list);
  if (!index || items == nullptr || !items->is_array() || *index >= items->size()) return nullptr;
  const Json& found = (*items)[*index];
  return found.is_object() ? &found : nullptr;
}

std::optional<std::span<const std::byte>> GltfText::buffer(std::size_t index) const {
  if (const auto found = decoded_.find(index); found != decoded_.end()) return found->second;
  const Json* const buffer = item("buffers", index);
  if (buffer == nullptr) return std::nullopt;
  const auto member = buffer->find("uri");
  if (member == buffer->end()) return index == 0 ? std::optional(chunk_) : std::nullopt;
  if (!member->is_string()) return std::nullopt;
  const auto& uri = member->get_ref<const std::string&>();
  if (!uri.starts_with("data:")) {
    const std::filesystem::path folder = std::filesystem::path(files_->name()).parent_path();
    return files_->read((folder / uri).string());
  }
  constexpr std::string_view kMark = ";base64,";
  const std::size_t place = uri.find(kMark);
  if (place == std::string::npos) return std::nullopt;
  std::optional<std::vector<std::byte>> bytes = decode_base64(std::string_view(uri).substr(place + kMark.size()));
  if (!bytes) return std::nullopt;
  return decoded_.emplace(index, std::move(*bytes)).first->second;
}

std::optional<GltfText::View> GltfText::view(const Json& owner, const char* key) const {
  const Json* const view = item("bufferViews", index_in(owner, key));
  if (view == nullptr) return std::nullopt;
  const std::optional<std::size_t> index = index_in(*view, "buffer"), bytes = index_in(*view, "byteLength");
  if (!index || !bytes) return std::nullopt;
  const std::optional<std::span<const std::byte>> whole = buffer(*index);
  const std::size_t offset = index_in(*view, "byteOffset").value_or(0);
  if (!whole || offset > whole->size() || *bytes > whole->size() - offset) return std::nullopt;
  return View{whole->subspan(offset, *bytes), index_in(*view, "byteStride").value_or(0)};
}

std::optional<std::vector<float>> GltfText::numbers(std::optional<std::size_t> index, unsigned components) const {
  const Json* const accessor = item("accessors", index);
  if (accessor == nullptr || components_of(words_in(*accessor, "type")) != components) return std::nullopt;
  const int type = type_in(*accessor);
  const std::size_t count = index_in(*accessor, "count").value_or(0), part = bytes_of_component(type);
  const bool is_share = is_normalized(*accessor);
  if (part == 0 || count == 0 || count > kMostSceneVertices) return std::nullopt;
  std::vector<float> numbers;
  if (accessor->contains("bufferView")) {
    const std::optional<View> source = view(*accessor, "bufferView");
    if (!source) return std::nullopt;
    const std::size_t element = part * components, stride = source->stride != 0 ? source->stride : element;
    const std::size_t offset = index_in(*accessor, "byteOffset").value_or(0), bytes = source->bytes.size();
    if (offset > bytes || bytes - offset < element || (bytes - offset - element) / stride < count - 1) {
      return std::nullopt;
    }
    numbers.reserve(count * components);
    for (std::size_t i = 0; i < count; ++i) {
      const std::byte* const place = source->bytes.data() + offset + i * stride;
      for (unsigned k = 0; k < components; ++k) numbers.push_back(component_at(place + k * part, type, is_share));
    }
  } else {
    numbers.resize(count * components);
  }
  if (const Json* const sparse = member(accessor, "sparse")) {
    if (!replace_sparse(*sparse, *accessor, components, numbers)) return std::nullopt;
  }
  return numbers;
}

bool GltfText::replace_sparse(const Json& sparse, const Json& accessor, unsigned components,
                              std::vector<float>& numbers) const {
  const Json *const places = member(&sparse, "indices"), *const values = member(&sparse, "values");
  const std::size_t count = index_in(sparse, "count").value_or(0);
  if (places == nullptr || values == nullptr) return false;
  const std::optional<View> places_view = view(*places, "bufferView"), values_view = view(*values, "bufferView");
  if (!places_view || !values_view) return false;
  const int type = type_in(accessor), place_type = type_in(*places);
  const std::size_t element = bytes_of_component(type) * components, place_bytes = bytes_of_component(place_type);
  if (place_type != kUnsignedByte && place_type != kUnsignedShort && place_type != kUnsignedInt) return false;
  const auto from = [](const View& view, const Json& part) {
    return view.bytes.subspan(std::min(view.bytes.size(), index_in(part, "byteOffset").value_or(0)));
  };
  const std::span<const std::byte> place_list = from(*places_view, *places), value_list = from(*values_view, *values);
  if (count > place_list.size() / place_bytes || count > value_list.size() / element) return false;
  const bool is_share = is_normalized(accessor);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = whole_number_at(place_list.data() + i * place_bytes, place_type);
    if (index >= numbers.size() / components) return false;
    for (unsigned k = 0; k < components; ++k) {
      const std::size_t part = bytes_of_component(type);
      numbers[index * components + k] = component_at(value_list.data() + i * element + k * part, type, is_share);
    }
  }
  return true;
}

bool GltfText::is_misread(std::optional<std::size_t> index) const {
  const Json* const accessor = item("accessors", index);
  return accessor != nullptr && (type_in(*accessor) != kFloat || accessor->contains("sparse"));
}

void GltfText::require_readable() const {
  for (const std::string& name : names_in(root_, "extensionsRequired")) {
    const bool is_look = std::ranges::any_of(kLookPrefixes, [&](std::string_view p) { return name.starts_with(p); });
    if (!is_look && !is_read(name)) {
      throw ImportError("requires the glTF extension " + in_quotes(name) + ", which is not read");
    }
  }
  const Json* const skins = member(&root_, "skins");
  if (skins == nullptr) return;
  for (const Json& skin : *skins) {
    if (skin.is_object() && !skin.contains("inverseBindMatrices")) {
      throw ImportError("has a skin without inverseBindMatrices, which Assimp cannot read");
    }
  }
}

std::vector<std::string> GltfText::unused_extensions() const {
  std::vector<std::string> names = names_in(root_, "extensionsUsed");
  std::erase_if(names, is_read);
  return names;
}

}  // namespace gridiron::tool
