// The real kernel when a transfer goes wrong: every transfer of a small frame in turn, refused, failed, timed out.
// Each time the error comes back as a Status, nothing hangs, and no byte outside the local store or the picture
// changes. The same for every allocation of host memory that fails while a frame is rendered.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/platform/fault_injection.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/store/local_store.h>

#include <new>

#include "core/build/grid/built_image.h"
#include "failing_new.h"
#include "host_board.h"
#include "sim_platform/program_bench.h"
#include "support/instrumented.h"
#include "support/test_mesh.h"
#include "support/views.h"
#include "template_port.h"

namespace gridiron::sim {
namespace {

using Store = LocalStore<StoreLayout64K<8>>;

/// A frame of 2 x 2 small tiles in simulated memory, with the bytes around the picture remembered.
class SmallFrame {
 public:
  SmallFrame() : memory_(std::uint64_t{1} << 22) {
    const test::TestMesh mesh = test::make_torus(8, 12, 0.6f, 0.25f);
    const test::BuiltImage built = test::build_image(mesh.view());
    const MemoryRegion image = *memory_.allocate(built.need.image_bytes);
    std::ranges::copy(built.image.bytes(), image.bytes.begin());

    FrameSettings settings;
    settings.camera = test::framed_camera(mesh.view());
    settings.width = settings.height = 2 * Store::Layout::kTileWidth;
    settings.tile_width = Store::Layout::kTileWidth;
    plane_bytes_ = output_plane_bytes(settings.width, settings.height, settings.tile_width);
    picture_ = *memory_.allocate(3 * plane_bytes_);
    settings.color = picture_.address;
    settings.depth = picture_.address.offset_by(plane_bytes_);
    settings.ids = picture_.address.offset_by(2 * plane_bytes_);
    FrameRecord frame;
    EXPECT_EQ(make_frame_record(settings, built.view, image.address, frame), Status::kOk);
    record_ = *memory_.allocate(sizeof frame);
    std::memcpy(record_.bytes.data(), &frame, sizeof frame);
    before_ = outside_picture();

    shape.tile_count = 4;
    shape.output_depth = settings.output_depth;
    shape.arena_bytes = Store::Layout::kArenaBytes;
    shape.data_bytes = sizeof(Store);
    shape.writable = {{picture_.address.value, picture_.address.value + 3 * plane_bytes_}};
  }

  /// All of memory but the picture.
  [[nodiscard]] std::vector<std::byte> outside_picture() {
    const std::span<std::byte> all = memory_.bytes_at(MainAddress{SimMemory::kFirstAddress}, memory_.used_bytes());
    std::vector<std::byte> copy(all.begin(), all.end());
    const std::size_t first = picture_.address.value - SimMemory::kFirstAddress;
    std::fill_n(copy.begin() + static_cast<std::ptrdiff_t>(first), 3 * plane_bytes_, std::byte{0});
    return copy;
  }
  [[nodiscard]] bool is_untouched() { return outside_picture() == before_; }
  [[nodiscard]] SimMemory& memory() { return memory_; }
  [[nodiscard]] MainAddress record() const { return record_.address; }
  [[nodiscard]] std::vector<std::byte> picture() const { return {picture_.bytes.begin(), picture_.bytes.end()}; }

  FrameShape shape{kGridEngine};

 private:
  SimMemory memory_;
  MemoryRegion picture_, record_;
  std::uint64_t plane_bytes_ = 0;
  std::vector<std::byte> before_;
};

TEST(KernelFault, EveryTransferThatFailsInTheSimulatorComesBackAsAStatus) {
  SmallFrame frame;
  ChipOptions options{.store = StoreSize::k64KB};
  const std::uint64_t count = test::render_in_test(frame.memory(), frame.record(), options).transfers;
  ASSERT_GT(count, 50u);
  for (const Completion completion : {Completion::kEarly, Completion::kRandom}) {
    options.completion = completion;
    for (std::uint64_t i = 1; i <= count; ++i) {
      // Odd ones with one thread, even ones with two.
      options.threads = i % 2 == 0 ? 2 : 1;
      options.fail_transfer = i;
      options.seed = i;
      const ChipResult result = test::render_in_test(frame.memory(), frame.record(), options);
      ASSERT_EQ(result.status, Status::kTransferFailed) << "transfer " << i << ": " << words(result);
      ASSERT_TRUE(result.violations.empty()) << "transfer " << i << ": " << words(result);
      ASSERT_TRUE(frame.is_untouched()) << "transfer " << i;
    }
  }
  options.fail_transfer = count + 100;
  options.threads = 1;
  EXPECT_EQ(render_frame(frame.memory(), frame.record(), options).status, Status::kOk);
}

TEST(KernelFault, EveryAllocationThatFailsComesBackAsAStatus) {
  SmallFrame frame;
  std::vector<Mode> modes = {Mode::kChecked, Mode::kPlain};
  if (has_instrumented_mode()) modes.push_back(Mode::kInstrumented);
  for (const Mode mode : modes) {
    for (const std::uint32_t threads : {1u, 3u}) {
      const ChipOptions options{.mode = mode, .threads = threads, .store = StoreSize::k64KB};
      ASSERT_EQ(render_frame(frame.memory(), frame.record(), options).status, Status::kOk);
      const std::vector<std::byte> picture = frame.picture();
      std::uint64_t ended = 0;
      bool is_last = false;
      for (std::uint64_t i = 1; !is_last; i = i + 1 + i / 8) {
        test::fail_allocation(i);
        const ChipResult result = render_frame(frame.memory(), frame.record(), options);
        is_last = test::end_of_failing() < i;
        if (result.status == Status::kOk) {
          // The allocation was there for a thread that could be done without, or the frame had fewer.
          ASSERT_TRUE(frame.picture() == picture) << "allocation " << i;
          ASSERT_EQ(result.host_shortage, HostShortage::kNone);
          continue;
        }
        ++ended;
        ASSERT_EQ(result.status, Status::kAborted) << "allocation " << i << ": " << words(result);
        ASSERT_EQ(result.host_shortage, HostShortage::kMemory) << "allocation " << i;
        ASSERT_TRUE(frame.is_untouched()) << "allocation " << i;
      }
      EXPECT_GT(ended, 3u);
    }
  }
}

/// The kernel over the decorator over a checked core.
ChipResult render_faulty(SmallFrame& frame, const FaultPlan& plan, Completion completion, std::uint64_t* transfers) {
  const ChipOptions options{.completion = completion, .seed = plan.transfer};
  return run_cores(frame.memory(), frame.shape, options, [&](SimCore& core, std::span<std::byte> data) {
    FaultInjection<SimCore> faulty(core, plan);
    Store& store = *::new (static_cast<void*>(data.data())) Store;
    const Status status = render_tiles<Lanes<4>>(store, faulty, frame.record());
    if (transfers != nullptr) *transfers = faulty.transfers();
    return status;
  });
}

TEST(KernelFault, EveryTransferThatIsRefusedOrTimesOutComesBackAsAStatus) {
  SmallFrame frame;
  std::uint64_t count = 0;
  ASSERT_EQ(render_faulty(frame, {}, Completion::kEarly, &count).status, Status::kOk);
  ASSERT_GT(count, 50u);
  for (std::uint64_t i = 1; i <= count; ++i) {
    const FaultPlan refused{.transfer = i, .kind = FaultPlan::Kind::kRefuse, .status = Status::kTransferQueueFull};
    const FaultPlan late{.transfer = i, .kind = FaultPlan::Kind::kReport, .status = Status::kTransferTimedOut};
    for (const FaultPlan& plan : {refused, late}) {
      const ChipResult result = render_faulty(frame, plan, Completion::kLate, nullptr);
      ASSERT_EQ(result.status, plan.status) << "transfer " << i << ": " << words(result);
      ASSERT_TRUE(result.violations.empty()) << "transfer " << i << ": " << words(result);
      ASSERT_TRUE(frame.is_untouched()) << "transfer " << i;
    }
  }
}

TEST(KernelFault, ADelayedTransferChangesNothing) {
  SmallFrame frame;
  std::uint64_t count = 0;
  ASSERT_EQ(render_faulty(frame, {}, Completion::kEarly, &count).status, Status::kOk);
  const std::vector<std::byte> picture = frame.picture();
  for (std::uint64_t i = 1; i <= count; ++i) {
    const FaultPlan plan{.transfer = i, .kind = FaultPlan::Kind::kDelay};
    const ChipResult result = render_faulty(frame, plan, Completion::kEarly, nullptr);
    ASSERT_EQ(result.status, Status::kOk) << "transfer " << i << ": " << words(result);
    ASSERT_TRUE(frame.picture() == picture) << "transfer " << i;
  }
}

TEST(KernelFault, AnEndOfClaimsEndsTheFrameBetweenTiles) {
  SmallFrame frame;
  for (std::uint64_t claim = 1; claim <= 5; ++claim) {
    for (const ItemClaim::Kind kind : {ItemClaim::Kind::kAborted, ItemClaim::Kind::kDeadline}) {
      const ChipResult result =
          render_faulty(frame, {.claim = claim, .claim_answer = kind}, Completion::kLate, nullptr);
      EXPECT_EQ(result.status, kind == ItemClaim::Kind::kAborted ? Status::kAborted : Status::kDeadline);
      EXPECT_TRUE(result.violations.empty()) << "claim " << claim << ": " << words(result);
      EXPECT_EQ(result.trace.tiles[claim - 1 < 4 ? claim - 1 : 3].packed.empty(), claim != 5) << "claim " << claim;
    }
  }
}

/// The kernel over the template port: the same picture, and an engine that fails or hangs is reported.
TEST(KernelFault, TheTemplatePortRendersTheSamePictureAndReportsItsEngine) {
  SmallFrame frame;
  ASSERT_EQ(render_faulty(frame, {}, Completion::kEarly, nullptr).status, Status::kOk);
  const std::vector<std::byte> picture = frame.picture();
  const auto store = std::make_unique<Store>();
  const auto render = [&](auto prepare, std::uint64_t* starts) {
    contract::HostBoard board(frame.memory(), std::as_writable_bytes(std::span(store.get(), 1)), 4);
    prepare(board);
    port::TemplatePort<contract::HostBoard, 16, 64> port(board);
    const Status status = render_tiles<Lanes<4>>(*store, port, frame.record());
    EXPECT_EQ(board.starts_while_busy, 0u);
    if (starts != nullptr) *starts = board.starts;
    return status;
  };
  std::uint64_t starts = 0;
  ASSERT_EQ(render([](contract::HostBoard&) {}, &starts), Status::kOk);
  EXPECT_TRUE(frame.picture() == picture);
  for (std::uint64_t i = 1; i <= starts; ++i) {
    ASSERT_EQ(render([&](contract::HostBoard& b) { b.fail_command = i; }, nullptr), Status::kTransferFailed) << i;
    ASSERT_EQ(render([&](contract::HostBoard& b) { b.hang_command = i; }, nullptr), Status::kTransferTimedOut) << i;
  }
  EXPECT_TRUE(frame.is_untouched());
}

}  // namespace
}  // namespace gridiron::sim
