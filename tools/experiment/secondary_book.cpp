// The sections on secondary rays. SPDX-License-Identifier: Apache-2.0
#include "experiment/secondary_book.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/words.h"
#include "experiment/sections.h"
#include "experiment/table.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

constexpr std::string_view kUsual = "standard";

double per_million(double count, std::uint64_t rays) {
  return rays == 0 ? 0.0 : 1e6 * count / static_cast<double>(rays);
}

// Cycles that all cores compute and wait.
double busy_cycles(const EffectFrame& frame) {
  double sum = 0;
  for (const sim::StageTiming& stage : frame.stages) sum += stage.compute_cycles + stage.wait_cycles;
  return sum;
}

struct Decision {
  const char* key;
  WorkId work;
  bool is_exact;  ///< in integers; else in double
};
constexpr Decision kDecisions[] = {{"exact_signs", Work::kExactSign, true},
                                   {"exact_distances", Work::kExactDistance, true},
                                   {"exact_orders", Work::kExactOrder, true},
                                   {"double_signs", Work::kDoubleSign, false},
                                   {"double_distances", Work::kRayDistance, false}};

// A kind of rays with a profile, over all scenes.
struct Sum {
  std::uint64_t rays = 0;
  double cycles = 0;      ///< that the rays take, of all cores
  double log_frames = 0;  ///< of the frames' cycles, over those of standard
  std::uint64_t exact = 0, doubles = 0;
  RayErrors errors, at_edges;
  std::uint64_t pixels = 0, differing_pixels = 0, square_sum = 0;
  std::uint32_t greatest_pixel_error = 0;

  [[nodiscard]] double cycles_per_ray() const { return rays == 0 ? 0.0 : cycles / static_cast<double>(rays); }
  [[nodiscard]] double differing_percent() const {
    return pixels == 0 ? 0.0 : 100 * static_cast<double>(differing_pixels) / static_cast<double>(pixels);
  }
  [[nodiscard]] double rms_error() const {
    return PictureErrors{pixels, differing_pixels, greatest_pixel_error, square_sum}.rms_error();
  }
};

double extra_cycles(const SecondaryPrices& prices, const SecondaryPrice& price) {
  return busy_cycles(price.frame) - busy_cycles(prices.without(price));
}

std::uint64_t extra_count(const SecondaryPrices& prices, const SecondaryPrice& price, WorkId work) {
  return price.frame.count(work) - prices.without(price).count(work);
}

Sum sum_of(const SecondaryPrices& prices, RayKind kind, std::size_t profile) {
  Sum sum;
  const std::size_t usual = prices.find_profile(kUsual);
  for (std::size_t scene = 0; scene < prices.scenes().size(); ++scene) {
    const SecondaryPrice& price = prices.price(scene, kind, profile);
    sum.rays += price.rays();
    sum.cycles += extra_cycles(prices, price);
    sum.log_frames += std::log(price.frame.cycles / prices.price(scene, kind, usual).frame.cycles);
    for (const Decision& decision : kDecisions) {
      (decision.is_exact ? sum.exact : sum.doubles) += extra_count(prices, price, decision.work);
    }
    sum.errors += price.errors;
    sum.at_edges += price.at_edges;
    sum.pixels += price.picture.pixels;
    sum.differing_pixels += price.picture.differing_pixels;
    sum.square_sum += price.picture.square_sum;
    sum.greatest_pixel_error = std::max(sum.greatest_pixel_error, price.picture.greatest_pixel_error);
  }
  return sum;
}

using Value = std::function<double(RayKind, std::size_t)>;

// Bars of all profiles for each kind of rays.
std::string chart_svg(const SecondaryPrices& prices, std::string title, std::string y_title, const Value& value) {
  BarChart chart{.title = std::move(title), .y_title = std::move(y_title), .parts = {"all"}};
  for (const NamedRayKind& kind : kRayKinds) chart.groups.emplace_back(kind.title);
  for (const Profile& profile : prices.profiles()) chart.bars.push_back(profile.key);
  for (const NamedRayKind& kind : kRayKinds) {
    for (std::size_t profile = 0; profile < prices.profiles().size(); ++profile) {
      chart.values.push_back(value(kind.kind, profile));
    }
  }
  return bar_chart_svg(chart);
}

// "fast 2.1 to 3.4, standard 0": the figures of a plot, by profile over all kinds.
std::string range_words(const SecondaryPrices& prices, const Value& value, int decimals) {
  std::string words;
  for (std::size_t profile = 0; profile < prices.profiles().size(); ++profile) {
    Range range;
    for (const NamedRayKind& kind : kRayKinds) range.add(value(kind.kind, profile));
    words += (words.empty() ? "" : ", ") + prices.profiles()[profile].key + " " +
             (range.greatest() == 0 ? "0" : range.text(decimals));
  }
  return words;
}

// Everything of every frame.
Table frames_table(const SecondaryPrices& prices) {
  Table table = make_table("secondary_frames", "scene", "rays_of", "profile", "rays", "cycles", "cycles_without",
                           "cycles_per_ray", "cycles_per_ray_over_standard");
  for (const Decision& decision : kDecisions) {
    table.columns.emplace_back((std::string(decision.key) + "_without").c_str());
    table.columns.emplace_back(decision.key);
    table.columns.emplace_back((std::string(decision.key) + "_per_million_rays").c_str());
  }
  for (const std::string where : {"", "edge_"}) {
    for (const char* name : {"rays_asked", "leaks", "self_hits", "false_hits", "wrong_triangles", "leaks_per_million",
                             "self_hits_per_million"}) {
      table.columns.emplace_back((where + name).c_str());
    }
  }
  for (const char* name :
       {"differing_pixels", "differing_percent", "greatest_pixel_error", "rms_pixel_error", "psnr_db"}) {
    table.columns.emplace_back(name);
  }
  const auto per_ray = [&](const SecondaryPrice& price) {
    return ratio_of(extra_cycles(prices, price), static_cast<double>(price.rays()));
  };
  for (const SecondaryPrice& price : prices.prices()) {
    const SecondaryPrice& usual = prices.price(price.scene, price.kind, prices.find_profile(kUsual));
    std::vector<Cell> row = {prices.scenes()[price.scene].key,
                             named(price.kind).title,
                             prices.profiles()[price.profile].key,
                             price.rays(),
                             price.frame.cycles,
                             prices.without(price).cycles,
                             per_ray(price),
                             ratio_of(per_ray(price), per_ray(usual))};
    for (const Decision& decision : kDecisions) {
      const std::uint64_t extra = extra_count(prices, price, decision.work);
      row.emplace_back(prices.without(price).count(decision.work));
      row.emplace_back(price.frame.count(decision.work));
      row.emplace_back(per_million(static_cast<double>(extra), price.rays()));
    }
    for (const RayErrors* errors : {&price.errors, &price.at_edges}) {
      const HitCounts& hits = errors->hits;
      row.emplace_back(hits.rays);
      row.emplace_back(hits.leaks());
      row.emplace_back(errors->self_hits);
      row.emplace_back(hits.false_hits);
      row.emplace_back(hits.wrong_triangles);
      row.emplace_back(hits.per_million(hits.leaks()));
      row.emplace_back(hits.per_million(errors->self_hits));
    }
    const PictureErrors& picture = price.picture;
    row.emplace_back(picture.differing_pixels);
    row.emplace_back(100 *
                     ratio_of(static_cast<double>(picture.differing_pixels), static_cast<double>(picture.pixels)));
    row.emplace_back(std::uint64_t{picture.greatest_pixel_error});
    row.emplace_back(picture.rms_error());
    row.emplace_back(picture.psnr_db());
    table.add(std::move(row));
  }
  return table;
}

Table solids_table(const SecondaryPrices& prices) {
  Table table = make_table(
      "secondary_solids", Column("rays_of", "rays of"), "profile", Column("enclosed_rays", "rays inside solids"),
      "leaks", Column("leaks_per_million", "a million", 1), Column("edge_rays", "rays inside, at edges"),
      Column("edge_leaks", "leaks"), Column("edge_leaks_per_million", "a million", 1),
      Column("edge_exact_per_million", "integers a million", 0), Column("open_rays", "rays off a convex body"),
      Column("self_hits", "self-hits"), Column("self_hits_per_million", "a million", 1));
  for (const SolidPrice& price : prices.solids()) {
    std::vector<Cell> row = {named(price.kind).title, prices.profiles()[price.profile].key};
    const auto add = [&row](const HitCounts& hits, std::uint64_t count) {
      row.emplace_back(hits.rays);
      row.emplace_back(count);
      row.emplace_back(hits.per_million(count));
    };
    add(price.enclosed, price.enclosed.leaks());
    add(price.at_edges, price.at_edges.leaks());
    row.emplace_back(price.at_edges.per_million(price.edge_integers));
    add(price.open, price.open.false_hits);
    table.add(std::move(row));
  }
  return table;
}

Table overview_table(const SecondaryPrices& prices) {
  Table table =
      make_table("secondary", Column("rays_of", "rays of"), "profile", Column("cycles_over_standard", "frame", 3),
                 Column("cycles_per_ray", "cycles", 0), Column("cycles_per_ray_over_standard", "times", 3),
                 Column("exact_per_million_rays", "integers", 0), Column("doubles_per_million_rays", "doubles", 0),
                 Column("leaks_per_million", "leak", 1), Column("edge_leaks_per_million", "edge leak", 0),
                 Column("self_hits_per_million", "self-hit", 1), Column("differing_percent", "pixels %", 2),
                 Column("greatest_pixel_error", "most"), Column("rms_pixel_error", "RMS", 2));
  const auto scenes = static_cast<double>(prices.scenes().size());
  for (const NamedRayKind& kind : kRayKinds) {
    const Sum usual = sum_of(prices, kind.kind, prices.find_profile(kUsual));
    for (std::size_t profile = 0; profile < prices.profiles().size(); ++profile) {
      const Sum sum = sum_of(prices, kind.kind, profile);
      const SolidPrice& solid = prices.solid(kind.kind, profile);
      const HitCounts& hits = sum.errors.hits;
      const HitCounts& at_edges = sum.at_edges.hits;
      table.add(
          {kind.title, prices.profiles()[profile].key, std::exp(sum.log_frames / scenes), sum.cycles_per_ray(),
           ratio_of(sum.cycles_per_ray(), usual.cycles_per_ray()),
           per_million(static_cast<double>(sum.exact), sum.rays),
           per_million(static_cast<double>(sum.doubles), sum.rays),
           per_million(static_cast<double>(hits.leaks() + solid.enclosed.leaks()), hits.rays + solid.enclosed.rays),
           per_million(static_cast<double>(at_edges.leaks() + solid.at_edges.leaks()),
                       at_edges.rays + solid.at_edges.rays),
           per_million(static_cast<double>(sum.errors.self_hits + solid.open.false_hits), hits.rays + solid.open.rays),
           sum.differing_percent(), std::uint64_t{sum.greatest_pixel_error}, sum.rms_error()});
    }
  }
  return table;
}

std::string joined_keys(const std::vector<Profile>& profiles) {
  std::string words;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    words += (i == 0 ? "" : i + 1 == profiles.size() ? " and " : ", ") + profiles[i].key;
  }
  return words;
}

}  // namespace

std::vector<std::string> secondary_file_names() {
  return {"secondary.csv",        "secondary.txt",       "secondary_frames.csv",    "secondary_solids.csv",
          "secondary_cycles.svg", "secondary_leaks.svg", "secondary_decisions.svg", "secondary_pixels.svg"};
}

void write_secondary_prices(const SecondaryPrices& prices, Book& book) {
  const Value cycles = [&](RayKind kind, std::size_t profile) {
    return sum_of(prices, kind, profile).cycles_per_ray();
  };
  const Value leaks = [&](RayKind kind, std::size_t profile) {
    const HitCounts& hits = prices.solid(kind, profile).at_edges;
    return hits.per_million(hits.leaks());
  };
  const Value integers = [&](RayKind kind, std::size_t profile) {
    const SolidPrice& solid = prices.solid(kind, profile);
    return ratio_of(static_cast<double>(solid.edge_integers), static_cast<double>(solid.at_edges.rays));
  };
  const Value pixels = [&](RayKind kind, std::size_t profile) {
    return sum_of(prices, kind, profile).differing_percent();
  };
  const auto figure = [&](const char* name, const char* title, const char* y_title, const Value& value, int decimals,
                          const std::string& words) {
    book.figure(name, chart_svg(prices, title, y_title, value),
                words + " Of all kinds: " + range_words(prices, value, decimals) + ".");
  };
  std::string scenes;
  for (const EffectScene& scene : prices.scenes()) scenes += (scenes.empty() ? "" : ", ") + scene.key;
  book.section("secondary", "Secondary rays");
  book.paragraph("Effects can be rendered with these profiles: " + joined_keys(prices.profiles()) +
                 ". They cannot with " + joined_keys(prices.refused()) +
                 ": its hits lie too far off their triangles for secondary rays to start there. The scenes are " +
                 scenes + ", " + std::to_string(prices.width()) + "x" + std::to_string(prices.height()) +
                 " pixels in configuration grid on six cores. Each scene is changed so that it casts one kind of "
                 "secondary rays and no other. Each point sends four rays to an area light, and four for ambient "
                 "occlusion. Refraction is glass, and includes the rays that glass reflects.");
  figure("secondary_cycles", "What a secondary ray costs", "cycles of a core a ray", cycles, 0,
         "Cycles of a core for a ray, all scenes together: what the frame takes beyond the same frame without these "
         "rays.");
  figure("secondary_leaks", "Leaks at edges", "leaks of a million rays at edges", leaks, 0,
         "Rays inside closed solids, aimed at edges and vertices, that hit nothing.");
  figure("secondary_decisions", "Decisions in integers at edges", "decisions of a ray at an edge", integers, 2,
         "Signs, distances and orders of distances that integers decide for these rays; of fast only edges where a hit "
         "may lie before the ray's beginning or behind its end. Other rays hardly ever need integers: the table below "
         "has their number.");
  figure("secondary_pixels", "Pixels that differ from exact", "% of all pixels", pixels, 2,
         "Pixels of another colour than in profile exact, all scenes together.");
  const Table overview = overview_table(prices);
  book.table(
      overview,
      "Over all scenes. frame: its cycles over those of standard (geometric mean). cycles: of a core for a ray; "
      "times: the same over standard. integers, doubles: decisions of a million rays. leak, edge leak, self-hit: "
      "of a million rays, of a million rays aimed at edges, of a million rays, in scenes and solids. pixels %: "
      "those that differ from exact; most and RMS: difference of a channel, of 255.");
  book.text("secondary.txt", aligned_text(overview), "the same as plain text.");
  book.linked_table(frames_table(prices), "every scene, kind of rays and profile with every figure.");

  std::uint64_t least_rays = ~0ull;
  for (const SolidPrice& price : prices.solids()) least_rays = std::min(least_rays, price.at_edges.rays);
  book.section("solids", "Secondary rays in closed solids");
  book.paragraph(
      "Exact arithmetic decides each ray correctly, but it cannot know whether a ray begins on the right side of its "
      "surface. So two solids are rendered whose rays have known answers, whatever a profile says. The first is a "
      "room: a ball, seen from inside, with a smaller ball in it and the lights outside. Every ray hits something "
      "there, and one that does not is a leak. The second is a ball alone, lit from behind the eye. No ray that leaves "
      "it hits anything, and one that does is a self-hit; a ray refracted into it must hit it from inside. Both solids "
      "stand at the origin and again a thousand radii away, where coordinates are coarser.");
  book.table(solids_table(prices),
             "Rays inside solids and those that leak; the same of rays aimed at edges, and what a million of these "
             "leave to integers; rays that leave a convex body, and those that hit it.");
  book.paragraph(
      "Rays are those of the kernel: its own code renders each frame with an engine that notes every ray and its "
      "answer. In the scenes an answer is compared with that of exact to the same ray, on the triangles as the profile "
      "stores them. Moved vertices are therefore an error of the picture, not of a ray. A ray leaks if it should hit "
      "something and hits nothing, or something farther away by more than a thousandth. It hits itself if the hit "
      "should not be there, or should be farther away, and lies within a thousandth of the scene's diagonal of the "
      "ray's origin. Each ray that hits a triangle gives a ray aimed at an edge of that triangle or, every fourth, at "
      "a vertex. Aimed rays are asked for their nearest hit through the kernel's lists of rays, without a frame. The "
      "least share that can be measured is one ray: in solids at most " +
      fixed_text(per_million(1, least_rays), 1) +
      " of a million rays at edges. Cycles of a ray are what all cores compute and wait beyond the same frame without "
      "secondary rays; they include shading of what the ray hits. Decisions in integers and double are counted the "
      "same way.");
}

}  // namespace gridiron::experiment
