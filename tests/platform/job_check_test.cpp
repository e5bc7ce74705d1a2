// The firmware's check of a job, on jobs that the program makes: whole ones pass, and of those that were made wrong,
// with a check value that holds, each is refused with the field's name. SPDX-License-Identifier: Apache-2.0
#include "job_check.h"

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <variant>
#include <vector>

#include "console.h"
#include "gridiron/command_line/arguments.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/job/job_file.h"

namespace gridiron::port {

namespace {
std::string told;
}

void put_character(char character) {
  told.push_back(character);
}

namespace {

constexpr std::uint64_t kRecordPlace = 256;  // of the frame record in a job
constexpr std::size_t kRoom = std::size_t{1} << 26;

// Main memory of a board, with a job at its start.
class JobMemory {
 public:
  JobMemory(const std::string& scene, std::vector<const char*> options)
      : bytes_(static_cast<std::byte*>(::operator new (kRoom, std::align_val_t{4096}))) {
    const std::string input = std::string(GRIDIRON_SCENE_FILES) + "/" + scene;
    const std::string output = (std::filesystem::temp_directory_path() / "unwritten.job").string();
    options.insert(options.begin(), {"gridiron", "job", input.c_str(), "-o", output.c_str(), "--base", "0", "--quiet"});
    const tool::Command command = tool::parse_arguments(static_cast<int>(options.size()), options.data());
    const tool::RequestedFrame request =
        tool::read_requested_frame(std::get<tool::JobRequest>(command).render, {{"-o", output}});
    tool::FrameMemory frame(tool::frame_memory_bytes(request.input, request.plan));
    tool::prepare_frame(frame, request.input, request.plan, request.view);
    file_ = tool::make_job_file(frame, request.plan, reinterpret_cast<std::uintptr_t>(bytes_));
    load();
  }
  ~JobMemory() { ::operator delete (bytes_, std::align_val_t{4096}); }
  JobMemory(const JobMemory&) = delete;
  JobMemory& operator=(const JobMemory&) = delete;

  // As the program made it.
  void load() {
    std::memcpy(bytes_, file_.data(), file_.size());
    built = kAllEffects;
  }

  FrameJob& job() { return *reinterpret_cast<FrameJob*>(bytes_); }
  FrameRecord& record() { return *reinterpret_cast<FrameRecord*>(bytes_ + kRecordPlace); }
  std::byte* image() { return bytes_ + (job().image_address - job().base_address); }
  ImageHeader& header() { return *reinterpret_cast<ImageHeader*>(image()); }
  SectionEntry& section(SectionKind kind) {
    auto* entries = reinterpret_cast<SectionEntry*>(image() + header().section_table_offset_bytes);
    for (std::uint32_t i = 0; i < header().section_count; ++i) {
      if (entries[i].kind == static_cast<std::uint32_t>(kind)) return entries[i];
    }
    ADD_FAILURE() << "no section " << static_cast<std::uint32_t>(kind);
    return entries[0];
  }
  GridRecord& grid() { return *reinterpret_cast<GridRecord*>(image() + section(SectionKind::kGrid).offset_bytes); }
  EffectsRecord& effects() {
    return *reinterpret_cast<EffectsRecord*>(image() + section(SectionKind::kEffects).offset_bytes);
  }

  // Whether a firmware for this job accepts it, once its check value is that of its bytes. Its output: told.
  bool check() {
    job().check_value = tool::job_check_value({bytes_, file_.size()});
    FirmwareFacts facts{};
    facts.memory_end = reinterpret_cast<std::uintptr_t>(bytes_) + kRoom;
    facts.core_count = 4;
    facts.tile_width = whole().tile_width;
    facts.effects = built;
    facts.packet_width = whole().packet_width;
    facts.store_bytes = whole().store_bytes;
    facts.most_tiles = 1024;
    told.clear();
    return check_job(job(), facts);
  }

  std::uint32_t built = kAllEffects;  ///< into the firmware

 private:
  [[nodiscard]] const FrameJob& whole() const { return *reinterpret_cast<const FrameJob*>(file_.data()); }

  std::byte* bytes_;
  std::vector<std::byte> file_;
};

struct Wrong {
  const char* words;  // that the refusal begins with
  std::function<void(JobMemory&)> change;
};

void expect_refusals(JobMemory& memory, const std::vector<Wrong>& wrongs) {
  for (const Wrong& wrong : wrongs) {
    memory.load();
    wrong.change(memory);
    EXPECT_FALSE(memory.check()) << wrong.words;
    EXPECT_EQ(told.substr(0, told.find('\n')).rfind(std::string("job refused: ") + wrong.words, 0), 0u)
        << "wanted: " << wrong.words << "\nsaid: " << told;
  }
  memory.load();
  EXPECT_TRUE(memory.check()) << told;
}

const std::vector<const char*> kPlain = {"--size", "70x40", "--packet", "8", "--cores", "4", "--depth", "--ids"};

TEST(JobCheck, TakesWhatTheProgramMakes) {
  for (const char* accuracy : {"standard", "paper", "exact", "fast", "compact"}) {
    std::vector<const char*> options = kPlain;
    options.insert(options.end(), {"--accuracy", accuracy});
    EXPECT_TRUE(JobMemory("teapot.ply", options).check()) << accuracy << ": " << told;
  }
  EXPECT_TRUE(JobMemory("teapot.ply", {"--size", "9x9", "--store", "64", "--cores", "4"}).check()) << told;
  for (const char* scene : {"everything.nff", "shadow.nff", "environment.nff", "smooth_normals.nff"}) {
    EXPECT_TRUE(JobMemory(scene, {"--size", "40x40", "--cores", "4"}).check()) << scene << ": " << told;
    EXPECT_TRUE(JobMemory(scene, {"--size", "40x40", "--cores", "4", "--store", "64"}).check())
        << scene << ": " << told;
  }
}

TEST(JobCheck, HoldsTheRecordAgainstTheJob) {
  JobMemory memory("teapot.ply", kPlain);
  using Memory = JobMemory;
  expect_refusals(
      memory, {{"frame record: magic", [](Memory& m) { m.record().magic ^= 1; }},
               {"frame record: version", [](Memory& m) { ++m.record().version; }},
               {"frame record: width", [](Memory& m) { m.record().width = 2048; }},
               {"frame record: height", [](Memory& m) { m.record().height = 2048; }},
               {"frame record: engine", [](Memory& m) { ++m.record().engine_id; }},
               {"frame record: tile width", [](Memory& m) { m.record().tile_width *= 2; }},
               {"frame record: tiles_x", [](Memory& m) { ++m.record().tiles_x; }},
               {"frame record: tiles_y", [](Memory& m) { --m.record().tiles_y; }},
               {"frame record: colour address", [](Memory& m) { m.record().color_address = 0x200000; }},
               {"frame record: colour address", [](Memory& m) { m.record().color_address += 128; }},
               {"frame record: depth address", [](Memory& m) { m.record().depth_address = 0; }},
               {"frame record: ids address", [](Memory& m) { m.record().id_address = m.record().color_address; }},
               {"frame record: macro table address", [](Memory& m) { m.record().engine.macro_table_address = 0; }},
               {"frame record: cell blocks address", [](Memory& m) { m.record().engine.cell_blocks_address -= 4096; }},
               {"frame record: triangles address", [](Memory& m) { ++m.record().engine.triangles_address; }},
               {"frame record: effects address", [](Memory& m) { m.record().effects_address = m.job().image_address; }},
               {"frame record: image address", [](Memory& m) { m.record().image_address = m.job().image_address; }},
               {"frame record: the grid", [](Memory& m) { ++m.record().engine.grid.reference_count; }},
               {"frame record: the grid", [](Memory& m) { m.record().engine.grid.cells_per_unit[2] *= 2; }},
               {"frame record: accuracy", [](Memory& m) { m.record().accuracy = 5; }},
               {"frame record: accuracy", [](Memory& m) { m.record().accuracy = 1; }},
               {"frame record: shading", [](Memory& m) { m.record().shading = 3; }},
               {"frame record: shading", [](Memory& m) { m.job().effects = kPointShadows; }},
               {"scene image: no effects", [](Memory& m) { m.record().shading = 2; }}});
}

TEST(JobCheck, HoldsTheImageAgainstTheJob) {
  JobMemory memory("teapot.ply", kPlain);
  using Memory = JobMemory;
  expect_refusals(
      memory,
      {{"scene image of another version", [](Memory& m) { m.header().magic ^= 1; }},
       {"scene image: image_bytes", [](Memory& m) { m.header().image_bytes += 128; }},
       {"scene image: image_bytes", [](Memory& m) { m.job().image_bytes -= 128; }},
       {"scene image of 0 bytes", [](Memory& m) { m.job().image_bytes = 0; }},
       {"scene image: section table", [](Memory& m) { m.header().section_count = 33; }},
       {"scene image: section table", [](Memory& m) { m.header().section_table_offset_bytes = 0xFFFFFFF8; }},
       {"scene image: section 4", [](Memory& m) { m.section(SectionKind::kTriangles).offset_bytes = 0u - 128ull; }},
       {"scene image: section 3", [](Memory& m) { m.section(SectionKind::kCellBlocks).section_bytes = ~0ull; }},
       {"scene image: no grid", [](Memory& m) { m.section(SectionKind::kGrid).kind = 99; }},
       {"scene image: macrocells",
        [](Memory& m) { m.record().engine.grid.macro_cell_count[1] = m.grid().macro_cell_count[1] = ~0u; }},
       {"scene image: macrocell table", [](Memory& m) { m.section(SectionKind::kMacroTable).section_bytes = 0; }},
       {"scene image: cell blocks",
        [](Memory& m) { m.record().engine.grid.cell_block_count = m.grid().cell_block_count = ~0u; }},
       {"scene image: triangles",
        [](Memory& m) { m.record().engine.grid.reference_count = m.grid().reference_count = ~0u; }},
       {"scene image: bytes of a triangle: 0",
        [](Memory& m) { m.record().engine.grid.triangle_bytes = m.grid().triangle_bytes = 0; }},
       {"scene image: bytes of a triangle: 1",
        [](Memory& m) { m.record().engine.grid.triangle_bytes = m.grid().triangle_bytes = 1; }},
       {"scene image: bytes of a cell block",
        [](Memory& m) { m.record().engine.grid.cell_block_bytes = m.grid().cell_block_bytes = 32; }},
       {"scene image: macrocells of 9 cells",
        [](Memory& m) { m.record().engine.grid.macro_width = m.grid().macro_width = 9; }},
       {"scene image: macrocells of 0 cells",
        [](Memory& m) { m.record().engine.grid.macro_width = m.grid().macro_width = 0; }},
       {"scene image: cells along an axis: 0",
        [](Memory& m) { m.record().engine.grid.cell_count[2] = m.grid().cell_count[2] = 0; }},
       {"scene image: cells along an axis: 2049",
        [](Memory& m) { m.record().engine.grid.cell_count[0] = m.grid().cell_count[0] = 2049; }},
       {"scene image: macrocells along an axis: 1 for 2048", [](Memory& m) {
          m.record().engine.grid.cell_count[1] = m.grid().cell_count[1] = 2048;
          m.record().engine.grid.macro_cell_count[1] = m.grid().macro_cell_count[1] = 1;
        }}});
}

TEST(JobCheck, HoldsEffectsAgainstTheJob) {
  JobMemory memory("everything.nff", {"--size", "40x40", "--cores", "4"});
  using Memory = JobMemory;
  constexpr std::uint64_t kFar = 0u - 128ull;
  expect_refusals(memory, {{"frame record: effects address", [](Memory& m) { m.record().effects_address += 128; }},
                           {"frame record: image address", [](Memory& m) { m.record().image_address -= 4096; }},
                           {"frame record: shading", [](Memory& m) { m.record().shading = 1; }},
                           {"effects", [](Memory& m) { m.effects().called_for ^= kReflection; }},
                           {"effects", [](Memory& m) { m.job().effects ^= kReflection; }},
                           {"effects reflection, smooth_normals are not built into this firmware",
                            [](Memory& m) { m.built &= ~(kReflection | kSmoothNormals); }},
                           {"effects 0x400 are not built", [](Memory& m) { m.job().effects |= 1u << kEffectCount; }},
                           {"scene image: more materials", [](Memory& m) { m.effects().light_count = kMaxLights + 1; }},
                           {"scene image: materials", [](Memory& m) { m.effects().materials_offset_bytes = kFar; }},
                           {"scene image: lights", [](Memory& m) { m.effects().lights_offset_bytes += 16; }},
                           {"scene image: surfaces", [](Memory& m) { m.header().triangle_count = ~0u; }},
                           {"scene image: normals", [](Memory& m) { m.effects().smooth_triangle_count = ~0u; }},
                           {"scene image: environment", [](Memory& m) { m.effects().environment_offset_bytes = kFar; }},
                           {"scene image: recursion depth 0", [](Memory& m) { m.effects().recursion_depth = 0; }},
                           {"scene image: recursion depth 9", [](Memory& m) { m.effects().recursion_depth = 9; }},
                           // Of which the bytes of waiting rays are none, modulo 2^32.
                           {"scene image: recursion depth", [](Memory& m) { m.effects().recursion_depth = 8388606; }},
                           {"scene image: 1 samples", [](Memory& m) { m.effects().samples_per_pixel = 1; }},
                           {"scene image: 2 samples", [](Memory& m) { m.effects().samples_per_pixel = 2; }},
                           {"scene image: 0 samples of occ", [](Memory& m) { m.effects().occlusion_samples = 0; }},
                           {"scene image: 65 samples of occ", [](Memory& m) { m.effects().occlusion_samples = 65; }},
                           {"scene image: 65 point lights", [](Memory& m) { m.effects().point_light_count = 65; }},
                           {"scene image: an environment", [](Memory& m) { m.effects().environment_width = 0; }},
                           {"no memory for rays that wait", [](Memory& m) { m.job().spill_address = 0; }},
                           {"waiting rays of ", [](Memory& m) { m.job().spill_bytes -= 128; }},
                           {"memory for waiting rays of 3 cores", [](Memory& m) { m.job().spill_cores = 3; }},
                           {"memory for waiting rays", [](Memory& m) { m.job().spill_address = m.job().base_address; }},
                           {"memory for waiting rays", [](Memory& m) { m.job().spill_address -= 4096; }}});
}

// Planes that record and job agree on, but that are not in the result; a result or a record where transfers change it.
TEST(JobCheck, KeepsPartsApart) {
  JobMemory memory("teapot.ply", kPlain);
  using Memory = JobMemory;
  expect_refusals(
      memory,
      {{"colour plane", [](Memory& m) { m.job().color_address = m.record().color_address = m.job().result_address; }},
       {"depth plane", [](Memory& m) { m.job().depth_address = m.record().depth_address = m.job().color_address; }},
       {"plane of ids", [](Memory& m) { m.job().ids_address = m.record().id_address = 1ull << 63; }},
       {"colour plane", [](Memory& m) { m.job().color_address = m.record().color_address = 0; }},
       {"result of 64 bytes", [](Memory& m) { m.job().result_bytes = 64; }},
       {"result at ", [](Memory& m) { m.job().result_address = m.job().image_address; }},
       {"result at ", [](Memory& m) { m.job().result_bytes = ~0ull; }},
       {"frame record at ", [](Memory& m) { m.job().frame_address = m.job().color_address; }},
       {"frame record at ", [](Memory& m) { m.job().frame_address = m.job().base_address - 384; }},
       {"scene image at ", [](Memory& m) { m.job().image_address = m.job().color_address; }},
       {"check value", [](Memory& m) { m.job().loaded_bytes -= 64; }}});
}

TEST(Console, NamesAStatus) {
  told.clear();
  print("status ", StatusNumber{static_cast<std::uint32_t>(Status::kBadImage)}, ", ", StatusNumber{kNotRun});
  EXPECT_EQ(told, "status 14 (kBadImage), 4294967295");
}

}  // namespace
}  // namespace gridiron::port
