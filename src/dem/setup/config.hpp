#pragma once
// The case file of the DEM: every key with its unit, range and meaning.

#include <cmath>

#include "core/case_config.hpp"
#include "dem/setup/drive_config.hpp"

namespace breccia::dem {

/// [material.<name>.ldpm]: the facet law of LDPM (docs/theory-ldpm.md), besides young, poisson,
/// tensile_strength s_t and cohesion s_s of the material
struct LdpmConfig {
  double tensile_length = 0.5;       ///< l_t  [m]
  double softening_exponent = 0.4;   ///< n_t  [-]
  double unloading = 0.0;            ///< k_t  [-]
  double collapse_strength = 150e6;  ///< s_c0  [Pa]
  double hardening = 0.4;            ///< H_c0 / E_0  [-]
  double final_hardening = 0.1;      ///< H_c1 / E_0  [-]
  double compaction_strain = 4.0;    ///< k_c0  [-]
  double deviatoric_start = 1.0;     ///< k_c1  [-]
  double deviatoric_slope = 5.0;     ///< k_c2  [-]
  double friction = 0.4;             ///< mu_0  [-]
  double final_friction = 0.0;       ///< mu_inf  [-]
  double friction_stress = 600e6;    ///< s_N0  [Pa]
  double densification = 1.0;        ///< E_d / E_0  [-]
  double rate_factor = 0.0;          ///< c_1; 0: strengths do not depend on rate  [-]
  double rate_reference = 1e-5;      ///< c_0  [1/s]

  template <class Visit>
  void each_key(Visit&& key) {
    key("tensile_length", tensile_length, "m", positive,
        "l_t = 2 E_0 G_t / s_t^2 of the fracture energy G_t; longer than every edge");
    key("softening_exponent", softening_exponent, "-", not_negative,
        "n_t, how soon softening ends between tension and shear");
    key("unloading", unloading, "-", Range{0.0, 1.0, Open::high},
        "k_t, share of the largest strain at which a closed crack bears tension again");
    key("collapse_strength", collapse_strength, "Pa", positive,
        "s_c0, compressive stress at which pores begin to collapse");
    key("hardening", hardening, "-", not_negative,
        "H_c0 / E_0, hardening in hydrostatic compression");
    key("final_hardening", final_hardening, "-", not_negative,
        "H_c1 / E_0, hardening far from hydrostatic compression");
    key("compaction_strain", compaction_strain, "-", Range{1.0, no_limit},
        "k_c0, strain at which compaction begins, over s_c0 / E_0");
    key("deviatoric_start", deviatoric_start, "-", not_negative,
        "k_c1, ratio of deviatoric to volumetric strain up to which H_c0 holds");
    key("deviatoric_slope", deviatoric_slope, "-", not_negative,
        "k_c2, how soon hardening falls with that ratio");
    key("friction", friction, "-", Range{0.0, 1e3}, "mu_0, friction at low pressure");
    key("final_friction", final_friction, "-", Range{0.0, 1e3},
        "mu_inf, friction at high pressure");
    key("friction_stress", friction_stress, "Pa", positive,
        "s_N0, pressure over which friction falls from one to the other");
    key("densification", densification, "-", positive,
        "E_d / E_0, stiffness in unloading from beyond s_c0 over the elastic one");
    key("rate_factor", rate_factor, "-", Range{0.0, 1.0},
        "c_1: strengths in tension and shear grow to 1 + c_1 asinh(strain rate / c_0) times "
        "themselves; published: 0.05; 0: they do not");
    key("rate_reference", rate_reference, "1/s", positive, "c_0, strain rate of slow tests");
  }
};

/// [material.<name>.mix]: a mix design, of which LDPM places the coarse grains
struct MixConfig {
  double cement = 315.0;           ///< c  [kg/m3]
  double water_ratio = 0.5;        ///< w/c  [-]
  double aggregate_ratio = 0.0;    ///< a/c; 0: by cement  [-]
  double cement_density = 3150.0;  ///<  [kg/m3]
  double air = 0.03;               ///<  [-]
  double smallest = 6e-3;          ///< d_0  [m]
  double largest = 12e-3;          ///< d_a  [m]
  double fuller = 0.5;             ///< n_F  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("cement", cement, "kg/m3", Range{10.0, 1000.0},
        "c, mass of cement over volume of concrete");
    key("water_ratio", water_ratio, "-", Range{0.1, 2.0}, "w/c, water over cement by mass");
    key("aggregate_ratio", aggregate_ratio, "-", not_negative,
        "a/c, aggregate over cement by mass: then c follows from the density of the material; 0: c "
        "is given");
    key("cement_density", cement_density, "kg/m3", Range{1000.0, 6000.0}, "density of cement");
    key("air", air, "-", Range{0.0, 0.5}, "share of the volume that air takes");
    key("smallest", smallest, "m", positive,
        "d_0, diameter of the smallest grains that are placed");
    key("largest", largest, "m", positive, "d_a, diameter of the largest grains");
    key("fuller", fuller, "-", Range{0.1, 2.5}, "n_F, exponent of the sieve curve (d / d_a)^n_F");
  }
};

/// [material.<name>]
struct MaterialConfig {
  std::string name;
  std::string use;
  std::string law = "concrete";
  double density = 2400.0;  ///< of the bulk, voids included  [kg/m3]
  double young = 30e9;      ///< E, macroscopic  [Pa]
  double poisson = 0.2;     ///< nu, macroscopic  [-]
  // concrete (docs/theory.md, cohesive links)
  double tensile_strength = 2.2e6;             ///< T, local  [Pa]
  double cohesion = 5.5e6;                     ///< C, local  [Pa]
  double softening = 5.0;                      ///< zeta: initial over softening stiffness  [-]
  double fracture_energy = 0.0;                ///< G_F, macroscopic; 0: by zeta  [J/m2]
  double friction_angle = 0.5235987755982988;  ///< phi_i of intact links  [rad]
  double rolling_stiffness = 1.0;              ///< beta_r  [-]
  double rolling_limit = 0.17;                 ///< eta  [-]
  double rolling_cap = 0.0;                    ///< s_M; 0: none  [Pa]
  double broken_friction = -1.0;               ///< mu_b; below 0: that of contacts  [-]
  double friction_cap = 0.0;                   ///< s_F; 0: none  [Pa]
  double broken_rolling_limit = -1.0;          ///< eta_b; below 0: eta  [-]
  double slip_wear = 0.0, turn_wear = 0.0;     ///< w_s, w_m  [-]
  double compaction_strength = 0.0;            ///< Y_c; 0: none  [Pa]
  double compaction_slope = 0.4;               ///< H_c  [-]
  double crushing_strength = 0.0;              ///< Y_b; 0: none  [Pa]
  double crushing_slope = 0.4;                 ///< H_b  [-]
  double closing_strain = 0.0;                 ///< p_c; 0: none  [-]
  std::string rate = "none";
  double rate_strength = 30e6;                    ///< f_c, static, of malvar_ross  [Pa]
  double rate_crossings = 5.0;                    ///< time constant over D / c  [-]
  double alpha = 3.9, beta = 3.125, gamma = 5.0;  ///< macro-micro constants  [-]
  std::string shear = "plastic";
  // parallel: the strengths and constants above, and
  double bond_radius = 1.0;   ///< lambda: of the bond, over the smaller element's  [-]
  double moment_share = 1.0;  ///< beta of moments in the bond's stresses  [-]
  std::string fabric = "packed", stiffness = "estimated";
  // ldpm
  LdpmConfig ldpm;
  MixConfig mix;
  // steel
  double yield = 500e6;          ///< f_y  [Pa]
  double hardening = 1e9;        ///< H  [Pa]
  double failure_strain = 0.08;  ///< plastic strain at rupture  [-]
  // interface (steel to concrete)
  std::string bond = "mc90";
  double bond_strength = 13.7e6;                    ///< tau_max  [Pa]
  double bond_residual = 5.5e6;                     ///< tau_f  [Pa]
  double slip1 = 1e-3, slip2 = 3e-3, slip3 = 8e-3;  ///< s_1, s_2, s_3  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("use", use,
        "material of the program whose numbers it has (breccia materials); keys that stand here "
        "take their place; empty: none");
    key("law", law, OneOf{"concrete", "parallel", "ldpm", "steel", "interface", "grain"},
        "concrete: cohesive links; parallel: bonds of cement between grains (bonded-particle "
        "rock); ldpm: particles of the lattice discrete particle model of concrete; "
        "steel: bars; interface: between bars and concrete; grain: contacts only");
    key("density", density, "kg/m3", Range{10.0, 1e6}, "mass per volume of the bulk material");
    key("young", young, "Pa", Range{1e3, 1e13}, "Young's modulus of the bulk material");
    key("poisson", poisson, "-", Range{-1.0, 0.5, Open::both},
        "Poisson's ratio of the bulk material; links need at most 1 / alpha");
    key("tensile_strength", tensile_strength, "Pa", Range{0.0, 1e15},
        "local tensile strength T of a link");
    key("cohesion", cohesion, "Pa", Range{0.0, 1e15}, "local cohesion C of a link");
    key("softening", softening, "-", Range{0.0, 1e9},
        "zeta, initial stiffness over softening stiffness in tension; 0 is brittle");
    key("fracture_energy", fracture_energy, "J/m2", Range{0.0, 1e9},
        "G_F, energy of a crack in tension over its area, which sets how far links open before "
        "they "
        "break, whatever the size of elements; 0: softening sets that");
    key("friction_angle", friction_angle, "rad", Range{0.0, 1.5707, Open::high},
        "internal friction angle of intact links");
    key("rolling_stiffness", rolling_stiffness, "-", Range{0.0, 1e6},
        "beta_r, rolling stiffness over shear stiffness times radius squared; 0 switches moments "
        "off");
    key("rolling_limit", rolling_limit, "-", Range{0.0, 1e6}, "eta, plastic limit of the moments");
    key("rolling_cap", rolling_cap, "Pa", Range{0.0, 1e15},
        "s_M, largest normal stress that the limit of the moments counts; 0: no bound");
    key("broken_friction", broken_friction, "-", Range{-1.0, 1e6},
        "mu_b, friction coefficient of broken links; below 0: contact.friction");
    key("friction_cap", friction_cap, "Pa", Range{0.0, 1e15},
        "s_F, largest shear stress that friction bears in a link, whole or broken; 0: no bound");
    key("broken_rolling_limit", broken_rolling_limit, "-", Range{-1.0, 1e6},
        "eta_b, plastic limit of the moments of broken links; below 0: rolling_limit");
    key("slip_wear", slip_wear, "-", Range{0.0, 1e6},
        "w_s, opening that a link gains by plastic slip, over that slip; 0: none");
    key("turn_wear", turn_wear, "-", Range{0.0, 1e6},
        "w_m, opening that a link gains by plastic turn, over that turn times the mean radius; 0: "
        "none");
    key("compaction_strength", compaction_strength, "Pa", Range{0.0, 1e15},
        "Y_c, compressive stress at which intact links and broken ones that touch yield; 0: never");
    key("compaction_slope", compaction_slope, "-", Range{0.0, 1.0, Open::high},
        "H_c, stiffness of a link beyond compaction_strength over the elastic one");
    key("crushing_strength", crushing_strength, "Pa", Range{0.0, 1e15},
        "Y_b, compressive stress at which broken links yield until their ends touch; 0: never");
    key("crushing_slope", crushing_slope, "-", Range{0.0, 1.0, Open::high},
        "H_b, stiffness of a link beyond crushing_strength over the elastic one");
    key("closing_strain", closing_strain, "-", Range{0.0, 1.0, Open::high},
        "p_c, share of its length by which compaction and crushing shorten a link until its pores "
        "are closed and it is elastic again; 0: they are never closed");
    key("rate", rate, OneOf{"none", "malvar_ross", "mc2010"},
        "how the tensile strength of a link grows with its own strain rate: none; malvar_ross: by "
        "Malvar and Ross 1998; mc2010: by the fib Model Code 2010; a quasi-static test in a few ms "
        "needs none");
    key("rate_strength", rate_strength, "Pa", Range{1e6, 1e9},
        "f_c, static compressive strength, on which the exponent of malvar_ross depends");
    key("rate_crossings", rate_crossings, "-", Range{1.0, 1000.0},
        "time over which a link's strain rate is smoothed, in crossings of the link by a wave of "
        "speed sqrt(E / density)");
    key("alpha", alpha, "-", Range{1e-6, 1e6}, "macro-micro constant of Poisson's ratio");
    key("beta", beta, "-", Range{1e-6, 1e6}, "macro-micro constant of the stiffness");
    key("gamma", gamma, "-", Range{1e-6, 1e6}, "macro-micro constant of the stiffness");
    key("shear", shear, OneOf{"plastic", "brittle"}, "what a link does at its shear strength");
    key("bond_radius", bond_radius, "-", Range{0.0, 1.0, Open::low},
        "lambda, radius of a parallel bond over that of the smaller element");
    key("moment_share", moment_share, "-", Range{0.0, 1.0},
        "how far moments count in the stresses that break a parallel bond");
    key("fabric", fabric, OneOf{"packed", "even"},
        "sections of links: packed: by the radii alone, so that faces of a body are weak and soft; "
        "even: larger where an element has fewer links than those deep in the body");
    key("stiffness", stiffness, OneOf{"estimated", "measured"},
        "stiffness of links: estimated: by alpha, beta, gamma; measured: times a factor that makes "
        "the modulus of each body, measured when it is built, that of the key young");
    key.table("ldpm", ldpm, "the facet law of a material of law ldpm");
    key.table("mix", mix, "the mix design of a material of law ldpm");
    key("yield", yield, "Pa", Range{0.0, 1e15, Open::low}, "yield stress of steel");
    key("hardening", hardening, "Pa", Range{0.0, 1e15}, "plastic hardening modulus of steel");
    key("failure_strain", failure_strain, "-", positive, "plastic strain at which steel ruptures");
    key("bond", bond, OneOf{"perfect", "plastic", "mc90"},
        "bond-slip law: no limit, constant limit, or the curve of the CEB-FIP Model Code 1990");
    key("bond_strength", bond_strength, "Pa", Range{0.0, 1e15}, "largest bond stress tau_max");
    key("bond_residual", bond_residual, "Pa", Range{0.0, 1e15},
        "bond stress after slip3, mc90 only");
    key("slip1", slip1, "m", positive, "slip at which tau_max is reached, mc90 only");
    key("slip2", slip2, "m", positive, "slip at which the bond starts to fall, mc90 only");
    key("slip3", slip3, "m", positive, "slip at which the bond is residual, mc90 only");
  }
};

/// [body.pack]: a disordered packing
struct PackConfig {
  int count = 0;              ///< elements  [-]
  double size_ratio = 2.0;    ///< largest over smallest radius, uniformly spread  [-]
  double compactness = 0.60;  ///< share of the volume that elements fill  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("count", count, "-", Range{1, 2e9}, "how many elements fill the body");
    key.required("count");
    key("size_ratio", size_ratio, "-", Range{1.0, 10.0}, "largest over smallest radius");
    key("compactness", compactness, "-", Range{0.05, 0.64},
        "share of the volume that elements fill");
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
        "points of the axis in the frame of the body (its centre is the origin), joined by "
        "straight "
        "lines");
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

/// [[body.cut]]: what is taken out of a body
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
        "edge lengths of a box; one may be 0: a crack, which parts links");
    key("radius", radius, "m", not_negative, "radius of a sphere or cylinder");
    key("length", length, "m", not_negative, "length of a cylinder, along its axis");
    key("axis", axis, "-", any_number, "direction of its own z, along a cylinder");
    key("across", across, "-", any_number,
        "about the direction of its own x; left out: turned the shortest way");
    key("file", file, "stl: the file, beside the case file");
    key("file_unit", file_unit, "m", positive, "length of one unit of the file's coordinates");
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
  Vec3 velocity{};              ///< at the start  [m/s]
  Vec3 spin{};                  ///< at the start, of every element about the body's centre  [rad/s]
  Vec3 axis{0.0, 0.0, 1.0};     ///< where its own z points
  Vec3 across{};                ///< about where its own x points; 0: turned the shortest way
  std::vector<CutConfig> cuts;  ///< taken out of it
  std::string file;             ///< CSV of x, y, z, radius in metres; of LDPM its tetrahedra; STL
  double file_unit = 1.0;       ///< of an STL file  [m]
  double volume = 0.0;  ///< of the bulk that a file's spheres stand for; 0: of the box `size`  [m3]

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
    key.list("cut", cuts, "notches, holes and slots, sawn out of a packed body");
    key.table("pack", pack, "the packing of a box, sphere, cylinder or STL file");
    key.table("rebar", rebar, "the bars of a rebar body");
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
  Vec3 gravity{};              ///<  [m/s2]
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

  template <class Visit>
  void each_key(Visit&& key) {
    CaseConfig::each_key(key);
    key("gravity", gravity, "m/s2", Range{-1e6, 1e6}, "acceleration of gravity");
    key("local_damping", local_damping, "-", Range{0.0, 1.0, Open::high},
        "share of each force that opposes motion (Cundall), for quasi-static runs only");
    key.named("material", materials, "the materials");
    key.list("body", bodies, "what there is");
    key.table("links", links, "which elements are linked at the start");
    key.table("contact", contact, "what happens where elements touch");
    key.list("wall", walls, "rigid planes, boxes, cylinders and spheres");
    key.list("support", supports, "prescribed motion");
    key.list("stage", stages, "what changes when, one stage after the other");
    key.table("search", search, "when new contacts are searched for");
  }
};

}  // namespace breccia::dem
