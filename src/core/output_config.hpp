#pragma once
// Keys of [output]: what a run leaves, and how its pictures look.

#include <algorithm>
#include <string>
#include <vector>

#include "core/keys.hpp"

namespace breccia {

/// Fields of frames that cost time and space, and are there if they are asked for.
struct MoreFields {
  bool displacement = false, force = false, stress = false;
};

/// [output]
struct OutputConfig {
  int frames = 20;             ///< frames over the whole run, besides the one at the start  [-]
  double history = 0.0;        ///< time between history rows; 0: 1000 rows over the run  [s]
  bool fields = true;          ///< write ParaView files
  std::string format = "vtu";  ///< of ParaView files
  bool pictures = true;        ///< write a PNG a frame
  bool report = false;         ///< write report.html at the end
  bool step_times = false;     ///< write steps.csv
  std::vector<std::string> curves;    ///< "force over deflection": a probe over another one
  std::vector<std::string> more;      ///< fields of frames besides the usual ones
  std::vector<double> picture_steps;  ///< steps since the start of the case  [-]
  std::string color = "damage";
  std::vector<double> range;  ///< values at the ends of the colours; empty: those of each frame
  std::string map;            ///< of colours; empty: by the field
  std::string view = "iso";
  std::string fit = "run";
  std::string clip;
  std::vector<std::string> hide;  ///< bodies
  bool links = false, xray = false, crosses = false, forces = false;
  std::string arrows;  ///< a field of vectors
  double scale = 1.0;  ///< of displacements  [-]
  bool walls = true;   ///< with supports
  bool transparent = false;
  int width = 1280, height = 0;  ///< height 0: as the model needs  [pixels]

  MoreFields more_fields() const {
    const auto wants = [&](const std::string& field) {
      return color == field || color.starts_with(field + "_") || arrows == field ||
             std::find(more.begin(), more.end(), field) != more.end();
    };
    return {wants("displacement") || scale != 1.0, wants("force"), wants("stress") || crosses};
  }

  template <class Visit>
  void each_key(Visit&& key) {
    key("frames", frames, "-", Range{0, 100000}, "frames over the whole run, besides the first");
    key("history", history, "s", not_negative,
        "time between two rows of history.csv; 0 writes 1000 rows over the run");
    key("fields", fields, "write the frames as ParaView files");
    key("format", format, OneOf{"vtu", "vtkhdf"},
        "of ParaView files: vtu (VTK XML), or vtkhdf (VTKHDF 1.0 in HDF5 files, for what else "
        "reads "
        "HDF5)");
    key("pictures", pictures, "write one PNG picture a frame");
    key("report", report, "write report.html when the run is done, as `breccia report` does");
    key("step_times", step_times,
        "write steps.csv, a row a step: its simulated time, the wall time it took, searches for "
        "contacts in it; a GPU then computes one step at a time");
    key("curves", curves,
        "plots of a probe over another one, as \"force over deflection\", first in curves.svg and "
        "in the report; - before a name turns its sign");
    key("more", more,
        "fields that frames hold besides the usual ones: displacement, force (of links and "
        "contacts), and for spheres stress");
    key("picture_steps", picture_steps, "-", not_negative,
        "steps of which a picture is drawn, as pictures/step_<number>.png, besides those of "
        "frames");
    key("color", color, "field that colours the pictures");
    key("range", range, "-", any_number,
        "two values at the ends of the colours, in SI units; none: those of each frame");
    key("map", map, "colours: viridis, magma, diverging, damage, ground, gray; none: by the field");
    key("view", view, OneOf{"iso", "x", "y", "z"}, "camera of the pictures");
    key("fit", fit, OneOf{"run", "frame", "first"},
        "run: the camera shows the bodies at the start and goes back when they leave it; frame: "
        "it shows each frame as large as can be; first: it stays as it is at the start");
    key("clip", clip, "cuts away one side of a plane such as \"y=0\"");
    key("hide", hide, "bodies that are not drawn");
    key("links", links, "draw the links as well");
    key("xray", xray, "what bars, cracks and broken links lie in is translucent");
    key("forces", forces, "forces of contacts without links as lines, as wide as they are large");
    key("crosses", crosses,
        "principal stresses in the plane of the picture: tension red, compression blue");
    key("arrows", arrows, "field of vectors drawn as arrows: velocity, displacement, force");
    key("scale", scale, "-", Range{0.0, 1e9}, "displacements are drawn so many times");
    key("walls", walls, "draw walls and supports");
    key("transparent", transparent, "pictures without a ground");
    key("width", width, "-", Range{64, 16384}, "width of the pictures in pixels");
    key("height", height, "-", Range{0, 16384},
        "height of the pictures in pixels; 0: as much as the model needs, at most 3/4 of the "
        "width");
  }
};

}  // namespace breccia
