// gridiron/c/gridiron.h as C++20 sees it: what it refuses, in which words, and what it passes on from the firmware.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/c/gridiron.h>
#include <gridiron/platform/status_name.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace {

// What the port of this test has been called with, and what it answers.
struct PortState {
  std::uint32_t next_item = 0, item_count = 0;
  std::uint32_t core = 0;
  std::uint32_t get_count = 0, failing_get = 0;  ///< failing_get: the number of the get that fails, from 1 on
  GridironStatus failure = kGridironTransferFailed;
  GridironClaim end = kGridironClaimNone;
  bool writes_item = true;
};
PortState port;

}  // namespace

GridironStatus gridiron_dma_get(uint32_t core, void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  port.core = core;
  if (++port.get_count == port.failing_get) return port.failure;
  const GridironStatus status = gridiron_check_transfer(local, main_address, bytes, tag);
  if (status == kGridironOk) std::memcpy(local, reinterpret_cast<const void*>(main_address), bytes);
  return status;
}
GridironStatus gridiron_dma_put(uint32_t, const void* local, uint64_t main_address, uint32_t bytes, uint32_t tag) {
  const GridironStatus status = gridiron_check_transfer(local, main_address, bytes, tag);
  if (status == kGridironOk) std::memcpy(reinterpret_cast<void*>(main_address), local, bytes);
  return status;
}
GridironStatus gridiron_dma_wait(uint32_t, uint32_t) {
  return kGridironOk;
}
GridironClaim gridiron_claim_item(uint32_t, uint32_t* item) {
  if (port.next_item == port.item_count) return port.end;
  if (port.writes_item) *item = port.next_item;
  ++port.next_item;
  return kGridironClaimItem;
}

namespace {

// A triangle in main memory, its image and a frame of 16 x 16 pixels.
class CInterface : public testing::Test {
 protected:
  void SetUp() override {
    port = {};
    ASSERT_EQ(gridiron_count_image(&mesh_, &build_, &need_), kGridironOk);
    ASSERT_LE(need_.image_bytes, sizeof image_bytes_);
    ASSERT_LE(need_.scratch_bytes, sizeof scratch_);
    ASSERT_EQ(build(), kGridironOk);
    ASSERT_EQ(open(), kGridironOk);
    frame_ = gridiron_usual_frame();
    frame_.eye[2] = 4;
    frame_.width = frame_.height = 16;
    frame_.color_address = reinterpret_cast<std::uintptr_t>(color_);
    port.item_count = gridiron_tile_count(frame_.width, frame_.height);
  }

  GridironStatus build() {
    return gridiron_build_image(&mesh_, &build_, &need_, image_bytes_, sizeof image_bytes_, scratch_, sizeof scratch_);
  }
  GridironStatus open(GridironFault* fault = nullptr) {
    return gridiron_open_image(image_bytes_, sizeof image_bytes_, &image_, fault);
  }
  GridironStatus make_frame(GridironFault* fault = nullptr) {
    return gridiron_make_frame(&frame_, &image_, reinterpret_cast<std::uintptr_t>(image_bytes_), record_, fault);
  }
  // A changed frame is refused with this status, by this member, and the record stays as it is.
  void refuses(const std::function<void()>& change, GridironStatus wanted, const std::string& field,
               std::size_t offset) {
    const GridironFrame before = frame_;
    std::memset(record_, 0x5a, sizeof record_);
    change();
    GridironFault fault{99, nullptr};
    EXPECT_EQ(make_frame(&fault), wanted) << field;
    EXPECT_EQ(make_frame(), wanted) << field;
    EXPECT_EQ(fault.field, field);
    EXPECT_EQ(fault.byte_offset, offset) << field;
    for (const unsigned char byte : record_) ASSERT_EQ(byte, 0x5a) << field;
    frame_ = before;
    EXPECT_EQ(make_frame(&fault), kGridironOk) << field;
    EXPECT_STREQ(fault.field, "");
    EXPECT_EQ(fault.byte_offset, 0u);
  }
  GridironStatus render() { return gridiron_render(7, store_, reinterpret_cast<std::uintptr_t>(record_), 0, 0); }

  const float vertices_[9] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const std::uint32_t indices_[3] = {0, 1, 2};
  GridironMesh mesh_{vertices_, indices_, 3, 1};
  GridironBuild build_ = gridiron_usual_build();
  GridironNeed need_{};
  GridironImage image_{};
  GridironFrame frame_{};
  alignas(4096) unsigned char image_bytes_[16384];
  alignas(128) unsigned char scratch_[16384];
  alignas(128) std::uint32_t color_[256];
  alignas(128) std::uint32_t depth_[256];
  alignas(128) std::uint32_t ids_[256];
  alignas(128) unsigned char record_[512];
  alignas(128) unsigned char store_[GRIDIRON_STORE_BYTES];
};

TEST_F(CInterface, RendersATriangle) {
  EXPECT_EQ(image_.triangle_count, 1u);
  EXPECT_TRUE(image_.has_tree);
  ASSERT_EQ(make_frame(), kGridironOk);
  ASSERT_EQ(render(), kGridironOk);
  EXPECT_EQ(port.core, 7u);
  EXPECT_EQ(color_[gridiron_plane_index(16, 0, 0)], 0xFF000000u);
  EXPECT_NE(color_[gridiron_plane_index(16, 8, 8)], 0xFF000000u);
  std::uint32_t count = 0;
  const std::uint32_t* work = gridiron_work(store_, &count);
  EXPECT_GT(count, 0u);
  EXPECT_NE(work[0] + work[1] + work[2], 0u);
}

TEST_F(CInterface, SizesAreThoseOfTheLayout) {
  const GridironSizes sizes = gridiron_sizes();
  EXPECT_EQ(sizes.store_bytes, GRIDIRON_STORE_BYTES);
  EXPECT_LE(sizes.store_bytes + sizes.stack_budget_bytes, sizes.arena_bytes);
  EXPECT_LE(sizes.code_budget_bytes, sizes.code_memory_bytes);
  EXPECT_EQ(sizes.arena_bytes, 16384u);
  EXPECT_EQ(gridiron_plane_bytes(17, 9), 4u * 24 * 16);
  EXPECT_EQ(gridiron_tile_count(17, 9), 6u);
}

TEST_F(CInterface, WrongParametersHaveAStatusAndAText) {
  const auto says = [&](auto change, GridironStatus wanted, const std::string& words) {
    const GridironFrame before = frame_;
    change();
    const GridironStatus status = make_frame();
    EXPECT_EQ(status, wanted);
    EXPECT_NE(std::string(gridiron_status_text(status)).find(words), std::string::npos) << gridiron_status_text(status);
    frame_ = before;
  };
  says([&] { frame_.width = 0; }, kGridironBadFrame, "size");
  says([&] { frame_.color_address = 0; }, kGridironBadFrame, "plane");
  says([&] { frame_.color_address += 4; }, kGridironTransferAlignment, "misaligned");
  says([&] { std::memcpy(frame_.at, frame_.eye, sizeof frame_.at); }, kGridironBadFrame, "camera");
  says([&] { frame_.accuracy = static_cast<GridironAccuracy>(7); }, kGridironUnsupportedFrame, "not built");
  says([&] { frame_.accuracy = kGridironAccuracyCompact; }, kGridironUnsupportedImage, "lacks");
  EXPECT_STREQ(gridiron_status_text(static_cast<GridironStatus>(31)), "unknown status");
}

#define GRIDIRON_MEMBER(member) #member, offsetof(GridironFrame, member)

TEST_F(CInterface, ARefusedFrameNamesItsMember) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  const auto bad = [&](const std::function<void()>& change, const std::string& field, std::size_t offset) {
    refuses(change, kGridironBadFrame, field, offset);
  };
  for (const std::uint32_t pixels : {0u, 16385u}) {
    bad([&] { frame_.width = pixels; }, GRIDIRON_MEMBER(width));
    bad([&] { frame_.height = pixels; }, GRIDIRON_MEMBER(height));
  }
  for (const float number : {0.0f, -1.0f, kNan, kInfinity}) {
    bad([&] { frame_.tan_half_fov = number; }, GRIDIRON_MEMBER(tan_half_fov));
  }
  for (const float number : {0.0f, -1.0f, kNan}) bad([&] { frame_.t_far = number; }, GRIDIRON_MEMBER(t_far));
  for (const float number : {kNan, kInfinity}) {
    bad([&] { frame_.eye[1] = number; }, GRIDIRON_MEMBER(eye));
    bad([&] { frame_.at[2] = number; }, GRIDIRON_MEMBER(at));
    bad([&] { frame_.up[0] = number; }, GRIDIRON_MEMBER(up));
  }
  bad([&] { frame_.eye[0] = 0x1.1p120f; }, GRIDIRON_MEMBER(eye));
  bad([&] { std::memcpy(frame_.at, frame_.eye, sizeof frame_.at); }, GRIDIRON_MEMBER(at));
  bad([&] { frame_.up[1] = 0; }, GRIDIRON_MEMBER(up));
  bad([&] { frame_.up[1] = 0, frame_.up[2] = -3; }, GRIDIRON_MEMBER(up));
  refuses([&] { frame_.accuracy = static_cast<GridironAccuracy>(5); }, kGridironUnsupportedFrame,
          GRIDIRON_MEMBER(accuracy));
  refuses([&] { frame_.accuracy = kGridironAccuracyPaper; }, kGridironUnsupportedImage, GRIDIRON_MEMBER(accuracy));
  refuses([&] { frame_.shading = static_cast<GridironShading>(3); }, kGridironUnsupportedFrame,
          GRIDIRON_MEMBER(shading));
  refuses([&] { frame_.shading = kGridironShadingScene; }, kGridironMissingEffect, GRIDIRON_MEMBER(shading));
}

TEST_F(CInterface, DepthsBeyondTheLayoutAreRefused) {
  refuses([&] { frame_.output_depth = 0; }, kGridironBadFrame, GRIDIRON_MEMBER(output_depth));
  refuses([&] { frame_.output_depth = 3; }, kGridironUnsupportedFrame, GRIDIRON_MEMBER(output_depth));
  refuses([&] { frame_.fetch_depth = 0; }, kGridironBadFrame, GRIDIRON_MEMBER(fetch_depth));
  refuses([&] { frame_.fetch_depth = 3; }, kGridironUnsupportedFrame, GRIDIRON_MEMBER(fetch_depth));
  // What is not refused renders.
  for (frame_.output_depth = 1; frame_.output_depth <= 2; ++frame_.output_depth) {
    for (frame_.fetch_depth = 1; frame_.fetch_depth <= 2; ++frame_.fetch_depth) {
      port.next_item = 0;
      ASSERT_EQ(make_frame(), kGridironOk);
      EXPECT_EQ(render(), kGridironOk);
    }
  }
}

TEST_F(CInterface, PlanesThatOverlapOrAreMisplacedAreRefused) {
  const auto place = [](const void* where) { return reinterpret_cast<std::uintptr_t>(where); };
  frame_.depth_address = place(depth_);
  frame_.ids_address = place(ids_);
  const std::uint64_t plane_bytes = gridiron_plane_bytes(16, 16);
  ASSERT_EQ(plane_bytes, sizeof color_);
  const std::uint64_t image = place(image_bytes_), image_end = image + image_.image_bytes;
  const struct {
    std::uint64_t& address;
    const char* name;
    std::size_t offset;
  } planes[] = {{frame_.color_address, GRIDIRON_MEMBER(color_address)},
                {frame_.depth_address, GRIDIRON_MEMBER(depth_address)},
                {frame_.ids_address, GRIDIRON_MEMBER(ids_address)}};
  for (const auto& plane : planes) {
    refuses([&] { plane.address += 16; }, kGridironTransferAlignment, plane.name, plane.offset);
    // Right before and right behind the image is allowed, 32 bytes nearer is not.
    const std::uint64_t before = plane.address;
    for (const std::uint64_t address : {image - plane_bytes, image_end}) {
      plane.address = address;
      EXPECT_EQ(make_frame(), kGridironOk) << plane.name;
    }
    plane.address = before;
    for (const std::uint64_t address : {image - plane_bytes + 32, image, image_end - 32}) {
      refuses([&] { plane.address = address; }, kGridironBadFrame, plane.name, plane.offset);
    }
    // The last bytes of the address space are memory, and what lies behind them is not.
    plane.address = 0 - plane_bytes;
    EXPECT_EQ(make_frame(), kGridironOk) << plane.name;
    plane.address = before;
    refuses([&] { plane.address = 32 - plane_bytes; }, kGridironBadFrame, plane.name, plane.offset);
  }
  // Of two planes the later one is named.
  for (const std::uint64_t address : {place(color_), place(color_) + plane_bytes - 32}) {
    refuses([&] { frame_.depth_address = address; }, kGridironBadFrame, GRIDIRON_MEMBER(depth_address));
    refuses([&] { frame_.ids_address = address; }, kGridironBadFrame, GRIDIRON_MEMBER(ids_address));
  }
  refuses([&] { frame_.ids_address = frame_.depth_address; }, kGridironBadFrame, GRIDIRON_MEMBER(ids_address));
  refuses([&] { frame_.color_address = 0; }, kGridironBadFrame, GRIDIRON_MEMBER(color_address));
}

#undef GRIDIRON_MEMBER

TEST_F(CInterface, WrongParametersOfAFrameAreNamed) {
  const std::uint64_t at = reinterpret_cast<std::uintptr_t>(image_bytes_);
  const auto named = [](GridironStatus status, GridironStatus wanted, const GridironFault& fault, const char* field) {
    EXPECT_EQ(status, wanted) << field;
    EXPECT_STREQ(fault.field, field);
    EXPECT_EQ(fault.byte_offset, sizeof(GridironFrame)) << field;
  };
  GridironFault fault{};
  named(gridiron_make_frame(nullptr, &image_, at, record_, &fault), kGridironBadParameter, fault, "frame");
  named(gridiron_make_frame(&frame_, nullptr, at, record_, &fault), kGridironBadParameter, fault, "image");
  named(gridiron_make_frame(&frame_, &image_, at, nullptr, &fault), kGridironBadParameter, fault, "record");
  named(gridiron_make_frame(&frame_, &image_, at, record_ + 4, &fault), kGridironBadParameter, fault, "record");
  named(gridiron_make_frame(&frame_, &image_, at + 64, record_, &fault), kGridironTransferAlignment, fault,
        "image_address");
  named(gridiron_make_frame(&frame_, &image_, 0, record_, &fault), kGridironBadFrame, fault, "image_address");
  named(gridiron_make_frame(&frame_, &image_, std::uint64_t{0} - 128, record_, &fault), kGridironBadFrame, fault,
        "image_address");
  EXPECT_EQ(gridiron_make_frame(nullptr, &image_, at, record_, nullptr), kGridironBadParameter);
}

TEST_F(CInterface, AnImageThatTheLayoutDoesNotReadIsRefused) {
  const auto refused = [&] {
    GridironFault fault{};
    ASSERT_EQ(gridiron_count_image(&mesh_, &build_, &need_), kGridironOk);
    ASSERT_EQ(build(), kGridironOk);
    ASSERT_EQ(open(), kGridironOk);
    EXPECT_EQ(make_frame(&fault), kGridironUnsupportedImage);
    EXPECT_STREQ(fault.field, "image");
  };
  for (const std::uint32_t triangles : {gridiron_usual_build().leaf_triangles + 1, 16u}) {
    build_.leaf_triangles = triangles;
    refused();
  }
  build_ = gridiron_usual_build();
  build_.has_tree = false;
  build_.has_grid = true;
  refused();
}

TEST_F(CInterface, WrongMeshesAndSmallMemoryAreRefused) {
  const std::uint32_t beyond[3] = {0, 1, 3};
  mesh_.indices = beyond;
  EXPECT_EQ(gridiron_count_image(&mesh_, &build_, &need_), kGridironBadIndex);
  mesh_.indices = nullptr;
  EXPECT_EQ(gridiron_count_image(&mesh_, &build_, &need_), kGridironBadParameter);
  mesh_.indices = indices_;
  build_.leaf_triangles = 0;
  EXPECT_EQ(gridiron_count_image(&mesh_, &build_, &need_), kGridironBadParameter);
  build_ = gridiron_usual_build();
  const auto build_in = [&](std::uint64_t image, std::uint64_t scratch) {
    return gridiron_build_image(&mesh_, &build_, &need_, image_bytes_, image, scratch_, scratch);
  };
  EXPECT_EQ(build_in(need_.image_bytes - 1, sizeof scratch_), kGridironMemoryTooSmall);
  EXPECT_EQ(build_in(sizeof image_bytes_, need_.scratch_bytes - 1), kGridironMemoryTooSmall);
}

TEST_F(CInterface, ADamagedImageNamesItsField) {
  GridironFault fault{};
  image_bytes_[4] ^= 1;
  EXPECT_EQ(open(&fault), kGridironBadImage);
  EXPECT_STREQ(fault.field, "header.version");
  EXPECT_EQ(gridiron_open_image(image_bytes_ + 8, 128, &image_, nullptr), kGridironBadParameter);
}

TEST_F(CInterface, WhatTheFirmwareReturnsEndsTheFrame) {
  ASSERT_EQ(make_frame(), kGridironOk);
  for (std::uint32_t get = 1; get <= 3; ++get) {
    port.get_count = port.next_item = 0;
    port.failing_get = get;
    port.failure = kGridironTransferMainRange;
    EXPECT_EQ(render(), kGridironTransferMainRange) << "get " << get;
    // A number that is no status.
    port.get_count = port.next_item = 0;
    port.failure = static_cast<GridironStatus>(30);
    EXPECT_EQ(render(), kGridironTransferFailed) << "get " << get;
  }
  port.failing_get = 0;
  port.end = kGridironClaimAborted;
  EXPECT_EQ(render(), kGridironAborted);
  port.end = kGridironClaimDeadline;
  EXPECT_EQ(render(), kGridironDeadline);
  for (const int number : {4, 255, -1}) {
    port.end = static_cast<GridironClaim>(number);
    EXPECT_EQ(render(), kGridironBadParameter) << number;
  }
  // Items that the frame does not have: it has four. The last one is that of a port which forgets to write it.
  port.end = kGridironClaimNone;
  for (const std::uint32_t item : {4u, 0x7FFFFFFFu, 0xFFFFFFFEu, 0xFFFFFFFFu}) {
    port.next_item = item;
    port.item_count = 0;
    EXPECT_EQ(render(), kGridironBadFrame) << item;
  }
  port.next_item = 0;
  port.item_count = 1;
  port.writes_item = false;
  EXPECT_EQ(render(), kGridironBadFrame);
  EXPECT_EQ(gridiron_render(0, store_ + 16, reinterpret_cast<std::uintptr_t>(record_), 0, 0), kGridironBadParameter);
}

TEST(CStatus, HasTheNumbersAndATextOfEveryStatus) {
  const std::uint32_t count = kGridironBadEffects + 1;
  EXPECT_EQ(gridiron::status_name(count), nullptr);
  std::vector<std::string> texts;
  for (std::uint32_t number = 0; number < count; ++number) {
    ASSERT_NE(gridiron::status_name(number), nullptr);
    texts.emplace_back(gridiron_status_text(static_cast<GridironStatus>(number)));
    EXPECT_NE(texts.back(), "unknown status") << number;
    for (std::uint32_t other = 0; other < number; ++other) EXPECT_NE(texts[other], texts.back());
  }
}

}  // namespace
