#include "run/results/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "domain/together.hpp"
#include "exec/error.hpp"

namespace breccia {
namespace {

namespace fs = std::filesystem;

Schedule row_schedule(const CaseConfig& config) {
  if (config.output.history > 0.0) return {config.output.history, 1.0};
  return {config.time.end, 1000.0};
}

Schedule frame_schedule(const CaseConfig& config) {
  if (config.output.frames == 0) return {};
  return {config.time.end, static_cast<double>(config.output.frames)};
}

/// Removes the pictures numbered `first` and later.
void drop_pictures(const std::string& folder, std::int64_t first) {
  std::error_code error;
  std::vector<fs::path> later;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string stem = entry.path().stem().string();
    std::int64_t number = 0;
    const auto [end, problem] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    if (problem == std::errc{} && *end == '\0' && number >= first) later.push_back(entry.path());
  }
  for (const fs::path& path : later) fs::remove(path, error);
}

ProbeRange fresh_range(const std::string& name) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {name, 0.0, infinity, -infinity};
}

}  // namespace

void Schedule::pass(double time) {
  if (time < next_) return;
  if (std::isinf(end_)) {
    next_ = end_;
    return;
  }
  const auto moment = [this](double k) { return k / count_ * end_; };
  // The quotient may be off by a rounding, so the search starts below it.
  double k = std::max(0.0, std::floor(time / end_ * count_) - 2.0);
  constexpr double most_counted = 1e15;  // beyond, k + 1 may be k
  if (!(k < most_counted)) {
    next_ = std::nextafter(time, std::numeric_limits<double>::infinity());
    return;
  }
  while (moment(k) <= time) k += 1.0;
  next_ = moment(k);
}

void RecordState::save(CheckpointWriter& writer) const {
  writer.value("run.row_step", row_step);
  writer.value("run.frame_step", frame_step);
  writer.value("run.frame_time", frame_time);
  writer.value("run.frames", frames);
  if (extent) writer.value("run.extent", *extent);
  if (first) writer.value("run.first_extent", *first);
  writer.value("run.height", height);
  writer.value("run.energy_watch", unbalanced);
  writer.value("run.energy_watch_from", unbalanced_from);
  writer.value("run.moving", moving);
  std::vector<double> ranges;
  for (const ProbeRange& probe : probes)
    ranges.insert(ranges.end(), {probe.last, probe.min, probe.max});
  writer.section("run.probes", ranges.data(), ranges.size(), sizeof(double));
}

void RecordState::load(const CheckpointReader& reader) {
  row_step = reader.value<std::int64_t>("run.row_step");
  frame_step = reader.value<std::int64_t>("run.frame_step");
  frame_time = reader.value<double>("run.frame_time");
  frames = reader.value<std::int64_t>("run.frames");
  if (reader.has("run.extent")) extent = reader.value<Extent>("run.extent");
  first = extent;
  if (reader.has("run.first_extent")) first = reader.value<Extent>("run.first_extent");
  if (reader.has("run.height")) height = reader.value<std::int64_t>("run.height");
  if (reader.has("run.energy_watch"))
    unbalanced = reader.value<EnergyWatch::Rows>("run.energy_watch");
  if (reader.has("run.energy_watch_from"))
    unbalanced_from = reader.value<double>("run.energy_watch_from");
  if (reader.has("run.moving")) moving = reader.value<KineticShare>("run.moving");
  const CheckpointReader::Section& ranges = reader.section("run.probes", sizeof(double));
  probes.resize(ranges.count / 3);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    std::array<double, 3> range{};
    std::copy_n(ranges.bytes.data() + i * sizeof(range), sizeof(range),
                reinterpret_cast<std::byte*>(range.data()));
    probes[i].last = range[0];
    probes[i].min = range[1];
    probes[i].max = range[2];
  }
}

Recorder::Recorder(const CaseConfig& config, const std::vector<StageEnd>& stages,
                   Communicator* ranks)
    : config_(config),
      stages_(stages),
      ranks_(ranks),
      rows_(row_schedule(config)),
      frames_(frame_schedule(config)),
      format_(frame_format(config.output.format)),
      watch_(config.energy) {
  for (const double step : config_.output.picture_steps)
    picture_steps_.push_back(static_cast<std::int64_t>(std::min(std::ceil(step), 9e15)));
  std::sort(picture_steps_.begin(), picture_steps_.end());
  for (const ProbeConfig& probe : config_.probes) state_.probes.push_back(fresh_range(probe.name));
}

void Recorder::resume(const RecordState& state, double time, std::int64_t step) {
  state_ = state;
  watch_ = EnergyWatch(config_.energy, state.unbalanced, state.unbalanced_from);
  state_.probes.resize(config_.probes.size());
  for (std::size_t i = 0; i < config_.probes.size(); ++i)
    state_.probes[i].name = config_.probes[i].name;
  if (state_.row_step >= 0) rows_.pass(time);
  if (state_.frame_step >= 0) frames_.pass(time);
  frame_count_ = state_.frames;
  resumed_from_ = step;
}

void Recorder::open(const ResultFolder& folder, Log& log) {
  log_ = &log;
  pictures_ = folder.file("pictures");
  const std::string history = folder.file("history.csv");
  if (resumed_from_) {
    const std::int64_t last = History::cut_to(history, state_.row_step);
    if (last < state_.row_step)
      log.warn("history", *resumed_from_,
               fmt::format("history.csv has lost its rows from step {} to step {}, which the "
                           "checkpoint has seen: curves and sentences about this run lack them",
                           last + 1, state_.row_step));
  }
  history_.emplace(history, config_.probes, config_.method == "fdem2d", !stages_.empty());
  if (config_.output.step_times) {
    const std::string steps = folder.file("steps.csv");
    if (resumed_from_) History::cut_to(steps, *resumed_from_);
    steps_.emplace(steps);
  }
  if (config_.output.fields && state_.frames > 0)
    series_ = ParaviewSeries::resumed(folder.path(), state_.frame_time, format_);
  else if (config_.output.fields)
    series_.emplace(folder.path(), format_);
  if (!config_.output.pictures && picture_steps_.empty()) return;
  make_folder(pictures_);
  if (resumed_from_ && config_.output.pictures) drop_pictures(pictures_, state_.frames);
}

bool Recorder::is_picture_step(std::int64_t step) const {
  return std::binary_search(picture_steps_.begin(), picture_steps_.end(), step);
}

std::int64_t Recorder::next_step(std::int64_t step) const {
  if (config_.output.step_times) return step + 1;
  const auto next = std::upper_bound(picture_steps_.begin(), picture_steps_.end(), step);
  return next == picture_steps_.end() ? std::numeric_limits<std::int64_t>::max() : *next;
}

/// Rank 0 judges energies: of those that end the run it is told which element moves fastest.
template <class Work>
void Recorder::naming_fastest(Method& method, const Work& work) const {
  try {
    on_first(ranks_, work);
  } catch (const NumericsError& error) {
    if (!thrown_by_all(ranks_)) throw;
    std::string fastest;
    at_once(ranks_, [&] { fastest = method.fastest(); });
    throw NumericsError(fastest.empty() ? error.what()
                                        : fmt::format("{}; {}", error.what(), fastest));
  }
}

void Recorder::note_step(const StepRow& row) {
  if (steps_) steps_->write(row);
}

void Recorder::record(Method& method, Background& background) {
  const double time = method.time();
  if (time < rows_.next()) {
    method.verify();
  } else {
    write_row(method);  // which verifies
    naming_fastest(method, [&] {
      if (watch_.look(*last_energy_, method.steps(), time))
        log_->warn(
            "step", method.steps(),
            fmt::format("energies do not add up: error_relative has been above {} for {} rows, "
                        "and is {:.2g}; a smaller time.safety may help",
                        config_.energy.warn, EnergyWatch::patience, last_energy_->error_relative));
      if (watch_.contacts_gave(*last_energy_))
        log_->warn("step", method.steps(),
                   fmt::format("contacts have given out {:.2g} % of the largest energy there was, "
                               "beyond what they took up; what follows is doubtful. A finer mesh "
                               "or a smaller time.safety may help",
                               100.0 * last_energy_->contact_relative));
      state_.unbalanced = watch_.rows();
      state_.unbalanced_from = watch_.began();
      state_.moving.look(*last_energy_);
    });
    rows_.pass(time);
    state_.row_step = method.steps();
  }
  if (time >= frames_.next()) {
    if (wants_frames()) write_frame(method, Then::steps, background);
    frames_.pass(time);
    state_.frame_step = method.steps();
    state_.frame_time = time;
    state_.frames = frame_count_;
  }
  if (is_picture_step(method.steps())) {
    background.finish();  // the first frame gives the extent
    write_picture_beside_frames(method, fmt::format("step_{}.png", method.steps()));
  }
}

/// A run that is resumed draws it anew.
void Recorder::write_picture_beside_frames(Method& method, const std::string& name) {
  FrameWish wish = wish_of_picture();
  wish.files = false;
  const FrameOutput output = method.frame_output(wish);
  write_picture(name, moment_of(method), output);
}

std::function<void(const std::string& stage)> Recorder::drawer(Method& method,
                                                               Background& background) {
  return [&](const std::string& stage) {
    if (config_.output.frames == 0 || !config_.output.pictures) return;
    std::string name = stage;
    for (char& c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
    background.finish();  // the first frame gives the extent
    write_picture_beside_frames(method, fmt::format("stage_{}.png", name));
  };
}

void Recorder::record_last(Method& method, Background& background) {
  if (state_.row_step != method.steps()) write_row(method);
  if (wants_frames() && config_.output.frames > 0 && state_.frame_step != method.steps())
    write_frame(method, Then::end, background);
}

void Recorder::judge_end(Method& method, const EnergyBalance& energy) const {
  naming_fastest(method, [&] {
    if (watch_.judge_end(energy, method.steps(), method.time()))
      log_->warn(
          "step", method.steps(),
          fmt::format("energies do not add up: error_relative is {:.2g} at the end, above {}; a "
                      "smaller time.safety may help",
                      energy.error_relative, config_.energy.warn));
  });
}

void Recorder::sync() {
  if (series_) series_->finish();
  history_->sync();
  if (steps_) steps_->sync();
}

void Recorder::write_row(Method& method) {
  const auto [probes, energy] = method.row();
  last_energy_ = energy;
  on_first(ranks_, [&] {
    require_numbers(*last_energy_);
    const std::string stage =
        stages_.empty() ? "" : stages_[static_cast<std::size_t>(method.stage().index)].name;
    history_->write(
        {method.steps(), method.time(), method.time_step(), *last_energy_, probes, stage});
    for (std::size_t i = 0; i < std::min(probes.size(), state_.probes.size()); ++i) {
      ProbeRange& range = state_.probes[i];
      range.last = probes[i];
      range.min = std::min(range.min, probes[i]);
      range.max = std::max(range.max, probes[i]);
    }
  });
}

void Recorder::write_frame(Method& method, Then then, Background& background) {
  background.finish();
  const std::int64_t number = frame_count_;
  const PictureMoment moment = moment_of(method);
  std::shared_ptr<Method> later;
  if (state_.extent || !config_.output.pictures)  // else it belongs to the record's state
    later = snapshot_of(method, then);
  if (later != nullptr)
    background.add([this, later, number, moment] { write_frame_of(*later, number, moment); });
  else
    write_frame_of(method, number, moment);
  on_first(ranks_, [&] {
    log_->write(Level::info, "frame", moment.step,
                fmt::format("frame {} at {:.9g} s, state {:016x}", number, moment.time,
                            moment.hash.value_or(0)),
                std::pair{number, moment.time});
  });
  ++frame_count_;
}

RenderOptions Recorder::picture_options() const {
  const OutputConfig& wanted = config_.output;
  RenderOptions options;
  options.field = wanted.color;
  options.view = wanted.view;
  options.clip = wanted.clip;
  options.map = wanted.map;
  options.arrows = wanted.arrows;
  options.hidden = {wanted.hide.begin(), wanted.hide.end()};
  options.show_links = wanted.links;
  options.xray = wanted.xray;
  options.forces = wanted.forces;
  options.crosses = wanted.crosses;
  options.walls = wanted.walls;
  options.transparent = wanted.transparent;
  options.scale = wanted.scale;
  options.width = wanted.width;
  options.height = wanted.height > 0 ? wanted.height : static_cast<int>(state_.height);
  if (wanted.fit != "frame") options.extent = state_.extent;
  if (options.field == "damage") options.range = ValueRange{0.0, 1.0};
  if (wanted.range.size() == 2) options.range = ValueRange{wanted.range[0], wanted.range[1]};
  options.title = config_.title;
  return options;
}

FrameWish Recorder::wish_of_picture() const {
  FrameWish wish{config_.output.fields, picture_options(), {}, format_};
  if (config_.output.fit == "run") wish.grows_from = state_.first;
  return wish;
}

PictureMoment Recorder::moment_of(Method& method) {
  return {method.steps(), method.time(), method.state_hash()};
}

/// With the texts that `verify` makes it again from.
void Recorder::write_picture(const std::string& name, const PictureMoment& moment,
                             const FrameOutput& output) {
  on_first(ranks_, [&] {
    RenderOptions options = picture_options();
    options.extent = output.extent;
    options.height = output.height;
    if (!state_.first) state_.first = output.extent;
    state_.extent = output.extent;
    state_.height = output.height;
    std::vector<PngNote> notes = notes_;
    for (PngNote& one : notes_of_picture(moment, options)) notes.push_back(std::move(one));
    write_png(pictures_ + "/" + name, with_notes(output.png, notes));
    if (!output.blank || std::exchange(told_blank_, true)) return;
    log_->warn("picture", moment.step,
               fmt::format("nothing of the model is in the picture {}: output.fit = {:?}, "
                           "output.clip = {:?}, output.hide; \"run\" and \"frame\" follow what "
                           "flies",
                           name, config_.output.fit, config_.output.clip));
  });
}

void Recorder::write_frame_of(Method& method, std::int64_t number, const PictureMoment& moment) {
  FrameWish wish{config_.output.fields, std::nullopt, {}, format_};
  if (config_.output.pictures) wish = wish_of_picture();
  const FrameOutput output = method.frame_output(wish);
  on_first(ranks_, [&] {
    if (series_) series_->write(output.files);
  });
  if (config_.output.pictures) write_picture(fmt::format("{:04}.png", number), moment, output);
}

}  // namespace breccia
