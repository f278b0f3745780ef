#pragma once
// Cameras in files: keys in time, a turntable, a cut that moves.

#include <optional>
#include <string>
#include <vector>

#include "core/keys.hpp"
#include "io/picture/picture.hpp"

namespace breccia::app {

/// [[key]]: where the camera is at a time of the run
struct CameraKey {
  double time = 0.0;  ///<  [s]
  Vec3 eye{}, target{}, up{0.0, 0.0, 1.0};
  double angle = 0.6;  ///< from the lower to the upper border of the picture  [rad]
  std::string clip;

  template <class Visit>
  void each_key(Visit&& key) {
    key("time", time, "s", any_number, "time of the run at which the camera is here");
    key("eye", eye, "m", any_number, "where the camera is");
    key.required("eye");
    key("target", target, "m", any_number, "the point in the middle of the picture");
    key("up", up, "-", any_number, "the direction that points upwards in the picture");
    key("angle", angle, "rad", Range{0.0, 3.1, Open::low},
        "the picture is as high as this angle takes in at the target; projection is parallel");
    key("clip", clip,
        "a plane such as \"x<0.1\" beyond which all is cut away; between keys with one axis and "
        "one "
        "side the plane moves");
  }
};

/// [turntable]: the camera goes round
struct Turntable {
  double turns = 0.0;  ///< over the film; counter-clockwise seen from the tip of the axis
  Vec3 axis{0.0, 0.0, 1.0};
  int pictures = 0;  ///< of the film; 0: one a frame

  template <class Visit>
  void each_key(Visit&& key) {
    key("turns", turns, "-", any_number,
        "of the camera round its target over the film; counter-clockwise seen from the axis' tip");
    key("axis", axis, "-", any_number, "that it turns about");
    key("pictures", pictures, "-", Range{0, 100000},
        "of the film, each of the frame nearest in time; 0: one a frame");
  }
};

/// A camera file.
struct CameraFile {
  std::vector<CameraKey> keys;
  Turntable turntable;

  template <class Visit>
  void each_key(Visit&& key) {
    key.list("key", keys, "where the camera is at a time of the run; between two it moves");
    key.table("turntable", turntable, "the camera goes round");
  }
};

/// The camera of a picture or film.
class CameraPath {
 public:
  /// @throws InputError with file, line and key of all that is wrong
  explicit CameraPath(const std::string& path);

  /// Pictures of a film; 0: one a frame.
  int pictures() const { return file_.turntable.pictures; }
  /// Sets camera and clip plane. Without keys the camera turns about the middle of the extent, from
  /// the direction of `view`, and takes in as much as that does.
  /// @param time   of the frame  [s]
  /// @param share  of the film that is over, 0 to 1
  void apply(RenderOptions& options, double time, double share) const;

 private:
  void set_from_keys(RenderOptions& options, double time) const;
  CameraFile file_;
};

}  // namespace breccia::app
