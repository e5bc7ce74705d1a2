// libFuzzer target: the PLY reader on hostile bytes. Seeds: the files of GRIDIRON_PLY_ZOO, given as a corpus directory.
// Checks what a caller relies on: any cutting gives the same, indices are in range, counts hold, loops end.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include <bit>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace {

using namespace gridiron;

void require(bool condition) {
  if (!condition) std::abort();
}

// Everything a caller sees, folded into one number; pieces must not change it.
struct Digest {
  std::uint64_t value = 0xCBF29CE484222325u;
  void add(std::uint64_t word) { value = (value ^ word) * 0x100000001B3u; }
};

struct Seen {
  Digest digest;
  PlyError error;
  PlyCounts counts;
};

// Pieces of `piece` bytes, or of varying sizes where it is 0, each in memory of exactly its size.
Seen read_in_pieces(const std::uint8_t* data, std::size_t bytes, std::size_t piece, std::size_t batch) {
  const auto reader = std::make_unique<PlyReader>();
  std::vector<Vec3> vertices(batch);
  std::vector<UVec3> triangles(batch);
  std::vector<Vec3> normals(batch), colors(batch);
  reader->set_output({vertices, triangles, normals, colors});
  Seen seen;
  std::uint64_t vertex_total = 0, triangle_total = 0;
  const auto take = [&](const PlyStep& step) {
    if (step.event == PlyEvent::kNeedInput) return;
    seen.digest.add(static_cast<std::uint64_t>(step.event));
    require(step.item_count <= batch);
    if (step.event == PlyEvent::kVertices) {
      require(step.item_count > 0 && step.first_item == vertex_total);
      vertex_total += step.item_count;
      for (std::size_t i = 0; i < step.item_count; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          const std::uint32_t bits = std::bit_cast<std::uint32_t>(vertices[i][axis]);
          require((bits & 0x7F800000u) != 0x7F800000u);
          seen.digest.add(bits);
          const std::uint32_t normal = std::bit_cast<std::uint32_t>(normals[i][axis]);
          require((normal & 0x7F800000u) != 0x7F800000u);
          require(colors[i][axis] >= 0.0f && colors[i][axis] <= 1.0f);
          seen.digest.add(normal);
          seen.digest.add(std::bit_cast<std::uint32_t>(colors[i][axis]));
        }
      }
    }
    if (step.event == PlyEvent::kTriangles) {
      require(step.item_count > 0 && step.first_item == triangle_total);
      triangle_total += step.item_count;
      for (std::size_t i = 0; i < step.item_count; ++i) {
        for (int corner = 0; corner < 3; ++corner) {
          require(triangles[i][corner] < reader->header().vertex_count);
          seen.digest.add(triangles[i][corner]);
        }
      }
    }
  };

  std::size_t place = 0;
  bool failed = false;
  std::uint32_t state = 12345;
  while (place < bytes && !failed) {
    state = state * 1664525u + 1013904223u;
    std::size_t size = piece != 0 ? piece : (state >> 16) % 97;
    if (size > bytes - place) size = bytes - place;
    const auto copy = std::make_unique<std::byte[]>(size);
    if (size > 0) std::memcpy(copy.get(), data + place, size);
    place += size;
    std::span<const std::byte> rest(copy.get(), size);
    for (;;) {
      const PlyStep step = reader->feed(rest);
      require(step.consumed_bytes <= rest.size());
      rest = rest.subspan(step.consumed_bytes);
      take(step);
      require(step.event != PlyEvent::kEnd);
      failed = step.event == PlyEvent::kError;
      if (failed || step.event == PlyEvent::kNeedInput) break;
    }
    require(failed || rest.empty());
  }
  for (bool over = failed; !over;) {
    const PlyStep step = reader->finish();
    require(step.event != PlyEvent::kNeedInput && step.consumed_bytes == 0);
    take(step);
    over = step.event == PlyEvent::kEnd || step.event == PlyEvent::kError;
  }

  seen.error = reader->error();
  seen.counts = reader->counts();
  const PlyPosition& position = reader->position();
  require(position.byte_offset <= bytes);
  for (const std::uint64_t word :
       {static_cast<std::uint64_t>(seen.error), position.byte_offset, position.line, position.row,
        std::uint64_t{position.element_index}, seen.counts.vertices, seen.counts.triangles, seen.counts.faces,
        seen.counts.strip_rows, seen.counts.surplus_bytes}) {
    seen.digest.add(word);
  }
  if (seen.error == PlyError::kNone) {
    require(seen.counts.vertices == reader->header().vertex_count);
    require(seen.counts.faces == reader->header().face_count);
    require(seen.counts.strip_rows == reader->header().strip_row_count);
    require(batch == 0 || (vertex_total == seen.counts.vertices && triangle_total == seen.counts.triangles));
  }
  return seen;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t bytes) {
  const Seen whole = read_in_pieces(data, bytes, bytes, 16);
  require(read_in_pieces(data, bytes, 1, 16).digest.value == whole.digest.value);
  require(read_in_pieces(data, bytes, 0, 16).digest.value == whole.digest.value);

  const auto input = std::as_bytes(std::span(data, bytes));
  const PlyResult counted = count_ply(input);
  require(counted.error == whole.error);
  if (counted.error != PlyError::kNone) return 0;
  require(counted.counts.triangles == whole.counts.triangles);
  require(counted.counts.vertices <= bytes && counted.counts.triangles <= bytes);
  std::vector<Vec3> vertices(counted.counts.vertices);
  std::vector<UVec3> triangles(counted.counts.triangles);
  require(read_ply(input, vertices, triangles).error == PlyError::kNone);
  std::vector<Vec3> normals(vertices.size()), colors(vertices.size());
  require(read_ply(input, {vertices, triangles, normals, colors}).error == PlyError::kNone);
  return 0;
}
