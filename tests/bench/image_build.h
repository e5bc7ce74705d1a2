// The build of the image of configuration `best`, by parts. Memory: owns image and working memory. Threads: those of
// its sharing.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>

#include "core/build/grid/line_buffer.h"

namespace gridiron::bench {

/// What `gridiron render` builds for configuration `best`: the tree alone, with leaves of 16.
inline constexpr GridParameters kBestParameters = {.leaf_triangles = kMaxTreeLeaf, .has_tree = true, .has_grid = false};

/// Everything from vertices and indices to a frame that may start: count, build, open; in memory that is there.
class ImageBuild {
 public:
  explicit ImageBuild(const MeshView& mesh, const GridParameters& parameters = kBestParameters,
                      const WorkSharing& sharing = {})
      : mesh_(mesh), parameters_(parameters), sharing_(sharing) {
    count();
    if (status_ != Status::kOk) return;
    image_ = test::LineBuffer(static_cast<std::size_t>(need_.image_bytes));
    scratch_ = test::LineBuffer(static_cast<std::size_t>(need_.scratch_bytes));
  }

  void run() {
    count();
    build();
    open();
  }
  // Its parts, in this order.
  void count() { take(count_scene_image(mesh_, parameters_, need_, nullptr, kAnyImageBytes, {}, sharing_)); }
  void build() {
    if (status_ != Status::kOk) return;
    take(build_scene_image(mesh_, parameters_, need_, image_.bytes(), scratch_.bytes(), nullptr, sharing_));
  }
  void open() {
    SceneImageError error;
    if (status_ == Status::kOk) take(open_scene_image(image_.bytes(), view_, error, sharing_));
  }

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] const GridNeed& need() const { return need_; }
  [[nodiscard]] const std::byte* image() const { return image_.bytes().data(); }
  /// Precondition: open() was called.
  [[nodiscard]] const SceneImageView& view() const { return view_; }

 private:
  void take(Status status) {
    if (status_ == Status::kOk) status_ = status;
  }

  MeshView mesh_;
  GridParameters parameters_;
  WorkSharing sharing_;
  GridNeed need_{};
  test::LineBuffer image_, scratch_;
  SceneImageView view_{};
  Status status_ = Status::kOk;
};

}  // namespace gridiron::bench
