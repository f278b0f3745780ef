#pragma once
// The case file of two methods in one run: the keys of both below [spheres] and [tetrahedra], those
// that they share above, and what is between them.

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::coupled {

/// Passes keys on, but for some.
template <class Visit, class Names>
struct Without {
  Visit& key;
  const Names& left_out;

  bool passes(const char* name) const {
    return std::find(std::begin(left_out), std::end(left_out), std::string_view(name)) ==
           std::end(left_out);
  }
  template <class... Rest>
  void operator()(const char* name, Rest&&... rest) {
    if (passes(name)) key(name, std::forward<Rest>(rest)...);
  }
  void required(const char* name) {
    if (passes(name)) key.required(name);
  }
  template <class Config>
  void table(const char* name, Config& config, const char* meaning) {
    if (passes(name)) key.table(name, config, meaning);
  }
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, const char* meaning) {
    if (passes(name)) key.list(name, configs, meaning);
  }
  template <class Config>
  void named(const char* name, std::vector<Config>& configs, const char* meaning) {
    if (passes(name)) key.named(name, configs, meaning);
  }
};

/// Keys that a case has once, for both methods.
inline constexpr std::string_view shared_keys[] = {
    "breccia", "method", "precision", "title", "seed",  "time",  "output", "checkpoint",
    "domain",  "energy", "audit",     "probe", "check", "stage", "gravity"};

/// Keys of a stage of the whole case.
inline constexpr std::string_view shared_stage_keys[] = {"name", "until",   "rest",    "when",
                                                         "drop", "drop_of", "gravity", "remove"};

/// The keys of one of the methods, without those that both share.
template <class Whole, const auto& shared>
struct PartOf : Whole {
  template <class Visit>
  void each_key(Visit&& key) {
    Without<std::remove_reference_t<Visit>, std::remove_reference_t<decltype(shared)>> own{key,
                                                                                           shared};
    Whole::each_key(own);
  }
};
template <class Whole>
using Part = PartOf<Whole, shared_keys>;
template <class Stage>
using StagePart = PartOf<Stage, shared_stage_keys>;

/// [[stage]]
struct StageConfig : StageEnd {
  OverTime<Vec3> gravity{no_limit, no_limit, no_limit};  ///<  [m/s2]
  StagePart<dem::StageConfig> spheres;
  StagePart<fdem3::StageConfig> tetrahedra;

  template <class Visit>
  void each_key(Visit&& key) {
    constexpr std::string_view of_parts[] = {"local_damping", "friction"};
    Without<std::remove_reference_t<Visit>, decltype(of_parts)> shared{key, of_parts};
    StageEnd::each_key(shared);
    key("gravity", gravity, "m/s2", any_number,
        "acceleration of gravity from its beginning on, or a table of it over time since then; "
        "left "
        "out (inf): as before");
    key.table("spheres", spheres, "what changes of spheres and walls as it begins");
    key.table("tetrahedra", tetrahedra, "what changes of tetrahedra as it begins");
  }
};

/// [coupling]
struct CouplingConfig {
  double stiffness = 4.24;  ///< p_s R / E*  [-]
  double tangential = 0.8;  ///< over the stiffness along the normal  [-]
  double friction = 0.5;    ///< mu  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("stiffness", stiffness, "-", Range{0.0, 1e6, Open::low},
        "penalty of spheres on faces times their radius, over E* of both materials: 4.24 gives the "
        "force of Hertz at an overlap of a hundredth of the radius; ten times as much where "
        "tetrahedra are smaller than what is pressed");
    key("tangential", tangential, "-", Range{0.0, 1e3},
        "stiffness of spheres on faces across the normal, over that along it");
    key("friction", friction, "-", Range{0.0, 1e3},
        "coefficient of friction between spheres and faces");
  }
};

/// [[bond]]: spheres of one body that are tied to the surface of another one of tetrahedra
struct BondConfig {
  std::string name;
  std::string spheres, tetrahedra;             ///< bodies
  double range = 1.5;                          ///< over the radius  [-]
  double stiffness = 2.0;                      ///< p_b / E  [-]
  double tensile_strength = 3e6;               ///< f_t  [Pa]
  double cohesion = 15e6;                      ///< c  [Pa]
  double friction_angle = 0.5235987755982988;  ///< phi_i  [rad]
  double energy_open = 100.0;                  ///< G_I  [J/m2]
  double energy_slide = 1000.0;                ///< G_II  [J/m2]
  bool breaks = true;

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the bonds");
    key.required("name");
    key("spheres", spheres, "body of spheres that is tied");
    key.required("spheres");
    key("tetrahedra", tetrahedra, "body of tetrahedra that it is tied to");
    key.required("tetrahedra");
    key("range", range, "-", Range{1.0, 3.0},
        "a sphere is tied to each face with a point within so many radii of its centre");
    key("stiffness", stiffness, "-", Range{1e-3, 1e4},
        "p_b / E of the tetrahedra: slope of the bonds' tractions times their length; 2 stands for "
        "the sphere's matter between its centre and the face, so that waves pass");
    key("tensile_strength", tensile_strength, "Pa", positive, "f_t, tensile strength");
    key("cohesion", cohesion, "Pa", positive, "c, shear strength without pressure");
    key("friction_angle", friction_angle, "rad", Range{0.0, 1.5},
        "phi_i, by which pressure adds to the shear strength");
    key("energy_open", energy_open, "J/m2", positive, "G_I, fracture energy in tension");
    key("energy_slide", energy_slide, "J/m2", positive, "G_II, fracture energy in shear");
    key("breaks", breaks, "false: the bonds are elastic, whatever they bear");
  }
};

/// A whole case.
struct Config : CaseConfig {
  Config() { method = "dem3d+fdem3d"; }

  std::vector<std::string> methods{"dem3d", "fdem3d"};
  OverTime<Vec3> gravity{};  ///< [m/s2]
  Part<dem::Config> spheres;
  Part<fdem3::Config> tetrahedra;
  CouplingConfig coupling;
  std::vector<BondConfig> bonds;
  std::vector<StageConfig> stages;

  template <class Visit>
  void each_key(Visit&& key) {
    constexpr std::string_view of_one[] = {"method"};
    key("method", methods, "[\"dem3d\", \"fdem3d\"]: spheres and tetrahedra in one run");
    Without<std::remove_reference_t<Visit>, decltype(of_one)> others{key, of_one};
    CaseConfig::each_key(others);
    key("gravity", gravity, "m/s2", Range{-1e6, 1e6},
        "acceleration of gravity, or a table [[t, x, y, z], ...] of it over time");
    key.table("spheres", spheres, "keys of dem3d: what consists of spheres, and walls");
    key.table("tetrahedra", tetrahedra, "keys of fdem3d: what consists of tetrahedra");
    key.table("coupling", coupling, "how spheres press on faces of tetrahedra");
    key.list("bond", bonds, "spheres that are tied to faces of tetrahedra");
    key.list("stage", stages, "what changes when, one stage after the other");
  }
};

/// A probe of the case, as the method reads it that it asks.
struct PlacedProbe {
  bool of_spheres;
  std::size_t place;  ///< among that method's
};
/// The case of each method, with what both share.
struct Parts {
  dem::Config spheres;
  fdem3::Config tetrahedra;
  std::vector<PlacedProbe> probes;
};
Parts parts_of(const Config& config);

/// Problems that keep a case of two methods from being run, one sentence each, beyond those of its
/// parts.
std::vector<std::string> case_problems(const Config& config);

}  // namespace breccia::coupled
