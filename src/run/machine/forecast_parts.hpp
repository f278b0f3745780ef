#pragma once
// Parts of forecasts that all methods share.

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "exec/error.hpp"
#include "run/machine/forecast.hpp"
#include "run/method/method.hpp"

namespace breccia {

inline double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time of a step of a specimen, per item; 0 if it cannot be stepped.  [s]
inline double pace_of(Method& method, double items) {
  constexpr int warm = 5, timed = 60;
  try {
    while (method.steps() < warm) method.advance({.time = 1e300, .step = warm});
    const double begin = processor_seconds();
    while (method.steps() < warm + timed) method.advance({.time = 1e300, .step = warm + timed});
    const auto steps = static_cast<double>(method.steps() - warm);
    return steps > 0.0 ? (processor_seconds() - begin) / (steps * items) : 0.0;
  } catch (const NumericsError&) {
    return 0.0;
  }
}

/// Wall time of steps of so many items on the processors of this machine.  [s]
inline double wall_of(double steps, double items, double pace) {
  constexpr double least_share = 2000.0;  // items that keep a processor busy
  const double processors = omp_get_num_procs();
  const double useful = std::clamp(items / least_share, 1.0, processors);
  return steps * items * pace / (1.0 + 0.85 * (useful - 1.0));
}

inline constexpr double bytes_of_facet = 450.0;  // of cases/rc_slab_ldpm, elements included

/// Memory of a run of next to nothing and without pictures, measured: libraries, threads.  [bytes]
inline constexpr double own_memory = 25e6;

/// Memory of a pixel while a picture is drawn, measured.  [bytes]
inline constexpr double pixel_of_spheres = 13.0, pixel_of_faces = 98.0;  // drawn 3 x 3 finer

/// Materials and rules of a mesh's case, without what it consists of and what is done to it.
template <class Config>
Config without_bodies(Config config) {
  config.bodies.clear();
  config.discontinuities.clear();
  config.joint_sets.clear();
  config.supports.clear();
  config.loads.clear();
  config.bolts.clear();
  config.probes.clear();
  config.checks.clear();
  return config;
}

template <class Stage>
bool may_end_early(const std::vector<Stage>& stages) {
  return std::any_of(stages.begin(), stages.end(), [](const Stage& s) {
    return s.rest > 0.0 || !s.when.empty() || s.drop > 0.0;
  });
}

/// When the last stage ends, if none waits longer than its `until`; else time.end.  [s]
template <class Stage>
double end_of(const std::vector<Stage>& stages, double end) {
  double sum = 0.0;
  for (const Stage& s : stages) {
    if (!(s.until > 0.0)) return end;
    sum += s.until;
  }
  return stages.empty() ? end : std::min(sum, end);
}

/// Pixels of a picture of a run, by what is known before its model is.
/// @param aspect  height of the model over its width; 0: not known
inline double pixels_of(const OutputConfig& output, double aspect = 0.0) {
  constexpr double lowest = 0.28, highest = 0.75, beside = 0.11;  // as pictures take; of the width
  const double width = output.width;
  if (output.height > 0) return width * output.height;
  return width * width *
         (aspect > 0.0 ? std::clamp(beside + 0.78 * aspect, lowest, highest) : highest);
}
/// Whether triangles or tetrahedra of any of them are joined, from the start or once they wake.
template <class Materials>
bool can_crack(const Materials& materials) {
  return std::any_of(materials.begin(), materials.end(),
                     [](const auto& m) { return m.joints != "none"; });
}
inline bool draws(const OutputConfig& output) {
  return output.frames > 0 && output.pictures;
}
inline double rows_of(const CaseConfig& config) {
  return config.output.history > 0.0 ? config.time.end / config.output.history : 1000;
}

/// Processor time of output, as measured on small cases of both methods.
struct OutputRates {
  double row;    ///< of an item or bond in a row of history.csv  [s]
  double frame;  ///< of an item or bond in a frame's files  [s]
  double pixel;  ///< of a picture  [s]
};
/// @param pixels  of a picture
inline void add_output(Forecast& f, const CaseConfig& config, double pixels,
                       const OutputRates& rates) {
  constexpr double begun_row = 15e-6, begun_frame = 4e-3;  // whatever the model's size  [s]
  const double parts = f.items + f.bonds;
  const double rows = std::min(rows_of(config), f.steps), frames = config.output.frames + 1.0;
  const bool framed = config.output.frames > 0;
  const double fields = framed && config.output.fields ? begun_frame + rates.frame * parts : 0.0;
  const double picture = draws(config.output) ? rates.pixel * pixels : 0.0;
  f.output_s = rows * (begun_row + rates.row * parts) + frames * (fields + picture);
}

/// Bytes of a result folder, as small cases of both methods leave them.
struct DiskRates {
  double element, bond;      ///< of fields, each frame
  double saved, saved_bond;  ///< of a checkpoint
  double picture;            ///< of a pixel
};
/// @param rich  those of the bonds that keep more than their breaking
inline void add_disk(Forecast& f, const CaseConfig& config, double pixels, std::size_t columns,
                     const DiskRates& rates, double rich = 0.0) {
  const double frames = config.output.frames + 1.0;
  const double rows = rows_of(config);
  const double fields =
      config.output.fields ? frames * (rates.element * f.items + rates.bond * f.bonds) : 0.0;
  const double pictures = draws(config.output) ? frames * rates.picture * pixels : 0.0;
  const double history = std::min(rows, f.steps) * 19.0 * static_cast<double>(columns);
  const double kept = std::min<double>(config.checkpoint.keep, f.here_s / config.checkpoint.wall);
  const double each = rates.saved * f.items + rates.saved_bond * rich;
  const double saved = config.checkpoint.keep > 0 ? std::max(1.0, std::floor(kept)) * each : 0.0;
  f.disk = fields + pictures + history + saved;
  const std::pair<double, const char*> parts[] = {
      {fields, "fields"}, {pictures, "pictures"}, {history, "history.csv"}, {saved, "checkpoints"}};
  f.longest_part = std::max_element(std::begin(parts), std::end(parts))->second;
}

/// The least of the steps that specimens allow, with what rules it.
inline void take_step(Forecast& f, double step, const std::string& rule) {
  if (step > 0.0 && (f.step == 0.0 || step < f.step)) {
    f.step = step;
    f.step_rule = rule;
  }
}

/// Sizes of elements: the least of all counts.
inline void take_size(Forecast& f, double size, const char* name) {
  if (!(size > 0.0) || (f.least > 0.0 && size >= f.least)) return;
  f.least = size;
  f.least_name = name;
}

/// @param end    of the last stage  [s]
/// @param model  its step is taken in place of that of specimens
inline void finish(Forecast& f, const TimeConfig& time, double end, const ModelStep& model) {
  if (model.step > 0.0) {
    f.of_model = true;
    f.cut_by_lines = false;
    f.step = model.step;
    f.step_rule = (model.rule.empty() ? f.item_name : model.rule) + " of the model as it is set up";
  }
  if (f.step == 0.0 || f.step > time.max_step) take_step(f, time.max_step, "time.max_step");
  if (f.step > 0.0) f.steps = std::ceil(end / f.step);
}

}  // namespace breccia
