// gridiron/c/gridiron.h as C++20 sees it: what it refuses, in which words, and what it passes on from the firmware.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/c/gridiron.h>
#include <gridiron/platform/status_name.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
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
  *item = port.next_item++;
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
  GridironStatus make_frame() {
    return gridiron_make_frame(&frame_, &image_, reinterpret_cast<std::uintptr_t>(image_bytes_), record_);
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
  alignas(128) unsigned char record_[512];
  alignas(128) unsigned char store_[16384];
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
  EXPECT_LE(sizes.store_bytes + sizes.stack_budget_bytes, sizes.arena_bytes);
  EXPECT_LE(sizes.code_budget_bytes, sizes.code_memory_bytes);
  EXPECT_EQ(sizes.arena_bytes, 16384u);
  EXPECT_EQ(gridiron_plane_bytes(17, 9), 4u * 24 * 16);
  EXPECT_EQ(gridiron_tile_count(17, 9), 6u);
}

TEST_F(CInterface, WrongParametersHaveAStatusAndAText) {
  const auto refuses = [&](auto change, GridironStatus wanted, const std::string& words) {
    const GridironFrame before = frame_;
    change();
    const GridironStatus status = make_frame();
    EXPECT_EQ(status, wanted);
    EXPECT_NE(std::string(gridiron_status_text(status)).find(words), std::string::npos) << gridiron_status_text(status);
    frame_ = before;
  };
  refuses([&] { frame_.width = 0; }, kGridironBadFrame, "size");
  refuses([&] { frame_.color_address = 0; }, kGridironBadFrame, "plane");
  refuses([&] { frame_.color_address += 4; }, kGridironTransferAlignment, "misaligned");
  refuses([&] { std::memcpy(frame_.at, frame_.eye, sizeof frame_.at); }, kGridironBadFrame, "camera");
  refuses([&] { frame_.accuracy = static_cast<GridironAccuracy>(7); }, kGridironUnsupportedFrame, "not built");
  refuses([&] { frame_.accuracy = kGridironAccuracyCompact; }, kGridironUnsupportedImage, "lacks");
  EXPECT_EQ(gridiron_make_frame(nullptr, &image_, 0, record_), kGridironBadParameter);
  EXPECT_EQ(gridiron_make_frame(&frame_, &image_, 0, record_ + 4), kGridironBadParameter);
  EXPECT_STREQ(gridiron_status_text(static_cast<GridironStatus>(31)), "unknown status");
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
  port.next_item = 0;
  port.item_count = 5;  // of four
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
