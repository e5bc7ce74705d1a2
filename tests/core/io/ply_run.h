// Drives the PLY reader over pieces of an input, and writes PLY inputs of every kind for the tests.
// Memory: std::vector, std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/io/ply_reader.h>

#include "support/test_headers.h"

namespace gridiron::test {

/// Everything a caller of the reader can see, but where the pieces were cut.
struct PlyOutcome {
  struct Batch {
    PlyEvent event;
    std::uint64_t first;
    std::uint64_t count;
    bool operator==(const Batch&) const = default;
  };
  PlyError error = PlyError::kNone;
  std::uint64_t byte_offset = 0, line = 0, row = 0;
  std::uint32_t element_index = kPlyNoElement;
  std::string element_name;
  std::uint64_t vertex_count = 0, face_count = 0, strip_row_count = 0;  ///< of the header
  std::uint64_t faces = 0, strip_rows = 0, surplus_bytes = 0;
  std::uint64_t counted_vertices = 0, counted_triangles = 0;
  std::vector<Batch> batches;
  std::vector<std::array<std::uint32_t, 3>> vertices;  ///< as float bits
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<float, 3>> normals, colors;  ///< of each vertex kept; -77 where the input has none
  bool operator==(const PlyOutcome&) const = default;
};

/// Size of the next piece, given how many bytes are left; 0 and more than is left are legal.
using Chunking = std::function<std::size_t(std::size_t bytes_left)>;

Chunking chunks_of(std::size_t bytes);
Chunking random_chunks(std::uint32_t seed);

struct PlyRunOptions {
  std::size_t vertex_batch = 5;  ///< places in the output span; 0: count only
  std::size_t triangle_batch = 4;
  PlyConfig config = {};
};

/// Feeds `input` in pieces, each in memory of exactly its size, and gathers what comes out.
PlyOutcome run_ply(std::string_view input, const Chunking& chunking, const PlyRunOptions& options = {});

/// The same with the whole input as one piece.
PlyOutcome run_ply(std::string_view input);

/// The same in pieces of several sizes, which must give what the whole gives: EXPECTs that. @returns it.
PlyOutcome run_ply_in_pieces(const std::string& input, const PlyRunOptions& options = {});

/// One line for the message of a failing test.
std::string describe(const PlyOutcome& outcome);

inline constexpr std::array<std::string_view, 8> kPlyTypes = {"char", "uchar", "short", "ushort",
                                                              "int",  "uint",  "float", "double"};

inline constexpr PlyFormat kPlyFormats[] = {PlyFormat::kAscii, PlyFormat::kBinaryLittleEndian,
                                            PlyFormat::kBinaryBigEndian};

/// Writes a PLY input value by value.
class PlyMaker {
 public:
  explicit PlyMaker(PlyFormat format, std::string line_end = "\n");

  PlyMaker& line(std::string_view text);         ///< a header line
  PlyMaker& coordinates(std::string_view type);  ///< the header lines of properties x, y, z
  PlyMaker& end_header();
  PlyMaker& value(std::string_view type, double value);  ///< ASCII: %.17g
  PlyMaker& token(std::string_view text);                ///< ASCII only: as it stands
  PlyMaker& end_row();                                   ///< ASCII: a line end
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  PlyFormat format_;
  std::string line_end_;
  std::string text_;
  bool row_has_value_ = false;
};

}  // namespace gridiron::test
