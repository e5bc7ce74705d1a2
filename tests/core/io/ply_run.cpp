// Drives the PLY reader and writes its inputs.
// Memory: std::vector, std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#include "core/io/ply_run.h"

namespace gridiron::test {

Chunking chunks_of(std::size_t bytes) {
  return [bytes](std::size_t) { return bytes; };
}

Chunking random_chunks(std::uint32_t seed) {
  auto generator = std::make_shared<std::mt19937>(seed);
  return [generator](std::size_t) -> std::size_t {
    const std::uint32_t bits = static_cast<std::uint32_t>((*generator)());
    return (bits >> 8) % (1u << (bits % 11));  // 0..1023, small ones often
  };
}

PlyOutcome run_ply(std::string_view input, const Chunking& chunking, const PlyRunOptions& options) {
  PlyOutcome outcome;
  auto reader = std::make_unique<PlyReader>(options.config);
  std::vector<Vec3> vertices(options.vertex_batch);
  std::vector<UVec3> triangles(options.triangle_batch);
  std::vector<Vec3> normals(options.vertex_batch, Vec3(-77.0f)), colors = normals;
  reader->set_output({vertices, triangles, normals, colors});

  const auto take = [&](const PlyStep& step) {
    if (step.event == PlyEvent::kNeedInput) return;
    outcome.batches.push_back({step.event, step.first_item, step.item_count});
    if (step.event == PlyEvent::kVertices) {
      EXPECT_LE(step.item_count, vertices.size());
      EXPECT_EQ(step.first_item, outcome.vertices.size());
      for (std::size_t i = 0; i < step.item_count; ++i) {
        const Vec3& v = vertices[i];
        outcome.vertices.push_back(
            {std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y), std::bit_cast<std::uint32_t>(v.z)});
        outcome.normals.push_back({normals[i].x, normals[i].y, normals[i].z});
        outcome.colors.push_back({colors[i].x, colors[i].y, colors[i].z});
      }
    }
    if (step.event == PlyEvent::kTriangles) {
      EXPECT_LE(step.item_count, triangles.size());
      EXPECT_EQ(step.first_item, outcome.triangles.size());
      for (std::size_t i = 0; i < step.item_count; ++i) {
        outcome.triangles.push_back({triangles[i].x, triangles[i].y, triangles[i].z});
      }
    }
    // What the reader said is done with; whatever it still reads of it would be seen.
    for (auto* const values : {&vertices, &normals, &colors}) std::fill(values->begin(), values->end(), Vec3(-77.0f));
    std::fill(triangles.begin(), triangles.end(), UVec3(0xDEADBEEFu));
  };

  bool over = false;
  std::size_t idle = 0;
  while (!input.empty() && !over) {
    const std::size_t bytes = std::min(chunking(input.size()), input.size());
    idle = bytes == 0 ? idle + 1 : 0;
    // Memory of exactly the piece's size, so that a sanitizer sees a read beyond it.
    const auto piece = std::make_unique<std::byte[]>(bytes);
    std::transform(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(bytes), piece.get(),
                   [](char c) { return static_cast<std::byte>(c); });
    input.remove_prefix(bytes);
    std::span<const std::byte> rest(piece.get(), bytes);
    for (;;) {
      const PlyStep step = reader->feed(rest);
      take(step);
      EXPECT_LE(step.consumed_bytes, rest.size());
      rest = rest.subspan(step.consumed_bytes);
      over = step.event == PlyEvent::kError;
      EXPECT_TRUE(step.event != PlyEvent::kNeedInput || rest.empty());
      if (over || step.event == PlyEvent::kNeedInput) break;
    }
  }
  while (!over) {
    const PlyStep step = reader->finish();
    EXPECT_EQ(step.consumed_bytes, 0u);
    EXPECT_NE(step.event, PlyEvent::kNeedInput);
    take(step);
    over = step.event == PlyEvent::kError || step.event == PlyEvent::kEnd || step.event == PlyEvent::kNeedInput;
  }

  outcome.error = reader->error();
  const PlyPosition& position = reader->position();
  outcome.byte_offset = position.byte_offset;
  outcome.line = position.line;
  outcome.row = position.row;
  outcome.element_index = position.element_index;
  outcome.element_name = position.element_name;
  outcome.vertex_count = reader->header().vertex_count;
  outcome.face_count = reader->header().face_count;
  outcome.strip_row_count = reader->header().strip_row_count;
  outcome.faces = reader->counts().faces;
  outcome.strip_rows = reader->counts().strip_rows;
  outcome.surplus_bytes = reader->counts().surplus_bytes;
  outcome.counted_vertices = reader->counts().vertices;
  outcome.counted_triangles = reader->counts().triangles;
  // After the end or an error nothing happens any more.
  const std::byte more[1] = {};
  EXPECT_EQ(reader->feed(more).event, outcome.error == PlyError::kNone ? PlyEvent::kEnd : PlyEvent::kError);
  return outcome;
}

PlyOutcome run_ply(std::string_view input) {
  return run_ply(input, chunks_of(input.size()));
}

PlyOutcome run_ply_in_pieces(const std::string& input, const PlyRunOptions& options) {
  const PlyOutcome whole = run_ply(input, chunks_of(input.size()), options);
  const auto expect_same = [&](const Chunking& chunking, const std::string& what) {
    const PlyOutcome pieces = run_ply(input, chunking, options);
    EXPECT_TRUE(pieces == whole) << what << ": " << describe(pieces) << "\ninstead of " << describe(whole) << "\n"
                                 << input.substr(0, 600);
  };
  for (const std::size_t bytes : {1u, 2u, 3u, 7u, 64u, 4096u}) {
    expect_same(chunks_of(bytes), "pieces of " + std::to_string(bytes));
  }
  for (const std::uint32_t seed : {1u, 2u, 3u, 9u}) {
    expect_same(random_chunks(seed), "random pieces, seed " + std::to_string(seed));
  }
  return whole;
}

std::string describe(const PlyOutcome& outcome) {
  std::ostringstream out;
  if (outcome.error != PlyError::kNone) {
    out << ply_error_reason(outcome.error) << " (" << static_cast<int>(outcome.error) << ") at byte "
        << outcome.byte_offset << ", line " << outcome.line << ", element " << outcome.element_name << ", row "
        << outcome.row << "; ";
  }
  out << outcome.counted_vertices << " vertices, " << outcome.faces << " faces, " << outcome.strip_rows
      << " strip rows, " << outcome.counted_triangles << " triangles, " << outcome.surplus_bytes << " surplus bytes, "
      << outcome.batches.size() << " events";
  return out.str();
}

PlyMaker::PlyMaker(PlyFormat format, std::string line_end) : format_(format), line_end_(std::move(line_end)) {
  line("ply");
  line(format == PlyFormat::kAscii                ? "format ascii 1.0"
       : format == PlyFormat::kBinaryLittleEndian ? "format binary_little_endian 1.0"
                                                  : "format binary_big_endian 1.0");
}

PlyMaker& PlyMaker::line(std::string_view text) {
  text_ += text;
  text_ += line_end_;
  return *this;
}

PlyMaker& PlyMaker::coordinates(std::string_view type) {
  for (const char* name : {" x", " y", " z"}) line("property " + std::string(type) + name);
  return *this;
}

PlyMaker& PlyMaker::end_header() {
  return line("end_header");
}

PlyMaker& PlyMaker::token(std::string_view text) {
  if (row_has_value_) text_ += ' ';
  row_has_value_ = true;
  text_ += text;
  return *this;
}

PlyMaker& PlyMaker::value(std::string_view type, double value) {
  if (format_ == PlyFormat::kAscii) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return token(text);
  }
  std::uint64_t bits = 0;
  std::size_t bytes = 0;
  if (type == "float") {
    bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    bytes = 4;
  } else if (type == "double") {
    bits = std::bit_cast<std::uint64_t>(value);
    bytes = 8;
  } else {
    bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
    bytes = type == "char" || type == "uchar" ? 1 : type == "short" || type == "ushort" ? 2 : 4;
  }
  for (std::size_t i = 0; i < bytes; ++i) {
    const std::size_t place = format_ == PlyFormat::kBinaryBigEndian ? bytes - 1 - i : i;
    text_ += static_cast<char>(bits >> (8 * place) & 0xFF);
  }
  return *this;
}

PlyMaker& PlyMaker::end_row() {
  if (format_ == PlyFormat::kAscii) text_ += line_end_;
  row_has_value_ = false;
  return *this;
}

}  // namespace gridiron::test
