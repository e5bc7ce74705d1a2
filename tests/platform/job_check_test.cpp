// The firmware's check of a job, on jobs that the program makes: whole ones pass, and of those that were made wrong,
// with a check value that holds, each is refused with the field's name. SPDX-License-Identifier: Apache-2.0
#include "job_check.h"

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>

#include <new>
#include <variant>

#include "console.h"
#include "gridiron/command_line/arguments.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/job/job_file.h"
#include "support/test_headers.h"

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
    engine = record().engine_id;
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
  // The grid of the image, and the frame record's copy.
  void change_grid(void (*change)(GridRecord&)) {
    change(grid());
    change(record().engine.grid);
  }
  GridRecord& grid() { return *reinterpret_cast<GridRecord*>(image() + section(SectionKind::kGrid).offset_bytes); }
  // Its sections become ones that are not known.
  void remove_grid() {
    for (std::uint32_t kind = 1; kind <= Sections::kGridCount; ++kind) {
      section(static_cast<SectionKind>(kind)).kind += 1000;
    }
  }
  EffectsRecord& effects() {
    return *reinterpret_cast<EffectsRecord*>(image() + section(SectionKind::kEffects).offset_bytes);
  }

  TreeRecord& tree() { return *reinterpret_cast<TreeRecord*>(image() + section(SectionKind::kTree).offset_bytes); }

  // Whether a firmware for this job accepts it, once its check value is that of its bytes. `told`: its output.
  bool check() {
    job().check_value = tool::job_check_value({bytes_, file_.size()});
    FirmwareFacts facts{};
    facts.memory_end = reinterpret_cast<std::uintptr_t>(bytes_) + kRoom;
    facts.core_count = 4;
    facts.tile_width = whole().tile_width;
    facts.effects = built;
    facts.packet_width = whole().packet_width;
    facts.engine = engine;
    facts.store_bytes = whole().store_bytes;
    facts.most_tiles = 1024;
    told.clear();
    return check_job(job(), facts);
  }

  std::uint32_t built = kAllEffects, engine = 0;  ///< into the firmware

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

const std::vector<const char*> kPlain = {"--size",  "70x40", "--configuration", "grid", "--packet", "8",
                                         "--cores", "4",     "--depth",         "--ids"};

TEST(JobCheck, TakesWhatTheProgramMakes) {
  for (const char* accuracy : {"standard", "paper", "exact", "fast", "compact"}) {
    std::vector<const char*> options = kPlain;
    options.insert(options.end(), {"--accuracy", accuracy});
    EXPECT_TRUE(JobMemory("teapot.ply", options).check()) << accuracy << ": " << told;
  }
  EXPECT_TRUE(JobMemory("teapot.ply", {"--size", "9x9", "--store", "64", "--cores", "4"}).check()) << told;
  for (const char* store : {"64", "256"}) {
    for (const char* accuracy : {"standard", "exact", "fast", "compact"}) {
      EXPECT_TRUE(JobMemory("teapot.ply",
                            {"--size", "70x40", "--configuration", "best", "--store", store, "--accuracy", accuracy})
                      .check())
          << store << ", " << accuracy << ": " << told;
    }
    EXPECT_TRUE(JobMemory("everything.nff", {"--size", "40x40", "--configuration", "best", "--store", store}).check())
        << store << ": " << told;
  }
  for (const char* scene : {"everything.nff", "shadow.nff", "environment.nff", "smooth_normals.nff"}) {
    EXPECT_TRUE(JobMemory(scene, {"--size", "40x40", "--cores", "4"}).check()) << scene << ": " << told;
    EXPECT_TRUE(JobMemory(scene, {"--size", "40x40", "--cores", "4", "--store", "64"}).check())
        << scene << ": " << told;
  }
}

#define WRONG(words, ...)                    \
  {                                          \
    words, [](JobMemory& m) { __VA_ARGS__; } \
  }
#define WRONG_GRID(words, ...)                                                     \
  {                                                                                \
    words, [](JobMemory& m) { m.change_grid([](GridRecord& g) { __VA_ARGS__; }); } \
  }

TEST(JobCheck, HoldsTheRecordAgainstTheJob) {
  JobMemory memory("teapot.ply", kPlain);
  expect_refusals(
      memory,
      {WRONG("frame record: magic", m.record().magic ^= 1),
       WRONG("frame record: version", ++m.record().version),
       WRONG("frame record: width", m.record().width = 2048),
       WRONG("frame record: height", m.record().height = 2048),
       WRONG("frame record: height 0x0 at byte 12: ", m.record().height = m.job().height = 0),
       WRONG("frame record: width 0x4001", m.record().width = m.job().width = kMaxPictureWidth + 1),
       WRONG("frame record: engine_id", ++m.record().engine_id),
       WRONG("frame record: tile_width", m.record().tile_width *= 2),
       WRONG("frame record: tiles_x", ++m.record().tiles_x),
       WRONG("frame record: tiles_y", --m.record().tiles_y),
       WRONG("frame record: output_depth 0x0", m.record().output_depth = 0),
       WRONG("frame record: t_far", m.record().t_far = 0.0f),
       WRONG("frame record: macro_depth 0x0", m.record().engine.macro_depth = 0),
       WRONG("frame record: triangle_depth 0x0", m.record().engine.triangle_depth = 0),
       WRONG("frame record: color_address", m.record().color_address = 0x200000),
       WRONG("frame record: color_address", m.record().color_address += 128),
       WRONG("frame record: depth_address", m.record().depth_address = 0),
       WRONG("frame record: id_address", m.record().id_address = m.record().color_address),
       WRONG("frame record: macro_table_address", m.record().engine.macro_table_address = 0),
       WRONG("frame record: cell_blocks_address", m.record().engine.cell_blocks_address -= 4096),
       WRONG("frame record: triangles_address", ++m.record().engine.triangles_address),
       WRONG("frame record: effects_address", m.record().effects_address = m.job().image_address),
       WRONG("frame record: image_address", m.record().image_address = m.job().image_address),
       WRONG("frame record: tree_address", m.record().tree_address = m.job().image_address),
       WRONG("frame record: the grid", ++m.record().engine.grid.reference_count),
       WRONG("frame record: the grid", m.record().engine.grid.cells_per_unit[2] *= 2),
       WRONG("frame record: accuracy 0x5", m.record().accuracy = 5),
       WRONG("frame record: accuracy 0x1", m.record().accuracy = 1),
       WRONG("frame record: shading 0x3", m.record().shading = 3),
       WRONG("effects 0x1, frame record and", m.job().effects = kPointShadows),
       WRONG("frame record: effects_address 0x0", m.record().shading = 2),
       WRONG("frame record: shading 2, the scene image has no effects", m.record().shading = m.record().fetch_depth = 2,
             m.record().effects_address = m.record().image_address = m.record().tree_address = 4096),
       WRONG("47 tiles, of ", m.job().tile_count = 47)});
}

TEST(JobCheck, HoldsTreesAgainstTheJob) {
  JobMemory memory("teapot.ply", {"--size", "70x40", "--configuration", "best"});
  expect_refusals(
      memory,
      {WRONG("frame record: engine_id 3, no engine of core", ++m.record().engine_id),
       WRONG("engine of eye rays", m.engine = static_cast<std::uint32_t>(EngineId::kGrid)),
       WRONG("scene image: header.section_count 3", m.section(SectionKind::kTree).kind = 1000,
             m.section(SectionKind::kTreeNodes).kind = 1000, m.section(SectionKind::kTreeTriangles).kind = 1000),
       WRONG("scene image: header.section_count 3", m.section(SectionKind::kTree).kind = 1000),
       WRONG("frame record: image_address", m.record().image_address = 0),
       WRONG("frame record: image_address", m.record().image_address += 128),
       WRONG("frame record: tree_address", m.record().tree_address = 0),
       WRONG("frame record: tree_address", m.record().tree_address += 128),
       WRONG("frame record: fetch_depth 0x0", m.record().fetch_depth = 0),
       WRONG("frame record: accuracy 1, the tree's triangles are of format 1", m.record().accuracy = 1),
       WRONG("frame record: accuracy 4, the tree's triangles are of format 1", m.record().accuracy = 4),
       WRONG("frame record: color_address", m.record().color_address += 128),
       WRONG("scene image: tree.nodes_offset_bytes", m.tree().nodes_offset_bytes = ~127ull)});
  JobMemory with_grid("teapot.ply", {"--size", "70x40", "--configuration", "grid"});
  expect_refusals(with_grid, {WRONG("frame record: engine_id 2, the scene image has no tree", m.record().engine_id = 2,
                                    m.engine = 2)});
}

TEST(JobCheck, HoldsTheImageAgainstTheJob) {
  JobMemory memory("teapot.ply", kPlain);
  expect_refusals(
      memory, {WRONG("scene image: header.magic", m.header().magic ^= 1),
               WRONG("scene image: header.image_bytes", m.header().image_bytes += 128),
               WRONG("scene image: header.image_bytes", m.job().image_bytes -= 128),
               WRONG("scene image: image 0 ", m.job().image_bytes = 0),
               WRONG("scene image: header.section_count 33 at byte 0x18", m.header().section_count = 33),
               WRONG("scene image: header.section_table_offset_bytes", m.header().section_table_offset_bytes = ~7u),
               WRONG("scene image: section.offset_bytes", m.section(SectionKind::kTriangles).offset_bytes = ~127ull),
               WRONG("scene image: section.section_bytes", m.section(SectionKind::kCellBlocks).section_bytes = ~127ull),
               WRONG("scene image: header.section_count", m.section(SectionKind::kGrid).kind = 99),
               WRONG("scene image: section.element_count", m.section(SectionKind::kMacroTable).section_bytes = 0),
               WRONG_GRID("scene image: section.element_count", g.cell_block_count = ~0u),
               WRONG_GRID("scene image: section.element_count", g.reference_count = ~0u),
               WRONG_GRID("scene image: grid.triangle_bytes 0 ", g.triangle_bytes = 0),
               WRONG_GRID("scene image: grid.triangle_bytes 1 ", g.triangle_bytes = 1),
               WRONG_GRID("scene image: grid.cell_block_bytes 32 ", g.cell_block_bytes = 32),
               WRONG_GRID("scene image: grid.macro_width 9 ", g.macro_width = 9),
               WRONG_GRID("scene image: grid.macro_width 0 ", g.macro_width = 0),
               WRONG_GRID("scene image: grid.cell_count 0 ", g.cell_count[2] = 0),
               WRONG_GRID("scene image: grid.cell_count 2049 ", g.cell_count[0] = 2049),
               WRONG_GRID("scene image: grid.macro_cell_count 4294967295 ", g.macro_cell_count[1] = ~0u),
               WRONG_GRID("scene image: grid.macro_cell_count 1 ", g.cell_count[1] = 2048, g.macro_cell_count[1] = 1)});
}

TEST(JobCheck, HoldsEffectsAgainstTheJob) {
  JobMemory memory("everything.nff", {"--size", "40x40", "--cores", "4", "--configuration", "grid"});
  constexpr std::uint32_t kMirrors = kReflection | kSmoothNormals;
  expect_refusals(
      memory,
      {WRONG("frame record: effects_address", m.record().effects_address += 128),
       WRONG("frame record: image_address", m.record().image_address -= 4096),
       WRONG("frame record: tree_address", m.record().tree_address += 128), WRONG("effects", m.record().shading = 1),
       WRONG("frame record: fetch_depth", m.record().fetch_depth = 0),
       WRONG("effects", m.effects().called_for ^= kReflection), WRONG("effects", m.job().effects ^= kReflection),
       WRONG("effects reflection, smooth_normals are not built into this firmware", m.built &= ~kMirrors),
       WRONG("effects 0x800 are not built", m.job().effects |= 1u << kEffectCount),
       WRONG("scene image: effects.light_count 257 ", m.effects().light_count = kMaxLights + 1),
       WRONG("scene image: effects.materials_offset_bytes", m.effects().materials_offset_bytes = ~127ull),
       WRONG("scene image: effects.lights_offset_bytes", m.effects().lights_offset_bytes += 16),
       WRONG("scene image: section.element_count", m.header().triangle_count = ~0u),
       WRONG("scene image: section.element_count", m.effects().smooth_triangle_count = ~0u),
       WRONG("scene image: effects.environment_offset_bytes", m.effects().environment_offset_bytes = ~127ull),
       WRONG("scene image: effects.environment_offset_bytes", m.effects().environment_width = 0),
       WRONG("scene image: header.section_count", m.section(SectionKind::kTree).kind = 1000),
       WRONG("scene image: header.section_count", m.section(SectionKind::kGrid).kind = 1000),
       WRONG("frame record: engine_id 1, the scene image has no grid", m.remove_grid()),
       WRONG("scene image: tree.nodes_offset_bytes", m.section(SectionKind::kTreeNodes).kind = 1000),
       WRONG("scene image: tree.nodes_offset_bytes", m.tree().nodes_offset_bytes = ~127ull),
       WRONG("scene image: tree.triangles_offset_bytes", m.tree().triangles_offset_bytes += 128),
       WRONG("scene image: section.element_count", m.tree().node_count = ~0u),
       WRONG("scene image: tree.triangle_count 4294967295 ", m.tree().triangle_count = ~0u),
       WRONG("scene image: tree.depth 13 ", m.tree().depth = kMaxTreeDepth + 1),
       WRONG("scene image: tree.leaf_triangles 17 ", m.tree().leaf_triangles = kMaxTreeLeaf + 1),
       WRONG("scene image: tree.triangle_format 2 ", m.tree().triangle_format = 2),
       WRONG("scene image: effects.recursion_depth 0 ", m.effects().recursion_depth = 0),
       WRONG("scene image: effects.recursion_depth 9 ", m.effects().recursion_depth = 9),
       // Of which the bytes of waiting rays are none, modulo 2^32.
       WRONG("scene image: effects.recursion_depth", m.effects().recursion_depth = 8388606),
       WRONG("scene image: effects.called_for", m.effects().samples_per_pixel = 1),
       WRONG("scene image: effects.samples_per_pixel 2 ", m.effects().samples_per_pixel = 2),
       WRONG("scene image: effects.called_for", m.effects().occlusion_samples = 0),
       WRONG("scene image: effects.occlusion_samples 65 ", m.effects().occlusion_samples = 65),
       WRONG("scene image: effects.point_light_count 65 ", m.effects().point_light_count = 65),
       WRONG("no memory for rays that wait", m.job().spill_address = 0),
       WRONG("waiting rays of ", m.job().spill_bytes -= 128),
       WRONG("memory for waiting rays of 3 cores", m.job().spill_cores = 3),
       WRONG("memory for waiting rays", m.job().spill_address = m.job().base_address),
       WRONG("memory for waiting rays", m.job().spill_address -= 4096)});
}

// Planes that record and job agree on, but that are not in the result; a result or a record where transfers change it.
TEST(JobCheck, KeepsPartsApart) {
  JobMemory memory("teapot.ply", kPlain);
  expect_refusals(
      memory, {WRONG("colour plane", m.job().color_address = m.record().color_address = m.job().result_address),
               WRONG("depth plane", m.job().depth_address = m.record().depth_address = m.job().color_address),
               WRONG("plane of ids", m.job().ids_address = m.record().id_address = 1ull << 63),
               WRONG("frame record: color_address", m.job().color_address = m.record().color_address = 0),
               WRONG("plane bytes", m.job().plane_bytes += 128), WRONG("result of 64 bytes", m.job().result_bytes = 64),
               WRONG("result at ", m.job().result_address = m.job().image_address),
               WRONG("result at ", m.job().result_bytes = ~0ull),
               WRONG("frame record at ", m.job().frame_address = m.job().color_address),
               WRONG("frame record at ", m.job().frame_address = m.job().base_address - 384),
               WRONG("scene image at ", m.job().image_address = m.job().color_address),
               WRONG("scene image at ", m.job().image_address += 64, m.job().image_bytes -= 128),
               WRONG("scene image at ", m.job().loaded_bytes -= 64), WRONG("check value", m.job().loaded_bytes += 64),
               WRONG("reserved", m.job().reserved[23] = 1)});
}

TEST(Console, NamesAStatus) {
  told.clear();
  print("status ", StatusNumber{static_cast<std::uint32_t>(Status::kBadImage)}, ", ", StatusNumber{kNotRun});
  EXPECT_EQ(told, "status 14 (kBadImage), 4294967295");
}

}  // namespace
}  // namespace gridiron::port
