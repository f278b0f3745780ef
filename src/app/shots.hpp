#pragma once
// The frames of a run as pictures of them are asked for.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "app/camera_path.hpp"
#include "exec/error.hpp"
#include "io/emphasis.hpp"
#include "io/harmless.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/picture.hpp"
#include "io/vtu/vtu_reader.hpp"

namespace breccia::app {

/// Damage, or of grains that nothing links how fast they are.
inline std::string usual_field(const Frame& frame) {
  const bool linked = !frame.triangles.empty() || !frame.tetrahedra.empty() || !frame.lines.empty();
  const char* const field = linked ? "damage" : "velocity";
  return has_field(frame, field) ? field : "";
}

inline void warn(const std::string& what) {
  fmt::print(stderr, "{} {}\n", emphasized(Emphasis::warning, "warning:", stderr), harmless(what));
}

/// The frames of a run, and how pictures of them look: alike, so that they can be compared.
struct Shots {
  std::string folder, fit;
  std::vector<double> times;  ///<  [s]
  RenderOptions options;

  Shots(std::string from, const RenderOptions& wanted, const std::optional<std::string>& color,
        std::string fitted)
      : folder(std::move(from)),
        fit(std::move(fitted)),
        times(frame_times(folder)),
        options(wanted) {
    if (times.empty()) throw InputError(folder + ": this folder holds no frames");
    first_ = read_frame(folder, 0);
    options.field = color ? *color : usual_field(first_);
    if (options.field == "damage" && !options.range) options.range = ValueRange{0.0, 1.0};
    if (fit != "frame") options.extent = extent_of_run();
    if (shows_contacts(first_, options) && !add_contacts_of(folder, 0, first_))
      warn(folder +
           ": no forces of contacts can be drawn, as this folder has none: a run with "
           "[output] fields = true writes them beside its frames");
  }
  Frame frame(int number) const {
    Frame frame = number == 0 ? first_ : read_frame(folder, number);
    if (needs_displacement(options)) add_displacement(frame, first_);
    if (number > 0 && shows_contacts(frame, options)) add_contacts_of(folder, number, frame);
    return frame;
  }
  /// @param path   null: the camera stands as the options say
  /// @param share  of the film that is over
  RenderOptions seen(int number, const CameraPath* path, double share) const {
    RenderOptions seen = options;
    if (path == nullptr) return seen;
    if (!seen.extent) seen.extent = bulk_extent(frame(number));
    path->apply(seen, times.at(static_cast<std::size_t>(number)), share);
    return seen;
  }
  Image picture(int number, const CameraPath* path, double share) const {
    return render(frame(number), seen(number, path, share));
  }
  /// The frame nearest to a time.
  int at_time(double time) const {
    const auto nearer = [time](double a, double b) {
      return std::abs(a - time) < std::abs(b - time);
    };
    return static_cast<int>(std::min_element(times.begin(), times.end(), nearer) - times.begin());
  }
  /// Widens a range to that of a frame's colours.
  void widen(std::optional<ValueRange>& range, int number) const {
    const auto bar = color_frame(frame(number), options.field, {}).legend.bar;
    if (!bar) return;
    range = range ? ValueRange{std::min(range->low, bar->range.low),
                               std::max(range->high, bar->range.high)}
                  : bar->range;
  }

 private:
  /// Of the first frame or, for a camera that follows, of the run at some moments.
  Extent extent_of_run() const {
    constexpr int moments = 8;
    const auto extent = [&](const Frame& of) { return bulk_extent(as_moved(of)); };
    const Extent start = extent(frame(0));
    if (fit == "first") return start;
    Extent all = start;
    const int last = static_cast<int>(times.size()) - 1;
    for (int k = 1; k <= moments; ++k)
      if (const int number = k * last / moments; number > (k - 1) * last / moments)
        all = grown_extent(all, start, as_moved(frame(number)), 0.0);
    return all;
  }
  Frame as_moved(Frame of) const {
    return options.scale == 1.0 ? of : displaced(of, options.scale);
  }
  Frame first_;
};

}  // namespace breccia::app
