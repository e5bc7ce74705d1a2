// File kinds: by content, whatever the name. SPDX-License-Identifier: Apache-2.0
#include "files/file_kind.h"

#include <gtest/gtest.h>

namespace gridiron::test {
namespace {

using tool::SceneKind;
using namespace std::string_literals;

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(FileKind, ScenesAreKnownByTheirContent) {
  const struct {
    std::string content;
    SceneKind kind;
  } cases[] = {
      {"ply\nformat ascii 1.0\n", SceneKind::kMesh},
      {"ply\r\nformat ascii 1.0\r\n", SceneKind::kMesh},
      {"GDRI\1\0\0\0"s, SceneKind::kPacked},
      {"v\nfrom 1 2 3\n", SceneKind::kText},
      {"# a scene\n\n  b 0 0.5 1 # blue\n", SceneKind::kText},
      {"s 0 0 0 1\n", SceneKind::kText},
      {"p 3\n0 0 0\n", SceneKind::kText},
      {"m mesh.ply\n", SceneKind::kText},
      {"sn on\n", SceneKind::kText},
      {"v 0.1 0.2 0.3\n", SceneKind::kMesh},  // OBJ
      {"s off\n", SceneKind::kMesh},
      {"f 1/2/3 4/5/6 7/8/9\n", SceneKind::kUnknown},
      {"s 0\0 0 0 1\n"s, SceneKind::kUnknown},
      {"plywood\n", SceneKind::kUnknown},
      {"bring me a mesh\n", SceneKind::kUnknown},
      {"# nothing\n", SceneKind::kUnknown},
      {"", SceneKind::kUnknown},
  };
  for (const auto& each : cases) {
    for (const char* name : {"a", "a.ply", "a.gri", "a.txt"}) {
      EXPECT_EQ(tool::scene_kind_of(bytes_of(each.content), name), each.kind) << each.content << name;
    }
  }
  // The reader of text scenes names the line of a mistake, if the name promises a text scene and the content allows it.
  EXPECT_EQ(tool::scene_kind_of(bytes_of("spher 0 0 0 1\n"), "a.nff"), SceneKind::kText);
  EXPECT_EQ(tool::scene_kind_of(bytes_of("v 0.1 0.2 0.3\n"), "a.nff"), SceneKind::kUnknown);
  EXPECT_EQ(tool::scene_kind_of(bytes_of(""), "a.nff"), SceneKind::kUnknown);
}

TEST(FileKind, ModelsAreKnownByTheirContentElseByTheirName) {
  const std::string stl = std::string(80, ' ') + "\1\0\0\0"s + std::string(50, '\0');
  const struct {
    std::string content, name, ending;
  } cases[] = {
      {"v 1 2 3\n", "a", "obj"},       {"s 0 0 0 1\n", "a", ""},         {"s 0 0 0 1\n", "a.OBJ", "obj"},
      {"glTF\2\0\0\0"s, "a.obj", "glb"}, {"{\"asset\": {}}", "a", "gltf"}, {"{\"a\": 1}", "a.gltf", "gltf"},
      {"solid x\n", "a", "stl"},        {stl, "a", "stl"},               {"solid" + stl.substr(5), "a.obj", "stl"},
      {"\x89PNG", "a.obj", ""},         {"\x1F\x8B", "a.obj", ""},       {"PK\x03\x04", "a.3mf", "3mf"},
      {"PK\x03\x04", "a", ""},         {"ply\n", "a.obj", ""},          {"", "a.obj", ""},
      {"OFF\n", "a", "off"},            {"anything", "a.fbx", "fbx"},    {"v 1 2 3\n", "a.nff", ""},
      {"\xFF\xFEv\0 \0"s, "a.obj", ""}, {"v\0 \0"s, "a.obj", ""},       {"\xFF\xFE<\0?\0"s, "a.dae", "dae"},
      {"\xFF\xFE" + stl.substr(2), "a.stl", "stl"}};
  for (const auto& each : cases) {
    EXPECT_EQ(tool::model_ending(bytes_of(each.content), each.name, each.content.size()), each.ending)
        << each.content.substr(0, 10) << " " << each.name;
  }
}

TEST(FileKind, WhatIsNotReadIsNamed) {
  const struct {
    std::string content, words;
  } cases[] = {
      {"", "is empty"},
      {"\x89PNG\r\n\x1A\n", "is a PNG picture"},
      {"\xFF\xD8\xFF\xE0", "is a JPEG picture"},
      {"MM\0*"s, "is a TIFF picture"},
      {"\x1F\x8B\x08\0"s, "is compressed with gzip; unpack it first"},
      {"PK\x03\x04", "is a zip archive; unpack it first"},
      {"glTF\2\0\0\0"s, "is a glTF scene"},
      {"{\"asset\": {\"version\": \"2.0\"}}", "is a glTF scene"},
      {"{\"version\": 2}", "is JSON text"},
      {"# made by a program\nmtllib a.mtl\nv 1 2 3\n", "is an OBJ mesh"},
      {"v 1 2 3\n", "is an OBJ mesh"},
      {"solid part\nfacet normal 0 0 1\n", "is an STL mesh"},
      {std::string(80, ' ') + "\1\0\0\0"s + std::string(50, '\0'), "is an STL mesh"},
      {"OFF\n8 6 12\n", "is an OFF mesh"},
      {"<!DOCTYPE html>", "is a web page"},
      {"ply\n", "is a PLY mesh"},
      {"GDRI\1\0\0\0"s, "is a packed scene"},
      {"GJOB\1\0\0\0"s, "is a job"},
      {"GRES\1\0\0\0"s, "is the result of a job"},
      {"b 0 0 0\n", "is a text scene"},
      {"eye 1 2 3\n", "is a camera file"},
      {"based_on cell-ps3\n", "is a machine file"},
      {"\xFF\xFEp\0l\0y\0"s, "is UTF-16 text; save it as UTF-8"},
      {"\xFE\xFF\0p\0l\0y"s, "is UTF-16 text; save it as UTF-8"},
      {"p\0l\0y\0\n\0"s, "is UTF-16 text; save it as UTF-8"},
      {"\0p\0l\0y"s, "is UTF-16 text; save it as UTF-8"},
      {"# nothing\n", "holds nothing but blanks and comments"},
      {"\1\2\3\0abcdefgh"s, "is of no known kind: it begins with '\\x01\\x02\\x03\\x00abcd'"},
  };
  for (const auto& each : cases) {
    EXPECT_EQ(tool::words_of_content(bytes_of(each.content), each.content.size()), each.words);
  }
}

}  // namespace
}  // namespace gridiron::test
