#pragma once
// The case file of the FDEM in three dimensions: bodies, their meshes, and cracks that are there
// already.

#include <string>
#include <vector>

#include "core/keys.hpp"
#include "fdem/setup/body_config.hpp"
#include "math/vec.hpp"

namespace breccia::fdem3 {

/// [[body]]
struct BodyConfig {
  std::string name;
  std::string shape = "box";
  std::string material;
  Vec3 center{};        ///<  [m]
  Vec3 size{};          ///< edge lengths  [m]
  double radius = 0.0;  ///<  [m]
  double height = 0.0;  ///<  [m]
  std::string axis = "z";
  double mesh_size = 0.0;  ///< edge length that is aimed at  [m]
  double jitter = 0.0;     ///< over the edge length  [-]
  bool structured = false;
  Vec3 velocity{};  ///< at the start  [m/s]
  std::string of;   ///< the body that a part is of
  std::string file;
  std::vector<std::string> parts;  ///< physical groups of the file
  fdem::GrainsConfig grains;
  fdem::WeibullConfig weibull;
  Vec3 direction{}, across{};  ///< of its own z, and about its own x; 0: as in the case  [-]

  bool is_turned() const { return norm(direction) + norm(across) > 0.0; }
  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the body: its tetrahedra form a group of this name");
    key.required("name");
    key("shape", shape, OneOf{"box", "cylinder", "sphere", "mesh", "stl", "part"},
        "mesh: tetrahedra from a file; stl: the inside of a closed surface from a file; part: the "
        "tetrahedra of another body whose middles lie in a box (size), a cylinder (radius and "
        "height) or a sphere (radius), joined to it as before");
    key("material", material, "name of a material; with grains: of what is no mineral");
    key.required("material");
    key("center", center, "m", any_number,
        "centre of the body; files are moved by this much from where they lie");
    key("size", size, "m", not_negative, "edge lengths of a box");
    key("radius", radius, "m", not_negative, "radius of a cylinder or sphere");
    key("height", height, "m", not_negative, "length of a cylinder along its axis");
    key("axis", axis, OneOf{"x", "y", "z"}, "direction of a cylinder's axis");
    key("direction", direction, "-", any_number,
        "box, cylinder, stl: any direction for its own z, along a cylinder: it is turned about its "
        "centre, of a file about the origin; left out: not turned");
    key("across", across, "-", any_number,
        "about the direction of its own x; left out: turned the shortest way");
    key("mesh_size", mesh_size, "m", not_negative, "edge length of the tetrahedra");
    key("jitter", jitter, "-", Range{0.0, 0.3},
        "inner vertices are moved by up to this share of an edge");
    key("structured", structured,
        "a regular mesh, made without gmsh: of a box, six tetrahedra to a cube. Cracks follow its "
        "planes: for tests");
    key("velocity", velocity, "m/s", any_number, "velocity at the start");
    key("of", of, "part: the body that it is a part of");
    key("file", file, "file beside the case file: .msh (Gmsh 2.2 or 4.1) or .inp; .stl");
    key("parts", parts,
        "physical volumes (.msh) or element sets (.inp) that are this body; empty: all. Bodies "
        "from the same file, moved by the same center, share their vertices");
    key.table("grains", grains, "minerals in place of the body's one material");
    key.table("weibull", weibull, "strength that varies in space");
  }
};

/// [[discontinuity]]: a flat disc or polygon along which bodies are cracked already, or joined
/// otherwise
struct DiscontinuityConfig {
  std::string name;
  std::vector<Vec3> points;    ///< corners of a flat polygon  [m]
  Vec3 center{};               ///< of a disc  [m]
  Vec3 normal{0.0, 0.0, 1.0};  ///< of a disc  [-]
  double radius = 0.0;         ///< of a disc  [m]
  std::string kind = "open";
  std::string material;
  bool embedded = true;

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name, for messages");
    key.required("name");
    key("points", points, "m", any_number,
        "three or more corners of a flat polygon; left out: it is a disc");
    key("center", center, "m", any_number, "centre of a disc");
    key("normal", normal, "-", any_number, "direction across a disc");
    key("radius", radius, "m", not_negative, "radius of a disc");
    key("kind", kind, OneOf{"open", "cohesive"},
        "open: broken at the start, with contact only; cohesive: joints with a law of their own");
    key("material", material, "cohesive: name of a joint law");
    key("embedded", embedded,
        "meshes that gmsh makes follow it; false: faces of the mesh near it are taken");
  }
};

/// [[joint_set]]: many flat discontinuities of one kind, from a file or at random
struct JointSetConfig {
  std::string name;
  std::string kind = "open";
  std::string material;
  bool embedded = true;
  std::string file;
  Vec3 min{}, max{};                ///< box that it fills  [m]
  double intensity = 0.0;           ///< P32: area of discs over volume  [1/m]
  double number = 0.0;              ///< of discs with their middle in the box; 0: by intensity  [-]
  Vec3 normal{0.0, 0.0, 1.0};       ///< mean direction across them  [-]
  double concentration = no_limit;  ///< kappa of Fisher's distribution  [-]
  std::string radius_law = "constant";
  double radius = 0.0;             ///< mean  [m]
  double radius_deviation = 0.0;   ///<  [m]
  double radius_exponent = 3.5;    ///<  [-]
  double least = 0.0, most = 0.0;  ///< radii; 0: no limit  [m]
  int sides = 8;
  double clear = -1.0;  ///< below 0: a quarter of the least mesh_size  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name, for messages");
    key.required("name");
    key("kind", kind, OneOf{"open", "cohesive"},
        "open: broken at the start, with contact only; cohesive: joints with a law of their own");
    key("material", material, "cohesive: name of a joint law");
    key("embedded", embedded,
        "meshes that gmsh makes follow them; false: faces of the mesh near them are taken");
    key("file", file,
        "file beside the case file: .csv with a disc x,y,z,nx,ny,nz,radius in each line (centre, "
        "direction across it, radius), or .wkt with POLYGON Z and MULTIPOLYGON Z, in metres; "
        "empty: "
        "at random, by the keys below");
    key("min", min, "m", any_number, "lower corner of the box that random discs fill");
    key("max", max, "m", any_number, "upper corner of that box");
    key("intensity", intensity, "1/m", not_negative,
        "P32 of random discs: their area in the box over its volume, met exactly; of discs with "
        "one direction it is also P10, their number per length across them");
    key("number", number, "-", Range{0.0, 1e5},
        "how many random discs have their middle in the box, in place of intensity");
    key("normal", normal, "-", any_number, "mean direction across them");
    key("concentration", concentration, "-", not_negative,
        "kappa of Fisher's distribution around it: 0: every direction alike, inf: all have normal");
    key("radius_law", radius_law, OneOf{"constant", "exponential", "lognormal", "power"},
        "how large they are: all as radius; exponential or lognormal with that mean; power: "
        "density "
        "r^-radius_exponent from least to most");
    key("radius", radius, "m", not_negative, "mean radius before least and most");
    key("radius_deviation", radius_deviation, "m", not_negative,
        "standard deviation of lognormal radii");
    key("radius_exponent", radius_exponent, "-", positive, "exponent of the power law");
    key("least", least, "m", not_negative, "smaller radii are drawn again; 0: no limit");
    key("most", most, "m", not_negative, "larger radii are drawn again; 0: no limit");
    key("sides", sides, "-", Range{3, 64},
        "corners of the regular polygon that stands for a disc of its area");
    key("clear", clear, "m", Range{-1.0, 1e30},
        "a random disc is drawn again where it would pass another crack nearer than that, meet one "
        "along a shorter line, or at less than 20 degrees: otherwise slivers make the steps short; "
        "below 0: a quarter of the least mesh_size");
  }
};

}  // namespace breccia::fdem3
