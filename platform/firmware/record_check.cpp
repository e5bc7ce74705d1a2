// Whether the frame record of a job is that of the job. Layout of the image: core/SPEC.md.
// Memory: reads the job. Threads: the master, integers only. SPDX-License-Identifier: Apache-2.0
#include "record_check.h"

#include <gridiron/base/accuracies.h>
#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/triangle_formats.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "refusal.h"

namespace gridiron::port {

namespace {

constexpr std::uint32_t kSectionKinds = static_cast<std::uint32_t>(SectionKind::kEnvironmentMap) + 1;

template <class Record>
const Record& record_at(std::uint64_t address) {
  return *reinterpret_cast<const Record*>(static_cast<std::uintptr_t>(address));
}

bool is_of_job(const char* field, std::uint64_t value, std::uint64_t wanted) {
  return value == wanted || refuse("frame record: ", field, " ", Hex{value}, ", the job's is ", Hex{wanted});
}

bool is_of_image(const char* field, std::uint64_t value, std::uint64_t wanted) {
  return value == wanted || refuse("frame record: ", field, " ", Hex{value}, ", the scene image's is ", Hex{wanted});
}

bool is_of_format(const char* field, std::uint64_t value, std::uint64_t wanted) {
  return value == wanted || refuse("scene image: ", field, ": ", value, ", its triangles' format has ", wanted);
}

// Where the sections of an image lie.
class ImageHead {
 public:
  explicit ImageHead(const FrameJob& job) : address_(job.image_address), bytes_(job.image_bytes) {}

  // Reads the table of sections; a section that is there lies in the image.
  [[nodiscard]] bool read() {
    if (bytes_ < sizeof(ImageHeader) || bytes_ % kLineBytes != 0) return refuse("scene image of ", bytes_, " bytes");
    const ImageHeader& header = this->header();
    if (header.magic != kImageMagic || header.version != kImageVersion) return refuse("scene image of another version");
    if (header.image_bytes != bytes_) return refuse("scene image: image_bytes ", Hex{header.image_bytes});
    const std::uint32_t table = header.section_table_offset_bytes;
    if (header.section_count > kMaxSectionCount || table % alignof(SectionEntry) != 0 ||
        !holds(table, header.section_count, sizeof(SectionEntry))) {
      return refuse("scene image: section table at ", Hex{table}, " of ", header.section_count);
    }
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
      const auto& entry = record_at<SectionEntry>(address_ + table + i * sizeof(SectionEntry));
      if (entry.offset_bytes % kLineBytes != 0 || !holds(entry.offset_bytes, entry.section_bytes, 1)) {
        return refuse("scene image: section ", entry.kind, " at ", Hex{entry.offset_bytes}, " is outside");
      }
      if (entry.kind < kSectionKinds) sections_[entry.kind] = &entry;
    }
    return true;
  }

  [[nodiscard]] const ImageHeader& header() const { return record_at<ImageHeader>(address_); }

  // Whether the image has the section, with so much in it. Cores read whole lines, of which images are made.
  [[nodiscard]] bool has(SectionKind kind, const char* name, std::uint64_t count, std::uint64_t record_bytes) const {
    const SectionEntry* entry = sections_[static_cast<std::uint32_t>(kind)];
    if (entry == nullptr) return refuse("scene image: no ", name);
    return (record_bytes != 0 && count <= entry->section_bytes / record_bytes) ||
           refuse("scene image: ", name, " of ", entry->section_bytes, " bytes for ", count);
  }

  // A section of one record; null where the image has none, which has been told then.
  template <class Record>
  [[nodiscard]] const Record* find(SectionKind kind, const char* name) const {
    if (!has(kind, name, 1, sizeof(Record))) return nullptr;
    return reinterpret_cast<const Record*>(static_cast<std::uintptr_t>(address_of(kind)));
  }

  // 0 where it has none.
  [[nodiscard]] std::uint64_t address_of(SectionKind kind) const {
    const SectionEntry* entry = sections_[static_cast<std::uint32_t>(kind)];
    return entry == nullptr ? 0 : address_ + entry->offset_bytes;
  }

  // Whether records that begin at an offset lie in the image.
  [[nodiscard]] bool holds(std::uint64_t offset, std::uint64_t count, std::uint64_t record_bytes) const {
    return offset <= bytes_ && count <= (bytes_ - offset) / record_bytes;
  }

 private:
  std::uint64_t address_;
  std::uint64_t bytes_;
  const SectionEntry* sections_[kSectionKinds] = {};
};

bool check_picture(const FrameJob& job, const FrameRecord& frame) {
  return is_of_job("magic", frame.magic, kFrameMagic) && is_of_job("version", frame.version, kFrameVersion) &&
         is_of_job("engine", frame.engine_id, static_cast<std::uint32_t>(EngineId::kGrid)) &&
         is_of_job("width", frame.width, job.width) && is_of_job("height", frame.height, job.height) &&
         is_of_job("tile width", frame.tile_width, job.tile_width) &&
         is_of_job("tiles_x", frame.tiles_x, (job.width + job.tile_width - 1) / job.tile_width) &&
         is_of_job("tiles_y", frame.tiles_y, (job.height + job.tile_width - 1) / job.tile_width) &&
         is_of_job("colour address", frame.color_address, job.color_address) &&
         is_of_job("depth address", frame.depth_address, job.depth_address) &&
         is_of_job("ids address", frame.id_address, job.ids_address);
}

bool check_grid(const FrameRecord& frame, const ImageHead& image) {
  const GridRecord* const grid = image.find<GridRecord>(SectionKind::kGrid, "grid");
  if (grid == nullptr) return false;
  // Bit for bit: no floating point here.
  if (std::memcmp(reinterpret_cast<const std::byte*>(&frame.engine.grid), reinterpret_cast<const std::byte*>(grid),
                  sizeof *grid) != 0) {
    return refuse("frame record: the grid is not the scene image's");
  }
  // What sizes and steps of the walk follow from; the same rules as open_scene_image's.
  if (grid->macro_width < 1 || grid->macro_width > kMaxMacroWidth) {
    return refuse("scene image: macrocells of ", grid->macro_width, " cells");
  }
  std::uint64_t macro_cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t cells = grid->cell_count[axis], count = grid->macro_cell_count[axis];
    if (cells < 1 || cells > kMaxCellsPerAxis) return refuse("scene image: cells along an axis: ", cells);
    if (count != (cells + grid->macro_width - 1) / grid->macro_width) {
      return refuse("scene image: macrocells along an axis: ", count, " for ", cells, " cells");
    }
    macro_cells *= count;
  }
  const auto format = static_cast<TriangleFormat>(grid->triangle_format);
  const std::uint32_t block_bytes = cell_block_bytes_of(format, grid->macro_width);
  return is_of_format("bytes of a triangle", grid->triangle_bytes, triangle_bytes_of(format)) &&
         is_of_format("bytes of a cell block", grid->cell_block_bytes, block_bytes) &&
         image.has(SectionKind::kMacroTable, "macrocell table", (macro_cells + 31) / 32, sizeof(MacroTableEntry)) &&
         image.has(SectionKind::kCellBlocks, "cell blocks", grid->cell_block_count, grid->cell_block_bytes) &&
         image.has(SectionKind::kTriangles, "triangles", grid->reference_count, grid->triangle_bytes) &&
         is_of_image("macro table address", frame.engine.macro_table_address,
                     image.address_of(SectionKind::kMacroTable)) &&
         is_of_image("cell blocks address", frame.engine.cell_blocks_address,
                     image.address_of(SectionKind::kCellBlocks)) &&
         is_of_image("triangles address", frame.engine.triangles_address, image.address_of(SectionKind::kTriangles));
}

bool check_accuracy(const FrameRecord& frame) {
  if (frame.accuracy >= kAccuracyCount) {
    return refuse("frame record: accuracy ", frame.accuracy);
  }
  const TriangleFormat format = accuracy_traits(frame.accuracy).format;
  return frame.engine.grid.triangle_format == static_cast<std::uint32_t>(format) ||
         refuse("frame record: accuracy ", frame.accuracy, " of triangles of format ",
                frame.engine.grid.triangle_format);
}

// A section that an effects record speaks of lies in the image; of no records it need not.
bool has_records(const ImageHead& image, const char* name, std::uint64_t offset, std::uint64_t count,
                 std::uint64_t record_bytes) {
  return count == 0 || (offset % kLineBytes == 0 && image.holds(offset, count, record_bytes)) ||
         refuse("scene image: ", name, " at ", Hex{offset}, ", ", count, " of them, are outside");
}

bool check_effects(const FrameJob& job, const FrameRecord& frame, const ImageHead& image) {
  if (frame.shading > static_cast<std::uint32_t>(Shading::kScene)) {
    return refuse("frame record: shading ", frame.shading);
  }
  if (frame.shading != static_cast<std::uint32_t>(Shading::kScene)) {
    if (job.effects != 0) return refuse("frame record: shading ", frame.shading, " of a job with effects");
    return is_of_job("effects address", frame.effects_address, 0) && is_of_job("image address", frame.image_address, 0);
  }
  const EffectsRecord* const effects = image.find<EffectsRecord>(SectionKind::kEffects, "effects");
  if (effects == nullptr ||
      !is_of_image("effects address", frame.effects_address, image.address_of(SectionKind::kEffects)) ||
      !is_of_job("image address", frame.image_address, job.image_address)) {
    return false;
  }
  if (effects->called_for != job.effects) {
    return refuse("effects ", Hex{job.effects}, ", the scene image calls for ", Hex{effects->called_for});
  }
  const auto calls_for = [effects](std::uint32_t bits) { return (effects->called_for & bits) != 0; };
  if (effects->material_count > kMaxMaterials || effects->light_count > kMaxLights ||
      effects->environment_width > kMaxEnvironmentWidth) {
    return refuse("scene image: more materials, lights or environment than a scene has");
  }
  // What loops, queues and addresses follow from. Of single lights and materials the firmware reads none.
  if (effects->recursion_depth < 1 || effects->recursion_depth > kMaxRecursionDepth) {
    return refuse("scene image: recursion depth ", effects->recursion_depth);
  }
  const std::uint32_t samples = effects->samples_per_pixel;
  if ((samples != 1 && samples != 4 && samples != 16) || calls_for(kMultisampling) != (samples > 1)) {
    return refuse("scene image: ", samples, " samples of a pixel");
  }
  if (effects->occlusion_samples > kMaxEffectSamples ||
      calls_for(kAmbientOcclusion) != (effects->occlusion_samples != 0)) {
    return refuse("scene image: ", effects->occlusion_samples, " samples of occlusion");
  }
  if (effects->point_light_count > effects->light_count) {
    return refuse("scene image: ", effects->point_light_count, " point lights of ", effects->light_count);
  }
  if (calls_for(kEnvironment) != (effects->environment_width != 0)) {
    return refuse("scene image: an environment of ", effects->environment_width, " texels");
  }
  const std::uint64_t edge = effects->environment_width == 0 ? 0 : environment_blocks(effects->environment_width);
  return has_records(image, "materials", effects->materials_offset_bytes, effects->material_count,
                     sizeof(MaterialRecord)) &&
         has_records(image, "lights", effects->lights_offset_bytes, effects->light_count, sizeof(LightRecord)) &&
         has_records(image, "surfaces", effects->surfaces_offset_bytes, image.header().triangle_count,
                     sizeof(SurfaceRecord)) &&
         has_records(image, "normals", effects->normals_offset_bytes, effects->smooth_triangle_count,
                     sizeof(NormalRecord)) &&
         has_records(image, "environment", effects->environment_offset_bytes, 6 * edge * edge,
                     sizeof(EnvironmentBlock));
}

}  // namespace

bool check_record(const FrameJob& job) {
  const auto& frame = record_at<FrameRecord>(job.frame_address);
  ImageHead image(job);
  return check_picture(job, frame) && image.read() && check_grid(frame, image) && check_accuracy(frame) &&
         check_effects(job, frame, image);
}

}  // namespace gridiron::port
