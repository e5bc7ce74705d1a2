// Sweeps of the local store: its size, the tiles in it, the layouts that fit, and the maps.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "experiment/sections.h"
#include "gridiron/device/store_facts.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

const char* const kSweptConfigurations[] = {"reference", "grid", "best"};

std::uint64_t kilobytes(sim::StoreSize store) {
  return sim::arena_bytes(store) >> 10;
}

/// A value of a sweep: a store and the tiles in it.
struct Place {
  std::string key;    ///< suffix of CSV columns
  std::string title;  ///< for people
  sim::StoreSize store;
  std::optional<std::uint32_t> tile_width;  ///< nothing: the usual one of store and configuration
};

/// A frame of a sweep, or why it is missing.
struct Point {
  const View* view;
  std::string configuration;
  std::size_t place;
  std::uint32_t tile_width;
  bool is_usual;                           ///< whether store and tiles are those that the configuration has by default
  tool::Configuration fitted;              ///< what the layout has room for
  std::optional<tool::StoreFacts> layout;  ///< nothing: not built
  std::optional<Plan::RunId> run;          ///< of a layout that is built
  std::string note;
};

struct Sweep {
  std::vector<Place> places;
  std::vector<Point> points;  ///< by view, configuration, place

  /// @returns the result of a point; nothing without a frame.
  [[nodiscard]] static const RunResult* result(const Plan& done, const Point& point) {
    const RunResult* run = point.run ? &done.result(*point.run) : nullptr;
    return run != nullptr && !run->failed() ? run : nullptr;
  }
  /// @returns the result of the same view and configuration at the usual place.
  [[nodiscard]] const RunResult* usual_result(const Plan& done, const Point& point) const {
    for (const Point& other : points) {
      const bool same = other.view == point.view && other.configuration == point.configuration;
      if (same && other.is_usual) return result(done, other);
    }
    return nullptr;
  }
};

// Why there is no kernel for a layout.
std::string missing_words(const sim::LayoutChoice& layout) {
  for (const tool::LayoutFit& fit : tool::layout_fits()) {
    const bool same = fit.layout.store == layout.store && fit.layout.tile_width == layout.tile_width &&
                      fit.layout.packet_width == layout.packet_width;
    if (same && !fit.fits) {
      return "does not fit: " + std::to_string(fit.data_bytes) + " bytes of data, room for " +
             std::to_string(fit.room_bytes);
    }
  }
  return "not built";
}

// The configuration at another place: packets no wider than tiles, no more buffers than the layout has.
Point make_point(Plan& plan, const Stage& stage, const View& view, const char* configuration,
                 const std::vector<Place>& places, std::size_t index) {
  const Place& place = places[index];
  GridVariant variant = grid_variant(configuration);
  const tool::Configuration usual = variant.configuration;
  tool::Configuration& fitted = variant.configuration;
  const std::uint32_t usual_width =
      usual.has_grid() ? sim::usual_tile_width(place.store) : tool::tree_tile_width(place.store);
  const std::uint32_t tile_width = place.tile_width.value_or(usual_width);
  const bool is_usual = place.store == variant.store && tile_width == variant.tile_width;
  fitted.packet_width = std::min(fitted.packet_width, tile_width);
  const sim::LayoutChoice layout = {place.store, tile_width, fitted.packet_width};
  Point point{&view, configuration, index, tile_width, is_usual, fitted, tool::find_store_facts(layout), std::nullopt,
              ""};
  if (!point.layout) {
    point.note = missing_words(layout);
    return point;
  }
  if (usual.has_grid()) {
    fitted.depths.macro = std::min(fitted.depths.macro, point.layout->most_depths.macro);
    fitted.depths.triangle = std::min(fitted.depths.triangle, point.layout->most_depths.triangle);
  } else {
    fitted.depths.fetch = std::min(fitted.depths.fetch, point.layout->most_depths.fetch);
  }
  if (fitted.depths.macro != usual.depths.macro || fitted.depths.triangle != usual.depths.triangle) {
    point.note = "no room for " + std::to_string(usual.depths.macro) + " cell blocks and " +
                 std::to_string(usual.depths.triangle) + " triangle buffers";
  }
  point.fitted = fitted;
  variant.store = place.store;
  variant.tile_width = tile_width;
  // The usual frame keeps the key that other sections use.
  if (!is_usual) variant.key += "/" + place.key;
  point.run =
      plan.add(view, std::make_shared<GridSystem>(std::move(variant)), Shading::kNone, stage.machine, kPaperCores);
  return point;
}

std::shared_ptr<const Sweep> plan_sweep(Plan& plan, const Stage& stage, std::vector<Place> places) {
  auto sweep = std::make_shared<Sweep>();
  sweep->places = std::move(places);
  for (const View& view : stage.views()) {
    for (const char* configuration : kSweptConfigurations) {
      for (std::size_t i = 0; i < sweep->places.size(); ++i) {
        sweep->points.push_back(make_point(plan, stage, view, configuration, sweep->places, i));
      }
    }
  }
  return sweep;
}

double idle_percent(const RunResult& run) {
  double idle = 0;
  for (const sim::CoreTiming& core : run.timing.cores) idle += core.idle_cycles;
  return 100 * idle / (run.timing.frame_cycles * static_cast<double>(run.timing.cores.size()));
}

bool is_same_picture(const Sweep& sweep, const Plan& done, const Point& point) {
  const RunResult* run = Sweep::result(done, point);
  const RunResult* usual = sweep.usual_result(done, point);
  return run != nullptr && usual != nullptr && run->facts.picture_hash == usual->facts.picture_hash;
}

// The whole table, a row for each point.
Table long_table(const Sweep& sweep, const Plan& done, const std::string& name) {
  Table table = make_table(
      name, "view", "configuration", Column("store_kb", "local store, KB"), "tile_width", "packet_width",
      "mailbox_slots", "cell_blocks", "triangle_buffers", Column("triangles_per_buffer", "triangles in each"), "fps",
      "fps_over_usual", Column("wait_percent", "wait, %"), Column("idle_percent", "idle, %"),
      Column("fetched_mb", "fetched, MB", 1), "traversal_steps", "intersection_tests", "same_picture", "note");
  for (const Point& point : sweep.points) {
    const Place& place = sweep.places[point.place];
    std::vector<Cell> row = {point.view->title, point.configuration, kilobytes(place.store), point.tile_width,
                             point.fitted.packet_width};
    const RunResult* run = Sweep::result(done, point);
    if (run == nullptr) {
      row.resize(table.columns.size() - 1);
      row.emplace_back(point.run ? done.result(*point.run).failure : point.note);
    } else {
      const RunResult* usual = sweep.usual_result(done, point);
      row.insert(row.end(),
                 {point.layout->mailbox_slots, point.fitted.depths.macro, point.fitted.depths.triangle,
                  point.layout->triangles_per_buffer, run->fps(),
                  usual != nullptr ? Cell{ratio_of(run->fps(), usual->fps())} : Cell{}, run->wait_percent(),
                  idle_percent(*run), run->megabytes_in(), run->facts.traversal_steps, run->facts.intersection_tests,
                  is_same_picture(sweep, done, point) ? "yes" : "no", point.note.empty() ? Cell{} : Cell{point.note}});
    }
    table.add(std::move(row));
  }
  return table;
}

// The table for readers: a row for each view and configuration, the places side by side.
Table short_table(const Sweep& sweep, const Plan& done) {
  Table table = make_table("", "view", "configuration");
  struct Figure {
    const char* title;
    int decimals;
    double (RunResult::*value)() const;
  };
  const Figure figures[] = {{"fps", 2, &RunResult::fps},
                            {"wait, %", 2, &RunResult::wait_percent},
                            {"fetched, MB", 1, &RunResult::megabytes_in}};
  for (const Figure& figure : figures) {
    for (const Place& place : sweep.places) {
      table.columns.push_back({place.key, place.title + ": " + figure.title, figure.decimals});
    }
  }
  table.columns.push_back({"same_picture", "same picture"});
  for (std::size_t first = 0; first < sweep.points.size(); first += sweep.places.size()) {
    std::vector<Cell> row = {sweep.points[first].view->title, sweep.points[first].configuration};
    bool all_same = true;
    for (const Figure& figure : figures) {
      for (std::size_t i = first; i < first + sweep.places.size(); ++i) {
        const RunResult* run = Sweep::result(done, sweep.points[i]);
        row.push_back(run != nullptr ? Cell{(run->*figure.value)()}
                                     : Cell{sweep.points[i].run ? "failed" : "not built"});
        all_same = all_same && (run == nullptr || is_same_picture(sweep, done, sweep.points[i]));
      }
    }
    row.emplace_back(all_same ? "yes" : "no");
    table.add(std::move(row));
  }
  return table;
}

// A bar for each place, a group for each view.
std::string bar_chart(const Sweep& sweep, const Plan& done, const std::string& configuration,
                      const std::string& title) {
  BarChart chart{.title = title + ", " + configuration, .y_title = "frames a second", .parts = {""}, .labels = true};
  for (const Place& place : sweep.places) chart.bars.push_back(place.title);
  for (const Point& point : sweep.points) {
    if (point.configuration != configuration) continue;
    if (point.place == 0) chart.groups.push_back(point.view->title);
    const RunResult* run = Sweep::result(done, point);
    chart.values.push_back(run != nullptr ? run->fps() : std::nan(""));
  }
  return bar_chart_svg(chart);
}

// "1.00 to 1.02 times with 512 KB, ...": a figure of all other places, over that of the usual one.
template <class Value>
std::string ratio_words(const Sweep& sweep, const Plan& done, const std::string& configuration, Value value) {
  std::string text;
  for (std::size_t i = 0; i < sweep.places.size(); ++i) {
    Range ratios;
    bool is_usual = false;
    for (const Point& point : sweep.points) {
      if (point.configuration != configuration || point.place != i) continue;
      is_usual = point.is_usual;
      const RunResult* run = Sweep::result(done, point);
      const RunResult* usual = sweep.usual_result(done, point);
      if (run != nullptr && usual != nullptr)
        ratios.add(ratio_of(std::invoke(value, *run), std::invoke(value, *usual)));
    }
    if (is_usual) continue;
    const std::string words = ratios.empty() ? "not at all" : ratios.text(2) + " times";
    text += (text.empty() ? "" : ", ") + words + " with " + sweep.places[i].title;
  }
  return text;
}

template <class Value>
std::string range_words(const Sweep& sweep, const Plan& done, const std::string& configuration, Value value) {
  Range range;
  for (const Point& point : sweep.points) {
    const RunResult* run = Sweep::result(done, point);
    if (point.configuration == configuration && run != nullptr) range.add(std::invoke(value, *run));
  }
  return range.percent(2);
}

// "64 KB (Bunny), ...": the fastest place of each view.
std::string fastest_words(const Sweep& sweep, const Plan& done, const std::string& configuration) {
  std::string text;
  for (std::size_t first = 0; first < sweep.points.size(); first += sweep.places.size()) {
    if (sweep.points[first].configuration != configuration) continue;
    const Point* fastest = nullptr;
    double most = 0;
    for (std::size_t i = first; i < first + sweep.places.size(); ++i) {
      const RunResult* run = Sweep::result(done, sweep.points[i]);
      if (run != nullptr && run->fps() > most) {
        most = run->fps();
        fastest = &sweep.points[i];
      }
    }
    if (fastest == nullptr) continue;
    text += (text.empty() ? "" : ", ") + sweep.places[fastest->place].title + " (" + fastest->view->title + ")";
  }
  return text;
}

std::string picture_words(const Sweep& sweep, const Plan& done) {
  for (const Point& point : sweep.points) {
    if (Sweep::result(done, point) != nullptr && !is_same_picture(sweep, done, point)) {
      return "NOT all runs of a row render the same picture: see the last column.";
    }
  }
  return "All runs of every row render the same picture, pixel for pixel.";
}

double tests_of(const RunResult& run) {
  return static_cast<double>(run.facts.intersection_tests);
}

double steps_of(const RunResult& run) {
  return static_cast<double>(run.facts.traversal_steps);
}

// What people read, a plot for each configuration, and a link to everything.
void write_tables(const Sweep& sweep, const Plan& done, const std::string& name, const std::string& title,
                  const std::string& swept, const std::string& caption, Book& book) {
  book.shown_table(short_table(sweep, done), caption);
  for (const std::string configuration : kSweptConfigurations) {
    book.figure(name + "_" + configuration, bar_chart(sweep, done, configuration, title),
                "Frames a second against " + swept + ", " + configuration + ", 6 cores.");
  }
  book.linked_table(long_table(sweep, done, name), "every frame, with buffers, work and idle time.");
}

}  // namespace

Writer plan_tile_sweep(Plan& plan, const Stage& stage) {
  std::vector<Place> places;
  for (const std::uint32_t width : {8u, 16u, 32u, 64u}) {
    const std::string text = std::to_string(width);
    places.push_back({"tile=" + text, text + " pixels", sim::StoreSize::k256KB, width});
  }
  const auto sweep = plan_sweep(plan, stage, std::move(places));
  return [sweep](const Plan& done, Book& book) {
    book.section("tiles", "Sweep: tile size");
    book.paragraph(
        "Pixels along a tile's edge, in the store of 256 KB. The reference keeps its packets of 8x8; configuration "
        "grid traverses "
        "once per tile as far as packets go: they are as wide as the tile up to 32x32, whose 64 subpackets are one "
        "word of bits, so that tiles of 64 pixels take four. Packets of 8x8 have mailboxes of 64 slots, those of "
        "16x16 and of tiles of 64 pixels 256, the others 1,024. Two tiles of 64 pixels take 96 KB with their planes of "
        "colour, distance and triangle; beside them there is room for 8 triangle buffers instead of 12; configuration "
        "grid uses 3. Configuration best draws 32 x 32 pixels at a time whatever a tile's width; in tiles of 64 pixels "
        "two such squares take turns, and these tiles are claimed and leave less often.");
    book.paragraph(
        "Frames over those at 32 pixels, all views: the reference renders " +
        ratio_words(*sweep, done, "reference", &RunResult::fps) + "; grid " +
        ratio_words(*sweep, done, "grid", &RunResult::fps) + ". Over those at 64 pixels: best renders " +
        ratio_words(*sweep, done, "best", &RunResult::fps) +
        ". Traversal steps of grid: " + ratio_words(*sweep, done, "grid", steps_of) +
        ". Over all widths the reference stands idle for " + range_words(*sweep, done, "reference", idle_percent) +
        " of its core cycles, grid for " + range_words(*sweep, done, "grid", idle_percent) + " and best for " +
        range_words(*sweep, done, "best", idle_percent) + ". Configuration grid is fastest with " +
        fastest_words(*sweep, done, "grid") + ", the reference with " + fastest_words(*sweep, done, "reference") +
        ", best with " + fastest_words(*sweep, done, "best") + ". " + picture_words(*sweep, done));
    write_tables(*sweep, done, "sweep_tile_width", "Width of tiles", "the width of tiles",
                 "Widths of tiles, 256 KB, 6 cores, no shading.", book);
  };
}

namespace {

Table bvh_map() {
  Table map = make_table("local_store_map_bvh", "region", "offset", "bytes");
  for_each_region<bvh::BvhStore::Layout>([&map](const char* name, std::size_t offset_bytes, std::size_t bytes) {
    map.add({name, offset_bytes, bytes});
  });
  const auto add_row = [&map](const char* name, std::uint64_t bytes) { map.add({name, Cell{}, bytes}); };
  using Layout = bvh::BvhStore::Layout;
  add_row("code (budget)", Layout::kCodeBudgetBytes);
  add_row("stack (budget)", Layout::kStackBudgetBytes);
  add_row("free", kDataRoomBytes<Layout> - sizeof(bvh::BvhStore));
  add_row("local store", Layout::kArenaBytes);
  return map;
}

/// A layout as the maps show it.
struct NamedLayout {
  std::string key, title;
  tool::StoreFacts facts;
};

std::uint64_t free_bytes(const tool::StoreFacts& facts) {
  return facts.arena_bytes - facts.code_bytes - facts.stack_bytes - facts.data_bytes();
}

// The layouts of a configuration, by size of the store.
std::vector<NamedLayout> layouts_of(const std::string& configuration) {
  std::vector<NamedLayout> layouts;
  for (const sim::StoreSize store : sim::kStoreSizes) {
    const std::string size = std::to_string(kilobytes(store));
    layouts.push_back({"store_" + size, size + " KB",
                       tool::usual_store_facts(store, grid_variant(configuration).configuration.packet_width)});
  }
  return layouts;
}

Table map_table(const std::string& configuration) {
  const std::vector<NamedLayout> layouts = layouts_of(configuration);
  Table map = make_table("local_store_map_" + configuration, "region");
  for (const NamedLayout& layout : layouts) {
    map.columns.push_back({layout.key + "_offset", layout.title + ": offset"});
    map.columns.push_back({layout.key + "_bytes", "bytes"});
  }
  for (std::size_t i = 0; i < layouts.front().facts.regions.size(); ++i) {
    std::vector<Cell> cells = {layouts.front().facts.regions[i].name};
    for (const NamedLayout& layout : layouts) {
      cells.emplace_back(layout.facts.regions[i].offset_bytes);
      cells.emplace_back(layout.facts.regions[i].bytes);
    }
    map.add(std::move(cells));
  }
  const auto add_row = [&](const char* name, auto value) {
    std::vector<Cell> cells = {name};
    for (const NamedLayout& layout : layouts) {
      cells.emplace_back();
      cells.emplace_back(value(layout.facts));
    }
    map.add(std::move(cells));
  };
  add_row("code (budget)", [](const tool::StoreFacts& facts) { return facts.code_bytes; });
  add_row("stack (budget)", [](const tool::StoreFacts& facts) { return facts.stack_bytes; });
  add_row("free", free_bytes);
  add_row("local store", [](const tool::StoreFacts& facts) { return facts.arena_bytes; });
  return map;
}

Table contents_table() {
  Table table = make_table(
      "local_store_layouts", "configuration", Column("store_kb", "local store, KB"), "tile_width", "packet_width",
      "mailbox_slots", Column("resident_macrocells", "macrocells resident"),
      Column("most_macro_width", "macrocell width, at most"), Column("most_cell_blocks", "cell blocks, at most"),
      Column("most_triangle_buffers", "triangle buffers, at most"), Column("triangles_per_buffer", "triangles in each"),
      Column("data_bytes", "data, bytes"), Column("free_bytes", "free, bytes"));
  for (const char* configuration : kSweptConfigurations) {
    for (const NamedLayout& layout : layouts_of(configuration)) {
      const tool::StoreFacts& facts = layout.facts;
      table.add({configuration, facts.arena_bytes >> 10, facts.tile_width, facts.packet_width, facts.mailbox_slots,
                 facts.resident_macro_cells, facts.max_macro_width, facts.most_depths.macro, facts.most_depths.triangle,
                 facts.triangles_per_buffer, facts.data_bytes(), free_bytes(facts)});
    }
  }
  return table;
}

Table fit_table() {
  Table table =
      make_table("local_store_fit", Column("store_kb", "local store, KB"), "tile_width", "packet_width",
                 Column("data_bytes", "data, bytes"), Column("room_bytes", "room for data, bytes"), "fits", "built");
  for (const tool::LayoutFit& fit : tool::layout_fits()) {
    table.add({kilobytes(fit.layout.store), fit.layout.tile_width, fit.layout.packet_width, fit.data_bytes,
               fit.room_bytes, fit.fits ? "yes" : "no", tool::find_store_facts(fit.layout) ? "yes" : "no"});
  }
  return table;
}

// "16 pixels in 64 KB, ...": the widest tiles that fit with every packet.
std::string widest_tiles() {
  std::string text;
  for (const sim::StoreSize store : sim::kStoreSizes) {
    std::uint32_t widest = 0, narrowest_misfit = ~0u;
    for (const tool::LayoutFit& fit : tool::layout_fits()) {
      if (fit.layout.store != store) continue;
      if (fit.fits) widest = std::max(widest, fit.layout.tile_width);
      if (!fit.fits) narrowest_misfit = std::min(narrowest_misfit, fit.layout.tile_width);
    }
    text += (text.empty() ? "" : ", ") + std::to_string(widest) + " pixels in " + std::to_string(kilobytes(store)) +
            " KB" + (widest >= narrowest_misfit ? " (not with every packet)" : "");
  }
  return text;
}

// "; 64 KB hold fewer than grid asks for": the reduced configurations.
std::string short_store_words() {
  std::string stores;
  const tool::BufferDepths wanted = grid_variant("grid").configuration.depths;
  for (const NamedLayout& layout : layouts_of("grid")) {
    const tool::BufferDepths& most = layout.facts.most_depths;
    const bool is_short = most.macro < wanted.macro || most.triangle < wanted.triangle;
    if (is_short) stores += (stores.empty() ? "" : ", ") + layout.title;
  }
  return stores.empty() ? "" : "; " + stores + " have fewer than the " + buffer_words("grid") + " of grid";
}

// "64 KB: packet; ...": the regions whose sizes differ between reference and grid.
std::string differing_regions() {
  std::string text;
  const std::vector<NamedLayout> reference = layouts_of("reference"), grid = layouts_of("grid");
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::string names;
    const auto &ours = grid[i].facts.regions, &theirs = reference[i].facts.regions;
    for (std::size_t r = 0; r < ours.size(); ++r) {
      if (ours[r].bytes != theirs[r].bytes) names += (names.empty() ? "" : ", ") + ours[r].name;
    }
    text += (text.empty() ? "" : "; ") + grid[i].title + ": " + (names.empty() ? "none" : names);
  }
  return text;
}

void write_maps(Book& book) {
  book.section("map", "The local store, byte by byte");
  book.paragraph(
      "Everything a core works in, in address order. The sizes are those of the compiled layouts, whose buffers are as "
      "many as in the first table, however many of them a configuration uses" +
      short_store_words() + ". The layouts of reference and grid differ in these regions: " + differing_regions() +
      ". Code and stack are committed budgets; the cross builds prove those of the layouts of 256 KB "
      "with packets of 8x8 and 32x32 and of configuration best in 64 and 256 KB, and of no others.");
  book.table(contents_table(), "What each layout holds.");
  for (const char* configuration : kSweptConfigurations) {
    book.table(map_table(configuration), std::string("A core's local store, configuration ") + configuration +
                                             ": where each region begins, and its bytes.");
  }
  book.paragraph("The width of tiles is a parameter of every layout. The widest that fit: " + widest_tiles() +
                 ". What fits is built where a sweep needs it.");
  book.table(fit_table(), "Which tiles and packets a store has room for, the other sizes being those of its layout.");
  book.paragraph(
      "The hierarchy has a map of its own. The regions are as large as the largest ring and caches that it can be "
      "asked for; its budgets for code and stack are the grid's, taken over and not proved by a cross build.");
  book.table(bvh_map(), "A core's local store under the hierarchy.");
}

}  // namespace

Writer plan_store_sweep(Plan& plan, const Stage& stage) {
  std::vector<Place> places;
  for (const sim::StoreSize store : sim::kStoreSizes) {
    const std::string text = std::to_string(kilobytes(store));
    places.push_back({"store=" + text, text + " KB", store, std::nullopt});
  }
  const auto sweep = plan_sweep(plan, stage, std::move(places));
  return [sweep](const Plan& done, Book& book) {
    book.section("store", "Sweep: local store");
    book.paragraph(
        "A layout for each size: tiles of 16 pixels in 64 KB and of 32 in the others, and with the size the table of "
        "macrocells, the buffers and the mailbox of wide packets; the contents of each are below. Where a layout has "
        "fewer buffers than a configuration asks for, it is cut down to them; in 64 KB configuration grid traverses "
        "once per 16x16 tile. Configuration best has tiles of 16 pixels in 64 KB, of 32 in 128 KB and of 64 in the "
        "others. 64 and 128 KB hold 8 nodes and leaves and draw one tile at a time; the others hold 32 and 17 more "
        "that "
        "stay for the frame, and two tiles take turns: in 512 KB nothing is left to hold.");
    book.paragraph("Frames over those from 256 KB, all views: the reference renders " +
                   ratio_words(*sweep, done, "reference", &RunResult::fps) + "; grid " +
                   ratio_words(*sweep, done, "grid", &RunResult::fps) + "; best " +
                   ratio_words(*sweep, done, "best", &RunResult::fps) + ". Over all sizes the reference waits for " +
                   range_words(*sweep, done, "reference", &RunResult::wait_percent) + " of its core cycles, grid for " +
                   range_words(*sweep, done, "grid", &RunResult::wait_percent) + " and best for " +
                   range_words(*sweep, done, "best", &RunResult::wait_percent) + ". Intersection tests of grid: " +
                   ratio_words(*sweep, done, "grid", tests_of) + ", of the reference " +
                   ratio_words(*sweep, done, "reference", tests_of) + ". " + picture_words(*sweep, done));
    book.paragraph(
        "A mailbox that forgets has triangles tested again, so its size shows in those tests. The price of clearing it "
        "is that of the 256 KB layouts at every size.");
    write_tables(*sweep, done, "sweep_local_store", "Local store", "the size of the local store",
                 "Sizes of the local store, 6 cores, no shading.", book);
    write_maps(book);
  };
}

}  // namespace gridiron::experiment
