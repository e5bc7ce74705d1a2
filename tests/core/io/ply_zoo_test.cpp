// Every file of the PLY zoo against the verdict of its manifest, in several chunkings.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include "core/io/ply_run.h"
#include "support/scenes.h"

namespace gridiron::test {
namespace {

struct Verdict {
  std::string file;
  std::string expected;
};

std::vector<Verdict> read_manifest(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<Verdict> verdicts;
  std::string line;
  std::getline(in, line);  // names of the columns
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::stringstream rest(line);
    for (std::string cell; std::getline(rest, cell, '\t');) cells.push_back(cell);
    if (cells.size() < 6) continue;
    std::string expected = cells[5];
    if (!expected.empty() && expected.front() == '"') expected.erase(0, 1);
    verdicts.push_back({cells[0], expected});
  }
  return verdicts;
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// What is refused, and for which reason. Every file that the manifest wants refused must be here, so that none is
// refused for a reason that has nothing to do with it.
const std::map<std::string, PlyError>& refused() {
  static const std::map<std::string, PlyError> table = {
      {"assimp__Wuson.ply", PlyError::kUnknownKeyword},
      {"assimp__ant-half.ply", PlyError::kTruncatedBody},
      // The manifest's reader takes "7.941797" as a list count of 7 and runs out of rows; a count is an integer, so
      // that the row where the header and the data part company is named.
      {"assimp__issue623.ply", PlyError::kBadNumber},
      {"debpython3pydl__polygon.ply", PlyError::kNotPly},
      {"dracoencodecpp__test_thread0000.ply", PlyError::kNotPly},
      {"geogramdata__corrupted_invalid_face_count.ply", PlyError::kTruncatedBody},
      {"geogramdata__truncated.ply", PlyError::kTruncatedBody},
      {"lox__no_vertex_props_ascii.ply", PlyError::kMissingCoordinate},
      {"lox__no_vertex_props_ble.ply", PlyError::kMissingCoordinate},
      {"pdal__no_vertex.ply", PlyError::kNoVertexElement},
      {"pdal__sized_dims.ply", PlyError::kMissingCoordinate},
      {"plyrs__all_atomic_types_ok_ascii.ply", PlyError::kNoVertexElement},
      {"plyrs__exponent_values_ok_ascii.ply", PlyError::kNoVertexElement},
      // The manifest blames the body that ends early; the missing vertices are seen first, in the header.
      {"plyrs__single_elements_err_ascii.ply", PlyError::kNoVertexElement},
      {"stanbun__box.ply", PlyError::kExtraWord},
      {"synth__bad_magic.ply", PlyError::kNotPly},
      {"synth__bad_version.ply", PlyError::kUnknownVersion},
      {"synth__bom.ply", PlyError::kNotPly},
      {"synth__comment_in_body_ascii.ply", PlyError::kBadNumber},
      {"synth__count_neg_ascii.ply", PlyError::kBadElementCount},
      {"synth__count_overflow_ascii.ply", PlyError::kBadElementCount},
      {"synth__count_word_ascii.ply", PlyError::kBadElementCount},
      {"synth__dup_property_x.ply", PlyError::kDuplicateProperty},
      {"synth__huge_coord_ascii.ply", PlyError::kNotFinite},
      {"synth__idx_float_be.ply", PlyError::kBadIndexType},
      {"synth__idx_float_le.ply", PlyError::kBadIndexType},
      {"synth__index_eq_n_le.ply", PlyError::kIndexRange},
      {"synth__index_huge_le.ply", PlyError::kIndexRange},
      {"synth__letter_ascii.ply", PlyError::kBadNumber},
      {"synth__list_count_255_le.ply", PlyError::kTruncatedBody},
      {"synth__missing_z.ply", PlyError::kMissingCoordinate},
      {"synth__no_end_header.ply", PlyError::kUnknownKeyword},
      {"synth__truncated_ascii.ply", PlyError::kTruncatedBody},
      {"synth__unknown_type.ply", PlyError::kUnknownType},
      {"synth__utf16.ply", PlyError::kNotPly},
      {"trimesh__ply_empty_header.ply", PlyError::kNoVertexElement},
      {"visibilitycomp__cube.ply", PlyError::kNotPly},
      // "Policy: reject or drop": coordinates that are not finite are refused.
      {"draco__float_inf_point_cloud.ply", PlyError::kNotFinite},
      // "Reject, or read line by line": lines that hold more than the header declares are refused.
      {"trimesh__fuze_ascii.ply", PlyError::kRowsAndLinesDisagree},
  };
  return table;
}

// Strips are read, which the manifest leaves open. Triangles by the same rule as the polygons: degenerate ones count.
const std::map<std::string, std::uint64_t>& strip_triangles() {
  static const std::map<std::string, std::uint64_t> table = {{"meshlab__brain.ply", 36752},
                                                             {"meshlab__elephant.ply", 39290}};
  return table;
}

class PlyZoo : public ::testing::Test {
 protected:
  void SetUp() override {
    const SharedFile manifest = find_in_ply_zoo("MANIFEST.tsv");
    GRIDIRON_SKIP_IF_MISSING(manifest);
    verdicts_ = read_manifest(manifest.path);
    ASSERT_GE(verdicts_.size(), 100u) << "manifest not understood";
  }

  static std::string contents(const std::string& file) {
    const SharedFile found = find_in_ply_zoo(file);
    EXPECT_TRUE(found.missing.empty()) << found.missing;
    return read_file(found.path);
  }

  std::vector<Verdict> verdicts_;
};

TEST_F(PlyZoo, EveryVerdictIsMet) {
  std::size_t accepted = 0, rejected = 0;
  for (const Verdict& verdict : verdicts_) {
    SCOPED_TRACE(verdict.file + ": " + verdict.expected);
    const std::string input = contents(verdict.file);
    const PlyResult counted = count_ply(std::as_bytes(std::span(input)));
    const PlyOutcome outcome = run_ply(input);
    EXPECT_EQ(counted.error, outcome.error);

    const auto refusal = refused().find(verdict.file);
    if (refusal != refused().end()) {
      EXPECT_EQ(static_cast<int>(outcome.error), static_cast<int>(refusal->second)) << describe(outcome);
      unsigned long row = 0;
      const std::size_t place = verdict.expected.find(", row ");
      if (outcome.error == PlyError::kTruncatedBody && place != std::string::npos) {
        ASSERT_EQ(std::sscanf(verdict.expected.c_str() + place, ", row %lu", &row), 1);
        EXPECT_EQ(outcome.row, row);
      }
      ++rejected;
      continue;
    }
    ASSERT_EQ(outcome.error, PlyError::kNone) << describe(outcome);
    ++accepted;
    unsigned long vertices = 0, faces = 0, triangles = 0;
    const auto strips = strip_triangles().find(verdict.file);
    if (strips != strip_triangles().end()) {
      ASSERT_EQ(std::sscanf(verdict.expected.c_str(), "accept as %lu vertices", &vertices), 1);
      triangles = strips->second;
    } else {
      const int read = std::sscanf(verdict.expected.c_str(), "accept: %lu vertices, %lu faces, %lu triangles after fan",
                                   &vertices, &faces, &triangles);
      ASSERT_TRUE(read == 3 || (read == 1 && verdict.expected.find("None faces") != std::string::npos));
    }
    EXPECT_EQ(outcome.counted_vertices, vertices);
    EXPECT_EQ(outcome.vertices.size(), vertices);
    EXPECT_EQ(outcome.faces, faces);
    EXPECT_EQ(outcome.counted_triangles, triangles);
    EXPECT_EQ(outcome.triangles.size(), triangles);
    EXPECT_EQ(counted.counts.triangles, triangles);
    EXPECT_EQ(outcome.surplus_bytes, verdict.file == "synth__trailing_bytes_le.ply" ? 7u : 0u);
  }
  EXPECT_EQ(rejected, refused().size());
  EXPECT_EQ(accepted + rejected, verdicts_.size());
}

TEST_F(PlyZoo, ChunkingChangesNothing) {
  for (const Verdict& verdict : verdicts_) {
    const std::string input = contents(verdict.file);
    const PlyOutcome whole = run_ply(input);
    std::vector<std::pair<std::string, Chunking>> chunkings = {{"7", chunks_of(7)}, {"random", random_chunks(11)}};
    if (input.size() < 100000) {
      chunkings.push_back({"1", chunks_of(1)});
      chunkings.push_back({"64", chunks_of(64)});
    }
    for (const auto& [name, chunking] : chunkings) {
      const PlyOutcome pieces = run_ply(input, chunking);
      ASSERT_TRUE(pieces == whole) << verdict.file << " in pieces of " << name << ": " << describe(pieces)
                                   << " instead of " << describe(whole);
    }
  }
}

TEST_F(PlyZoo, TwoFilesOfOneShapeAgree) {
  const PlyOutcome text = run_ply(contents("lox__sphere_ascii.ply"));
  const PlyOutcome little = run_ply(contents("lox__sphere_ble.ply"));
  const PlyOutcome big = run_ply(contents("lox__sphere_bbe.ply"));
  EXPECT_EQ(little.vertices, big.vertices);
  EXPECT_EQ(little.triangles, big.triangles);
  EXPECT_EQ(text.triangles, little.triangles);
  EXPECT_EQ(text.vertices, little.vertices);
}

}  // namespace
}  // namespace gridiron::test
