#pragma once
// The case file of the DEM: every key with its unit, range and meaning.

#include <cmath>

#include "core/case_config.hpp"
#include "core/emission_config.hpp"
#include "dem/setup/drive_config.hpp"
#include "dem/setup/material_config.hpp"

namespace breccia::dem {

/// [body.pack]: a disordered packing
struct PackConfig {
  int count = 0;                        ///< elements; 0: by the sieves  [-]
  double size_ratio = 2.0;              ///< largest over smallest radius, uniformly spread  [-]
  double compactness = 0.60;            ///< share of the volume that elements fill  [-]
  double porosity = 0.0;                ///< that must be reached; 0: by compactness  [-]
  std::vector<double> sieves{};         ///< of a grading curve  [m]
  std::vector<double> passing{};        ///< share of the mass that passes each  [-]
  std::vector<std::string> periodic{};  ///< directions without faces
  Vec3 cell{};                          ///< of what is repeated along them; 0: the body's edge  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("count", count, "-", Range{0, 2e9},
        "how many elements fill the body; needed unless sieves give their sizes");
    key("size_ratio", size_ratio, "-", Range{1.0, 10.0},
        "largest over smallest radius; not used where sieves are given");
    key("compactness", compactness, "-", Range{0.05, 0.64},
        "share of the volume that elements fill; denser ones than 0.6 keep overlaps");
    key("porosity", porosity, "-", Range{0.0, 0.95},
        "share of the volume that elements leave free, instead of compactness, without overlaps: "
        "where that is not reached, the body is refused; 0: by compactness");
    key("sieves", sieves, "m", positive,
        "sizes of sieves, growing: the diameters of elements follow the grading curve that sieves "
        "and passing give");
    key("passing", passing, "-", Range{0.0, 1.0},
        "share of the mass of elements that passes each of the sieves, from 0 to 1; linear in the "
        "size in between");
    key("periodic", periodic,
        "directions among x, y, z of the upright body in which it is cut out of a periodic "
        "packing, so that its faces are like any plane within; elements reach beyond such faces "
        "by up to their radius");
    key("cell", cell, "m", not_negative,
        "edges of the periodic cell that is packed once and repeated; 0: the edge of the body");
  }
};

/// [[body.rebar.bar]]: a bar, or a stirrup, along straight lines
struct BarConfig {
  std::string mark;          ///< for messages
  std::vector<Vec3> points;  ///< of its axis, from the centre of the body  [m]
  bool closed = false;       ///< back to the first point
  double diameter = 0.0;     ///< 0: that of the rebar  [m]
  int copies = 1;            ///< alike, each `step` from the one before  [-]
  Vec3 step{};               ///<  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("mark", mark, "what messages call the bar; empty: its number");
    key("points", points, "m", any_number,
        "points of the axis in the frame of the body (its centre is the origin; of an STL body "
        "that of the file), joined by straight lines");
    key.required("points");
    key("closed", closed, "whether the last point is joined to the first one, as of a stirrup");
    key("diameter", diameter, "m", not_negative, "bar diameter; 0: that of the rebar");
    key("copies", copies, "-", Range{1, 10000}, "how many such bars lie beside each other");
    key("step", step, "m", any_number, "from one copy to the next");
  }
};

/// [body.rebar]: bars through a body: as drawn, or mats through a box
struct RebarConfig {
  std::string in;                ///< body that the bars reinforce
  std::string interface_law;     ///< material of the bond
  double diameter = 8e-3;        ///< d_b  [m]
  double cover = 0.02;           ///< from the face to the outer bar's axis  [m]
  int layers = 2;                ///< mats: 1 bottom, 2 bottom and top  [-]
  int bars = 7;                  ///< bars in each direction of a mat  [-]
  int bars_x = 0, bars_y = 0;    ///< along x, along y; 0: `bars`  [-]
  int elements = 28;             ///< elements along each bar of a mat  [-]
  double spacing = 0.0;          ///< of elements along drawn bars; 0: twice the diameter  [m]
  std::vector<BarConfig> drawn;  ///< instead of mats

  int along_x() const { return bars_x > 0 ? bars_x : bars; }
  int along_y() const { return bars_y > 0 ? bars_y : bars; }

  template <class Visit>
  void each_key(Visit&& key) {
    key("in", in, "body that the bars reinforce: of concrete; for mats a box");
    key.required("in");
    key("interface", interface_law, "material (law interface) that bonds bars and concrete");
    key.required("interface");
    key("diameter", diameter, "m", positive, "bar diameter");
    key("cover", cover, "m", positive, "distance from the face to the axes of the outer bars");
    key("layers", layers, "-", Range{1, 2}, "1: a mat near the bottom; 2: also one near the top");
    key("bars", bars, "-", Range{1, 10000}, "bars in each of the two directions of a mat");
    key("bars_x", bars_x, "-", Range{0, 10000}, "bars along x of a mat; 0: as many as bars says");
    key("bars_y", bars_y, "-", Range{0, 10000}, "bars along y of a mat; 0: as many as bars says");
    key("elements", elements, "-", Range{2, 100000}, "elements along each bar of a mat");
    key("spacing", spacing, "m", not_negative,
        "distance of elements along drawn bars, about; 0: twice the diameter");
    key.list("bar", drawn, "bars and stirrups one by one, instead of mats");
  }
};

/// [[body.join]] and [[body.cut]]: what belongs to a body besides its shape, and what is taken out
struct CutConfig {
  std::string shape = "box";
  Vec3 center{};             ///<  [m]
  Vec3 size{};               ///< edge lengths of a box  [m]
  double radius = 0.0;       ///< of a sphere or cylinder  [m]
  double length = 0.0;       ///< of a cylinder  [m]
  Vec3 axis{0.0, 0.0, 1.0};  ///< where its own z points
  Vec3 across{};             ///< about where its own x points; 0: turned the shortest way
  std::string file;          ///< STL
  double file_unit = 1.0;    ///<  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("shape", shape, OneOf{"box", "sphere", "cylinder", "stl"},
        "stl: a closed surface of triangles from a file");
    key("center", center, "m", any_number,
        "its centre, in the coordinates of the case; where the origin of a file lies");
    key("size", size, "m", not_negative,
        "edge lengths of a box; of a cut one may be 0: a crack, which parts links");
    key("radius", radius, "m", not_negative, "radius of a sphere or cylinder");
    key("length", length, "m", not_negative, "length of a cylinder, along its axis");
    key("axis", axis, "-", any_number, "direction of its own z, along a cylinder");
    key("across", across, "-", any_number,
        "about the direction of its own x; left out: turned the shortest way");
    key("file", file, "stl: the file, beside the case file");
    key("file_unit", file_unit, "m", positive, "length of one unit of the file's coordinates");
  }
};

/// [body.grains]: grains of spheres whose boundaries are of another material
struct GrainsConfig {
  std::string kind;
  double size = 0.0;  ///< of a grain  [m]
  std::string boundary;

  bool any() const { return !kind.empty() || size > 0.0 || !boundary.empty(); }
  template <class Visit>
  void each_key(Visit&& key) {
    key("kind", kind, OneOf{"voronoi"}, "voronoi: grains of the given size");
    key.required("kind");
    key("size", size, "m", not_negative, "size of a Voronoi grain: root of its mean volume");
    key("boundary", boundary,
        "material, of the body's law (concrete or parallel), whose strengths and moduli all links "
        "between two grains have; how far these open before they part stays the body's where that "
        "has a fracture_energy");
  }
};

/// [[body]]
struct BodyConfig {
  std::string name;
  std::string shape = "box";
  std::string material;
  Vec3 center{};        ///<  [m]
  Vec3 size{};          ///< edge lengths of a box  [m]
  double radius = 0.0;  ///< of a sphere or cylinder  [m]
  double length = 0.0;  ///< of a cylinder, along z  [m]
  PackConfig pack;
  RebarConfig rebar;
  Vec3 velocity{};           ///< at the start  [m/s]
  Vec3 spin{};               ///< at the start, of every element about the body's centre  [rad/s]
  Vec3 axis{0.0, 0.0, 1.0};  ///< where its own z points
  Vec3 across{};             ///< about where its own x points; 0: turned the shortest way
  std::vector<CutConfig> joins;  ///< that belong to it, too
  std::vector<CutConfig> cuts;   ///< taken out of all that
  std::string file;              ///< CSV of x, y, z, radius in metres; of LDPM its tetrahedra; STL
  double file_unit = 1.0;        ///< of an STL file  [m]
  double volume = 0.0;  ///< of the bulk that a file's spheres stand for; 0: of the box `size`  [m3]
  GrainsConfig grains{};

  /// Of what a file's spheres stand for; 0: of nothing but themselves.  [m3]
  double bulk_volume() const { return volume > 0.0 ? volume : size.x * size.y * size.z; }

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the body: its elements form a group of this name");
    key.required("name");
    key("shape", shape, OneOf{"box", "sphere", "cylinder", "stl", "element", "rebar", "file"},
        "box, sphere, cylinder: a packing; stl: a packing in the closed surface of an STL file; "
        "element: one sphere; rebar: bars; file: spheres from a CSV, or particles and tetrahedra "
        "of law ldpm");
    key("material", material, "name of a material");
    key.required("material");
    key("center", center, "m", any_number,
        "centre of the body; where the origin of an STL file lies");
    key("size", size, "m", not_negative,
        "edge lengths of a box, also of one that the spheres of a file fill");
    key("radius", radius, "m", not_negative, "radius of a sphere, cylinder or single element");
    key("length", length, "m", not_negative, "length of a cylinder, along its axis");
    key("axis", axis, "-", any_number,
        "direction of the body's own z, along a cylinder: the body is turned about its centre, "
        "with bars in it");
    key("across", across, "-", any_number,
        "about the direction of the body's own x; left out: turned the shortest way");
    key.list(
        "join", joins,
        "boxes, spheres and cylinders that belong to the body, too: it is their union with its "
        "own box, sphere or cylinder");
    key.list("cut", cuts, "notches, holes and slots, sawn out of a packed body");
    key.table("pack", pack, "the packing of a box, sphere, cylinder or STL file");
    key.table("rebar", rebar, "the bars of a rebar body");
    key.table("grains", grains, "grains, with links of another material between them");
    key("velocity", velocity, "m/s", Range{-1e6, 1e6}, "velocity at the start");
    key("spin", spin, "rad/s", Range{-1e6, 1e6},
        "angular velocity of the body about its centre at the start");
    key("file", file,
        "STL file, or CSV file of x,y,z,radius in metres, beside the case file; of law ldpm: "
        "<name>-data-tets.dat of a public preprocessor, with <name>-data-particles.dat beside it, "
        "or, for its facets as they are, <name>-data-facets.dat or <name>-data-facetsVertices.dat, "
        "in mm");
    key("file_unit", file_unit, "m", positive, "stl: length of one unit of the file's coordinates");
    key("volume", volume, "m3", not_negative,
        "volume of concrete that the spheres of a file stand for, voids included: it gives their "
        "mass; 0: that of the box size. Grains of a file have their own volume unless either is "
        "given");
  }
};

/// [links]
struct LinksConfig {
  double per_element = 0.0;  ///< z; the interaction range is solved for  [-]
  double range = 1.4;        ///< gamma_int, used when per_element is 0  [-]
  int count = 0;             ///< links in the whole model; 0: by per_element or range  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("per_element", per_element, "-", not_negative,
        "links per element (2 x links / elements); the interaction range is solved for; 0: use "
        "range");
    key("range", range, "-", Range{1.0, 3.0},
        "elements are linked up to this many times the sum of their radii");
    key("count", count, "-", Range{0, 2e9},
        "links in the whole model; the interaction range is solved for; 0: use per_element or "
        "range");
  }
};

/// [contact]
struct ContactConfig {
  std::string law = "linear";
  double friction = 0.5773502691896257;  ///< tan phi_c  [-]
  double restitution = 1.0;              ///< e  [-]
  double rolling_limit = 0.0;            ///< eta of contacts  [-]
  double rolling_stiffness = 0.0;        ///< beta_r of contacts  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("law", law, OneOf{"linear", "hertz"},
        "linear springs with the links' stiffness, or Hertz and Mindlin");
    key("friction", friction, "-", Range{0.0, 1e3},
        "coefficient of friction of contacts, and of broken links unless broken_friction is given");
    key("restitution", restitution, "-", Range{0.0, 1.0, Open::low},
        "coefficient of restitution of new contacts; 1 switches their dashpots off");
    key("rolling_limit", rolling_limit, "-", Range{0.0, 1e6},
        "eta, plastic limit of rolling moments");
    key("rolling_stiffness", rolling_stiffness, "-", Range{0.0, 1e6},
        "beta_r, rolling stiffness over shear stiffness times radius squared; 0: contacts roll "
        "freely");
  }
};

/// [search]
struct SearchConfig {
  double margin = 0.2;  ///< over the mean radius  [-]
  int every = 0;        ///< steps; 0: by travel  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("margin", margin, "-", Range{0.0, 1.0, Open::low},
        "how far two elements may approach before a new search, over the mean radius");
    key("every", every, "-", Range{0, 100},
        "search every so many steps, as Durand et al. 2012 do (10); 0 searches when travel uses "
        "the margin up");
  }
};

/// A whole DEM case.
struct Config : CaseConfig {
  OverTime<Vec3> gravity{};    ///<  [m/s2]
  double gravity_begin = 0.0;  ///< no key: where the time of its table begins  [s]
  double local_damping = 0.0;  ///< lambda_d, quasi-static runs only  [-]
  std::vector<MaterialConfig> materials;
  std::vector<BodyConfig> bodies;
  LinksConfig links;
  ContactConfig contact;
  std::vector<WallConfig> walls;
  std::vector<SupportConfig> supports;
  std::vector<StageConfig> stages;
  double stage_friction = -1.0;      ///< no key: of contacts in this stage; below 0: as given  [-]
  std::vector<std::string> removed;  ///< no key: bodies that are gone by now
  SearchConfig search;
  EmissionConfig emission;

  template <class Visit>
  void each_key(Visit&& key) {
    CaseConfig::each_key(key);
    key("gravity", gravity, "m/s2", Range{-1e6, 1e6},
        "acceleration of gravity, or a table [[t, x, y, z], ...] of it over time, as it is in the "
        "middle of each ten steps");
    key("local_damping", local_damping, "-", Range{0.0, 1.0, Open::high},
        "share of each force that opposes motion (Cundall), for quasi-static runs only");
    key.named("material", materials, "the materials");
    key.list("body", bodies, "what there is");
    key.table("links", links, "which elements are linked at the start");
    key.table("contact", contact, "what happens where elements touch");
    key.list("wall", walls, "rigid planes, boxes, cylinders, spheres and surfaces of STL files");
    key.list("support", supports, "prescribed motion");
    key.list("stage", stages, "what changes when, one stage after the other");
    key.table("search", search, "when new contacts are searched for");
    key.table("emission", emission, "which breaks are one event of acoustic emission");
  }
};

}  // namespace breccia::dem
