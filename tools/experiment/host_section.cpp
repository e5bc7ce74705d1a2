// Fig. 7 (b): the same kernel on this host's processor, and Embree there. SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "experiment/sections.h"
#include "files/interrupt.h"

#ifdef GRIDIRON_HAS_EMBREE
#include "embree_peer/embree_peer.h"
#endif

namespace gridiron::experiment {
namespace {

constexpr std::uint32_t kRepeats = 5;

/// Milliseconds by the wall clock and of the processors, or why they are missing.
struct Milliseconds {
  Cell wall, processor;

  explicit Milliseconds(const tool::HostSeconds& seconds)
      : wall(seconds.wall * 1e3), processor(seconds.processor * 1e3) {}
  explicit Milliseconds(const std::string& reason) : wall(reason), processor(reason) {}
};

// Embree's frame on one thread, with the faster of its two hierarchies.
Milliseconds embree_milliseconds([[maybe_unused]] const View& view, [[maybe_unused]] const FrameRecord& frame) {
#ifdef GRIDIRON_HAS_EMBREE
  if (frame.width % peer::kEmbreePacketWidth != 0 || frame.height % peer::kEmbreePacketWidth != 0) {
    return Milliseconds("size is no multiple of " + std::to_string(peer::kEmbreePacketWidth));
  }
  tool::HostSeconds least;
  std::vector<std::uint32_t> color;
  for (const peer::EmbreeQuality quality : {peer::EmbreeQuality::kLow, peer::EmbreeQuality::kMedium}) {
    tool::stop_if_interrupted();
    peer::EmbreeScene scene;
    scene.set_mesh(view.mesh().view());
    scene.build(quality);
    const tool::HostSeconds seconds = least_host_seconds(kRepeats, [&] { scene.render(frame, color); });
    if (least.wall <= 0 || seconds.processor < least.processor) least = seconds;
  }
  return Milliseconds(least);
#else
  return Milliseconds(std::string("not built in"));
#endif
}

}  // namespace

void write_host_figures(const Stage& stage, std::uint32_t threads, Book& book) {
  Table table =
      make_table("host_fig7", "view", "threads", "lanes", Column("reference_ms", "reference, ms"),
                 Column("grid_ms", "grid, ms"), Column("best_ms", "best, ms"), Column("embree_ms", "Embree, ms"),
                 Column("reference_processor_ms", "processor, ms"), Column("grid_processor_ms", "processor, ms"),
                 Column("best_processor_ms", "processor, ms"), Column("embree_processor_ms", "processor, ms"));
  const FrameRequest request = {.width = stage.width, .height = stage.height, .shading = Shading::kSimple};
  std::vector<std::uint32_t> thread_counts = {1};
  if (threads > 1) thread_counts.push_back(threads);
  for (const View& view : stage.views()) {
    for (const std::uint32_t count : thread_counts) {
      const HostFrame reference = render_on_host(grid_variant("reference"), view, request, count, kRepeats);
      const HostFrame grid = render_on_host(grid_variant("grid"), view, request, count, kRepeats);
      const HostFrame best = render_on_host(grid_variant("best"), view, request, count, kRepeats);
      const Milliseconds ours(reference.seconds), ours_grid(grid.seconds), ours_best(best.seconds);
      const Milliseconds peer =
          count == 1 ? embree_milliseconds(view, reference.record) : Milliseconds(std::string("one thread only"));
      table.add({view.title, count, sim::widest_lanes(), ours.wall, ours_grid.wall, ours_best.wall, peer.wall,
                 ours.processor, ours_grid.processor, ours_best.processor, peer.processor});
    }
  }
  book.section("host", "Fig. 7 (b): this host");
  book.paragraph(
      "Against coherent grid traversal on a general processor of its day the paper was almost four times faster [P]. "
      "The same kernels also run directly on this host, without checks or a simulated clock, in the widest SIMD groups "
      "that it has; beside them Embree 3 renders the same frames on one thread with coherent packets of 16 rays and "
      "the "
      "same simple shading, where the program was built with it (rays and shading around Embree are compiled for any "
      "host of the kind). Those are times of one machine, whatever "
      "else it was doing: they are kept in files whose names begin with host_, which alone differ from run to run, and "
      "are not repeated on this page.");
  book.linked_table(
      table,
      "milliseconds of a frame, the least of five, by the wall clock and, for a host with other work, of "
      "its processors, all threads together; Embree's is the better of its low and medium build quality.");
}

}  // namespace gridiron::experiment
