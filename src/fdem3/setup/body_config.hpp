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

}  // namespace breccia::fdem3
