#pragma once
// Contacts of a frame, bolts, and the walls, as files of their own.

#include <vector>

#include "io/vtu/vtu_writer.hpp"

namespace breccia {

/// The box around all points of frames or of parts of one.
struct Around {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};  ///<  [m]
  void add(const std::vector<Vec3>& points);
  void add(const Around& other);
};

/// Contacts of a whole model.
struct Touching {
  std::vector<FrameContact> contacts;  ///< by ascending ids, once sorted
  Around around;                       ///< the model
  bool plane = false;                  ///< forces are per metre of thickness

  void sort();
};

/// Each contact as a line from a to b, with the fields `force` (its size), `force_on_b`, `a`, `b`
/// and `wall` (-1: none).
/// @param like  gives step and time
Frame contacts_frame(const Frame& like, const Touching& sorted);

/// The walls of a frame as triangles, with the fields `wall` (its number) and `force` (of contacts
/// on it). A plane without end is a rectangle around the model.
Frame walls_frame(const Frame& like, const Touching& sorted);

/// The bolts of a frame as lines, with the fields `force` (along it, positive pulls), `across`,
/// `slip` and `bolt` (its number).
/// @param plane  forces are per metre of thickness
Frame bolts_frame(const Frame& like, bool plane);

/// Adds these files; those of walls and bolts where there are some.
void add_touching(FrameContents& files, const Frame& like, Touching touching, FrameFormat format,
                  int threads);

}  // namespace breccia
