// Camera move: an animation of one scene, whose image is built once. SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <span>
#include <utility>

#include "base/failure.h"
#include "base/ranks.h"
#include "base/value_bytes.h"
#include "files/input_file.h"
#include "frame_maker.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/frame/shared_frame.h"
#include "gridiron/frame/view_bounds.h"
#include "gridiron/scene/camera_path.h"
#include "gridiron/scene/scene_points.h"

namespace gridiron::tool {
namespace {

PointSource points_of(const SceneInput& input) {
  return [&input](const PointVisitor& visitor) {
    if (const PackedScene* const packed = std::get_if<PackedScene>(&input.content)) {
      visit_points(packed->view, packed->file.bytes, visitor);
    } else {
      visit_points(std::get<Mesh>(input.content).view(), visitor);
    }
  };
}

class CameraMove final : public FrameMaker {
 public:
  CameraMove(const AnimateRequest& request, const std::filesystem::path& input) : animate_(request) {
    request_ = request.render;
    request_.scene.input = input;
    if (ranks().is_first()) check_foreseen(request, input);
    if (request.path) path_ = read_camera_path(*request.path);
  }

  [[nodiscard]] std::size_t count() const override { return path_ ? path_->frame_count() : *animate_.turntable; }
  [[nodiscard]] std::filesystem::path input_of(std::size_t) const override { return request_.scene.input; }
  [[nodiscard]] std::string picture_of(std::size_t i) const override { return numbered_picture(i, count()); }

  void prepare() override;
  void begin() override;
  [[nodiscard]] FrameSource source_of(std::size_t i) override {
    return {content_, hash_of_view(camera(i), frame_.plan.width, frame_.plan.height)};
  }
  [[nodiscard]] MadeFrame make(std::size_t i, bool has_timeline, const FrameProgress& progress) override;
  [[nodiscard]] std::optional<SingleBuild> single_build() const override { return build_; }

 private:
  [[nodiscard]] Camera camera(std::size_t i) const {
    return camera_of(views_[i], frame_.plan.width, frame_.plan.height);
  }
  void read();
  void build();

  const AnimateRequest& animate_;
  RenderRequest request_;
  std::optional<CameraPath> path_;
  std::vector<ViewRequest> views_;
  std::uint64_t content_ = 0;
  RequestedFrame frame_;
  SingleBuild build_;
  std::optional<FrameMemory> memory_;  // once frames are rendered
};

// Rank 0 alone reads the scene; the others take what it found, and its memory in begin().
void CameraMove::prepare() {
  Bytes bytes;
  if (ranks().is_first()) {
    read();
    ByteWriter writer;
    add_plan(writer, frame_.plan);
    writer.add(content_);
    writer.add(views_);
    bytes = writer.take();
  }
  ranks().broadcast(bytes);
  if (ranks().is_first()) return;
  ByteReader reader(bytes);
  frame_.plan = take_plan(reader, request_);
  reader.take(content_);
  reader.take(views_);
}

void CameraMove::begin() {
  if (ranks().is_first()) build();
  share_frame(memory_);
}

void CameraMove::read() {
  PictureRequest picture{request_.view, std::nullopt, request_.size};
  if (request_.camera) picture.camera = read_camera_file(*request_.camera);
  const InputHash hash;
  SceneInput input =
      read_scene_input(request_.scene.input, request_.scene.tolerance, picture, kSceneExpected, request_.scene.model);
  content_ = hash.value();
  if (path_) {
    views_ = views_of_path(*path_, request_.view);
  } else {
    require_renderable(input);
    picture = complete_request(picture, input.text ? input.text->view : SceneView{});
    const double aspect = static_cast<double>(picture.size->x) / picture.size->y;
    views_ =
        views_of_turntable(join_view(picture.view, *picture.camera), *animate_.turntable, aspect, points_of(input));
  }
  request_.view = views_.front();
  frame_ = complete_frame(request_, std::move(input), std::nullopt);
  take_grid_without_bounds(request_, frame_, views_);
  tell_frame_notes(request_, frame_);
  const bool is_packed = std::holds_alternative<PackedScene>(frame_.input.content);
  if (!is_packed) choose_builder(animate_, frame_.plan);
  if (!is_packed) build_.structure = frame_.plan.engine == EngineId::kTree ? "tree" : "grid";
}

void CameraMove::build() {
  memory_.emplace(frame_memory_bytes(frame_.input, frame_.plan));
  // The first view without bounds, if there is one, so that the note about it is printed.
  const std::size_t view = frame_.plan.engine == EngineId::kTree
                               ? find_view_without_bounds(frame_.input, frame_.plan, views_).value_or(0)
                               : 0;
  if (std::holds_alternative<PackedScene>(frame_.input.content)) {
    prepare_frame(*memory_, std::move(frame_.input), frame_.plan, views_[view]);
  } else {
    std::optional<VertexOrder> order;
    if (!animate_.keeps_vertex_order) memory_->vertex_order = &order;
    prepare_frame(*memory_, frame_.input, frame_.plan, views_[view]);
    if (frame_.plan.mode != sim::Mode::kPlain) build_.cost = cost_of_build(frame_.input, *memory_, frame_.plan);
  }
}

MadeFrame CameraMove::make(std::size_t i, bool has_timeline, const FrameProgress& progress) {
  aim_camera(*memory_, camera(i), request_.scene.input);
  MadeFrame made = render_frame(*memory_, frame_.plan, content_, BuildCost{}, has_timeline, progress);
  if (made.note) made.note = "frame " + std::to_string(i) + ": " + *made.note;
  return made;
}

}  // namespace

std::unique_ptr<FrameMaker> make_camera_move(const AnimateRequest& request, const std::filesystem::path& input) {
  return std::make_unique<CameraMove>(request, input);
}

}  // namespace gridiron::tool
