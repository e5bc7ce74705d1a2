// Scene input. SPDX-License-Identifier: Apache-2.0
#include "scene_input.h"

#include <gridiron/build/grid/grid_resolution.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/sim/sim_memory.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "base/failure.h"
#include "base/progress.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "gridiron/device/accuracies.h"
#include "image_damage.h"
#include "image_structures.h"
#include "look.h"

namespace gridiron::tool {
namespace {

PackedScene open_packed_scene(InputFile file, const std::filesystem::path& path) {
  PackedScene packed{std::move(file), {}};
  SceneImageError error;
  if (open_scene_image(packed.file.bytes, packed.view, error) != Status::kOk) {
    const ImageDamage damage = find_image_damage(packed.file.bytes, error);
    throw Failure(ExitCode::kBadInput,
                  path.string() + ":byte " + std::to_string(damage.byte_offset) + ": " + damage.reason);
  }
  return packed;
}

ViewRequest view_of(const SceneView& view) {
  if (!view.is_given()) return {};
  return {.eye = view.from, .at = view.at, .up = view.up, .fov_degrees = view.angle_degrees};
}

ScenePicture picture_of(const PictureRequest& asked, const SceneView& own, const PointSource& points) {
  const PictureRequest request = complete_request(asked, own);
  const double aspect = static_cast<double>(request.size->x) / request.size->y;
  const Camera camera = complete_view(join_view(request.view, *request.camera), aspect, points);
  return {camera.eye, camera.tan_half_fov, request.size->y};
}

void read_text_scene(const InputFile& file, const std::filesystem::path& path, std::optional<float> tolerance,
                     const std::optional<PictureRequest>& picture, SceneInput& input) {
  SceneOptions options;
  options.tolerance = tolerance;
  if (picture) {
    options.picture = [&picture](const SceneView& own, const PointSource& points) {
      return picture_of(*picture, own, points);
    };
  }
  const std::string_view words(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
  SceneDescription scene = read_scene_text(words, path, options);
  input.effects = take_scene_effects(scene);
  input.text = {scene.view, std::move(scene.notes), scene.note_count, std::move(scene.roundness)};
  Mesh& mesh = std::get<Mesh>(input.content);
  mesh.vertices = std::move(scene.geometry.vertices);
  mesh.triangles = std::move(scene.geometry.triangles);
}

std::string text_of(float number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", static_cast<double>(number));
  return text;
}

std::uint64_t two_digits(std::uint64_t count) {
  std::uint64_t unit = 1;
  while (count / unit >= 100) unit *= 10;
  return (count + unit / 2) / unit * unit;
}

// "; --tolerance 0.003 would fit": a tolerance that makes a scene small enough; empty if there is none.
std::string words_of_fitting_tolerance(const GridChoice& choice, const SceneInput& input) {
  if (!input.text || choice.need.image_bytes == 0) return "";
  // Larger triangles lie in more cells each, so an image shrinks less than its number of triangles.
  constexpr double kMargin = 0.8;
  const auto triangles = static_cast<double>(std::get<Mesh>(input.content).triangles.size());
  const double share = static_cast<double>(choice.budget_bytes) / static_cast<double>(choice.need.image_bytes);
  const auto most = static_cast<std::uint64_t>(kMargin * share * triangles);
  const std::optional<float> tolerance = tolerance_for(input.text->roundness, most);
  if (!tolerance) return "";
  return "; coarser round shapes would fit: --tolerance " + text_of(*tolerance) + " (it is " +
         words_of_tolerance(input.text->roundness) + ")";
}

std::string words_of_budget(const sim::MachineProfile& machine, std::uint64_t budget_bytes) {
  return std::string(machine.name) + " has " + words_of_bytes(budget_bytes) + " for it: of its " +
         words_of_bytes(machine.main_memory_bytes) + " of main memory " +
         words_of_bytes(machine.main_memory_bytes - budget_bytes) +
         " are kept for pictures, the frame record and rays that wait (see 'gridiron machines')";
}

// " at lambda 4", or nothing without a grid.
std::string words_of_lambda(const GridParameters& parameters, float lambda) {
  return parameters.has_grid ? " at lambda " + text_of(lambda) : "";
}

// The configuration to pack with for what eye rays read.
std::string configuration_with(EngineId engine, const Configuration& wanted) {
  const auto reads = [engine](const Configuration& configuration) { return engine_of(configuration) == engine; };
  return std::string(reads(wanted) ? wanted.name : std::ranges::find_if(configurations(), reads)->name);
}

void require_engine(const SceneInput& input, const PackedScene& packed, const SceneRequest& request, EngineId engine) {
  const bool has_it = engine == EngineId::kTree ? packed.view.has_tree : packed.view.has_grid;
  if (has_it) return;
  if (engine == EngineId::kGrid && !request.configuration->has_grid()) {
    input_error(input.path, "has no grid, which frames with effects in a local store of 64 KB ask for; pack it with " +
                                std::string("--machine of a chip with such stores"));
  }
  const char* const missing = engine == EngineId::kTree ? "tree" : "grid";
  input_error(input.path, "holds " + words_of_structures(structures_of(packed.view)) + ", but no " + missing +
                              ", which --configuration " + std::string(request.configuration->name) +
                              " reads here; pack it with --configuration " +
                              configuration_with(engine, *request.configuration));
}

// Whether the grid of a packed scene is as requested.
void require_grid(const SceneInput& input, const GridRecord& grid, const SceneRequest& request,
                  const ImageLimits& limits) {
  if (request.lambda && *request.lambda != grid.lambda) {
    input_error(input.path, "was packed with lambda " + text_of(grid.lambda) + "; --lambda cannot change it");
  }
  if (grid.macro_width > limits.most_macro_width) {
    input_error(input.path, "was packed with macrocells of width " + std::to_string(grid.macro_width) +
                                "; the local store holds cell blocks of width " +
                                std::to_string(limits.most_macro_width));
  }
  if (request.macro_width && *request.macro_width != grid.macro_width) {
    input_error(input.path, "was packed with macrocells of width " + std::to_string(grid.macro_width) +
                                "; --macro-width cannot change it");
  }
}

void read_model(InputFile file, const ImportRequest& request, SceneInput& input) {
  ImportedModel model = import_model(std::move(file), request);
  for (const NeighbourFile& neighbour : model.neighbours) note_read_file(neighbour.path, neighbour.content);
  input.content = std::move(model.mesh);
  input.model = std::move(model.report);
}

void tell_model(const SceneInput& input) {
  const ImportReport& report = *input.model;
  const Mesh& mesh = std::get<Mesh>(input.content);
  // A mesh of this program's own format is worth a line for what a frame without a look does not show.
  if (report.reader.empty() && mesh.surface.is_empty()) return;
  // A look has added a ground to the model's own triangles.
  const std::optional<std::uint64_t> triangles =
      input.effects ? std::nullopt : std::optional<std::uint64_t>(mesh.triangles.size());
  std::fprintf(stderr, "%s: %s\n", input.path.c_str(), words_of_model(report, mesh, triangles).c_str());
  if (report.ignored.empty()) return;
  std::fprintf(stderr, "%s: ignored: %s\n", input.path.c_str(), words_of_list(report.ignored).c_str());
}

// What a file without triangles holds.
std::string words_without_triangles(const SceneInput& input, const Mesh& mesh) {
  if (input.model && !input.model->ignored.empty()) return "it holds " + words_of_list(input.model->ignored);
  if (mesh.vertices.empty()) return "it holds no vertex that a face names";
  return "a point cloud of " + words_of_count(mesh.vertices.size()) +
         (mesh.vertices.size() == 1 ? " vertex" : " vertices");
}

void require_tolerance(std::optional<float> tolerance, SceneKind kind) {
  if (tolerance && kind != SceneKind::kText) usage_error("--tolerance: applies to text scenes (NFF) only");
}

}  // namespace

std::string words_of_model(const ImportReport& report, const Mesh& mesh, std::optional<std::uint64_t> triangles) {
  std::string words = report.format;
  if (!report.reader.empty())
    words += ", " + words_of_count(report.meshes) + (report.meshes == 1 ? " mesh" : " meshes");
  if (!mesh.surface.materials.empty()) words += ", " + words_of_count(mesh.surface.materials.size(), "material");
  if (report.textures != 0) words += ", " + words_of_count(report.textures, "texture");
  if (triangles) words += ", " + words_of_count(*triangles, "triangle");
  if (!mesh.surface.triangle_normals.empty()) words += ", normals";
  if (!mesh.surface.triangle_colors.empty()) words += ", colours";
  if (const std::string frame = words_of_frame(report); !frame.empty()) words += "; " + frame;
  if (!report.reader.empty()) words += "; read with " + report.reader;
  return words;
}

SceneKind foreseen_kind(const std::filesystem::path& path) {
  if (is_stream(path)) return SceneKind::kUnknown;
  try {
    const InputReader reader(path, kSceneExpected);
    return scene_kind_of(reader.head(), path, reader.file_bytes());
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::kBadInput) throw;
    return scene_kind_by_ending(path);
  }
}

KnownScene foreseen_scene(const SceneRequest& request) {
  const SceneKind kind = foreseen_kind(request.input);
  if (kind != SceneKind::kUnknown) require_tolerance(request.tolerance, kind);
  check_look(request.look, kind);
  // What a packed scene holds decides its configuration.
  if (kind == SceneKind::kPacked && request.configuration == nullptr) return {};
  return {kind, kind == SceneKind::kText || request.look.is_given()};
}

KnownScene known_scene(const SceneInput& input) {
  if (const PackedScene* packed = std::get_if<PackedScene>(&input.content)) {
    return {
        .kind = SceneKind::kPacked,
        .has_effects = packed->view.has_effects,
        .is_read = true,
        .has_tree = packed->view.has_tree,
        .has_projection = packed->view.grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kProjection)};
  }
  if (!input.text) return {.kind = SceneKind::kMesh, .has_effects = input.effects.has_value(), .is_read = true};
  const SceneView& view = input.text->view;
  return {.kind = SceneKind::kText,
          .has_effects = true,
          .is_read = true,
          .size = view.is_given() ? std::optional(CountPair{view.width, view.height}) : std::nullopt};
}

void require_renderable(const SceneInput& input) {
  const Mesh* const mesh = std::get_if<Mesh>(&input.content);
  if (mesh == nullptr) return;
  GridNeed need{};
  const Status status = count_scene_image(mesh->view(), {.lambda = 1e-6f}, need);
  if (status != Status::kOk) input_error(input.path, words_of(status));
}

std::uint32_t recursion_depth(const SceneInput& input) {
  if (input.effects) return input.effects->recursion_depth;
  const PackedScene* packed = std::get_if<PackedScene>(&input.content);
  return packed != nullptr && packed->view.has_effects ? packed->view.effects.recursion_depth : 1;
}

PictureRequest complete_request(PictureRequest request, const SceneView& own) {
  if (!request.camera) request.camera = view_of(own);
  if (!request.size) request.size = own.is_given() ? CountPair{own.width, own.height} : kUsualPictureSize;
  return request;
}

SceneInput read_scene_input(const std::filesystem::path& path, std::optional<float> tolerance,
                            const std::optional<PictureRequest>& picture, const char* expected,
                            const ImportOptions& model_options) {
  const Stopwatch stopwatch;
  const Stage stage(path, "reading");
  SceneInput input{.path = path, .content = Mesh{}};
  InputReader reader(path, expected);
  const SceneKind kind = scene_kind_of(reader.head(), path, reader.file_bytes());
  if (kind == SceneKind::kUnknown) reader.refuse_content();
  const std::string ending = model_ending(reader.head(), path, reader.file_bytes());
  require_tolerance(tolerance, kind);
  InputFile file = reader.read_all(kind == SceneKind::kText ? kMostSceneBytes : kAnySize);
  name_in_shortage(path, "read it", [&] {
    if (!ending.empty()) {
      read_model(std::move(file), {.path = path, .ending = ending, .options = model_options}, input);
    } else if (kind == SceneKind::kMesh) {
      input.content = read_ply_mesh(file.bytes, path);
      input.model.emplace();
      input.model->format = "PLY";
      input.model->meshes = 1;
      const std::uint64_t lines = count_ply_lines(file.bytes);
      if (lines != 0) input.model->ignored.push_back(words_of_count(lines, "line"));
    } else if (kind == SceneKind::kPacked) {
      input.content = open_packed_scene(std::move(file), path);
    } else {
      read_text_scene(file, path, tolerance, picture, input);
    }
  });
  input.load_seconds = stopwatch.both();
  return input;
}

void tell_notes(const SceneInput& input, bool tells_model) {
  if (input.model && tells_model) tell_model(input);
  if (input.colorless_triangles != 0) {
    std::fprintf(stderr, "%s: the own colours of %s are left out: a look has %s materials at most\n",
                 input.path.c_str(), words_of_count(input.colorless_triangles, "triangle").c_str(),
                 words_of_count(kMostSceneMaterials).c_str());
  }
  for (const std::string& note : input.look_notes) {
    std::fprintf(stderr, "%s: note: %s\n", input.path.c_str(), note.c_str());
  }
  if (!input.text) return;
  for (const SceneNote& note : input.text->notes) {
    std::fprintf(stderr, "%s:%llu: note: %s\n", input.path.c_str(), static_cast<unsigned long long>(note.line),
                 note.text.c_str());
  }
  const std::uint64_t more = input.text->note_count - input.text->notes.size();
  if (more != 0) std::fprintf(stderr, "%s: %s\n", input.path.c_str(), words_of_count(more, "more note").c_str());
  if (input.text->roundness.rule != ToleranceRule::kPicture) return;
  const SceneRoundness& roundness = input.text->roundness;
  std::fprintf(stderr,
               "%s: tolerance of round shapes chosen by the picture: %s, %s; %s for all objects would make about %s; "
               "--tolerance sets another\n",
               input.path.c_str(), words_of_tolerance(roundness).c_str(),
               words_of_count(std::get<Mesh>(input.content).triangles.size(), "triangle").c_str(),
               text_of(roundness.diagonal_tolerance).c_str(),
               words_of_count(two_digits(roundness.diagonal_triangles)).c_str());
}

std::string words_of_tolerance(const SceneRoundness& roundness) {
  const std::string least = text_of(roundness.least_tolerance), most = text_of(roundness.most_tolerance);
  return least == most ? least : least + " to " + most;
}

std::uint64_t spill_bytes_of(std::uint32_t core_count, std::uint32_t recursion_depth) {
  const std::uint64_t bytes = spill_bytes(recursion_depth) * core_count;
  return bytes == 0 ? 0 : bytes + kSpillAlignment;
}

std::uint64_t image_budget_bytes(const sim::MachineProfile& machine, std::uint32_t width, std::uint32_t height,
                                 std::uint32_t planes, std::uint32_t tile_width, std::uint64_t spill_bytes) {
  constexpr std::uint32_t kUsualSize = 1024, kMostPlanes = 3;  // a multiple of every tile's width
  const std::uint64_t frame_bytes = round_up<std::uint64_t>(sizeof(FrameRecord), kLineBytes);
  const std::uint64_t wanted = output_plane_bytes(width, height, tile_width) * planes + frame_bytes;
  const std::uint64_t usual = output_plane_bytes(kUsualSize, kUsualSize, tile_width) * kMostPlanes + frame_bytes;
  if (spill_bytes >= machine.main_memory_bytes - sim::SimMemory::kFirstAddress) {
    throw Failure(ExitCode::kBadInput, "rays that wait need " + words_of_bytes(spill_bytes) + " of main memory; " +
                                           std::string(machine.name) + " has " +
                                           words_of_bytes(machine.main_memory_bytes));
  }
  const std::uint64_t memory = machine.main_memory_bytes - sim::SimMemory::kFirstAddress - spill_bytes;
  if (wanted > memory) {
    // In bytes: the simulator keeps the first few, and the picture may be too large by just these.
    throw Failure(ExitCode::kBadInput, "a whole frame of " + std::to_string(width) + "x" + std::to_string(height) +
                                           " needs " + words_of_count(wanted) + " bytes of main memory; " +
                                           std::string(machine.name) + " has " + words_of_count(memory) + " for it");
  }
  return memory - std::max(wanted, std::min(usual, memory / 2));
}

GridChoice choose_grid(const SceneInput& input, const Mesh& mesh, const SceneRequest& request,
                       const ImageLimits& limits, const EffectsView* effects, const WorkSharing& sharing) {
  GridChoice choice;
  const Configuration& configuration = *request.configuration;
  choice.wanted_lambda = request.lambda.value_or(configuration.lambda);
  choice.parameters.lambda = choice.wanted_lambda;
  choice.parameters.macro_width =
      request.macro_width.value_or(std::min(configuration.macro_width, limits.most_macro_width));
  choice.parameters.format = limits.format;
  choice.parameters.has_tree = limits.engine == EngineId::kTree;
  choice.parameters.has_grid = limits.engine != EngineId::kTree;
  choice.parameters.leaf_triangles = limits.leaf_triangles;
  choice.budget_bytes = limits.budget_bytes;
  constexpr std::size_t kMarks = std::size_t{1} << 21;  // words: one sweep over the triangles for most scenes
  const std::unique_ptr<std::uint64_t[]> storage(new (std::nothrow) std::uint64_t[kMarks]);
  const std::span<std::uint64_t> marks(storage.get(), storage != nullptr ? kMarks : 0);
  // The size of an image that does not fit is counted too, within a limit of time.
  constexpr std::uint64_t kCountedBytes = std::uint64_t{8} << 30;
  const std::uint64_t most_bytes = std::max(limits.budget_bytes, kCountedBytes);
  const Status status = [&] {
    const Stage stage(input.path, choice.parameters.has_grid ? "choosing its grid" : "counting its triangles");
    return request.lambda
               ? count_scene_image(mesh.view(), choice.parameters, choice.need, effects, most_bytes, marks, sharing)
               : fit_scene_image(mesh.view(), choice.parameters, limits.budget_bytes, choice.need, effects, marks,
                                 sharing);
  }();
  if (status == Status::kMemoryTooSmall) {
    input_error(input.path, "the scene needs more than " + words_of_bytes(choice.need.image_bytes) + " at lambda " +
                                text_of(choice.wanted_lambda) + "; " +
                                words_of_budget(*request.machine, limits.budget_bytes) +
                                (configuration.has_grid() ? "; a smaller --lambda needs less" : "") +
                                (input.text ? "; a greater --tolerance makes fewer triangles" : ""));
  }
  if (status == Status::kTooManyTriangles) {
    const float lambda = request.lambda ? choice.wanted_lambda : kLeastLambda;
    input_error(input.path, std::string(words_of(status)) + words_of_lambda(choice.parameters, lambda) +
                                (request.lambda ? "; a smaller --lambda needs fewer" : "") +
                                (input.text ? "; a greater --tolerance makes fewer triangles" : ""));
  }
  if (status == Status::kNoTriangles) {
    input_error(input.path, mesh.triangles.empty() ? "no triangles: " + words_without_triangles(input, mesh)
                                                   : "no triangle to trace: all " +
                                                         words_of_count(mesh.triangles.size()) + " have zero area");
  }
  if (status != Status::kOk) input_error(input.path, std::string("cannot build the scene image: ") + words_of(status));
  if (choice.parameters.has_grid) choice.parameters.lambda = choice.need.grid.lambda;
  return choice;
}

void require_fit(const GridChoice& choice, const SceneRequest& request, const SceneInput& input) {
  if (!choice.fits()) {
    input_error(request.input, "the scene needs " + words_of_bytes(choice.need.image_bytes) +
                                   words_of_lambda(choice.parameters, choice.parameters.lambda) + "; " +
                                   words_of_budget(*request.machine, choice.budget_bytes) +
                                   words_of_fitting_tolerance(choice, input));
  }
  if (!choice.is_reduced() || request.quiet) return;
  std::fprintf(stderr, "%s: lambda reduced from %g to %g so that the scene fits the main memory of %s\n",
               request.input.c_str(), static_cast<double>(choice.wanted_lambda),
               static_cast<double>(choice.parameters.lambda), std::string(request.machine->name).c_str());
}

SceneImageView build_image(const SceneInput& input, const Mesh& mesh, const GridChoice& choice,
                           std::span<std::byte> image, const EffectsView* effects, const WorkSharing& sharing) {
  stop_if_interrupted();
  const Stage stage(input.path, "building its scene image");
  std::vector<std::uint64_t> scratch = name_in_shortage(input.path, "build its scene image", [&] {
    return std::vector<std::uint64_t>((choice.need.scratch_bytes + 7) / 8);
  });
  const Status status = build_scene_image(mesh.view(), choice.parameters, choice.need, image,
                                          std::as_writable_bytes(std::span(scratch)), effects, sharing);
  if (status != Status::kOk) input_error(input.path, std::string("cannot build the scene image: ") + words_of(status));
  SceneImageView view{};
  SceneImageError error;
  if (open_scene_image(image, view, error, sharing) != Status::kOk) {
    throw Failure(ExitCode::kCheckFailed, input.path.string() + ": the built image is not valid: field " + error.field +
                                              " at byte " + std::to_string(error.byte_offset));
  }
  return view;
}

// "--accuracy compact": the profiles that read a format.
std::string readers_of(TriangleFormat format) {
  std::string names;
  for (const NamedAccuracy& accuracy : accuracies()) {
    if (format_of(accuracy.accuracy) == format)
      names += (names.empty() ? "--accuracy " : ", ") + std::string(accuracy.name);
  }
  return names;
}

void require_format(const SceneInput& input, const PackedScene& packed, TriangleFormat format) {
  const std::uint32_t stored = packed.view.grid.triangle_format;
  if (stored == static_cast<std::uint32_t>(format)) return;
  input_error(input.path, "was packed with --format " + word_of(static_cast<TriangleFormat>(stored)) + ", which " +
                              readers_of(static_cast<TriangleFormat>(stored)) + " read; this needs --format " +
                              word_of(format));
}

void check_packed(const SceneInput& input, const PackedScene& packed, const SceneRequest& request,
                  const ImageLimits& limits) {
  require_format(input, packed, limits.format);
  require_engine(input, packed, request, limits.engine);
  if (limits.engine == EngineId::kTree && packed.view.tree.leaf_triangles > limits.leaf_triangles) {
    input_error(input.path, "was packed with leaves of " + std::to_string(packed.view.tree.leaf_triangles) +
                                " triangles for a larger local store; this one holds leaves of " +
                                std::to_string(limits.leaf_triangles) +
                                "; a scene packed with --machine of a chip with such stores is read by both");
  }
  if (limits.engine != EngineId::kTree) require_grid(input, packed.view.grid, request, limits);
  if (packed.view.header.image_bytes > limits.budget_bytes) {
    input_error(input.path, "the scene needs " + words_of_bytes(packed.view.header.image_bytes) + "; " +
                                words_of_budget(*request.machine, limits.budget_bytes));
  }
}

}  // namespace gridiron::tool
