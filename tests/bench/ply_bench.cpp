// PLY reading against plain fread of the same bytes. The reader is fed from a window, as a tool would feed it.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bench/bench.h"

namespace gridiron::bench {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open_file(const std::filesystem::path& path) {
  File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) {
    std::fprintf(stderr, "cannot open %s\n", path.c_str());
    std::exit(1);
  }
  return file;
}

// Reads a file through a window of `window.size()` bytes; spans as large as the mesh, so that nothing is copied.
PlyCounts read_through_window(const std::filesystem::path& path, std::span<std::byte> window, const PlyOutput& output) {
  const File file = open_file(path);
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  PlyReader reader;
  reader.set_output(output);
  for (;;) {
    const std::size_t bytes = std::fread(window.data(), 1, window.size(), file.get());
    std::span<const std::byte> rest = window.first(bytes);
    PlyStep step;
    do {
      step = bytes == 0 ? reader.finish() : reader.feed(rest);
      rest = rest.subspan(step.consumed_bytes);
      if (step.event == PlyEvent::kError) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), ply_error_reason(reader.error()));
        std::exit(1);
      }
    } while (step.event != PlyEvent::kNeedInput && step.event != PlyEvent::kEnd);
    if (step.event == PlyEvent::kEnd) return reader.counts();
  }
}

bool bench_file(const std::filesystem::path& path, unsigned rounds, double limit) {
  std::vector<std::byte> contents(std::filesystem::file_size(path));
  std::vector<std::byte> large_window(65536), small_window(4096);
  const PlyCounts counts = read_through_window(path, large_window, {});
  std::vector<Vec3> vertices(counts.vertices);
  std::vector<UVec3> triangles(counts.triangles);
  const PlyOutput output{vertices, triangles};

  const std::vector<Candidate> candidates = {
      {"fread", [&] { (void)!std::fread(contents.data(), 1, contents.size(), open_file(path).get()); }},
      {"64 KB", [&] { read_through_window(path, large_window, output); }},
      {"4 KB", [&] { read_through_window(path, small_window, output); }},
      {"count", [&] { read_through_window(path, large_window, {}); }},
  };
  const std::vector<double> seconds = least_seconds(candidates, rounds);
  const std::string name = path.filename().string();
  bool within = report_ratio(name + ": read, 64 KB window / fread", seconds[1], seconds[0], limit);
  within = report_ratio(name + ": read, 4 KB window / fread", seconds[2], seconds[0], 2 * limit) && within;
  return report_ratio(name + ": count only, 64 KB window / fread", seconds[3], seconds[0], limit) && within;
}

bool bench_ply(const BenchOptions& options) {
  bool within = true;
  for (const char* name : {"bunny.ply", "armadillo_standin_345944.ply"}) {
    const std::filesystem::path path = options.scenes / name;
    std::error_code ignored;
    if (options.scenes.empty() || !std::filesystem::exists(path, ignored)) {
      std::printf("%s: not found, left out\n", name);
      continue;
    }
    within = bench_file(path, 4 * options.rounds, 5.0) && within;
  }
  return within;
}

const Registration kRegistration("ply", &bench_ply);

}  // namespace
}  // namespace gridiron::bench
