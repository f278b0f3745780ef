#pragma once
// The case file of the FDEM in three dimensions: every key with its unit, range and meaning.
// Materials, joints and friction have the keys of the plane method.

#include "core/case_config.hpp"
#include "core/emission_config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/body_config.hpp"
#include "math/mat3.hpp"

namespace breccia::fdem3 {

using fdem::FrictionConfig;
using fdem::HistoryConfig;
using fdem::JointConfig;
using fdem::JointsConfig;
using fdem::MaterialConfig;
using fdem::SearchConfig;

/// Which part of the model a support, load or probe takes.
struct RegionConfig {
  std::string on;
  std::string faces;
  Vec3 min{-no_limit, -no_limit, -no_limit}, max{no_limit, no_limit, no_limit};  ///<  [m]
  Vec3 center{};                                                                 ///<  [m]
  double radius = 0.0;  ///< of a sphere or cylinder; 0: none  [m]
  std::string around;
  std::vector<Vec2> polygon;  ///< seen along `around`, or z; empty: none  [m]
  bool outside = false;

  template <class Visit>
  void each_key(Visit&& key) {
    key("on", on, "body that it takes part of; empty: of all bodies");
    key("faces", faces, "named surface of a mesh file that it takes; empty: all");
    key("min", min, "m", any_number, "lower corner of the region it takes");
    key("max", max, "m", any_number, "upper corner of that region");
    key("center", center, "m", any_number, "centre of the sphere or cylinder that radius asks for");
    key("radius", radius, "m", not_negative,
        "the region takes only what lies in this sphere or cylinder, too; 0: none");
    key("around", around, OneOf{"", "x", "y", "z"},
        "axis of the cylinder, and along which a polygon is seen; empty: it is a sphere, and the "
        "polygon is seen along z");
    key("polygon", polygon, "m", any_number,
        "the region takes only what lies in this prism, too, given by the corners of its section: "
        "(x, y), of `around` = \"x\" (y, z), of \"y\" (z, x); empty: none");
    key("outside", outside, "the region takes what box, sphere, cylinder and polygon leave out");
  }
};

using SupportConfig = fdem_shared::SupportConfigOf<RegionConfig, Vec3>;

using ExplosiveConfig = fdem_shared::ExplosiveConfigOf<Vec3>;

/// [[load]]: forces on free faces
struct LoadConfig : fdem_shared::FluidLoadConfigOf<RegionConfig, Vec3> {
  ExplosiveConfig explosive;

  bool is_gas() const { return explosive.energy > 0.0; }

  template <class Visit>
  void each_key(Visit&& key) {
    keys_of_place(key);
    key("kind", kind, OneOf{"pressure", "traction", "force", "absorbing", "fluid"},
        "pressure: against the face, and traction: along fixed axes, both per present area; "
        "force: a sum, spread over the faces by their area at the start, that stays as given "
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

using BoltConfig = fdem_shared::BoltConfigOf<Vec3>;

using SupportChange = fdem_shared::SupportChangeOf<Vec3>;
using LoadChange = fdem_shared::LoadChangeOf<Vec3>;
using StageConfig = fdem_shared::MeshStageConfig<Vec3>;

/// [in_situ]
struct InSituConfig {
  double xx = 0.0, yy = 0.0, zz = 0.0, yz = 0.0, xz = 0.0, xy = 0.0;  ///<  [Pa]
  /// Their change with x, y and z  [Pa/m]
  Vec3 xx_slope{}, yy_slope{}, zz_slope{}, yz_slope{}, xz_slope{}, xy_slope{};
  Vec3 origin{};  ///< where xx to xy hold  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    const Range sane{-1e15, 1e15}, steep{-1e12, 1e12};
    key("xx", xx, "Pa", sane, "stress at the start, tension positive");
    key("yy", yy, "Pa", sane, "stress at the start, tension positive");
    key("zz", zz, "Pa", sane, "stress at the start, tension positive");
    key("yz", yz, "Pa", sane, "stress at the start");
    key("xz", xz, "Pa", sane, "stress at the start");
    key("xy", xy, "Pa", sane, "stress at the start");
    key("xx_slope", xx_slope, "Pa/m", steep,
        "how much xx grows per metre along x, y and z: stress that grows with depth");
    key("yy_slope", yy_slope, "Pa/m", steep, "how much yy grows per metre along x, y and z");
    key("zz_slope", zz_slope, "Pa/m", steep,
        "how much zz grows per metre along x, y and z; under gravity g along -z: [0, 0, rho g]");
    key("yz_slope", yz_slope, "Pa/m", steep, "how much yz grows per metre along x, y and z");
    key("xz_slope", xz_slope, "Pa/m", steep, "how much xz grows per metre along x, y and z");
    key("xy_slope", xy_slope, "Pa/m", steep, "how much xy grows per metre along x, y and z");
    key("origin", origin, "m", any_number,
        "where xx to xy hold, as a point of the ground's surface");
  }
  bool graded() const {
    return norm(xx_slope) + norm(yy_slope) + norm(zz_slope) + norm(yz_slope) + norm(xz_slope) +
               norm(xy_slope) >
           0.0;
  }
  bool any() const {
    return xx != 0.0 || yy != 0.0 || zz != 0.0 || yz != 0.0 || xz != 0.0 || xy != 0.0 || graded();
  }
  /// Force per volume of the slopes.  [N/m3]
  Vec3 push() const {
    return {xx_slope.x + xy_slope.y + xz_slope.z, xy_slope.x + yy_slope.y + yz_slope.z,
            xz_slope.x + yz_slope.y + zz_slope.z};
  }
  /// Stress at the origin, and at a place at the start.  [Pa]
  Sym3 stress() const { return {xx, yy, zz, yz, xz, xy}; }
  Sym3 at(const Vec3& place) const {
    const Vec3 from = place - origin;
    return {xx + dot(xx_slope, from), yy + dot(yy_slope, from), zz + dot(zz_slope, from),
            yz + dot(yz_slope, from), xz + dot(xz_slope, from), xy + dot(xy_slope, from)};
  }
};

/// A whole case.
struct Config : CaseConfig {
  Config() { method = "fdem3d"; }

  OverTime<Vec3> gravity{};    ///<  [m/s2]
  double gravity_begin = 0.0;  ///< no key: where the time of its table begins  [s]
  double local_damping = 0.0;  ///<  [-]
  std::vector<MaterialConfig> materials;
  std::vector<JointConfig> joint_laws;
  std::vector<FrictionConfig> frictions;
  std::vector<BodyConfig> bodies;
  std::vector<DiscontinuityConfig> discontinuities;
  std::vector<JointSetConfig> joint_sets;
  JointsConfig joints;
  InSituConfig in_situ;
  std::vector<SupportConfig> supports;
  std::vector<LoadConfig> loads;
  std::vector<BoltConfig> bolts;
  std::vector<StageConfig> stages;
  double stage_friction = -1.0;      ///< no key: of contacts in this stage; below 0: as given  [-]
  std::vector<std::string> removed;  ///< no key: bodies that are gone by now
  SearchConfig search;
  EmissionConfig emission;

  template <class Visit>
  void each_key(Visit&& key) {
    CaseConfig::each_key(key);
    key("gravity", gravity, "m/s2", any_number,
        "acceleration of gravity, or a table [[t, x, y, z], ...] of it over time, as it is in the "
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
    key.table("in_situ", in_situ, "stress at the start");
    key.list("support", supports, "prescribed motion");
    key.list("load", loads, "forces on faces");
    key.list("bolt", bolts, "rock bolts: bars that a bond ties to tetrahedra");
    key.list("stage", stages, "what changes when, one stage after the other");
    key.table("search", search, "when new contacts are searched for");
    key.table("emission", emission, "which breaks are one event of acoustic emission");
  }
};

}  // namespace breccia::fdem3
