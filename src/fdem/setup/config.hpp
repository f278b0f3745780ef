#pragma once
// The case file of the FDEM: every key with its unit, range and meaning.

#include <cmath>

#include "core/case_config.hpp"
#include "core/emission_config.hpp"
#include "fdem/laws/joint_bond.hpp"
#include "fdem/setup/body_config.hpp"
#include "fdem_shared/setup/bolt_config.hpp"
#include "fdem_shared/setup/config.hpp"
#include "fdem_shared/setup/explosive_config.hpp"

namespace breccia::fdem {

using fdem_shared::sane_strength;
/// Likewise.
inline constexpr Range sane_energy{1e-9, 1e9};  ///<  [J/m2]
inline constexpr Range sane_ratio{1e-6, 1e6};   ///<  [-]

/// Strengths of the joints of one material, or between two.
struct StrengthConfig {
  double tension = 5e6;                        ///< f_t  [Pa]
  double cohesion = 15e6;                      ///< c  [Pa]
  double friction_angle = 0.6108652381980153;  ///< phi_i of whole joints  [rad]
  double residual_angle = 0.0;                 ///< phi_r  [rad]
  double energy_open = 30.0;                   ///< G_I  [J/m2]
  double energy_slide = 100.0;                 ///< G_II  [J/m2]
  double stiffness = 20.0;                     ///< p_f over Young's modulus  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("tension", tension, "Pa", sane_strength, "tensile strength f_t");
    key("cohesion", cohesion, "Pa", sane_strength, "cohesion c");
    key("friction_angle", friction_angle, "rad", Range{0.0, 1.5707, Open::high},
        "internal friction angle of a whole joint; a broken one rubs by the contact's friction");
    key("residual_angle", residual_angle, "rad", Range{0.0, 1.5707, Open::high},
        "friction angle that a pressed joint keeps while it softens, at most friction_angle; 0: "
        "none, "
        "as in Lukas et al. 2014; the codes whose contact rubs between joined triangles keep it");
    key("energy_open", energy_open, "J/m2", sane_energy, "fracture energy of opening, G_I");
    key("energy_slide", energy_slide, "J/m2", sane_energy, "fracture energy of sliding, G_II");
    key("stiffness", stiffness, "-", sane_ratio,
        "joint penalty p_f over Young's modulus; 20 keeps 92 % of the solid's stiffness");
  }
};

/// [material.<name>.bedding]: planes along which rock is weaker, and stiffer
struct BeddingConfig {
  double angle = 0.0;     ///< of the planes from x, anticlockwise  [rad]
  double strength = 1.0;  ///< along them over across  [-]
  double young = 0.0;     ///< E' across them; 0: as along them  [Pa]
  double poisson = -1.0;  ///< nu', pressed across them; -1: nu E'/E  [-]
  double shear = 0.0;     ///< G'; 0: by Saint-Venant's rule  [Pa]
  Vec3 normal{};          ///< of the planes, in space; 0: none is given  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("angle", angle, "rad", Range{-6.3, 6.3}, "angle of its planes from the x axis");
    key("normal", normal, "-", any_number,
        "tetrahedra: direction across its planes, instead of an angle");
    key("strength", strength, "-", Range{0.01, 1.0},
        "tension and cohesion of joints along its planes, over those across them; an edge or face "
        "at an angle t from a plane has strength cos^2 t + sin^2 t of them");
    key("young", young, "Pa", Range{0.0, 1e15},
        "Young's modulus across its planes; young and poisson of the material are those along "
        "them; 0: the same");
    key("poisson", poisson, "-", Range{-1.0, 1.0},
        "Poisson's ratio across its planes: strain along them over strain across, pressed across; "
        "-1: poisson of the material times the ratio of the two Young's moduli");
    key("shear", shear, "Pa", Range{0.0, 1e15},
        "shear modulus G' between its planes; 0: by Saint-Venant's rule, 1/G' = 1/E + 1/E' + 2 "
        "nu'/E'");
  }
  /// Whether it is stiffer in one direction than in others.
  bool has_stiffness() const { return young > 0.0 || poisson > -1.0 || shear > 0.0; }
  bool is_given() const { return strength != 1.0 || angle != 0.0 || has_stiffness(); }
  /// Of a joint with this unit normal, in space.  [-]
  double share(const Vec3& across) const {
    if (strength == 1.0) return 1.0;
    const double along = dot(across, normal) / norm(normal);
    return strength + (1.0 - strength) * (1.0 - along * along);
  }
  /// Of a joint along a unit vector.  [-]
  double share(const Vec2& along) const {
    const double across = cross(Vec2{std::cos(angle), std::sin(angle)}, along);
    return strength + (1.0 - strength) * across * across;
  }
};

/// [material.<name>]
struct MaterialConfig {
  std::string name;
  std::string use;
  double density = 2700.0;  ///<  [kg/m3]
  double young = 60e9;      ///< E  [Pa]
  double poisson = 0.25;    ///< nu  [-]
  double damping = 0.0;     ///< eta over 2 h sqrt(E rho)  [-]
  std::string joints = "intrinsic";
  StrengthConfig joint;
  BeddingConfig bedding{};
  double contact_stiffness = 10.0;    ///< p_n over E  [-]
  double tangential_stiffness = 0.1;  ///< p_t over p_n  [-]
  double friction = 0.6;              ///< of contact  [-]
  double young_now = 0.0;             ///< no key: of its triangles in this stage; 0: young  [Pa]
  double in_situ_share = 1.0;         ///< no key: of the stress in situ that they bear  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("use", use,
        "material of the program whose numbers it has (breccia materials); keys that stand here "
        "take their place; empty: none");
    key("density", density, "kg/m3", Range{1e-3, 1e6}, "mass per volume");
    key("young", young, "Pa", Range{1e3, 1e15}, "Young's modulus");
    key("poisson", poisson, "-", Range{-1.0, 1.0, Open::both},
        "Poisson's ratio; below 0.5 in plane strain");
    key("damping", damping, "-", Range{0.0, 1e3},
        "viscosity over 2 h sqrt(E rho): 0.5 for quasi-static runs, 0.02 for dynamic ones");
    key("joints", joints, OneOf{"intrinsic", "extrinsic", "none"},
        "intrinsic: joints from the start; extrinsic: joints appear where strength is reached; "
        "none: it does not break; two such materials that share an edge move as one there, while "
        "to others only a [joint.<name>] between both joins it");
    key.table("joint", joint, "strength of its joints");
    key.table("bedding", bedding, "planes along which its joints are weaker and it is stiffer");
    key("contact_stiffness", contact_stiffness, "-", sane_ratio,
        "contact penalty p_n over Young's modulus");
    key("tangential_stiffness", tangential_stiffness, "-", sane_ratio,
        "tangential contact penalty p_t over p_n");
    key("friction", friction, "-", Range{0.0, 1e3},
        "coefficient of friction of contact; between two materials the lower one counts");
  }
};

/// [joint.<name>]: joints between two materials, or along a discontinuity
struct JointConfig {
  std::string name;
  std::vector<std::string> between;
  StrengthConfig strength;

  template <class Visit>
  void each_key(Visit&& key) {
    key("between", between,
        "the two materials whose triangles it joins; empty: for discontinuities that name it");
    key.table("strength", strength,
              "its strength; stiffness counts the stiffer material's modulus");
  }
};

using fdem_shared::FrictionConfig;
using fdem_shared::HistoryConfig;
using fdem_shared::SearchConfig;

/// Which part of the model a support, load or probe takes.
struct RegionConfig {
  std::string on;
  std::string edges;
  Vec2 min{-no_limit, -no_limit}, max{no_limit, no_limit};  ///<  [m]
  Vec2 center{};                                            ///<  [m]
  double radius = 0.0;                                      ///< of a circle; 0: none  [m]
  std::vector<Vec2> polygon;                                ///< empty: none  [m]
  bool outside = false;

  template <class Visit>
  void each_key(Visit&& key) {
    key("on", on, "body that it takes part of; empty: of all bodies");
    key("edges", edges, "named line of a mesh file that it takes; empty: all");
    key("min", min, "m", any_number, "lower corner of the region it takes");
    key("max", max, "m", any_number, "upper corner of that region");
    key("center", center, "m", any_number, "centre of the circle that radius asks for");
    key("radius", radius, "m", not_negative,
        "the region takes only what lies in this circle, too; 0: no circle");
    key("polygon", polygon, "m", any_number,
        "the region takes only what lies in this polygon, too, given by its corners; empty: none");
    key("outside", outside, "the region takes what box, circle and polygon leave out");
  }
};

using SupportConfig = fdem_shared::SupportConfigOf<RegionConfig, Vec2>;

using ExplosiveConfig = fdem_shared::ExplosiveConfigOf<Vec2>;

/// [[load]]: forces on free edges
struct LoadConfig : fdem_shared::FluidLoadConfigOf<RegionConfig, Vec2> {
  ExplosiveConfig explosive;

  bool is_gas() const { return explosive.energy > 0.0; }

  template <class Visit>
  void each_key(Visit&& key) {
    keys_of_place(key);
    key("kind", kind, OneOf{"pressure", "traction", "force", "absorbing", "fluid"},
        "pressure: against the edge, and traction: along fixed axes, both per present length; "
        "force: a sum, spread over the edges by their length at the start, that stays as given "
        "however they deform; absorbing: takes waves up (Lysmer and Kuhlemeyer); fluid: a pressure "
        "on the border in the region, which spreads through broken joints and open cracks that are "
        "connected to the region");
    keys_of_size(key);
    keys_of_fluid(key);
    key.table("explosive", explosive,
              "fluid: gas whose pressure follows from its volume; then pressure is left out");
    history.each_key(key);
  }
};

using BoltConfig = fdem_shared::BoltConfigOf<Vec2>;

using SupportChange = fdem_shared::SupportChangeOf<Vec2>;

using LoadChange = fdem_shared::LoadChangeOf<Vec2>;
/// [[stage]]
struct StageConfig : fdem_shared::MeshStageConfig<Vec2, LoadChange> {
  double restitution = 0.0;  ///< 0: as before  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    MeshStageConfig::each_key(key);
    key("restitution", restitution, "-", Range{0.0, 1.0},
        "coefficient of restitution of contacts from its beginning on; 0: as before");
  }
};
using fdem_shared::MaterialChange;

/// [in_situ]
struct InSituConfig {
  double xx = 0.0, yy = 0.0, xy = 0.0;      ///< stress at the start, tension positive  [Pa]
  Vec2 xx_slope{}, yy_slope{}, xy_slope{};  ///< its change with x and y  [Pa/m]
  Vec2 origin{};                            ///< where xx, yy and xy hold  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("xx", xx, "Pa", Range{-1e15, 1e15}, "stress at the start, tension positive");
    key("yy", yy, "Pa", Range{-1e15, 1e15}, "stress at the start, tension positive");
    key("xy", xy, "Pa", Range{-1e15, 1e15}, "stress at the start");
    key("xx_slope", xx_slope, "Pa/m", Range{-1e12, 1e12},
        "how much xx grows per metre along x and y: stress that grows with depth");
    key("yy_slope", yy_slope, "Pa/m", Range{-1e12, 1e12},
        "how much yy grows per metre along x and y; under gravity g along -y: [0, rho g]");
    key("xy_slope", xy_slope, "Pa/m", Range{-1e12, 1e12},
        "how much xy grows per metre along x and y");
    key("origin", origin, "m", any_number,
        "where xx, yy and xy hold, as a point of the ground's surface");
  }
  bool graded() const { return norm(xx_slope) + norm(yy_slope) + norm(xy_slope) > 0.0; }
  bool any() const { return xx != 0.0 || yy != 0.0 || xy != 0.0 || graded(); }
  /// Force per volume of the slopes.  [N/m3]
  Vec2 push() const { return {xx_slope.x + xy_slope.y, xy_slope.x + yy_slope.y}; }
  /// Stress at the origin, and at a place at the start.  [Pa]
  Sym2 stress() const { return {xx, yy, xy}; }
  Sym2 at(const Vec2& place) const {
    const Vec2 from = place - origin;
    return {xx + dot(xx_slope, from), yy + dot(yy_slope, from), xy + dot(xy_slope, from)};
  }
};

/// [contact]
struct ContactConfig {
  bool conservative = false;
  double restitution = 1.0;  ///< e  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("restitution", restitution, "-", Range{0.05, 1.0},
        "coefficient of restitution of bodies that hardly deform: a contact gives back e^2 of the "
        "energy that it has taken up (1: all), elastic bodies give back all of theirs; less than 1 "
        "costs one polygon cut a contact and step, and shorter steps");
    key("conservative", conservative,
        "adds the forces that make contact of deformable triangles the gradient of an energy; "
        "costs one polygon cut a contact");
  }
};

/// [joints]: what all joints share
struct JointsConfig {
  double softening_factor = exact_softening_factor;
  std::string unloading = "secant";
  std::string criterion = "rock";

  template <class Visit>
  void each_key(Visit&& key) {
    key("softening_factor", softening_factor, "-", sane_ratio,
        "softening length times strength over fracture energy: 2.5886128 dissipates exactly the "
        "fracture energy, 3 is the classical codes' and 15.9 % too much");
    key("unloading", unloading, OneOf{"secant", "reversible"},
        "secant: damage stays; reversible: joints heal as in the classical codes");
    key("criterion", criterion, OneOf{"rock", "edge"},
        "rock: a joint within a material fails where the stress of the rock beside it reaches f_t, "
        "or "
        "c - sigma tan phi, on any plane near its edge, and keeps f_t and G_I on a free mesh; "
        "edge: by "
        "its own tractions, as in the classical codes: on a free mesh 10 % (tension) to 60 % "
        "(discs) too "
        "strong; [joint.<name>] is always edge");
  }
};

/// A whole FDEM case.
struct Config : CaseConfig {
  std::string plane = "stress";
  OverTime<Vec2> gravity{};    ///<  [m/s2]
  double gravity_begin = 0.0;  ///< no key: where the time of its table begins  [s]
  double local_damping = 0.0;  ///<  [-]
  std::vector<MaterialConfig> materials;
  std::vector<JointConfig> joint_laws;
  std::vector<FrictionConfig> frictions;
  std::vector<BodyConfig> bodies;
  std::vector<DiscontinuityConfig> discontinuities;
  std::vector<JointSetConfig> joint_sets;
  JointsConfig joints;
  ContactConfig contact;
  InSituConfig in_situ;
  std::vector<SupportConfig> supports;
  std::vector<LoadConfig> loads;
  std::vector<BoltConfig> bolts;
  std::vector<StageConfig> stages;
  double stage_friction = -1.0;      ///< no key: of contacts in this stage; below 0: as given  [-]
  std::vector<std::string> removed;  ///< no key: bodies that are gone by now
  SearchConfig search;
  PlaneEmissionConfig emission;

  template <class Visit>
  void each_key(Visit&& key) {
    CaseConfig::each_key(key);
    key("plane", plane, OneOf{"stress", "strain"}, "plane stress or plane strain");
    key("gravity", gravity, "m/s2", any_number,
        "acceleration of gravity, or a table [[t, x, y], ...] of it over time, as it is in the "
        "middle of each ten steps");
    key("local_damping", local_damping, "-", Range{0.0, 1.0, Open::high},
        "share of each force that opposes motion (Cundall), for quasi-static runs only");
    key.named("material", materials, "the materials");
    key.named("joint", joint_laws, "joints between two materials, or of discontinuities");
    key.list("friction", frictions, "coefficients of friction by pairs of materials");
    key.list("body", bodies, "what there is");
    key.list("discontinuity", discontinuities, "cracks and weak planes at the start");
    key.list("joint_set", joint_sets, "many cracks or weak planes, from a file or at random");
    key.table("joints", joints, "what all joints share");
    key.table("contact", contact, "what happens where triangles touch");
    key.table("in_situ", in_situ, "stress at the start");
    key.list("support", supports, "prescribed motion");
    key.list("load", loads, "forces on edges");
    key.list("bolt", bolts, "rock bolts: bars that a bond ties to triangles");
    key.list("stage", stages, "what changes when, one stage after the other");
    key.table("search", search, "when new contacts are searched for");
    key.table("emission", emission, "which breaks are one event of acoustic emission");
  }
};

}  // namespace breccia::fdem
