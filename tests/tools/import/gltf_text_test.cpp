// The text of glTF files: accessors of all kinds, and damaged ones, which are nothing.
// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_text.h"

#include "gltf_writer.h"
#include "import/model_stream.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using tool::AssimpFiles;
using tool::GltfText;
using Numbers = std::vector<float>;

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// A file and what is read from it, in this process.
struct Parsed {
  explicit Parsed(std::string content)
      : file(std::move(content)),
        files("lost/a.gltf", bytes_of(file)),
        text(GltfText::parse(bytes_of(file), files, fault)) {}

  std::string file;
  AssimpFiles files;
  std::string fault;
  std::optional<GltfText> text;
};

GltfWriter all_kinds() {
  GltfWriter writer;
  (void)writer.add(std::vector<std::int8_t>{127, -128, -127, 0}, kGltfByte, "VEC4", 1, ",\"normalized\":true");
  (void)writer.add(std::vector<std::uint8_t>{255, 51, 0}, kGltfUnsignedByte, "SCALAR", 3, ",\"normalized\":true");
  (void)writer.add(std::vector<std::int16_t>{32767, -32768}, kGltfShort, "VEC2", 1, ",\"normalized\":true");
  (void)writer.add(std::vector<std::uint16_t>{7, 65535}, kGltfUnsignedShort, "SCALAR", 2);
  (void)writer.add(std::vector<std::uint32_t>{4000000000u}, kGltfUnsignedInt, "SCALAR", 1);
  (void)writer.add_floats({1.5f, -2, 3}, "VEC3", 3);
  const std::size_t place = writer.add_view("\x01\x00", 2), value = writer.add_view("\x09\x08\x07", 3);
  const std::string sparse = ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":" + std::to_string(place) +
                             ",\"componentType\":5121},\"values\":{\"bufferView\":" + std::to_string(value) + "}}";
  (void)writer.add_accessor("", kGltfUnsignedByte, "VEC3", 2, sparse);
  const std::vector<float> strided = {1, 9, 2, 9, 3, 9};
  (void)writer.add_accessor(writer.add_view(strided.data(), 24, ",\"byteStride\":8"), kGltfFloat, "SCALAR", 3);
  (void)writer.add_accessor(writer.add_view(strided.data(), 24, ",\"byteStride\":8"), kGltfFloat, "SCALAR", 2,
                            ",\"byteOffset\":12");
  return writer;
}

TEST(GltfText, AccessorsOfAllKindsAreRead) {
  const GltfWriter writer = all_kinds();
  for (const std::string& file : {writer.text("\"x\":0"), writer.binary("\"x\":0")}) {
    const Parsed parsed(file);
    ASSERT_TRUE(parsed.text.has_value());
    const struct {
      unsigned components;
      Numbers expected;
    } cases[] = {{4, {1, -1, -1, 0}}, {1, {1, 0.2f, 0}},       {2, {1, -1}},   {1, {7, 65535}}, {1, {4000000000.0f}},
                 {3, {1.5f, -2, 3}},  {3, {0, 0, 0, 9, 8, 7}}, {1, {1, 2, 3}}, {1, {9, 9}}};
    for (std::size_t i = 0; i < std::size(cases); ++i) {
      SCOPED_TRACE(i);
      const auto got = parsed.text->numbers(i, cases[i].components);
      ASSERT_TRUE(got.has_value());
      EXPECT_EQ(*got, cases[i].expected);
      EXPECT_FALSE(parsed.text->numbers(i, cases[i].components == 1 ? 2 : 1).has_value());
    }
    EXPECT_FALSE(parsed.text->numbers(std::size(cases), 1).has_value());
    EXPECT_FALSE(parsed.text->numbers(std::nullopt, 1).has_value());
    EXPECT_TRUE(parsed.text->is_misread(6));
    EXPECT_FALSE(parsed.text->is_misread(5));
  }
}

TEST(GltfText, WhatIsOutOfRangeIsNothing) {
  const auto is_read = [](const std::string& from, const std::string& to) {
    GltfWriter writer;
    (void)writer.add_floats({1, 2, 3, 4}, "SCALAR", 1);
    std::string file = writer.text("\"x\":0");
    const std::size_t place = file.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return Parsed(file.replace(place, from.size(), to)).text->numbers(0, 1).has_value();
  };
  EXPECT_TRUE(is_read("\"x\":0", "\"y\":0"));
  EXPECT_TRUE(is_read("\"count\":4", "\"count\":3"));
  for (const char* count : {"0", "5", "4611686018427387905", "18446744073709551615", "-1", "4.5", "null"}) {
    EXPECT_FALSE(is_read("\"count\":4", std::string("\"count\":") + count)) << count;
  }
  EXPECT_FALSE(is_read("\"bufferView\":0", "\"bufferView\":1"));
  EXPECT_FALSE(is_read("\"buffer\":0", "\"buffer\":1"));
  EXPECT_FALSE(is_read("\"byteOffset\":0", "\"byteOffset\":1"));
  EXPECT_FALSE(is_read("\"byteOffset\":0", "\"byteOffset\":18446744073709551615"));
  EXPECT_FALSE(is_read("\"byteLength\":16", "\"byteLength\":17"));
  EXPECT_FALSE(is_read("\"byteLength\":16", "\"byteLength\":16,\"byteStride\":18446744073709551615"));
  EXPECT_FALSE(is_read("\"componentType\":5126", "\"componentType\":5130"));
  EXPECT_FALSE(is_read("base64,", "base64,!"));
  EXPECT_FALSE(is_read("data:application/octet-stream;base64,", ""));
}

TEST(GltfText, DamagedFilesAreNoDanger) {
  const std::string texts[] = {all_kinds().text("\"extensionsUsed\":[1,\"a\"]"), all_kinds().binary("\"x\":[{}]")};
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    TestRandom random(seed);
    std::string file = texts[seed % 2];
    for (std::uint32_t i = 0; i <= random.below(4); ++i) {
      char& byte = file[random.below(static_cast<std::uint32_t>(file.size()))];
      constexpr std::string_view kDigits = "0123456789";
      // Digits stay digits most of the time, so that the file stays one.
      const bool is_digit = kDigits.find(byte) != std::string_view::npos;
      byte = is_digit ? kDigits[random.below(10)] : random.below(4) == 0 ? static_cast<char>(random.next()) : byte;
    }
    if (random.below(8) == 0) file.resize(random.below(static_cast<std::uint32_t>(file.size())));
    const Parsed parsed(std::move(file));
    if (!parsed.text) continue;
    for (std::size_t accessor = 0; accessor < 10; ++accessor) {
      for (unsigned components = 1; components <= 4; ++components) {
        if (const auto numbers = parsed.text->numbers(accessor, components)) {
          EXPECT_EQ(numbers->size() % components, 0u) << "seed " << seed;
        }
      }
      (void)parsed.text->is_misread(accessor);
    }
    (void)parsed.text->unused_extensions();
  }
}

}  // namespace
}  // namespace gridiron::test
