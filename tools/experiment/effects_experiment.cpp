// The effects experiment. SPDX-License-Identifier: Apache-2.0
#include <report/report.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/words.h"
#include "experiment/book.h"
#include "experiment/effect_frames.h"
#include "experiment/effect_scenes.h"
#include "experiment/effect_sizes.h"
#include "experiment/experiments.h"
#include "experiment/result_bytes.h"
#include "experiment/table.h"
#include "experiment/workers.h"
#include "files/image_files.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/scene/effect_names.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

constexpr float kLambda = 4;
constexpr float kLambdas[] = {0.4f, 2, 4, 8, 16};

// A scene with all of its effects, or without one.
struct Variant {
  std::string key;    ///< "all", "without_reflection"
  std::string title;  ///< "all effects", "without reflection"
  std::string label;  ///< shown under a bar, below "without"
  EffectScene scene;
  std::uint32_t expected = 0;   ///< EffectBits that it must call for
  EffectFrame single, twofold;  ///< single and double buffering
};

struct SceneFrames {
  std::vector<Variant> variants;     ///< all effects first
  EffectFrame deep;                  ///< all effects, as many buffers as the configuration has
  std::vector<EffectFrame> lambdas;  ///< all effects, double buffering, by kLambdas

  [[nodiscard]] const Variant& whole() const { return variants.front(); }
  [[nodiscard]] const std::string& key() const { return whole().scene.key; }
};

std::string spaced(std::string_view name) {
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string key_without(std::string_view effect) {
  return "without_" + std::string(effect);
}

std::string picture_name(const std::string& scene, const std::string& variant) {
  return "picture_" + scene + "_" + variant;
}

SceneFrames list_frames(std::string_view key) {
  SceneFrames frames;
  EffectScene scene = make_effect_scene(key);
  const std::uint32_t called = called_for(scene);
  frames.variants.push_back({"all", "all effects", "nothing", scene, called, {}, {}});
  for (const EffectName& effect : tool::effects()) {
    if (effect.bit == kSceneShading || (called & effect.bit) == 0) continue;
    frames.variants.push_back({key_without(effect.name),
                               "without " + spaced(effect.name),
                               effect.label,
                               without_effect(scene, effect.bit),
                               left_without(called, effect.bit),
                               {},
                               {}});
  }
  frames.lambdas.resize(std::size(kLambdas));
  return frames;
}

struct EffectStep {
  const EffectScene* scene;
  EffectFrameRequest request;
  EffectFrame* frame;
  std::string name;        ///< of the frame, for people
  std::uint32_t expected;  ///< EffectBits
};

std::vector<EffectStep> list_steps(std::vector<SceneFrames>& scenes, const ExperimentSettings& settings) {
  std::vector<EffectStep> steps;
  EffectFrameRequest request{.width = settings.width, .height = settings.height, .lambda = kLambda};
  for (SceneFrames& frames : scenes) {
    const auto add = [&](const Variant& variant, EffectFrame& frame) {
      steps.push_back({&variant.scene, request, &frame, variant.scene.key + ", " + variant.title, variant.expected});
    };
    for (Variant& variant : frames.variants) {
      request.depths = tool::kSingleBuffering;
      add(variant, variant.single);
      request.depths = tool::kDoubleBuffering;
      add(variant, variant.twofold);
    }
    for (std::size_t i = 0; i < std::size(kLambdas); ++i) {
      if (kLambdas[i] == kLambda) continue;
      request.lambda = kLambdas[i];
      add(frames.whole(), frames.lambdas[i]);
    }
    request.lambda = kLambda;
    request.depths = tool::find_configuration("grid")->depths;
    add(frames.whole(), frames.deep);
  }
  return steps;
}

double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : 0.0;
}

const EffectFrame& frame_of(const SceneFrames& scene, std::size_t lambda) {
  return kLambdas[lambda] == kLambda ? scene.whole().twofold : scene.lambdas[lambda];
}

void write_scenes(const std::vector<SceneFrames>& scenes, Book& book) {
  book.section("scenes", "The scenes");
  book.paragraph(
      "Each scene is shown with all the effects that it calls for, and then without one of them at a time. An effect "
      "is switched off in the scene, not in the kernel: shadows are off for all lights, an area light becomes a point "
      "in its middle, reflection ends with a depth of recursion of 1 (and refraction with it, for glass reflects), "
      "glass lets nothing through, normals are the triangles' own, highlights have no exponent, the background is in "
      "place of the sky, a pixel has one sample. What a row of pictures does not show, the scene does not call for.");
  for (const SceneFrames& scene : scenes) {
    const EffectScene& whole = scene.whole().scene;
    book.paragraph(scene.key() + ": " + whole.words + "; " +
                   tool::words_of_count(whole.description.geometry.triangles.size()) + " triangles.");
    std::vector<BookPicture> row;
    for (const Variant& variant : scene.variants) {
      const std::vector<std::byte> png = tool::encode_png(variant.twofold.picture);
      row.push_back({picture_name(scene.key(), variant.key),
                     std::string(reinterpret_cast<const char*>(png.data()), png.size()), variant.title});
    }
    book.pictures(std::move(row));
  }
}

void write_costs(const std::vector<SceneFrames>& scenes, Book& book) {
  Table table =
      make_table("effects", "scene", "variant", Column("effects", "effects called for"),
                 Column("primary_rays", "eye rays"), "shadow_rays", "occlusion_rays", "reflected_rays",
                 "refracted_rays", Column("environment_lookups", "sky lookups"), Column("cycles", "cycles", 0),
                 Column("fps", "frames/s"), Column("cycles_of_all_percent", "% of all effects' cycles", 1),
                 Column("dma_wait_cycles", "cycles waiting for DMA", 0), Column("dma_wait_percent", "% waiting"));
  for (const SceneFrames& scene : scenes) {
    for (const Variant& variant : scene.variants) {
      const EffectFrame& frame = variant.twofold;
      table.add({scene.key(), variant.key, tool::words_of_effects(frame.called_for), frame.primary_rays(),
                 frame.count(Work::kShadowRay), frame.count(Work::kOcclusionRay), frame.count(Work::kMirrorRay),
                 frame.count(Work::kRefractedRay), frame.count(Work::kEnvironmentLookup), frame.cycles,
                 1 / frame.seconds, percent(frame.cycles, scene.whole().twofold.cycles), frame.wait_cycles(),
                 percent(frame.wait_cycles(), frame.core_cycles)});
    }
  }
  book.section("costs", "What effects cost");
  book.paragraph(
      "Rays by kind and the time of the frame, with double buffering. What a scene gains without an effect is what the "
      "effect costs there; effects share work, so that costs do not add up: without multisampling all other effects "
      "have a quarter of the rays, without reflection there are fewer points to be lit. Cycles that wait are summed "
      "over the six cores, and the share is that of all cycles that the cores have.");
  book.table(table, "Rays and time of each frame.");
}

void write_stages(const std::vector<SceneFrames>& scenes, Book& book) {
  Table table = make_table("stages", "scene", "variant", "stage", Column("compute_cycles", "computing", 0),
                           Column("wait_cycles_single", "waiting, single buffering", 0),
                           Column("wait_cycles_double", "waiting, double buffering", 0), "bytes_in", "bytes_out");
  book.section("stages", "Where the cycles go");
  book.paragraph(
      "A core is in one stage at a time: primary is eye rays and the set-up of tiles, surface finds points, normals "
      "and materials of what was hit, shadow lights them, occlusion sends rays about them, bounce traces what they "
      "reflect and refract, environment looks up the sky, output makes pixels of sums. Plots show cycles of all cores "
      "together, waits included, with double buffering.");
  for (const SceneFrames& scene : scenes) {
    BarChart chart{"Cycles by stage: " + scene.key(), "million cycles of all cores", {}, {"without"}, {}, {}, false};
    for (std::size_t i = 0; i < kStageCount; ++i) {
      chart.parts.emplace_back(tool::stage_name(static_cast<Stage>(i)));
    }
    for (const Variant& variant : scene.variants) {
      chart.groups.push_back(variant.label);
      for (std::size_t i = 0; i < kStageCount; ++i) {
        const sim::StageTiming& single = variant.single.stages[i];
        const sim::StageTiming& stage = variant.twofold.stages[i];
        chart.values.push_back((stage.compute_cycles + stage.wait_cycles) / 1e6);
        table.add({scene.key(), variant.key, std::string(tool::stage_name(static_cast<Stage>(i))), stage.compute_cycles,
                   single.wait_cycles, stage.wait_cycles, stage.bytes_in, stage.bytes_out});
      }
    }
    book.figure("stages_" + scene.key(), bar_chart_svg(chart),
                "Scene " + scene.key() + ": each bar is a frame, with all effects and without one at a time.");
  }
  book.linked_table(table, "cycles that compute and wait and bytes moved, by stage of every frame");
}

void write_hiding(const std::vector<SceneFrames>& scenes, Book& book) {
  Table table =
      make_table("hiding", "scene", Column("single_wait_cycles", "waiting, single buffering", 0),
                 Column("double_wait_cycles", "waiting, double buffering", 0), Column("hidden_percent", "% gone"),
                 Column("grid_wait_cycles", "waiting, the configuration's buffers", 0),
                 Column("grid_hidden_percent", "% gone"), Column("single_fps", "frames/s, single"),
                 Column("double_fps", "double"), Column("grid_fps", "the configuration's"));
  BarChart chart{.title = "Waits for secondary rays",
                 .y_title = "million cycles of all cores",
                 .bars = {"buffering"},
                 .parts = {"waiting that is left", "waiting hidden by double buffering"}};
  double least = 1, most_left = 0;
  for (const SceneFrames& scene : scenes) {
    const EffectFrame& single = scene.whole().single;
    const EffectFrame& twofold = scene.whole().twofold;
    const double before = single.secondary_wait_cycles(), after = twofold.secondary_wait_cycles();
    least = std::min(least, hidden_share(single, twofold));
    most_left = std::max(most_left, secondary_wait_share(twofold));
    table.add({scene.key(), before, after, 100 * hidden_share(single, twofold), scene.deep.secondary_wait_cycles(),
               100 * hidden_share(single, scene.deep), 1 / single.seconds, 1 / twofold.seconds,
               1 / scene.deep.seconds});
    chart.groups.push_back(scene.key());
    chart.values.push_back(after / 1e6);
    chart.values.push_back(std::max(before - after, 0.0) / 1e6);
  }
  book.section("hiding", "Waits hidden");
  book.paragraph(
      "Secondary rays go where they like, and so do the nodes, leaves, materials and texels that they ask for. With "
      "single buffering a core asks for a child of a node or a record, waits, and uses it; with double buffering two "
      "are under way, and the core computes with one while the other comes. Counted are the waits of all cores in the "
      "stages surface, shadow, occlusion, bounce and environment, all effects on. The run ends with an error where "
      "less than " +
      fixed_text(100 * kLeastHiddenShare, 0) + " % of them go; the least here is " + fixed_text(100 * least, 1) +
      " %. It does so too where the rest is more than " + fixed_text(100 * kMostWaitShare, 1) +
      " % of the cores' time; the most here is " + fixed_text(100 * most_left, 1) +
      " %. The configuration itself has " + std::to_string(tool::find_configuration("grid")->depths.fetch) +
      " children or records under way.");
  book.figure("hiding", bar_chart_svg(chart), "A bar is all waiting for secondary rays with single buffering.");
  book.table(table, "Waiting in the stages of secondary rays, all effects on.");
}

void write_off(const std::vector<SceneFrames>& scenes, Book& book) {
  Table table = make_table("off", "scene", "variant", Column("effect", "effect that is off"), Column("what", "counted"),
                           "count", "stage", Column("bytes", "bytes moved in it"), Column("cycles", "cycles in it", 0));
  std::uint32_t on = 0, off = 0;
  for (const SceneFrames& scene : scenes) {
    for (const Variant& variant : scene.variants) {
      on |= variant.twofold.called_for;
      off |= kAllEffects & ~variant.twofold.called_for;
      for (const AbsentCost& cost : absent_costs(variant.twofold)) {
        const bool has_stage = !cost.stages.empty();
        table.add({scene.key(), variant.key, tool::words_of_effects(cost.effect), std::string(cost.what), cost.count,
                   std::string(cost.stages), has_stage ? Cell(cost.bytes) : Cell(),
                   has_stage ? Cell(cost.cycles) : Cell()});
      }
    }
  }
  book.section("off", "What an effect costs that is off");
  book.paragraph(
      "Nothing: 0 rays, 0 bytes and 0 cycles in the stages that are its own. All frames of this page are held to that "
      "while they are made, with single and double buffering, and the run ends with an error and without files where "
      "one is not. Effects without a stage of their own are held to a count: refracted rays, interpolated normals, "
      "highlights, eye rays beyond one a pixel, lights taken more than once a point. Light of points without shadows "
      "stays in stage shadow as computation; of shadows that are off it has no ray, no byte and no wait. Somewhere "
      "here are on: " +
      tool::words_of_effects(on) + "; and somewhere off: " + tool::words_of_effects(off) + ".");
  book.linked_table(table, tool::words_of_count(table.rows.size()) + " effects that were off in some frame, all 0");
}

void write_lambdas(const std::vector<SceneFrames>& scenes, Book& book) {
  Table table = make_table("lambda", "scene", Column("lambda", "cells per triangle", 1), Column("cycles", "cycles", 0),
                           Column("fps", "frames/s"), Column("scene_bytes", "bytes of the scene in main memory"));
  BarChart chart{"Grids for eye rays", "frames/s", {}, {}, {"frames/s"}, {}, true};
  for (const float lambda : kLambdas) chart.bars.push_back("lambda " + number_text(lambda));
  std::string fastest;
  for (const SceneFrames& scene : scenes) {
    chart.groups.push_back(scene.key());
    std::size_t best = 0;
    for (std::size_t i = 0; i < std::size(kLambdas); ++i) {
      const EffectFrame& frame = frame_of(scene, i);
      if (frame.cycles < frame_of(scene, best).cycles) best = i;
      table.add({scene.key(), std::stod(number_text(kLambdas[i])), frame.cycles, 1 / frame.seconds, frame.scene_bytes});
      chart.values.push_back(1 / frame.seconds);
    }
    fastest += (fastest.empty() ? "" : ", ") + scene.key() + " with " + number_text(kLambdas[best]);
  }
  book.section("lambda", "How fine a grid");
  book.paragraph(
      "Configuration grid has a coarse grid of " + number_text(tool::find_configuration("grid")->lambda) +
      " cells per triangle, which suits packets of eye rays that share what they fetch. Secondary rays go through a "
      "tree and do not use the grid. A finer one has fewer triangles a cell, but more cells and references. "
      "All other frames of this page have " +
      number_text(kLambda) + " cells per triangle. Fastest of those tried is " + fastest +
      ". All effects are on, with double buffering.");
  book.figure("lambda", bar_chart_svg(chart), "Frames a second by cells per triangle.");
  book.table(table, "Frames by the grid's cells per triangle.");
}

void write_sizes(Book& book) {
  book.section("sizes", "Room in the local store");
  book.paragraph(
      "The kernel of a set of effects is compiled without the code and the data of all others. The simulated chip has "
      "the one with all effects, whose code and stack have budgets:");
  const tool::StoreFacts facts =
      tool::effect_store_facts(sim::StoreSize::k256KB, tool::find_configuration("grid")->packet_width);
  Table map = make_table("", "region", "offset", "bytes");
  for (const tool::LocalStoreRegion& region : facts.regions) {
    map.add({region.name, region.offset_bytes, region.bytes});
  }
  map.add({"stack", Cell{}, facts.stack_bytes});
  map.add({"code", Cell{}, facts.code_bytes});
  book.shown_table(map, "The local store of 256 KB with all effects.");
  if (kEffectSizes.empty()) return;
  Table table =
      make_table("sizes", "effects", Column("code_bytes_256k", "code bytes, 256 KB"),
                 Column("store_bytes_256k", "data bytes, 256 KB"), Column("code_bytes_64k", "code bytes, 64 KB"),
                 Column("store_bytes_64k", "data bytes, 64 KB"), Column("fits_64k", "64 KB hold it"));
  for (const EffectSize& size : kEffectSizes) {
    table.add({tool::words_of_effects(size.effects), size.code_bytes_256k, size.store_bytes_256k, size.code_bytes_64k,
               size.store_bytes_64k, size.fits_64k ? "yes" : "no"});
  }
  book.table(table, "Code and data of a core by the set of effects that it is built for, in stores of two sizes.");
}

void write_method(const ExperimentSettings& settings, Book& book) {
  book.section("method", "How it is measured");
  book.paragraph(
      "All scenes are made in process, without files. Frames of " + std::to_string(settings.width) + "x" +
      std::to_string(settings.height) +
      " pixels are rendered by the kernel's real code in checked mode with four lanes, accuracy standard, "
      "configuration grid with " +
      number_text(kLambda) +
      " cells per triangle, and their traces get a time on six cores of cell-ps3. Single buffering is one buffer of "
      "each kind and one child of a node at a time, double buffering two of each. Rays are counted where they "
      "are made, bytes as gets and puts ask for them.");
}

}  // namespace

std::vector<std::string> effects_file_names() {
  std::vector<std::string> names = {"effects.csv", "hiding.csv", "hiding.svg", "index.html", "lambda.csv",
                                    "lambda.svg",  "off.csv",    "sizes.csv",  "stages.csv"};
  for (const std::string_view key : kEffectSceneKeys) {
    const std::string scene(key);
    names.push_back("stages_" + scene + ".svg");
    names.push_back(picture_name(scene, "all") + ".png");
    for (const EffectName& effect : tool::effects()) {
      if (effect.bit != kSceneShading) names.push_back(picture_name(scene, key_without(effect.name)) + ".png");
    }
  }
  return names;
}

ExperimentResult run_effects_experiment(const ExperimentSettings& settings, const ProgressCall& progress) {
  std::vector<SceneFrames> scenes;
  for (const std::string_view key : kEffectSceneKeys) scenes.push_back(list_frames(key));
  std::vector<EffectStep> steps = list_steps(scenes, settings);
  std::mutex mutex;
  std::uint32_t done = 0;
  const auto step_done = [&] { progress(++done, static_cast<std::uint32_t>(steps.size())); };
  const auto render = [&](std::size_t i) {
    const EffectStep& step = steps[i];
    *step.frame = render_effect_frame(*step.scene, step.request);
    check_absent_costs(*step.frame, step.expected, step.name);
    const std::lock_guard lock(mutex);
    step_done();
  };
  const auto pack = [&](std::size_t i) { return bytes_of_frame(*steps[i].frame); };
  const auto unpack = [&](std::size_t i, const tool::Bytes& bytes) {
    take_frame(bytes, *steps[i].frame);
    step_done();
  };
  share_work(settings.threads, steps.size(), render, {pack, unpack});
  if (!tool::ranks().is_first()) return {};
  for (const SceneFrames& scene : scenes) {
    check_hiding(scene.whole().single, scene.whole().twofold, scene.key());
  }

  Book book("What effects cost",
            "Every figure below comes from one run of `gridiron experiment effects`: " +
                tool::words_of_count(scenes.size(), "scene") + ", " + std::to_string(settings.width) + "x" +
                std::to_string(settings.height) +
                " pixels, with all of their effects and without each of them, rendered by the kernel's real code on "
                "the simulated chip cell-ps3 with six cores.");
  write_scenes(scenes, book);
  write_costs(scenes, book);
  write_off(scenes, book);
  write_stages(scenes, book);
  write_hiding(scenes, book);
  write_lambdas(scenes, book);
  write_sizes(book);
  write_method(settings, book);
  return {book.finish(), steps.size(), steps.size(), {}};
}

}  // namespace gridiron::experiment
