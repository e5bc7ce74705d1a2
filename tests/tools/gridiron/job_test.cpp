// job and result: correct files, a device simulated by the host, and damage that is found.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/tile_work.h>
#include <report/report.h>

#include <nlohmann/json.hpp>

#include "gridiron/job/job_file.h"
#include "host_device.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;
using port::FrameJob;
using port::FrameResult;

constexpr std::uint64_t kBase = 0x2000000;

constexpr const char* kMirrors =
    "v from 1 2 6 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 72 40\n"
    "b 0.1 0.2 0.4\nl 3 5 4\nf 0.9 0.5 0.3 0.5 0.5 40 0 0\ns -0.9 0 0 0.9\ns 0.9 0 0 0.9\n";

// Makes a.job of a torus, or of `scene`.
std::string make_job(const TemporaryFolder& folder, const Words& options, const std::string& scene = "a.ply") {
  folder.write_ply("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  folder.write("a.nff", kMirrors);
  run(folder, Words{"job", scene, "-o", "a.job", "--base", "0x2000000"} + options);
  return read_file(folder.path("a.job"));
}

template <class Record>
Record record_at(const std::string& bytes, std::size_t place) {
  Record record{};
  std::memcpy(&record, bytes.data() + place, sizeof record);
  return record;
}

template <class Record>
void put_record(std::string& bytes, std::size_t place, const Record& record) {
  std::memcpy(bytes.data() + place, &record, sizeof record);
}

struct JobCase {
  Words options;
  std::string scene = "a.ply";
  bool has_depth = true;  // effects out of 64 KB have none

  [[nodiscard]] Words job_options() const { return options + (has_depth ? Words{"--depth", "--ids"} : Words{"--ids"}); }
};

const std::vector<JobCase> kCases = {
    {with_reference({"--size", "96x64"})},
    {{"--size", "70x45", "--eye", "1,2,3", "--configuration", "grid"}},
    {with_reference({"--size", "40x40", "--store", "64", "--buffering", "single"})},
    {with_reference({"--size", "64x64", "--accuracy", "exact", "--lambda", "2"})},
    {{"--size", "64x64", "--accuracy", "paper", "--shading", "none"}},
    {with_reference({"--size", "64x64", "--accuracy", "compact", "--packet", "32"})},
    {{"--size", "96x64"}},
    {{"--size", "96x64", "--store", "64", "--accuracy", "compact"}},
    {{"--cores", "5"}, "a.nff"},
    {with_reference({"--cores", "5"}), "a.nff"},
    {with_reference({"--store", "64"}), "a.nff", false},
};

TEST(Job, NamesWhatLiesInIt) {
  for (const JobCase& each : kCases) {
    const TemporaryFolder folder;
    const std::string file = make_job(folder, each.job_options(), each.scene);
    const auto job = record_at<FrameJob>(file, 0);
    ASSERT_EQ(job.magic, port::kFrameJobMagic);
    EXPECT_EQ(job.base_address, kBase);
    EXPECT_EQ(job.loaded_bytes, file.size());
    const auto lies_in = [](std::uint64_t begin, std::uint64_t bytes, std::uint64_t first, std::uint64_t end) {
      return begin >= first && begin + bytes <= end;
    };
    const std::uint64_t loaded_end = kBase + job.loaded_bytes, end = kBase + job.memory_bytes;
    ASSERT_TRUE(lies_in(job.frame_address, sizeof(FrameRecord), kBase + sizeof job, loaded_end));
    ASSERT_TRUE(lies_in(job.image_address, job.image_bytes, job.frame_address + sizeof(FrameRecord), loaded_end));
    const auto record = record_at<FrameRecord>(file, job.frame_address - kBase);
    EXPECT_EQ(record.width, job.width);
    EXPECT_EQ(record.tiles_x * record.tiles_y, job.tile_count);
    const bool has_tree = record.engine_id == static_cast<std::uint32_t>(EngineId::kTree);
    const std::vector<std::uint64_t> parts =
        has_tree ? std::vector{record.image_address, record.tree_address}
                 : std::vector{record.engine.macro_table_address, record.engine.cell_blocks_address,
                               record.engine.triangles_address};
    for (const std::uint64_t part : parts) {
      EXPECT_TRUE(lies_in(part, kLineBytes, job.image_address, job.image_address + job.image_bytes));
    }
    const std::uint64_t head = sizeof(FrameResult) + job.tile_count * sizeof(port::TileResult);
    EXPECT_TRUE(lies_in(job.result_address, job.result_bytes, loaded_end, end));
    std::uint64_t free = job.result_address + head;
    for (const std::uint64_t plane : {record.color_address, record.depth_address, record.id_address}) {
      if (plane == record.depth_address && !each.has_depth) continue;
      EXPECT_TRUE(lies_in(plane, job.plane_bytes, free, job.result_address + job.result_bytes));
      EXPECT_EQ(plane % kLineBytes, 0u);
      free = plane + job.plane_bytes;
    }
    EXPECT_EQ(job.color_address, record.color_address);
    EXPECT_EQ(job.depth_address, record.depth_address);
    EXPECT_EQ(job.depth_address != 0, each.has_depth);
    EXPECT_EQ(job.ids_address, record.id_address);
    EXPECT_EQ(job.effects != 0, each.scene == "a.nff");
    EXPECT_EQ(job.spill_address != 0, each.scene == "a.nff");
    if (job.spill_address != 0) {
      EXPECT_EQ(job.spill_address % kSpillAlignment, 0u);
      EXPECT_TRUE(
          lies_in(job.spill_address, job.spill_bytes * job.spill_cores, job.result_address + job.result_bytes, end));
      EXPECT_EQ(job.spill_cores, each.options[0] == "--cores" ? 5u : 6u);
    }

    const tool::OpenJob open = tool::read_job_file(folder.path("a.job"));
    EXPECT_EQ(std::memcmp(&open.job, &job, sizeof job), 0);
    EXPECT_EQ(std::memcmp(&open.record, &record, sizeof record), 0);
  }
}

TEST(Job, IsTheSameBytesEveryTimeAndOfAPackedScene) {
  const TemporaryFolder folder;
  const Words frame = with_reference({"--size", "64x48"});
  const std::string job = make_job(folder, frame);
  run(folder, with_reference({"pack", "a.ply", "-o", "a.gri"}));
  EXPECT_EQ(make_job(folder, frame, "a.gri"), job);
  const auto plain = record_at<FrameJob>(job, 0);
  EXPECT_EQ(plain.depth_address, 0u);
  EXPECT_EQ(plain.ids_address, 0u);
}

TEST(Job, IsOfTheTreeByDefault) {
  const TemporaryFolder folder;
  EXPECT_EQ(make_job(folder, {"--size", "64x48"}), make_job(folder, {"--size", "64x48", "--configuration", "best"}));
}

TEST(Job, IsRefusedWhereItDoesNotFit) {
  const TemporaryFolder folder;
  const std::string file = make_job(folder, {"--size", "64x48"});
  std::filesystem::remove(folder.path("a.job"));
  const auto bytes = record_at<FrameJob>(file, 0).memory_bytes;
  const Words job = {"job", "a.ply", "-o", "a.job", "--size", "64x48"};
  const auto with = [&job](const Words& options) { return job + options; };
  expect_failure(folder, with({"--base", "0", "--memory", std::to_string(bytes - 1)}), 1, "a.ply: the job needs ");
  expect_failure(folder, with({"--base", "0xfffffffffffff000"}), 2, "--base: the job would end behind");
  expect_failure(folder, with({}), 2, "--base ADDRESS is required");
  for (const char* base : {"4095", "0x", "-4096", "0x80200800", "1e3", ""}) {
    expect_failure(folder, with({"--base", base}), 2, "--base");
  }
  expect_failure(folder, with({"--base", "0", "--cores", "17"}), 2, "--cores");
  expect_failure(folder, with({"--base", "0", "--memory", "many"}), 2, "--memory");
  expect_failure(folder, {"job", "a.ply", "-o", "a.ply", "--base", "0"}, 2, "is the input 'a.ply'");
  expect_failure(folder, {"job", "a.nff", "-o", "a.job", "--base", "0", "--store", "64", "--depth"}, 2,
                 "--depth: --shading scene has no distances with tiles 8 pixels wide and no packets");
  expect_failure(folder, {"job", "b.ply", "-o", "a.job", "--base", "0"}, 1, "b.ply: No such file");
  run(folder, with({"--base", "0x80200000", "--memory", std::to_string(bytes)}));
}

TEST(Result, OfADeviceIsTheSimulatorsFrame) {
  for (const JobCase& each : kCases) {
    const TemporaryFolder folder;
    const std::string job = make_job(folder, each.job_options(), each.scene);
    folder.write("a.res", render_on_host_device(job, 5));
    Words result_words = {"result", "a.job", "a.res",     "--compare", "-o",
                          "d.png",  "--ids", "d-ids.pfm", "--report",  "d.json"};
    Words render_words =
        Words{"render", each.scene, "-o", "r.png", "--ids", "r-ids.pfm", "--report", "r.json"} + each.options;
    Words items = {"image", "ids", "work", "transfers", "tiles.transfers"};
    Words files = {".png", "-ids.pfm"}, keys = {"image_hash", "ids_hash", "work"};
    if (each.has_depth) {
      result_words = result_words + Words{"--depth", "d.pfm"};
      render_words = render_words + Words{"--depth", "r.pfm"};
      items.emplace_back("depth");
      files.emplace_back(".pfm");
      keys.emplace_back("depth_hash");
    }
    const ProgramResult result = run(folder, result_words);
    for (const std::string& item : items) {
      const std::size_t line = result.out.find("\n" + item + " ");
      ASSERT_NE(line, std::string::npos) << item << result.out;
      EXPECT_EQ(result.out.substr(line + 26, 7), "equal: ") << result.out;
    }
    run(folder, render_words);
    for (const std::string& file : files) {
      EXPECT_EQ(read_file(folder.path("d" + file)), read_file(folder.path("r" + file))) << file;
    }
    const Json device = Json::parse(read_file(folder.path("d.json")));
    const Json render = Json::parse(read_file(folder.path("r.json")));
    for (const std::string& key : keys) EXPECT_EQ(device[key], render[key]) << key;
    ASSERT_EQ(device["cores"].size(), 5u);
    EXPECT_EQ(device["cores"][4]["instructions"], 1004);
    EXPECT_EQ(device["tiles"][1]["instructions"], 2);
    EXPECT_EQ(device["tiles"].size(), record_at<FrameJob>(job, 0).tile_count);
  }
}

TEST(Result, SaysThatNoPixelShowsTheSceneAndWhy) {
  const TemporaryFolder folder;
  const std::string note = "a.res: note: no pixel shows the scene: it lies behind the camera\n";
  for (const bool has_planes : {false, true}) {
    for (const bool is_seen : {false, true}) {
      std::vector<std::string> options = {"--size", "50x40", "--eye", "0,0,9", "--at", is_seen ? "0,0,0" : "0,0,20"};
      if (has_planes) options.insert(options.end(), {"--depth", "--ids"});
      const std::string job = make_job(folder, options);
      folder.write("a.res", render_on_host_device(job, 3));
      EXPECT_EQ(run(folder, {"result", "a.job", "a.res"}).err, is_seen ? "" : note);
      EXPECT_EQ(run(folder, {"result", "a.job", "a.res", "--quiet"}).err, "");
    }
  }
}

TEST(Result, OneDifferenceIsEnough) {
  const TemporaryFolder folder;
  const std::string file = make_job(folder, with_reference({"--size", "50x40", "--depth", "--ids"}));
  const auto job = record_at<FrameJob>(file, 0);
  const std::string whole = render_on_host_device(file, 3);
  const auto flip = [&whole](std::uint64_t place) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 1);
    return damaged;
  };
  const auto in_plane = [&job](std::uint64_t plane) { return plane - job.result_address + 33 * 4; };
  const std::uint64_t core = offsetof(FrameResult, cores) + sizeof(port::CoreResult);
  const struct {
    std::uint64_t place;
    const char* item;
  } cases[] = {
      {in_plane(job.color_address), "image"},
      {in_plane(job.depth_address), "depth"},
      {in_plane(job.ids_address), "ids"},
      {core + offsetof(port::CoreResult, work), "work.tile_start"},
      {core + offsetof(port::CoreResult, work) + 4 * static_cast<std::uint64_t>(Work::kWait), "work.wait"},
      {core + offsetof(port::CoreResult, transfers), "transfers"},
      {sizeof(FrameResult) + 16 + offsetof(port::TileResult, transfers), "tiles.transfers"},
  };
  for (const auto& each : cases) {
    folder.write("a.res", flip(each.place));
    const ProgramResult result = run_program(folder.folder(), {"result", "a.job", "a.res", "--compare", "-o", "d.png"});
    EXPECT_EQ(result.exit_code, 3) << each.item;
    EXPECT_NE(result.err.find("\n1 file was written before that and is kept\n"), std::string::npos) << result.err;
    EXPECT_TRUE(std::filesystem::remove(folder.path("d.png"))) << "the picture that differs is there to be looked at";
    EXPECT_NE(result.out.find(std::string("\n") + each.item + " "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("different: "), std::string::npos) << result.out;
    EXPECT_NE(result.err.find(std::string("differs from the simulator's: ")), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(each.item), std::string::npos) << result.err;
  }
  // Beside the picture an edge tile holds anything: the last pixel of tile 1 is column 63 of 50.
  folder.write("a.res", flip(job.color_address - job.result_address + 2 * 4096 - 1));
  run(folder, {"result", "a.job", "a.res", "--compare"});
}

// Kinds of work are those of the frame's engine.
TEST(Result, TilesOfTheTreeAreComparedByTheirOwnKinds) {
  const TemporaryFolder folder;
  const std::string file = make_job(folder, {"--size", "70x40", "--configuration", "best"});
  std::string result = render_on_host_device(file, 2);
  folder.write("a.res", result);
  run(folder, {"result", "a.job", "a.res", "--compare"});
  const std::size_t leaves =
      offsetof(FrameResult, cores) + offsetof(port::CoreResult, work) + 4 * static_cast<std::uint64_t>(TileWork::kLeaf);
  result[leaves] = static_cast<char>(result[leaves] ^ 1);
  folder.write("a.res", result);
  expect_failure(folder, {"result", "a.job", "a.res", "--compare"}, 3, "simulator's: work work.leaf");
}

// Other words of the device for how it counted: other lanes are said, another queue makes a core wait earlier.
TEST(Result, LanesAndQueueAreTheDevices) {
  const TemporaryFolder folder;
  const std::string file = make_job(folder, {"--size", "50x40", "--configuration", "grid"});
  std::string result = render_on_host_device(file, 2);
  put_record(result, offsetof(FrameResult, lane_count), std::uint32_t{1});
  folder.write("a.res", result);
  expect_failure(folder, {"result", "a.job", "a.res", "--compare"}, 3, "simulator's: work");
  put_record(result, offsetof(FrameResult, lane_count), std::uint32_t{4});
  put_record(result, offsetof(FrameResult, queue_depth), std::uint32_t{1});
  folder.write("a.res", result);
  expect_failure(folder, {"result", "a.job", "a.res", "--compare"}, 3, "simulator's: work work.wait");
}

TEST(Job, DamageIsFoundWithItsPlace) {
  const TemporaryFolder folder;
  const std::string whole = make_job(folder, with_reference({"--size", "50x40", "--depth"}));
  const auto expect_refused = [&](const std::string& file, std::uint64_t place, const char* words) {
    folder.write("b.job", file);
    expect_failure(folder, {"result", "b.job", "a.res"}, 1, "b.job:byte " + std::to_string(place) + ": " + words);
  };
  expect_refused(whole.substr(0, 255), 255, "the file ends inside its first record, which has 256 bytes");
  expect_refused(whole.substr(0, whole.size() - 1), offsetof(FrameJob, loaded_bytes), "");
  expect_refused(whole + "x", offsetof(FrameJob, loaded_bytes), "");
  // A bit that flipped: the place where the file stops making sense, or between which bytes it lies.
  const auto flipped = [&whole](std::size_t place) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 16);
    return damaged;
  };
  const std::size_t section = 4096 + record_at<ImageHeader>(whole, 4096).section_table_offset_bytes;
  const std::size_t grid = 256 + (sizeof(FrameHead) + offsetof(GridFrame, grid)),
                    bytes = offsetof(SectionEntry, section_bytes);
  expect_refused(flipped(grid + 3), grid,
                 "frame record: the grid is not the scene image's; the job's check_value differs too\n");
  expect_refused(
      flipped(section + bytes), section + bytes,
      "damaged scene image (field section.section_bytes); its check_value differs too, in the scene image that "
      "begins at byte 4096; the job's check_value differs too\n");
  expect_refused(flipped(4096 + 1), 4096, "damaged scene image (field header.magic)");
  expect_refused(
      flipped(1000), offsetof(FrameJob, check_value),
      "check_value differs from that of the file's bytes: some number in front of byte 4096, in the job's head or "
      "the frame record, has changed, and no other check finds which\n");
  const std::uint64_t triangles = [&] {
    for (std::size_t i = 0;; ++i) {
      const auto entry = record_at<SectionEntry>(whole, section + i * sizeof(SectionEntry));
      if (entry.kind == static_cast<std::uint32_t>(SectionKind::kTriangles)) return 4096 + entry.offset_bytes;
    }
  }();
  expect_refused(flipped(triangles), triangles, "damaged scene image (field triangle.v)");
  expect_refused(flipped(4096 + offsetof(ImageHeader, vertex_count)), 4096 + offsetof(ImageHeader, check_value),
                 "damaged scene image (field header.check_value): some number of the image has changed");
  const std::string others[] = {std::string(), "GJOX" + whole.substr(4), read_file(folder.path("a.ply"))};
  for (const std::string& other : others) {
    folder.write("b.job", other);
    expect_failure(folder, {"result", "b.job", "a.res"}, 1, "; expected a job, as 'gridiron job' makes it");
  }

  // Wrong ones that were made so: the check value holds.
  const auto expect_wrong = [&](std::uint64_t place, const std::function<void(FrameJob&, FrameRecord&)>& change) {
    auto job = record_at<FrameJob>(whole, 0);
    auto record = record_at<FrameRecord>(whole, 256);
    change(job, record);
    std::string file = whole;
    put_record(file, 256, record);
    put_record(file, 0, job);
    job.check_value = tool::job_check_value(std::as_bytes(std::span(file)));
    put_record(file, 0, job);
    expect_refused(file, place, "");
  };
  constexpr std::uint64_t kFar = std::uint64_t{1} << 63;
  using Job = FrameJob;
  using Record = FrameRecord;
  expect_wrong(offsetof(Job, version), [](Job& job, Record&) { ++job.version; });
  expect_wrong(offsetof(Job, base_address), [](Job& job, Record&) { job.base_address += 64; });
  expect_wrong(offsetof(Job, memory_bytes), [](Job& job, Record&) { job.memory_bytes = job.loaded_bytes - 64; });
  expect_wrong(offsetof(Job, memory_bytes), [](Job& job, Record&) { job.memory_bytes = ~std::uint64_t{0}; });
  expect_wrong(offsetof(Job, store_bytes), [](Job& job, Record&) { ++job.store_bytes; });
  expect_wrong(offsetof(Job, reserved), [](Job& job, Record&) { job.reserved[23] = 1; });
  expect_wrong(offsetof(Job, frame_address), [](Job& job, Record&) { job.frame_address = job.base_address - 128; });
  expect_wrong(offsetof(Job, image_address), [](Job& job, Record&) { job.image_address += 128; });
  expect_wrong(4096 + offsetof(ImageHeader, image_bytes), [](Job& job, Record&) { job.image_bytes -= 128; });
  expect_wrong(offsetof(Job, result_address), [](Job& job, Record&) { job.result_address = job.base_address; });
  expect_wrong(offsetof(Job, result_address), [](Job& job, Record&) { job.result_bytes = kFar; });
  expect_wrong(offsetof(Job, result_bytes), [](Job& job, Record&) { job.result_bytes = 64; });
  expect_wrong(offsetof(Job, plane_bytes), [](Job& job, Record&) { job.plane_bytes += 128; });
  expect_wrong(256 + offsetof(FrameHead, color_address), [](Job& job, Record&) { job.color_address += 128; });
  expect_wrong(offsetof(Job, color_address),
               [](Job& job, Record& record) { job.color_address = record.color_address = job.result_address; });
  expect_wrong(offsetof(Job, depth_address),
               [](Job& job, Record& record) { job.depth_address = record.depth_address = job.color_address; });
  expect_wrong(offsetof(Job, ids_address),
               [](Job& job, Record& record) { job.ids_address = record.id_address = kFar; });
  expect_wrong(offsetof(Job, spill_bytes), [](Job& job, Record&) { job.spill_bytes = 4096; });
  expect_wrong(offsetof(Job, spill_cores), [](Job& job, Record&) { job.spill_address = job.result_address; });
  expect_wrong(offsetof(Job, spill_address), [](Job& job, Record&) {
    job.spill_address = job.result_address;
    job.spill_bytes = 4096;
    job.spill_cores = 1;
  });
  expect_wrong(offsetof(Job, tile_count), [](Job& job, Record&) { ++job.tile_count; });
  expect_wrong(offsetof(Job, effects), [](Job& job, Record&) { job.effects = 1; });
  expect_wrong(256 + offsetof(FrameHead, magic), [](Job&, Record& record) { record.magic ^= 1; });
  expect_wrong(256 + offsetof(FrameHead, tile_width), [](Job&, Record& record) { record.tile_width = 0; });
  expect_wrong(256 + offsetof(FrameHead, tile_width),
               [](Job& job, Record& record) { job.tile_width = record.tile_width = 0; });
  expect_wrong(256 + offsetof(FrameHead, tiles_x), [](Job&, Record& record) { ++record.tiles_x; });
  expect_wrong(256 + (sizeof(FrameHead) + offsetof(GridFrame, triangles_address)),
               [](Job&, Record& record) { ++record.engine.triangles_address; });
  expect_wrong(256 + (sizeof(FrameHead) + offsetof(GridFrame, grid)),
               [](Job&, Record& record) { ++record.engine.grid.reference_count; });
  expect_wrong(256 + offsetof(FrameHead, effects_address),
               [](Job&, Record& record) { record.effects_address = kBase; });
  expect_wrong(256 + offsetof(FrameHead, effects_address), [](Job&, Record& record) { record.shading = 2; });
  expect_wrong(256 + offsetof(FrameHead, tree_address), [](Job&, Record& record) { record.tree_address = kBase; });
  expect_wrong(256 + offsetof(FrameHead, shading), [](Job&, Record& record) {
    record.shading = record.fetch_depth = 2;
    record.effects_address = record.image_address = record.tree_address = kBase;
  });
}

TEST(Result, DamageIsFoundWithItsPlace) {
  const TemporaryFolder folder;
  const std::string file = make_job(folder, with_reference({"--size", "50x40"}));
  const std::string whole = render_on_host_device(file, 2);
  const auto expect_refused = [&](const std::string& result, int code, const std::string& words) {
    folder.write("a.res", result);
    expect_failure(folder, {"result", "a.job", "a.res", "-o", "a.png"}, code, words);
  };
  const auto expect_wrong = [&](std::uint64_t place, const std::function<void(FrameResult&)>& change) {
    auto frame = record_at<FrameResult>(whole, 0);
    change(frame);
    std::string result = whole;
    put_record(result, 0, frame);
    expect_refused(result, 1, "a.res:byte " + std::to_string(place) + ": ");
  };
  expect_refused(whole.substr(0, whole.size() - 4), 1, "a.res:byte " + std::to_string(whole.size() - 4) + ": ");
  expect_refused(whole + "1234", 1, "a.res:byte " + std::to_string(whole.size()) + ": ");
  expect_refused("", 1, "a.res: is empty; expected the result of a job");
  expect_refused(file, 1, "a.res: is a job; expected the result of a job");
  const auto core = [](std::uint64_t i) { return offsetof(FrameResult, cores) + i * sizeof(port::CoreResult); };
  expect_wrong(offsetof(FrameResult, version), [](FrameResult& frame) { ++frame.version; });
  expect_wrong(offsetof(FrameResult, core_count), [](FrameResult& frame) { frame.core_count = 17; });
  expect_wrong(offsetof(FrameResult, core_count), [](FrameResult& frame) { frame.core_count = 0; });
  expect_wrong(offsetof(FrameResult, work_kinds), [](FrameResult& frame) { --frame.work_kinds; });
  expect_wrong(offsetof(FrameResult, queue_depth), [](FrameResult& frame) { frame.queue_depth = 1025; });
  expect_wrong(offsetof(FrameResult, reserved), [](FrameResult& frame) { frame.reserved[8] = 1; });
  expect_wrong(offsetof(FrameResult, status), [](FrameResult& frame) { frame.status = 1; });
  expect_wrong(core(1) + offsetof(port::CoreResult, tiles), [](FrameResult& frame) { ++frame.cores[1].tiles; });
  expect_wrong(core(2), [](FrameResult& frame) { frame.cores[2].work[0] = 1; });
  expect_wrong(core(2), [](FrameResult& frame) { frame.cores[2].stack_bytes = 1; });
  if constexpr (kWorkKindCount < port::kMostWorkKinds) {
    expect_wrong(core(0) + offsetof(port::CoreResult, work) + 4 * kWorkKindCount,
                 [](FrameResult& frame) { frame.cores[0].work[port::kMostWorkKinds - 1] = 1; });
  }
  expect_wrong(core(0) + offsetof(port::CoreResult, missing_effects),
               [](FrameResult& frame) { frame.cores[0].missing_effects = kReflection; });
  expect_wrong(sizeof(FrameResult) + 2 * sizeof(port::TileResult), [](FrameResult& frame) {
    frame.core_count = 1;
    frame.cores[1] = {};
  });
  std::string unclaimed = whole;
  put_record(unclaimed, sizeof(FrameResult), port::kNotRun);
  expect_refused(unclaimed, 1, "no core claimed tile 0");

  // A device's own report of a failure is accepted.
  auto failed = record_at<FrameResult>(whole, 0);
  failed.status = failed.cores[1].status = static_cast<std::uint32_t>(Status::kTransferFailed);
  std::string result = whole;
  put_record(result, 0, failed);
  expect_refused(result, 3, "a.res: core 1: transfer that failed (kTransferFailed)");
  failed.status = failed.cores[1].status = static_cast<std::uint32_t>(Status::kMissingEffect);
  failed.cores[1].missing_effects = kReflection;
  put_record(result, 0, failed);
  expect_refused(result, 3,
                 "a.res: core 1: the scene calls for reflection, which this renderer was built without "
                 "(kMissingEffect)");
  failed.cores[1].missing_effects = 0;
  failed.status = failed.cores[1].status = port::kNotRun;
  put_record(result, 0, failed);
  expect_refused(result, 3, "a.res: core 1: it never came back");

  folder.write("a.res", whole);
  expect_failure(folder, {"result", "a.job", "a.res", "--depth", "d.pfm"}, 2, "a.job was made without --depth");
  expect_failure(folder, {"result", "a.job", "a.res", "--ids", "d.pfm"}, 2, "a.job was made without --ids");
  expect_failure(folder, {"result", "a.job", "a.res", "--report", "a.job"}, 2, "is the input 'a.job'");
  expect_failure(folder, {"result", "a.job", "a.res", "-o", "a.job"}, 2, "must end in .png or .pfm");
  expect_failure(folder, {"result", "a.job", "b.res"}, 1, "b.res: No such file");
  expect_failure(folder, {"result", "a.job"}, 2, "RESULT is required");
}

}  // namespace
}  // namespace gridiron::test
