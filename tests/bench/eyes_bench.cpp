// Eye rays tile by tile through the tree beside Embree: build, frame, both; what planes and shading cost; two threads.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/sim/host_team.h>

#include <cmath>

#include "bench/bench.h"
#include "bench/image_build.h"
#include "core/build/grid/line_buffer.h"
#include "embree_peer/embree_peer.h"
#include "support/ply_load.h"
#include "support/render_mesh.h"
#include "support/views.h"

namespace gridiron::bench {
namespace {

// Limits of Embree's time over ours, of each view and of the geometric mean; of one thread over two; of Embree's one
// thread over our two.
constexpr double kFrameLimit = 2.2, kFrameMeanLimit = 3.3, kBuildLimit = 1.8, kBothLimit = 2.2, kBothMeanLimit = 2.8,
                 kThreadsLimit = 1.7, kSharedBuildLimit = 3.0;
constexpr std::uint32_t kTileWidth = 64;
constexpr std::uint32_t kFetchDepth = 1;  // a copy is there at once, so asking ahead gains nothing

const test::SceneView kViews[] = {test::kBunnyView,      test::kHorseView,       test::kArmadilloView,
                                  test::kConferenceView, test::kConferenceView2, test::kSponzaView,
                                  test::kDragonView};

// --- Our side -----------------------------------------------------------------------------------------------------

// Frames of one view that differ in what they write.
class Frames {
 public:
  Frames(test::SceneInMemory& scene, const Camera& camera)
      : frame_(scene.prepare(FrameSettings{.camera = camera,
                                           .tile_width = kTileWidth,
                                           .shading = Shading::kNone,
                                           .engine = EngineId::kTree,
                                           .fetch_depth = kFetchDepth},
                             chip_of(4), test::PlaneSet::kAll)),
        all_(frame_.record()) {}

  [[nodiscard]] Status status() const { return status_ == Status::kOk ? frame_.status() : status_; }
  [[nodiscard]] const FrameRecord& record() const { return all_; }
  [[nodiscard]] std::vector<std::uint32_t> ids() const { return frame_.planes().ids; }

  // To be called before render().
  void choose(Shading shading, bool has_depth, bool has_ids) {
    FrameRecord record = all_;
    record.shading = static_cast<std::uint32_t>(shading);
    if (!has_depth) record.depth_address = 0;
    if (!has_ids) record.id_address = 0;
    frame_.set_record(record);
  }
  void render(std::uint32_t lanes, std::uint32_t threads = 1) {
    const Status status = frame_.render(chip_of(lanes, threads)).status;
    if (status != Status::kOk) status_ = status;
  }

 private:
  static sim::ChipOptions chip_of(std::uint32_t lanes, std::uint32_t threads = 1) {
    return {.mode = sim::Mode::kPlain, .threads = threads, .lanes = lanes, .packet_width = 0};
  }

  test::PreparedFrame frame_;
  FrameRecord all_;
  Status status_ = Status::kOk;
};

std::vector<std::uint32_t> lanes_of_host() {
  std::vector<std::uint32_t> lanes;
  for (const std::uint32_t count : {4u, 8u, 16u}) {
    if (count <= sim::widest_lanes()) lanes.push_back(count);
  }
  return lanes;
}

// --- Embree -------------------------------------------------------------------------------------------------------

constexpr peer::EmbreeQuality kQualities[] = {peer::EmbreeQuality::kLow, peer::EmbreeQuality::kMedium,
                                              peer::EmbreeQuality::kHigh};
constexpr std::size_t kQualityCount = std::size(kQualities);
constexpr const char* kQualityNames[kQualityCount] = {"low", "medium", "high"};
constexpr std::pair<peer::EmbreeEyeCall, const char*> kCalls[] = {
    {peer::EmbreeEyeCall::kSingle, "1"},    {peer::EmbreeEyeCall::kPacket8, "8"},
    {peer::EmbreeEyeCall::kPacket16, "16"}, {peer::EmbreeEyeCall::kStream, "1M"},
    {peer::EmbreeEyeCall::kStream8, "8M"},  {peer::EmbreeEyeCall::kStream16, "16M"}};

// A mesh in Embree at one quality, and its fastest way to a frame.
struct EmbreeWay {
  peer::EmbreeScene scene;
  std::string name;
  peer::EmbreeEyeCall call{};
  bool is_coherent = false;

  void render(const FrameRecord& frame, std::vector<std::uint32_t>& ids) const {
    scene.find_triangles(frame, call, is_coherent, ids);
  }
};

// Chooses the fastest of all calls, each run twice.
void choose_call(const FrameRecord& frame, const char* quality, std::vector<std::uint32_t>& ids, EmbreeWay& way) {
  std::vector<Candidate> candidates;
  std::vector<std::pair<peer::EmbreeEyeCall, bool>> choices;
  for (const auto& [call, name] : kCalls) {
    for (const bool is_coherent : {false, true}) {
      if (is_coherent && call == peer::EmbreeEyeCall::kSingle) continue;
      choices.emplace_back(call, is_coherent);
      candidates.push_back(
          {std::string(name) + ' ' + quality + (is_coherent ? " coherent" : ""),
           [&, choice = choices.back()] { way.scene.find_triangles(frame, choice.first, choice.second, ids); }});
    }
  }
  const std::vector<double> seconds = least_seconds(candidates, 1);
  const auto best = static_cast<std::size_t>(std::min_element(seconds.begin(), seconds.end()) - seconds.begin());
  way.name = candidates[best].name;
  way.call = choices[best].first;
  way.is_coherent = choices[best].second;
}

using EmbreeWays = std::vector<std::unique_ptr<EmbreeWay>>;  // of each quality

EmbreeWays embree_ways(const MeshView& mesh, bool robust, const FrameRecord& frame, std::vector<std::uint32_t>& ids) {
  EmbreeWays ways;
  for (std::size_t quality = 0; quality < kQualityCount; ++quality) {
    ways.push_back(std::make_unique<EmbreeWay>());
    ways.back()->scene.set_mesh(mesh);
    ways.back()->scene.build(kQualities[quality], robust);
    choose_call(frame, kQualityNames[quality], ids, *ways.back());
  }
  return ways;
}

// --- Results ------------------------------------------------------------------------------------------------------

// Seconds of one view.
struct Row {
  const char* name;
  std::vector<double> frames;      // of each number of lanes
  double build, tree;              // ours; of the latter the tree alone, without an image and checks
  double shared_build;             // by two threads, wall clock
  double embree_low;               // of one thread, wall clock
  double simple, depth, ids, all;  // frames of the widest lanes with these
  double one_thread, two_threads;  // wall clock
  double two_together;             // processor time of two threads
  double embree_builds[2];         // low, medium
  double embree_frames[kQualityCount], robust_frames[kQualityCount];
  std::string way, robust_way;
  std::size_t different;  // pixels with another triangle than in Embree

  [[nodiscard]] double frame() const { return frames.back(); }
  [[nodiscard]] double embree_frame() const { return *std::min_element(embree_frames, embree_frames + kQualityCount); }
  [[nodiscard]] double robust_frame() const { return *std::min_element(robust_frames, robust_frames + kQualityCount); }
  // The high quality takes far longer to build than it saves in one frame.
  [[nodiscard]] double embree_both() const {
    return std::min(embree_builds[0] + embree_frames[0], embree_builds[1] + embree_frames[1]);
  }
};

bool measure_view(const BenchOptions& options, const test::SceneView& view, Row& row) {
  row.name = view.name;
  const auto mesh = test::load_ply(options.scenes / view.file);
  if (!mesh) {
    std::printf("%s: %s cannot be read; left out\n", view.name, (options.scenes / view.file).c_str());
    return false;
  }
  const MeshView mesh_view = mesh->view();
  test::SceneInMemory scene(mesh_view, kBestParameters);
  if (scene.status() != Status::kOk) {
    std::printf("%s: status %u\n", view.name, static_cast<unsigned>(scene.status()));
    return false;
  }
  Frames frames(scene, view.camera ? *view.camera : test::framed_camera(mesh_view));
  const std::vector<std::uint32_t> lanes = lanes_of_host();
  const std::uint32_t widest = lanes.back();
  std::vector<std::uint32_t> ids(std::size_t{frames.record().width} * frames.record().height);

  // Frames: ours for each number of lanes, of the widest with other planes, Embree's.
  const EmbreeWays ways = embree_ways(mesh_view, false, frames.record(), ids);
  const EmbreeWays robust_ways = embree_ways(mesh_view, true, frames.record(), ids);
  std::vector<Candidate> candidates;
  const auto none = [&] { frames.choose(Shading::kNone, false, false); };
  for (const std::uint32_t count : lanes) {
    candidates.push_back({"ours", [&frames, count] { frames.render(count); }, none});
  }
  const auto widest_frame = [&] { frames.render(widest); };
  candidates.push_back({"simple", widest_frame, [&] { frames.choose(Shading::kSimple, false, false); }});
  candidates.push_back({"depth", widest_frame, [&] { frames.choose(Shading::kNone, true, false); }});
  candidates.push_back({"ids", widest_frame, [&] { frames.choose(Shading::kNone, false, true); }});
  candidates.push_back({"all", widest_frame, [&] { frames.choose(Shading::kSimple, true, true); }});
  for (const EmbreeWays& group : {std::cref(ways), std::cref(robust_ways)}) {
    for (const auto& way : group) {
      candidates.push_back({way->name, [&ids, &frames, one = way.get()] { one->render(frames.record(), ids); }});
    }
  }
  const std::vector<double> seconds = least_seconds(candidates, options.rounds);
  auto next = seconds.begin();
  row.frames.assign(next, next + static_cast<std::ptrdiff_t>(lanes.size()));
  next += static_cast<std::ptrdiff_t>(lanes.size());
  for (double* const to : {&row.simple, &row.depth, &row.ids, &row.all}) *to = *next++;
  std::copy_n(next, kQualityCount, row.embree_frames);
  std::copy_n(next + kQualityCount, kQualityCount, row.robust_frames);
  const auto name_of_best = [](const EmbreeWays& group, const double* times) {
    return group[static_cast<std::size_t>(std::min_element(times, times + kQualityCount) - times)]->name;
  };
  row.way = name_of_best(ways, row.embree_frames);
  row.robust_way = name_of_best(robust_ways, row.robust_frames);

  // Triangles.
  frames.choose(Shading::kNone, false, true);
  frames.render(widest);
  const std::vector<std::uint32_t> ours = frames.ids();
  robust_ways[1]->render(frames.record(), ids);
  row.different = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) row.different += ours[i] != ids[i] ? 1u : 0u;

  // Threads: by the wall clock.
  none();
  const Candidate threads[] = {{"one thread", [&] { frames.render(widest, 1); }},
                               {"two threads", [&] { frames.render(widest, 2); }}};
  const std::vector<double> wall = least_seconds(threads, 4 * options.rounds, Clock::kWall);
  row.one_thread = wall[0];
  row.two_threads = wall[1];
  row.two_together = least_seconds(std::span(threads).last(1), options.rounds)[0];

  // Builds.
  ImageBuild image(mesh_view);
  test::LineBuffer records(mesh_view.triangles.size() * sizeof(VertexTriangle));
  test::LineBuffer nodes(most_tree_nodes(mesh_view.triangles.size(), kMaxTreeLeaf) * sizeof(TreeNode));
  test::LineBuffer scratch(tree_scratch_bytes(mesh_view.triangles.size()));
  const Candidate builds[] = {
      {"ours", [&] { image.run(); }},
      {"tree",
       [&] {
         TreeSize size;
         static_cast<void>(
             build_tree(mesh_view, kMaxTreeLeaf,
                        {reinterpret_cast<VertexTriangle*>(records.bytes().data()), mesh_view.triangles.size()},
                        {reinterpret_cast<TreeNode*>(nodes.bytes().data()), nodes.bytes().size() / sizeof(TreeNode)},
                        scratch.bytes(), size));
       }},
      {"low", [&] { ways[0]->scene.build(peer::EmbreeQuality::kLow); }},
      {"medium", [&] { ways[1]->scene.build(peer::EmbreeQuality::kMedium); }}};
  const std::vector<double> build_seconds = least_seconds(builds, options.rounds);
  sim::HostTeam team(2);
  ImageBuild shared(mesh_view, kBestParameters, team.sharing());
  const Candidate wall_builds[] = {{"two threads", [&] { shared.run(); }},
                                   {"low", [&] { ways[0]->scene.build(peer::EmbreeQuality::kLow); }}};
  const std::vector<double> wall_seconds = least_seconds(wall_builds, 4 * options.rounds, Clock::kWall);
  row.shared_build = wall_seconds[0];
  row.embree_low = wall_seconds[1];
  row.build = build_seconds[0];
  row.tree = build_seconds[1];
  row.embree_builds[0] = build_seconds[2];
  row.embree_builds[1] = build_seconds[3];
  if (frames.status() != Status::kOk || image.status() != Status::kOk || shared.status() != Status::kOk) {
    std::printf("%s: status %u, %u\n", view.name, static_cast<unsigned>(frames.status()),
                static_cast<unsigned>(image.status()));
    return false;
  }
  return true;
}

void print_row(const Row& row) {
  std::printf("%-17s |", row.name);
  for (const double seconds : row.frames) std::printf(" %6.2f", 1e3 * seconds);
  std::printf(" | %6.2f %-18s %6.2f %-18s |", 1e3 * row.embree_frame(), row.way.c_str(), 1e3 * row.robust_frame(),
              row.robust_way.c_str());
  std::printf(" %6.2f %6.2f %6.2f %6.2f |", 1e3 * row.build, 1e3 * row.tree, 1e3 * row.embree_builds[0],
              1e3 * row.embree_builds[1]);
  std::printf(" %4.2f %4.2f %4.2f %4.2f | %4.2f %4.2f | %zu\n", row.simple / row.frame(), row.depth / row.frame(),
              row.ids / row.frame(), row.all / row.frame(), row.one_thread / row.two_threads,
              2 * row.frame() / row.two_together, row.different);
  std::fflush(stdout);
}

// Prints a ratio of each view and their mean. @returns whether they reach their limits.
bool report(const char* what, const std::vector<Row>& rows, double (*ratio_of)(const Row&), double limit,
            double mean_limit) {
  std::printf("%-40s", what);
  double logs = 0;
  bool within = true;
  for (const Row& row : rows) {
    const double ratio = ratio_of(row);
    logs += std::log(ratio);
    within = within && ratio >= limit;
    std::printf(" %5.2f%s", ratio, ratio >= limit ? "" : "!");
  }
  const double mean = std::exp(logs / static_cast<double>(rows.size()));
  within = within && mean >= mean_limit;
  std::printf(" | mean %5.2f%s  (limit %.1f, mean %.1f)\n", mean, mean >= mean_limit ? "" : "!", limit, mean_limit);
  return within;
}

bool bench_eyes(const BenchOptions& options) {
  if (options.scenes.empty()) {
    std::printf("GRIDIRON_SCENES is not set; left out\n");
    return true;
  }
  std::printf("1024x1024, no shading, milliseconds of one thread; ours with");
  for (const std::uint32_t lanes : lanes_of_host()) std::printf(" %u", lanes);
  std::printf(
      " lanes; Embree's fastest calls; builds: ours, of it the tree, Embree low, medium;\n"
      "frames with simple shading, depth, ids, all over the frame; one thread over two by "
      "the wall clock, by processor time; pixels with another "
      "triangle than Embree robust\n");
  std::vector<Row> rows;
  for (const test::SceneView& view : kViews) {
    Row row{};
    if (!measure_view(options, view, row)) continue;
    print_row(row);
    rows.push_back(row);
  }
  if (rows.empty()) return true;
  bool within = report(
      "frame: Embree / ours", rows, [](const Row& row) { return row.embree_frame() / row.frame(); }, kFrameLimit,
      kFrameMeanLimit);
  report(
      "frame: Embree robust / ours", rows, [](const Row& row) { return row.robust_frame() / row.frame(); }, 0, 0);
  within = report(
               "build: Embree low / ours", rows, [](const Row& row) { return row.embree_builds[0] / row.build; },
               kBuildLimit, kBuildLimit) &&
           within;
  within = report(
               "build by two threads: Embree low / ours", rows,
               [](const Row& row) { return row.embree_low / row.shared_build; }, kSharedBuildLimit,
               kSharedBuildLimit) &&
           within;
  within =
      report(
          "build + frame: Embree / ours", rows,
          [](const Row& row) { return row.embree_both() / (row.build + row.frame()); }, kBothLimit, kBothMeanLimit) &&
      within;
  within = report(
               "one thread / two threads", rows, [](const Row& row) { return row.one_thread / row.two_threads; },
               kThreadsLimit, kThreadsLimit) &&
           within;
  return within;
}

const Registration kRegistration("eyes", bench_eyes);

}  // namespace
}  // namespace gridiron::bench
