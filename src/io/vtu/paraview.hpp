#pragma once
// A series of frames that a stock ParaView opens with its times.

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "io/vtu/vtu_writer.hpp"

namespace breccia {

/// Writes frames into a result folder:
///
///   fields/elements_0000.vtu  points with every point field and `radius`; vertices, triangles or
///                             tetrahedra
///   fields/links_0000.vtu     lines, or the triangles of joints in space, with their fields
///   fields/contacts_0000.vtu  what touches without a link: lines with their force
///   fields/walls_0000.vtu     walls as triangles, with the force on each; where there are some
///   elements.pvd, links.pvd, contacts.pvd, walls.pvd, bolts.pvd
///                             each series with its times; result.pvd: all in one, as parts of
///                             these names
///   tetrahedra.pvd, joints.pvd, joint_contacts.pvd
///                             of runs with spheres and tetrahedra: what elements, links and
///                             contacts are for spheres
///   open_in_paraview.py       shows them, spheres as spheres: paraview open_in_paraview.py
///
/// or, as VTKHDF, elements_0000.hdf and so on, listed in elements.hdf.series and so on.
///
/// Zlib blocks; numbers as Float32. The lists are replaced as a whole,
/// so a run that is killed leaves a series that opens. A few hundred frames are in them as soon as
/// they are written. Later the lists take a twentieth of the time between frames at most, so
/// that many frames cost as much each as few; what they lack is added by finish().
class ParaviewSeries {
 public:
  /// Starts a new series in the folder, which is made if it does not exist. @throws IoError
  explicit ParaviewSeries(const std::string& folder, FrameFormat format = FrameFormat::vtu);

  /// Continues the series of a folder: frames later than `time` [s] are dropped. @throws IoError
  static ParaviewSeries resumed(const std::string& folder, double time,
                                FrameFormat format = FrameFormat::vtu);

  /// Adds a frame. One that is not later than the last replaces all from its time on. @throws
  /// IoError
  void write(const FrameContents& frame);
  void write(const Frame& frame) { write(contents_of(frame, 1, format_)); }
  /// Brings the lists up to the last frame. @throws IoError
  void finish();

  /// Times of the frames written so far.  [s]
  const std::vector<double>& times() const { return times_; }

 private:
  using Clock = std::chrono::steady_clock;

  void write_collections();
  std::string file_of(const std::string& kind, std::size_t frame) const;
  std::string collection(std::span<const std::string> parts) const;
  std::string series(const std::string& kind) const;
  bool collections_are_due() const;
  void drop_from(std::size_t first);

  std::string folder_;
  FrameFormat format_;
  std::vector<std::string> kinds_{"elements", "links"};  ///< of files, in their order
  std::vector<double> times_;
  std::size_t listed_ = 0;         ///< frames in the lists
  Clock::time_point listed_at_{};  ///< when they had been written last
  Clock::duration listing_{};      ///< what that took
};

}  // namespace breccia
