// Series: an animation with a mesh or text scene for each frame. SPDX-License-Identifier: Apache-2.0
#include <set>
#include <span>
#include <utility>

#include "base/content_hash.h"
#include "base/failure.h"
#include "base/ranks.h"
#include "files/command_files.h"
#include "files/input_file.h"
#include "files/interrupt.h"
#include "frame_maker.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/scene/scene_points.h"

namespace gridiron::tool {
namespace {

constexpr const char* kExpected =
    "animate takes meshes (PLY, OBJ, STL, glTF), text scenes (NFF), and folders of either";

struct SeriesFrame {
  std::filesystem::path input;
  std::string picture{};
  SceneKind kind = SceneKind::kUnknown;  ///< as foreseen
  std::optional<SceneInput> scene{};     ///< of a stream, which is read once
  std::optional<double> moment{};        ///< of its animation, 0..1
  bool is_read = false;                  ///< content and own are known
  std::uint64_t content = 0;
  SceneView own{};                      ///< of a text scene
  std::optional<ViewRequest> framed{};  ///< the common view, of frames without one of their own
};

class Series final : public FrameMaker {
 public:
  Series(const AnimateRequest& request, std::vector<std::filesystem::path> inputs)
      : animate_(request), request_(request.render) {
    if (animate_.animation) inputs = std::vector<std::filesystem::path>(*animate_.animation, inputs.front());
    std::set<SceneKind> kinds;
    std::set<std::string> pictures;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      SeriesFrame frame{.input = std::move(inputs[i])};
      frame.kind = foreseen_kind(frame.input);
      require_kind(frame.input, frame.kind == SceneKind::kPacked);
      if (kinds.insert(frame.kind).second) check_foreseen(animate_, frame.input);
      if (animate_.animation) frame.moment = inputs.size() == 1 ? 0.0 : double(i) / double(inputs.size() - 1);
      const bool has_number = frame.moment || is_descriptor(frame.input);
      frame.picture = has_number ? numbered_picture(i, inputs.size()) : frame.input.stem().string() + ".png";
      if (!pictures.insert(frame.picture).second) usage_error("two frames would be called " + frame.picture);
      frames_.push_back(std::move(frame));
    }
  }

  [[nodiscard]] std::size_t count() const override { return frames_.size(); }
  [[nodiscard]] std::filesystem::path input_of(std::size_t i) const override { return frames_[i].input; }
  [[nodiscard]] std::string picture_of(std::size_t i) const override { return frames_[i].picture; }

  void prepare() override;
  [[nodiscard]] FrameSource source_of(std::size_t i) override;
  [[nodiscard]] MadeFrame make(std::size_t i, bool has_timeline, const FrameProgress& progress) override;

 private:
  static void require_kind(const std::filesystem::path& input, bool is_packed) {
    if (is_packed) input_error(input, std::string("is a packed scene; ") + kExpected);
  }

  [[nodiscard]] SceneInput read(SeriesFrame& frame) const;
  // Reads a frame to know its content, view and size.
  void look_at(SeriesFrame& frame) const;
  // The request's parts of a frame's picture, completed by the scene's own.
  [[nodiscard]] PictureRequest picture_for(const SeriesFrame& frame) const;
  [[nodiscard]] ViewRequest view_of(const SeriesFrame& frame) const;
  void require_size(const SeriesFrame& frame);
  void frame_together();
  [[nodiscard]] PointSource points_of(const std::vector<SeriesFrame*>& frames);

  const AnimateRequest& animate_;
  const RenderRequest& request_;
  std::optional<ViewRequest> camera_;
  std::vector<SeriesFrame> frames_;
  std::optional<CountPair> size_;            // of all pictures
  std::optional<LookBounds> bounds_;         // of all frames, where they have a look: its ground stays where it is
  bool has_told_ = !ranks().is_first();      // what is said of the first frame alone
  std::optional<VertexOrder> vertex_order_;  // meshes of one topology have one
};

SceneInput Series::read(SeriesFrame& frame) const {
  if (frame.scene) return *std::exchange(frame.scene, std::nullopt);
  stop_if_interrupted();
  const InputHash hash;
  ImportOptions model = request_.scene.model;
  model.moment = frame.moment;
  model.animation = animate_.clip;
  SceneInput input = read_scene_input(frame.input, request_.scene.tolerance,
                                      PictureRequest{request_.view, camera_, request_.size}, kExpected, model);
  if (frame.moment && (!input.model || input.model->animations.empty())) {
    input_error(frame.input, "has no animation, which --animation shows");
  }
  require_kind(frame.input, std::holds_alternative<PackedScene>(input.content));
  frame.content = hash.value();
  frame.own = input.text ? input.text->view : SceneView{};
  frame.is_read = true;
  return input;
}

void Series::look_at(SeriesFrame& frame) const {
  if (frame.is_read) return;
  SceneInput input = read(frame);
  if (is_stream(frame.input)) frame.scene = std::move(input);
}

PictureRequest Series::picture_for(const SeriesFrame& frame) const {
  return complete_request({frame.framed.value_or(request_.view), camera_, request_.size}, frame.own);
}

ViewRequest Series::view_of(const SeriesFrame& frame) const {
  const PictureRequest picture = picture_for(frame);
  return join_view(picture.view, *picture.camera);
}

void Series::require_size(const SeriesFrame& frame) {
  const CountPair size = *picture_for(frame).size;
  if (!size_) size_ = size;
  if (size.x == size_->x && size.y == size_->y) return;
  const auto words = [](const CountPair& pair) { return std::to_string(pair.x) + "x" + std::to_string(pair.y); };
  input_error(frame.input, "its picture has " + words(size) + " pixels, those of other frames have " + words(*size_) +
                               "; --size gives all frames one size");
}

void Series::prepare() {
  // Noted before any picture is written, because a picture must not overwrite a later frame's mesh.
  for (const SeriesFrame& frame : frames_) note_input(frame.input);
  if (request_.camera) camera_ = read_camera_file(*request_.camera);
  const ViewRequest given = join_view(request_.view, camera_.value_or(ViewRequest{}));
  const bool is_given = given.eye && given.at;
  for (SeriesFrame& frame : frames_) {
    // A mesh has no view and no size; a stream need not be read yet if the view is given.
    if (frame.kind == SceneKind::kText || (frame.kind == SceneKind::kUnknown && !is_given)) look_at(frame);
    if (frame.is_read || frame.kind == SceneKind::kMesh) require_size(frame);
  }
  frame_together();
  if (!request_.scene.look.is_given()) return;
  const Vec3 up = join_view(request_.view, camera_.value_or(ViewRequest{})).up.value_or(kUsualUp);
  std::vector<SeriesFrame*> frames;
  for (SeriesFrame& frame : frames_) frames.push_back(&frame);
  bounds_ = look_bounds_of(points_of(frames), up);
}

PointSource Series::points_of(const std::vector<SeriesFrame*>& frames) {
  return [this, frames](const PointVisitor& visitor) {
    for (SeriesFrame* const frame : frames) {
      SceneInput input = read(*frame);
      require_renderable(input);
      visit_points(std::get<Mesh>(input.content).view(), visitor);
      if (is_stream(frame->input)) frame->scene = std::move(input);
    }
  };
}

void Series::frame_together() {
  std::vector<SeriesFrame*> unframed;
  for (SeriesFrame& frame : frames_) {
    const ViewRequest view = view_of(frame);
    if (!view.eye || !view.at) unframed.push_back(&frame);
  }
  if (unframed.empty()) return;
  ViewRequest view = look_view(request_.scene.look, view_of(*unframed.front()));
  const Camera camera = complete_view(view, static_cast<double>(size_->x) / size_->y, points_of(unframed));
  view.eye = camera.eye;
  view.at = camera.at;
  view.up = camera.up;
  view.from.reset();
  for (SeriesFrame* const frame : unframed) frame->framed = view;
}

FrameSource Series::source_of(std::size_t i) {
  SeriesFrame& frame = frames_[i];
  look_at(frame);
  const CountPair size = *picture_for(frame).size;
  std::uint64_t view = hash_of_view(camera_of(view_of(frame), size.x, size.y), size.x, size.y);
  if (bounds_) {  // another frame may move the ground
    const double places[] = {bounds_->low.x,  bounds_->low.y,  bounds_->low.z,  bounds_->high.x,
                             bounds_->high.y, bounds_->high.z, bounds_->lowest, static_cast<double>(view >> 11)};
    view = content_hash(std::as_bytes(std::span(places)));
  }
  return {frame.content, view};
}

MadeFrame Series::make(std::size_t i, bool has_timeline, const FrameProgress& progress) {
  SeriesFrame& frame = frames_[i];
  SceneInput input = read(frame);
  require_size(frame);
  RenderRequest request = request_;
  request.scene.input = frame.input;
  request.view = frame.framed.value_or(request_.view);
  RequestedFrame requested = complete_frame(request, std::move(input), camera_, bounds_ ? &*bounds_ : nullptr);
  choose_builder(animate_, requested.plan);
  if (has_told_ && !frame.moment && !request.scene.quiet) {
    // Meshes of this program's own format lose nothing that would differ from frame to frame.
    tell_notes(requested.input, /*tells_model=*/requested.input.model && !requested.input.model->reader.empty());
  }
  if (!std::exchange(has_told_, true)) tell_frame_notes(request, requested);
  FrameMemory memory(frame_memory_bytes(requested.input, requested.plan));
  if (!animate_.keeps_vertex_order) memory.vertex_order = &vertex_order_;
  prepare_frame(memory, requested.input, requested.plan, requested.view);
  const std::optional<BuildCost> build =
      requested.plan.mode == sim::Mode::kPlain ? std::nullopt : cost_of_build(requested.input, memory, requested.plan);
  return render_frame(memory, requested.plan, frame.content, build, has_timeline, progress);
}

}  // namespace

std::unique_ptr<FrameMaker> make_series(const AnimateRequest& request, std::vector<std::filesystem::path> inputs) {
  return std::make_unique<Series>(request, std::move(inputs));
}

}  // namespace gridiron::tool
