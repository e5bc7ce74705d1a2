// The accuracy experiment. SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "base/ranks.h"
#include "base/words.h"
#include "experiment/experiments.h"
#include "experiment/price_book.h"
#include "experiment/price_list.h"
#include "experiment/secondary_book.h"
#include "experiment/secondary_prices.h"
#include "experiment/sections.h"

namespace gridiron::experiment {
namespace {

// What a reader must know to trust the figures, and their limits.
void write_method(const PriceList& list, Book& book) {
  std::size_t compared = 0, alike = 0;
  for (const Price& price : list.prices()) {
    compared += price.errors ? 1u : 0u;
    alike += price.errors && price.same_picture ? 1u : 0u;
  }
  book.section("method", "How it is measured");
  book.paragraph(
      "Truth is exact arithmetic on the mesh as it was read. Profile exact gives it: tests/numeric and tests/image "
      "hold its triangles and distances against integers and rational numbers. So its frame, with distances, in "
      "configuration grid is the reference for all others; whatever a profile does to the mesh is an error of the "
      "profile. All profiles of a view see it through the same camera, so a pixel is the same ray for all.");
  book.paragraph(
      "A ray that hits something in truth and nothing here is a hole, one that hits nothing in truth and something "
      "here a false hit; one that hits another triangle than in truth has a wrong triangle, even where the distance is "
      "the same float, and sees through what it should hit where that triangle is farther away by more than a "
      "thousandth: in a solid a leak shows the far side, not a hole. A picture's rays hardly ever meet an edge, so as "
      "many rays again are aimed at edges and, a quarter of them, at vertices of triangles that the picture shows: "
      "pictures of " +
      std::to_string(CloseLook::kWidth) + "x" + std::to_string(CloseLook::kWidth) +
      " pixels from the same eye, with distances, so small that all of their rays pass the point within a few "
      "roundings, "
      "through the same grid and the same code. A profile that moves vertices moves outlines and edges with them: what "
      "it misses there is its geometry's error, not a crack in it. The least share that can be told is one ray of a "
      "picture.");
  book.paragraph(
      "The plane of distances holds t times the length of the ray's direction, each rounded to a float; the length is "
      "the same for all profiles, so what differs is t. An ulp is a step from one float to the next in that plane. An "
      "error of 0 ulp means: the float that exact has there; as the product is rounded again, an error of t of one ulp "
      "may show as 0, 1 or 2. With distances requested, standard and exact round "
      "t correctly, and that is what they are timed for in frames with distances. Frames without distances estimate "
      "them (relative error 2^-14 at most) to choose triangles, and compute more where that leaves a choice open; they "
      "show the same triangles and give no t that could be wrong. Profile fast has floats for both, and paper too. So "
      "each frame is timed twice, and errors of t belong to the frames with distances. The pictures of " +
      tool::words_of_count(alike) + " of " + tool::words_of_count(compared) +
      " frames are the same with and without them.");
  book.paragraph(
      "Configuration grid culls by the vertices of triangles. The records of profile paper have none, so it runs grid "
      "without; its home is the reference configuration, and both are shown. Configuration best has no triangles for "
      "it, and is not shown where rays are aimed at edges: its tiles decide pixels that are so close together exactly, "
      "whatever the profile. All frames have simple shading, as gridiron render has by default, and six cores. Bytes "
      "moved by DMA are those requested by gets and puts of all "
      "cores; main memory holds scene image, frame record and picture. " +
      std::string(kCostTableWords));
  for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
    Range bytes;
    for (const Price& price : list.prices()) {
      if (price.configuration != configuration || list.frame(price).failed()) continue;
      bytes.add(static_cast<double>(list.frame(price).facts.local_store_bytes));
    }
    book.paragraph("Local store, configuration " + std::string(kPricedConfigurations[configuration]) + ": " +
                   bytes.text(0) + " bytes of data, stack and code in every profile" +
                   (bytes.least() == bytes.greatest() ? ", for one kernel serves them all." : "."));
  }
  for (const Price& price : list.prices()) {
    const RunResult& run = list.frame(price);
    if (!run.failed() || !price.is_possible()) continue;
    book.paragraph(list.views()[price.view].title + ", configuration " + kPricedConfigurations[price.configuration] +
                   ", profile " + list.profiles()[price.profile].key + " is left out: " + run.failure);
  }
}

}  // namespace

std::vector<std::string> accuracy_file_names() {
  std::vector<std::string> names = {"host_prices.csv", "index.html",  "overview.csv", "pareto.csv",
                                    "prices.csv",      "starved.csv", "targets.csv",  "t_histogram.csv"};
  for (std::string& name : secondary_file_names()) names.push_back(std::move(name));
  for (const char* front : {"pixels", "edges", "t"}) names.push_back("pareto_" + std::string(front) + ".svg");
  for (const std::string& view : known_view_keys()) {
    names.push_back(price_text_name(view));
    for (const char* configuration : kPricedConfigurations) {
      names.push_back("errors_" + std::string(configuration) + "_" + view + ".svg");
    }
    for (const char* front : {"pareto_pixels_", "pareto_edges_", "pareto_t_"}) names.push_back(front + view + ".svg");
  }
  return names;
}

ExperimentResult run_accuracy_experiment(const ExperimentSettings& settings, const ProgressCall& progress) {
  FoundViews found = find_views(settings.scenes);
  PriceList list(std::move(found.views), settings.width, settings.height);
  SecondaryPrices secondary(list.views().front(), settings.width, settings.height);
  const auto total = static_cast<std::uint32_t>(list.step_count() + secondary.step_count());
  std::uint32_t done = 0;
  const auto step_done = [&] { progress(++done, total); };
  list.collect(settings.threads, step_done);
  secondary.collect(settings.threads, step_done);
  if (!tool::ranks().is_first()) return {};

  const std::string size = std::to_string(settings.width) + "x" + std::to_string(settings.height);
  Book book(
      "What accuracy costs",
      "Every figure below comes from one run of `gridiron experiment accuracy`: pictures of " + size +
          " rendered by the kernel's real code on the simulated chip " + list.machine().key +
          " with six cores, in each of its accuracy profiles, and held pixel by pixel against the frame of profile "
          "exact in configuration grid, which the project's tests hold against integers. "
          "MB are 2^20 bytes, GB/s 10^9 bytes a second.");
  write_overview(list, book);
  write_targets(list, book);
  write_steps(list, book);
  write_fronts(list, book);
  write_starved(list, book);
  write_secondary_prices(secondary, book);
  write_views(list, book);
  write_method(list, book);
  write_host_prices(list, book);
  if (!found.missing.empty()) {
    book.section("missing", "Views left out");
    for (const std::string& sentence : found.missing) book.paragraph(sentence);
  }
  return {book.finish(), list.plan().rendered_count() + list.prices().size() + secondary.frame_count(),
          list.plan().run_count() + secondary.frame_count(), std::move(found.missing)};
}

}  // namespace gridiron::experiment
