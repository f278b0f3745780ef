#pragma once
// The case file of the FDEM: bodies, their meshes and grains, and cracks that are there already.

#include <string>
#include <vector>

#include "core/keys.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem {

/// [[body.hole]]
struct HoleConfig {
  Vec2 center{};                ///<  [m]
  double radius = 0.0;          ///< 0: a polygon  [m]
  std::vector<Vec2> corners{};  ///<  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("center", center, "m", any_number, "centre of the hole, in the coordinates of the case");
    key("radius", radius, "m", not_negative, "radius of a round hole");
    key("corners", corners, "m", any_number,
        "corners of a hole with straight sides, from its centre; then radius is left out");
  }
};

/// [[body.notch]]
struct NotchConfig {
  Vec2 from{}, to{};   ///<  [m]
  double width = 0.0;  ///< 0: an open crack  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("from", from, "m", any_number, "one end of the notch, in the coordinates of the case");
    key.required("from");
    key("to", to, "m", any_number, "the other end of the notch");
    key.required("to");
    key("width", width, "m", not_negative,
        "width of a slot that is cut out; 0: an open crack along edges of the mesh");
  }
};

/// [[body.grains.mineral]]
struct MineralConfig {
  std::string material;
  double fraction = 0.0;  ///< of the body's area  [-]
  std::string color;      ///< rrggbb

  template <class Visit>
  void each_key(Visit&& key) {
    key("material", material, "name of a material");
    key.required("material");
    key("fraction", fraction, "-", Range{0.0, 1.0}, "share of the body's area, without a picture");
    key("color", color, "its colour in the picture, as in \"ff8800\": red, green, blue");
  }
};

/// [body.grains]: minerals in place of the body's one material
struct GrainsConfig {
  std::string kind;
  double size = 0.0;  ///< of a grain  [m]
  std::vector<MineralConfig> minerals;
  std::string file;
  std::string boundary{};  ///< joint law between grains; empty: by their minerals

  template <class Visit>
  void each_key(Visit&& key) {
    key("kind", kind, OneOf{"voronoi", "random", "picture"},
        "voronoi: grains of the given size; random: each triangle for itself; picture: by the "
        "colours of a PNG file");
    key.required("kind");
    key("size", size, "m", not_negative, "size of a Voronoi grain: root of its mean area");
    key.list("mineral", minerals, "the minerals of the body");
    key("file", file, "PNG file beside the case file, stretched over the body's bounding box");
    key("boundary", boundary,
        "[joint.<name>] of all edges (tetrahedra: faces) between two Voronoi grains, of one "
        "mineral or of two; empty: those within a mineral and between minerals have the joints of "
        "these");
  }
};

/// [body.weibull]: strength that varies from triangle to triangle
struct WeibullConfig {
  double modulus = 0.0;  ///< m  [-]
  double length = 0.0;   ///< correlation length  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("modulus", modulus, "-", Range{0.5, 1000.0},
        "Weibull modulus m: the smaller, the wider strength is spread; its mean is kept");
    key.required("modulus");
    key("length", length, "m", not_negative,
        "distance at which correlation has fallen to 1/e; 0: triangles are independent, and the "
        "result depends on the mesh");
  }
};

/// [body.hexagons]: many elements of six triangles each
struct HexagonsConfig {
  int count = 0;      ///< elements  [-]
  double side = 0.0;  ///<  [m]
  double gap = 0.0;   ///< least distance between two of them  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("count", count, "-", Range{1, 1e8}, "how many hexagons");
    key.required("count");
    key("side", side, "m", positive, "length of a side");
    key.required("side");
    key("gap", gap, "m", not_negative, "least distance between two hexagons");
  }
};

/// [[body]]
struct BodyConfig {
  std::string name;
  std::string shape = "plate";
  std::string material;
  Vec2 center{};              ///<  [m]
  Vec2 size{};                ///< edge lengths  [m]
  double radius = 0.0;        ///<  [m]
  double inner_radius = 0.0;  ///< of a ring  [m]
  double mesh_size = 0.0;     ///< edge length that is aimed at  [m]
  double merge = 0.25;        ///< of cracks, over mesh_size  [-]
  double jitter = 0.0;        ///< over the edge length  [-]
  bool structured = false;
  std::string pattern = "equilateral";
  Vec2 velocity{};            ///< at the start  [m/s]
  std::string of;             ///< of a part: the body that it is a part of
  std::vector<Vec2> corners;  ///< of a part  [m]
  std::string file;
  std::vector<std::string> parts;  ///< physical groups of the file
  std::string seams = "refuse";
  std::vector<HoleConfig> holes;
  std::vector<NotchConfig> notches;
  HexagonsConfig hexagons;
  GrainsConfig grains;
  WeibullConfig weibull;

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the body: its triangles form a group of this name");
    key.required("name");
    key("shape", shape,
        OneOf{"disc", "plate", "ring", "beam", "hexagons", "outline", "geo", "mesh", "part"},
        "plate, beam: a rectangle; hexagons: many free elements of six triangles; outline: a "
        "polygon from a CSV file; geo: a file for gmsh (--allow-scripts); mesh: triangles from a "
        "file; part: what of "
        "another body lies in a circle, rectangle or polygon, joined to it as before");
    key("material", material, "name of a material; with grains: of what is no mineral");
    key.required("material");
    key("center", center, "m", any_number,
        "centre of the body; files are moved by this much from where they lie");
    key("size", size, "m", not_negative,
        "edge lengths of a plate or beam; the rectangle that hexagons are spread over");
    key("radius", radius, "m", not_negative, "radius of a disc, outer radius of a ring");
    key("inner_radius", inner_radius, "m", not_negative, "inner radius of a ring");
    key("mesh_size", mesh_size, "m", not_negative, "edge length of the triangles");
    key("merge", merge, "-", Range{0.0, 0.3},
        "cracks are moved by about this share of mesh_size where their ends, their crossings or "
        "straight sides of the body are nearer than that: otherwise slivers make the steps short");
    key("jitter", jitter, "-", Range{0.0, 0.3},
        "inner vertices are moved by up to this share of an edge; hexagons by this share of their "
        "distance");
    key("structured", structured, "a regular mesh, made without gmsh: of plate, beam or disc");
    key("pattern", pattern, OneOf{"equilateral", "crossed"},
        "regular mesh of rows of nearly equilateral triangles, or of squares with both diagonals");
    key("velocity", velocity, "m/s", any_number, "velocity at the start");
    key("of", of, "part: the body that it is a part of");
    key("corners", corners, "m", any_number,
        "part: corners of its polygon; left out: radius or size say what it is");
    key("file", file, "file beside the case file: .csv of x,y; .geo; .msh (Gmsh 4.1); .inp");
    key("parts", parts,
        "physical surfaces (.msh, .geo) or element sets (.inp) that are this body; empty: all. "
        "Bodies from the same file, moved by the same center, share their vertices");
    key("seams", seams, OneOf{"refuse", "open"},
        "of a mesh from a file: whether two nodes may lie at one place, so that the triangles "
        "beside "
        "them are not joined, and triangles share no edge with any other");
    key.list("hole", holes, "round holes, and holes with straight sides");
    key.list("notch", notches, "slots and open cracks");
    key.table("hexagons", hexagons, "how many hexagons and how large");
    key.table("grains", grains, "minerals in place of the body's one material");
    key.table("weibull", weibull, "strength that varies in space");
  }
};

/// [[discontinuity]]: a polyline along which bodies are cracked already, or joined otherwise
struct DiscontinuityConfig {
  std::string name;
  std::vector<Vec2> points;  ///<  [m]
  std::string kind = "open";
  std::string material;
  bool embedded = true;

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name, for messages");
    key.required("name");
    key("points", points, "m", any_number, "two or more points, joined by straight lines");
    key("kind", kind, OneOf{"open", "cohesive"},
        "open: broken at the start, with contact only; cohesive: joints with a law of their own");
    key("material", material, "cohesive: name of a joint law");
    key("embedded", embedded,
        "new meshes follow the lines; false: edges of the mesh near the lines are taken");
  }
};

/// [[joint_set]]: many discontinuities of one kind, from a file or at random
struct JointSetConfig {
  std::string name;
  std::string kind = "open";
  std::string material;
  bool embedded = true;
  std::string file;
  Vec2 min{}, max{};       ///< rectangle that it fills  [m]
  double intensity = 0.0;  ///< P21: length of lines over area  [1/m]
  double angle = 0.0;      ///< mean  [rad]
  double spread = 0.0;     ///< standard deviation of angles  [rad]
  std::string length_law = "constant";
  double length = 0.0;             ///< mean  [m]
  double length_deviation = 0.0;   ///<  [m]
  double length_exponent = 2.5;    ///<  [-]
  double least = 0.0, most = 0.0;  ///< lengths; 0: no limit  [m]
  double spacing = 0.0;            ///< of regular lines; 0: at random  [m]
  double gap = 0.0;                ///< of regular lines: between two on one line  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name, for messages");
    key.required("name");
    key("kind", kind, OneOf{"open", "cohesive"},
        "open: broken at the start, with contact only; cohesive: joints with a law of their own");
    key("material", material, "cohesive: name of a joint law");
    key("embedded", embedded,
        "new meshes follow the lines; false: edges of the mesh near the lines are taken");
    key("file", file,
        "file beside the case file: .csv with a line x1,y1,x2,y2 for each, or .wkt with LINESTRING "
        "and MULTILINESTRING, in metres; empty: at random, by the keys below");
    key("min", min, "m", any_number, "lower corner of the rectangle that random lines fill");
    key("max", max, "m", any_number, "upper corner of that rectangle");
    key("intensity", intensity, "1/m", not_negative,
        "P21 of random lines: their length in the rectangle over its area, met exactly; of lines "
        "with one angle it is also P10, their number per length across them");
    key("angle", angle, "rad", Range{-6.3, 6.3}, "mean angle of the lines from the x axis");
    key("spread", spread, "rad", Range{0.0, 1.5708},
        "standard deviation of their angles, by the normal distribution");
    key("length_law", length_law, OneOf{"constant", "exponential", "lognormal", "power"},
        "how long they are: all as length; exponential or lognormal with that mean; power: density "
        "l^-length_exponent from least to most");
    key("length", length, "m", not_negative, "mean length before least and most");
    key("length_deviation", length_deviation, "m", not_negative,
        "standard deviation of lognormal lengths");
    key("length_exponent", length_exponent, "-", positive, "exponent of the power law");
    key("least", least, "m", not_negative, "shorter ones are drawn again; 0: no limit");
    key("most", most, "m", not_negative, "longer ones are drawn again; 0: no limit");
    key("spacing", spacing, "m", not_negative,
        "regular lines at angle, so far apart, in place of random ones: they run through, or are "
        "length long with gap between them, on every other line moved by half of both; 0: random");
    key("gap", gap, "m", not_negative, "regular lines: bridge of rock between two on one line");
  }
};

}  // namespace breccia::fdem
