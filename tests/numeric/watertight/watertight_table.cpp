// The whole suite: a million rays of each kind from inside each solid, under every machine, and at every place and
// size. Prints a table of misses, ours and Embree's, and can write it as CSV. Its own README tells how long it takes.
// Memory: some 400 bytes a triangle, twice. Threads: as many as asked for. SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <chrono>
#include <stdexcept>

#include "numeric/watertight/grid_shots.h"
#include "numeric/watertight/tally.h"

#if defined(WATERTIGHT_EMBREE)
#include "embree_peer/embree_rays.h"
#endif

namespace gridiron::test {
namespace {

struct Arguments {
  unsigned threads = 1;
  std::uint64_t rays = 1000000;
  std::uint64_t machine_rays = 1000000;
  std::uint64_t placed_rays = 1000000;
  std::uint64_t grid_rays = 1000000;
  std::uint64_t seed = 1;
  std::string scenes;
  std::string csv;
  std::string only_solid, only_place, only_kind, only_factor;  // what their names hold
  std::vector<std::string> read;
};

// A row of the table: misses of each profile, then of each peer.
struct Row {
  std::uint64_t rays = 0;
  std::uint64_t lattice_rays = 0;
  std::vector<std::uint64_t> misses;
  std::uint64_t differences = 0;  // of watertight profiles, from the first machine and from the oracle
  std::uint64_t asked_rays = 0;
  bool is_promised = true;

  void add(const Row& other) {
    rays += other.rays;
    lattice_rays += other.lattice_rays;
    misses.resize(other.misses.size());
    for (std::size_t i = 0; i < misses.size(); ++i) misses[i] += other.misses[i];
    differences += other.differences;
    asked_rays += other.asked_rays;
    is_promised = is_promised && other.is_promised;
  }
  // Whether a profile that promises none has a miss, or two machines differ.
  [[nodiscard]] bool breaks_promise() const {
    bool broken = differences != 0;
    for (std::size_t p = 0; p < kProfileCount; ++p) broken = broken || (kProfiles[p].is_watertight && misses[p] != 0);
    return is_promised && broken;
  }
};

std::vector<std::string> column_names() {
  std::vector<std::string> names;
  for (const Profile& profile : kProfiles) names.emplace_back(profile.name);
#if defined(WATERTIGHT_EMBREE)
  names.emplace_back("Embree");
  names.emplace_back("Embree robust");
#endif
  return names;
}

// The peers of one placed solid.
class Peers {
 public:
  explicit Peers(const PlacedSolid& solid) {
#if defined(WATERTIGHT_EMBREE)
    for (const bool robust : {false, true}) {
      scenes_.push_back(std::make_unique<peer::EmbreeRays>(solid.mesh().view(), robust));
      peers_.push_back([scene = scenes_.back().get()](const watertight::Shot& shot, std::uint32_t width) {
        return scene->hits(shot.origin, shot.dir, shot.active, width);
      });
    }
#else
    (void)solid;
#endif
  }
  [[nodiscard]] std::span<const Peer> list() const {
    return peers_;
  }

 private:
#if defined(WATERTIGHT_EMBREE)
  std::vector<std::unique_ptr<peer::EmbreeRays>> scenes_;
#endif
  std::vector<Peer> peers_;
};

Row row_of(const Tally& tally, const Tally& on_lattice, std::size_t machine, bool is_promised) {
  Row row;
  row.rays = tally.rays;
  row.lattice_rays = on_lattice.rays;
  row.is_promised = is_promised;
  for (std::size_t p = 0; p < kProfileCount; ++p) {
    const Tally& own = kProfiles[p].is_on_lattice ? on_lattice : tally;
    row.misses.push_back(own.machines[machine].misses[p]);
    if (!kProfiles[p].is_watertight) continue;
    row.differences += own.machines[machine].differences[p];
    if (machine == 0) row.differences += own.oracle_differences[p];
  }
  if (machine == 0) row.asked_rays = tally.asked_rays + on_lattice.asked_rays;
  row.misses.insert(row.misses.end(), tally.machines[machine].peer_misses.begin(),
                    tally.machines[machine].peer_misses.end());
  return row;
}

class Table {
 public:
  explicit Table(const std::string& csv) {
    if (csv.empty()) return;
    file_.open(csv);
    if (!file_) throw std::runtime_error(csv + " cannot be written");
    file_ << "solid,rays_kind,factor,rays,rays_on_lattice";
    for (const std::string& name : column_names()) file_ << ',' << name << " misses";
    file_ << ",differences,rays_shown_to_oracle\n";
  }

  void add(const std::string& solid, const std::string& kind, const std::string& factor, const Row& row) {
    if (file_.is_open()) {
      file_ << solid << ',' << kind << ",\"" << factor << "\"," << row.rays << ',' << row.lattice_rays;
      for (const std::uint64_t misses : row.misses) file_ << ',' << misses;
      file_ << ',' << row.differences << ',' << row.asked_rays << std::endl;
    }
    print(solid + " | " + kind + " | " + factor, row);
    sum(by_factor_, factor, row);
    if (factor == machines()[0].name) sum(by_kind_, solid + " | " + kind, row);
    broken_ = broken_ || row.breaks_promise();
  }

  void print_head(const char* first) const {
    std::printf("\n| %s | rays |", first);
    for (const std::string& name : column_names()) std::printf(" %s |", name.c_str());
    std::printf(" differences |\n|---|---|");
    for (std::size_t i = 0; i < column_names().size(); ++i) std::printf("---|");
    std::printf("---|\n");
  }
  void print_sums() const {
    print_head("factor, all solids and kinds");
    for (const auto& [name, row] : by_factor_) print(name, row);
    print_head("solid | rays, base case");
    for (const auto& [name, row] : by_kind_) print(name, row);
  }
  [[nodiscard]] bool is_broken() const { return broken_; }

  // Adds the rows of a file that an earlier run has written.
  void read(const std::string& name) {
    std::ifstream in(name);
    std::string line;
    if (!std::getline(in, line)) throw std::runtime_error(name + " cannot be read");
    while (std::getline(in, line)) {
      std::istringstream fields(line);
      std::string solid, kind, factor, number;
      std::getline(fields, solid, ',');
      std::getline(fields, kind, ',');
      fields.ignore();
      std::getline(fields, factor, '"');
      fields.ignore();
      std::vector<std::uint64_t> numbers;
      while (std::getline(fields, number, ',')) numbers.push_back(std::stoull(number));
      if (numbers.size() != 4 + column_names().size()) throw std::runtime_error(name + ": " + line);
      Row row;
      row.rays = numbers[0];
      row.lattice_rays = numbers[1];
      row.misses.assign(numbers.begin() + 2, numbers.end() - 2);
      row.differences = numbers[numbers.size() - 2];
      row.asked_rays = numbers.back();
      for (const Machine& machine : machines()) row.is_promised &= machine.is_promised || machine.name != factor;
      add(solid, kind, factor, row);
    }
  }

 private:
  using Sums = std::vector<std::pair<std::string, Row>>;

  static void sum(Sums& sums, const std::string& name, const Row& row) {
    for (auto& [known, total] : sums) {
      if (known == name) return total.add(row);
    }
    sums.emplace_back(name, row);
  }
  static void print(const std::string& name, const Row& row) {
    std::printf("| %s | %llu |", name.c_str(), static_cast<unsigned long long>(row.rays));
    for (const std::uint64_t misses : row.misses) std::printf(" %llu |", static_cast<unsigned long long>(misses));
    std::printf(" %llu |%s\n", static_cast<unsigned long long>(row.differences), row.breaks_promise() ? " BROKEN" : "");
    std::fflush(stdout);
  }

  std::ofstream file_;
  Sums by_factor_, by_kind_;
  bool broken_ = false;
};

class Run {
 public:
  explicit Run(const Arguments& arguments) : arguments_(arguments), table_(arguments.csv) {}

  int run() {
    for (const std::string& file : arguments_.read) table_.read(file);
    if (!arguments_.read.empty()) {
      table_.print_sums();
      return table_.is_broken() ? 1 : 0;
    }
    std::vector<Solid> solids = make_solids(Detail::kFull);
    for (const Solid& solid : solids) {
      const std::string reason = why_not_closed(solid.mesh);
      if (!reason.empty()) throw std::logic_error(solid.name + " is not closed: " + reason);
    }
    if (!arguments_.scenes.empty()) {
      for (ScanSolid& scan : load_scans(arguments_.scenes)) {
        std::printf("%s: %s\n", scan.solid.name.c_str(),
                    scan.left_out.empty() ? "closed" : ("left out, " + scan.left_out).c_str());
        if (scan.left_out.empty()) solids.push_back(std::move(scan.solid));
      }
    }
    table_.print_head("solid | rays from | factor");
    bool is_base = true;
    for (const Placement& placement : all_placements()) {
      for (const Solid& solid : solids) {
        if (!holds(placement.name, arguments_.only_place) || !holds(solid.name, arguments_.only_solid)) continue;
        shoot(solid, placement, is_base);
      }
      is_base = false;
    }
    table_.print_sums();
    return table_.is_broken() ? 1 : 0;
  }

 private:
  static bool holds(const std::string& name, const std::string& part) { return name.find(part) != std::string::npos; }

  // In the base case under every machine, elsewhere under the first.
  void shoot(const Solid& solid, const Placement& placement, bool is_base) {
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < (is_base ? machines().size() : 1); ++i) {
      const std::string factor = is_base ? machines()[i].name : placement.name;
      if (i == 0 || holds(factor, arguments_.only_factor)) wanted.push_back(i);
    }
    std::vector<Machine> chosen;
    for (const std::size_t i : wanted) chosen.push_back(machines()[i]);
    const PlacedSolid placed(solid, placement);
    const PlacedSolid on_lattice(solid, placement, Vertices::kOnLattice);
    const Peers peers(placed);
    for (const RayKind kind : kRayKinds) {
      if (!holds(name_of(kind), arguments_.only_kind)) continue;
      // The first machine with all rays of the base case, then all with those that each other one gets.
      TallyOptions options{.rays = is_base ? arguments_.rays : arguments_.placed_rays,
                           .first_seed = arguments_.seed,
                           .threads = arguments_.threads,
                           .oracle_stride = 64};
      const bool is_split = is_base && chosen.size() > 1 && arguments_.machine_rays < arguments_.rays;
      for (std::size_t first = 0; first < (is_split ? 2u : 1u); ++first) {
        const auto start = Clock::now();
        const std::span<const Machine> shot(chosen.data(), is_split && first == 0 ? 1 : chosen.size());
        if (first == 1) options.rays = arguments_.machine_rays;
        const Tally tally = shoot_all(placed, kind, shot, peers.list(), options);
        const Tally lattice_tally = shoot_all(on_lattice, kind, shot, {}, options);
        report(solid, name_of(kind), placement, tally, lattice_tally, start);
        for (std::size_t i = first; i < shot.size(); ++i) {
          table_.add(solid.name, name_of(kind), is_base ? shot[i].name : placement.name,
                     row_of(tally, lattice_tally, i, shot[i].is_promised));
        }
      }
    }
    if (!holds(kGridKind, arguments_.only_kind)) return;
    const auto start = Clock::now();
    const TallyOptions options{
        .rays = arguments_.grid_rays, .first_seed = arguments_.seed, .threads = arguments_.threads};
    std::vector<Machine> grid = grid_machines();
    if (!is_base) grid.resize(1);
    const Tally tally = shoot_through_grid(placed, grid, peers.list(), sim::Mode::kChecked, options);
    const Tally lattice_tally = shoot_through_grid(on_lattice, grid, {}, sim::Mode::kChecked, options);
    report(solid, kGridKind, placement, tally, lattice_tally, start);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const std::string factor = is_base ? grid[i].name : placement.name;
      if (i == 0 || holds(factor, arguments_.only_factor)) {
        table_.add(solid.name, kGridKind, factor, row_of(tally, lattice_tally, i, true));
      }
    }
  }

  using Clock = std::chrono::steady_clock;
  static void report(const Solid& solid, const char* kind, const Placement& placement, const Tally& tally,
                     const Tally& lattice_tally, Clock::time_point start) {
    const std::chrono::duration<double> seconds = Clock::now() - start;
    std::fprintf(stderr, "%s, %s, %s: %.1f s%s\n", solid.name.c_str(), kind, placement.name.c_str(), seconds.count(),
                 tally.lost_packets + lattice_tally.lost_packets != 0 ? ", packets lost" : "");
    for (const Tally* one : {&tally, &lattice_tally}) {
      if (!one->first_failure.empty()) std::fprintf(stderr, "  %s\n", one->first_failure.c_str());
    }
  }

  const Arguments& arguments_;
  Table table_;
};

}  // namespace
}  // namespace gridiron::test

int main(int argc, char** argv) {
  using gridiron::test::Arguments;
  Arguments arguments;
  if (const char* scenes = std::getenv("GRIDIRON_SCENES")) arguments.scenes = scenes;
  CLI::App app("Rays from inside closed meshes that hit nothing: ours under every machine, and Embree's");
  app.add_option("--threads", arguments.threads, "threads to shoot with")->check(CLI::Range(1, 1024));
  app.add_option("--rays", arguments.rays, "rays of each kind in the base case, under the first machine");
  app.add_option("--machine-rays", arguments.machine_rays, "rays of each kind there under each other machine");
  app.add_option("--placed-rays", arguments.placed_rays, "rays of each kind in each other place and size");
  app.add_option("--grid-rays", arguments.grid_rays, "rays through the grid");
  app.add_option("--seed", arguments.seed, "of the first packet");
  app.add_option("--scenes", arguments.scenes, "directory of scans; default: $GRIDIRON_SCENES");
  app.add_option("--csv", arguments.csv, "a file for the whole table");
  app.add_option("--solid", arguments.only_solid, "only solids whose name holds this");
  app.add_option("--place", arguments.only_place, "only places and sizes whose name holds this");
  app.add_option("--kind", arguments.only_kind, "only kinds of rays whose name holds this");
  app.add_option("--factor", arguments.only_factor, "only machines, of the base case, whose name holds this");
  app.add_option("--read", arguments.read, "shoots nothing: sums up these files");
  CLI11_PARSE(app, argc, argv);
  try {
    return gridiron::test::Run(arguments).run();
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "watertight_table: %s\n", failure.what());
    return 2;
  }
}
