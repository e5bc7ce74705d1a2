// make_scene: writes a scene of the Standard Procedural Databases as NFF, or the six faces of a sky as PFM.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "files/interrupt.h"
#include "scene_makers/mesh.h"
#include "scene_makers/procedural.h"

namespace {

using namespace gridiron::scene_makers;

constexpr std::uint32_t kMostSkyWidth = 1024;

struct Database {
  const char* name;
  std::uint32_t least_size, most_size, usual_size;
  std::string (*make)(std::uint32_t);
};
constexpr Database kDatabases[] = {
    {"balls", 0, kMostBallsSize, 4, make_balls},       {"tetra", 1, kMostTetraSize, 6, make_tetra},
    {"mount", 1, kMostMountSize, 6, make_mount},       {"rings", 1, kMostRingsSize, 7, make_rings},
    {"lattice", 1, kMostLatticeSize, 8, make_lattice}, {"shells", 1, kMostShellsSize, 6, make_shells}};

bool write_or_tell(const std::string& path, const std::vector<char>& bytes) {
  const std::string reason = write_whole_file(path, bytes);
  if (!reason.empty()) std::fprintf(stderr, "%s\n", reason.c_str());
  return reason.empty();
}

}  // namespace

int main(int argument_count, char** arguments) {
  gridiron::tool::watch_for_interrupt();
  CLI::App app{"Writes a scene in the manner of the Standard Procedural Databases as NFF, or a sky."};
  std::string scene, output;
  std::uint32_t size = 0;
  app.add_option("--scene", scene, "sky: six PFM faces, OUTPUT_px.pfm, _nx, _py, _ny, _pz, _nz")
      ->check(CLI::IsMember({"balls", "tetra", "mount", "rings", "lattice", "shells", "sky"}))
      ->required();
  const CLI::Option* size_option = app.add_option(
      "--size", size,
      "size factor: balls 0 to 7, default 4; tetra, mount 1 to 11, 6; rings 1 to 90, 7; lattice 1 to 100, 8; "
      "shells 1 to 100, 6; sky: texels of a face's side, 1 to 1024, 16");
  app.add_option("-o,--output", output, "file to write; sky: what the six names begin with")->required();
  const Database* database = nullptr;
  try {
    app.parse(argument_count, arguments);
    for (const Database& candidate : kDatabases) {
      if (scene == candidate.name) database = &candidate;
    }
    const std::uint32_t least = database != nullptr ? database->least_size : 1;
    const std::uint32_t most = database != nullptr ? database->most_size : kMostSkyWidth;
    if (size_option->count() == 0) size = database != nullptr ? database->usual_size : 16;
    if (size < least || size > most) {
      throw CLI::ValidationError("--size", scene + " takes " + std::to_string(least) + " to " + std::to_string(most));
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  if (database != nullptr) {
    const std::string text = database->make(size);
    if (!write_or_tell(output, {text.begin(), text.end()})) return 1;
    std::printf("%s: %zu bytes\n", output.c_str(), text.size());
    return 0;
  }
  for (std::uint32_t face = 0; face < kFaceNames.size(); ++face) {
    std::string path = output;
    path.append("_").append(kFaceNames[face]).append(".pfm");
    if (!write_or_tell(path, make_sky_face(face, size))) return 1;
    std::printf("%s\n", path.c_str());
  }
  return 0;
}
