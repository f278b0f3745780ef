#pragma once
// A series of frames that a stock ParaView opens with its times.

#include <chrono>
#include <string>
#include <vector>

#include "io/vtu/vtu_writer.hpp"

namespace breccia {

/// Writes frames into a result folder:
///
///   fields/elements_0000.vtu  points with every point field and `radius`; vertices, or triangles
///   fields/links_0000.vtu     the lines with every line field
///   elements.pvd, links.pvd   each series with its times; result.pvd: both in one,
///                             as parts of these names
///   open_in_paraview.py       shows them, spheres as spheres: paraview open_in_paraview.py
///
/// VTK XML, appended raw, zlib blocks; numbers as Float32. The .pvd files are replaced as a whole,
/// so a run that is killed leaves a series that opens. A few hundred frames are in them as soon as
/// they are written. Later the .pvd files take a twentieth of the time between frames at most, so
/// that many frames cost as much each as few; what they lack is added by finish().
class ParaviewSeries {
 public:
  /// Starts a new series in the folder, which is made if it does not exist. @throws IoError
  explicit ParaviewSeries(const std::string& folder);

  /// Continues the series of a folder: frames later than `time` [s] are dropped. @throws IoError
  static ParaviewSeries resumed(const std::string& folder, double time);

  /// Adds a frame. One that is not later than the last replaces all from its time on. @throws
  /// IoError
  void write(const FrameContents& frame);
  void write(const Frame& frame) { write(contents_of(frame)); }
  /// Brings the .pvd files up to the last frame. @throws IoError
  void finish();

  /// Times of the frames written so far.  [s]
  const std::vector<double>& times() const { return times_; }

 private:
  using Clock = std::chrono::steady_clock;

  void write_collections();
  bool collections_are_due() const;
  void drop_from(std::size_t first);

  std::string folder_;
  std::vector<double> times_;
  std::size_t listed_ = 0;         ///< frames in the .pvd files
  Clock::time_point listed_at_{};  ///< when the .pvd files had been written last
  Clock::duration listing_{};      ///< what that took
};

}  // namespace breccia
