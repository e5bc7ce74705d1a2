// animate: the pictures of an animation, what they cost, and a film. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "animate/frame_figures.h"
#include "animate/frame_log.h"
#include "animate/frame_maker.h"
#include "animate/frame_sharing.h"
#include "base/content_hash.h"
#include "base/failure.h"
#include "base/numbers.h"
#include "base/progress.h"
#include "base/ranks.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "files/film_file.h"
#include "files/output_folder.h"
#include "gridiron/device/machine_file.h"
#include "gridiron/frame/unseen_scene.h"

namespace gridiron::tool {
namespace {

constexpr const char* kTableName = "animation.csv";
constexpr const char* kPassesName = "animation_passes.csv";
constexpr const char* kPlotName = "animation.svg";
constexpr const char* kLogName = "animation.log";

std::vector<std::string> names_of(const FrameMaker& maker) {
  std::vector<std::string> names = {kTableName, kPassesName, kPlotName, kLogName};
  for (std::size_t i = 0; i < maker.count(); ++i) names.push_back(maker.picture_of(i));
  return names;
}

// Nothing but a file: a folder or a link of that name is somebody else's.
void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(path, error))) {
    std::filesystem::remove(path, error);
  }
}

// The options that results depend on; a machine by its content.
std::map<std::string, std::string> settings_of(const AnimateRequest& request) {
  std::map<std::string, std::string> settings = request.options;
  const sim::MachineProfile& machine = *request.render.scene.machine;
  const std::string text = machine_text(machine);
  settings["--machine"] = std::string(machine.name) + " " + shortest_text(content_hash(std::as_bytes(std::span(text))));
  return settings;
}

// The pictures and figures of one command.
class Animation {
 public:
  explicit Animation(const AnimateRequest& request)
      : request_(request),
        maker_(make_frame_maker(request)),
        log_(request.output / kLogName, settings_of(request)),
        figures_(maker_->count()) {}

  [[nodiscard]] FrameMaker& maker() { return *maker_; }

  // Takes over the complete frames of an earlier command.
  void resume();
  void render();
  void write_table(bool is_last) const;
  void write_film() const;
  void print() const;

 private:
  [[nodiscard]] std::filesystem::path picture_path(std::size_t i) const {
    return request_.output / maker_->picture_of(i);
  }
  [[nodiscard]] std::vector<NamedFrame> named_frames() const;
  void write_frame(std::size_t i, const MadeFrame& made);

  const AnimateRequest& request_;
  std::unique_ptr<FrameMaker> maker_;
  FrameLog log_;
  std::vector<std::optional<FrameFigures>> figures_;
};

void Animation::resume() {
  const bool quiet = request_.render.scene.quiet;
  const bool exists = log_.exists();
  std::size_t kept = 0;
  if (exists) {
    const std::map<std::size_t, LoggedFrame> frames = log_.read();
    for (const auto& [i, frame] : frames) {
      const std::string words = "frame " + std::to_string(i);
      if (i >= maker_->count()) {
        log_.refuse(frame.line, words + " was one of it; now there are " + words_of_count(maker_->count(), "frame"));
      }
      const FrameSource source = maker_->source_of(i);
      if (source.content != frame.source.content) {
        log_.refuse(frame.line, words + ": " + maker_->input_of(i).string() + " has changed, or a file that it names");
      }
      if (source.view != frame.source.view) log_.refuse(frame.line, words + " has another view now");
      const std::optional<std::vector<std::byte>> picture = read_back(picture_path(i));
      if (!picture || content_hash(*picture) != frame.picture) {
        log_.drop(i);
        continue;
      }
      figures_[i] = frame.figures;
      ++kept;
    }
  }
  if (quiet) return;
  std::fprintf(stderr, "%s: %s of %s complete\n", (request_.output / kLogName).c_str(), words_of_count(kept).c_str(),
               words_of_count(maker_->count(), "picture").c_str());
}

void Animation::render() {
  Progress progress(!request_.render.scene.quiet, "frames");
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    if (!figures_[i]) missing.push_back(i);
  }
  missing = share_frame_numbers(std::move(missing));
  std::size_t done = 0;
  const auto take = [&](std::size_t i, const MadeFrame& made) {
    progress.wipe();
    write_frame(i, made);
    std::fputs(made.notes.c_str(), stderr);
    tell_note(maker_->input_of(i), made.note);
    ++done;
  };
  FrameArrivals arrivals(take);
  if (!missing.empty()) maker_->begin();
  for (std::uint64_t k = 0; k < ranks().share_of(missing.size()); ++k) {
    const std::size_t i = missing[ranks().piece(k)];
    progress.wipe();  // notes may come
    take(i, maker_->make(i, request_.timeline && i == 0, [&](double share) {
      arrivals.take_arrived();
      progress.update(done, missing.size(), share + arrivals.parts());
    }));
  }
  while (done < missing.size()) {
    arrivals.take_next();
    progress.update(done, missing.size(), arrivals.parts());
  }
  log_.put_in_order();
}

// At any moment the log names no picture that is not complete: a picture has its line last, and its hash is there.
void Animation::write_frame(std::size_t i, const MadeFrame& made) {
  log_.begin();
  AtomicFiles file;
  file.add(picture_path(i), made.png);
  if (!made.timeline.empty()) file.add(*request_.timeline, made.timeline);
  file.commit();
  log_.add(i, {.line = 0, .source = made.source, .picture = content_hash(made.png), .figures = made.figures});
  figures_[i] = made.figures;
}

std::vector<NamedFrame> Animation::named_frames() const {
  std::vector<NamedFrame> frames;
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    frames.push_back({maker_->input_of(i).filename().string(), maker_->picture_of(i), *figures_[i]});
  }
  return frames;
}

void Animation::write_table(bool is_last) const {
  AtomicFiles table;
  const std::vector<NamedFrame> frames = named_frames();
  table.add(request_.output / kTableName, table_of(frames, *request_.render.scene.machine));
  const std::string passes = passes_of(frames), plot = plot_of(frames);
  if (!passes.empty()) table.add(request_.output / kPassesName, passes);
  if (!plot.empty()) table.add(request_.output / kPlotName, plot);
  if (is_last) {
    table.commit_at_end();
  } else {
    table.commit();
  }
  // Those of an earlier command would be of other frames than the table.
  if (passes.empty()) remove_file(request_.output / kPassesName);
  if (plot.empty()) remove_file(request_.output / kPlotName);
}

void Animation::write_film() const {
  AtomicFiles files;
  {
    FilmMaker film(files.begin(*request_.film), request_.frames_per_second.value_or(kUsualFramesPerSecond));
    Progress progress(!request_.render.scene.quiet, "frames of the film");
    for (std::size_t i = 0; i < figures_.size(); ++i) {
      progress.update(i, figures_.size());
      const std::optional<std::vector<std::byte>> picture = read_back(picture_path(i));
      if (!picture) input_error(picture_path(i), "cannot be read for the film");
      film.add(*picture);
    }
    film.finish();
  }
  files.commit_at_end();
}

void Animation::print() const {
  const RenderRequest& render = request_.render;
  print_frames(named_frames(), *render.scene.machine, render.cores.value_or(render.scene.machine->core_count),
               maker_->single_build());
}

}  // namespace

void run_command(const AnimateRequest& request) {
  require_shared_inputs(request);
  if (!ranks().is_first()) return render_frames_for_first(request);
  if (request.film) require_ffmpeg(*request.film);
  Animation animation(request);
  OutputFolder folder(request.output, names_of(animation.maker()));
  std::vector<Output> outputs;
  if (request.film) outputs.push_back({"--film", *request.film, OutputKind::kFilm});
  if (request.timeline) outputs.push_back({"--timeline", *request.timeline, OutputKind::kText});
  declare_outputs(outputs);
  {
    const StageLines stages(!request.render.scene.quiet);
    animation.maker().prepare();
    if (request.resume) animation.resume();
  }
  animation.render();
  animation.write_table(/*is_last=*/!request.film);
  folder.keep();
  if (request.film) animation.write_film();
  if (!request.render.scene.quiet) animation.print();
}

}  // namespace gridiron::tool
