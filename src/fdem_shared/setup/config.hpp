#pragma once
// Keys that both finite-discrete methods share: friction, supports, changes of stages, the search.

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "core/case_config.hpp"
#include "core/servo.hpp"
#include "core/stages.hpp"
#include "core/table_over_time.hpp"
#include "fdem_shared/prescribed.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Numbers beyond these are slips of a unit, and powers of them overflow.
inline constexpr Range sane_strength{1e-3, 1e15};  ///<  [Pa]

/// [[friction]]
struct FrictionConfig {
  std::vector<std::string> between;
  double coefficient = 0.6;

  template <class Visit>
  void each_key(Visit&& key) {
    key("between", between, "the two materials, or twice the same");
    key.required("between");
    key("coefficient", coefficient, "-", Range{0.0, 1e3},
        "coefficient of friction of their contact");
  }
};

/// How something given grows and changes over time.
struct HistoryConfig {
  double ramp = 0.0;                   ///<  [s]
  std::vector<double> times, factors;  ///<  [s], [-]
  double begin = 0.0;                  ///< no key: where its time begins  [s]

  template <class Visit>
  void each_key(Visit&& key) {
    key("ramp", ramp, "s", not_negative, "time in which it grows from zero, linearly");
    key("times", times, "s", any_number,
        "times of a table of factors, linear in between, constant beyond; empty: always 1");
    key("factors", factors, "-", any_number, "the factors at these times");
  }
};

/// x, y, and in space z.
template <class Vector>
std::vector<std::string> directions_of() {
  std::vector<std::string> all{"x", "y"};
  if (std::is_same_v<Vector, Vec3>) all.emplace_back("z");
  return all;
}

template <class Vector>
using ServoOf =
    std::conditional_t<std::is_same_v<Vector, Vec2>, PlaneServoConfig, SupportServoConfig>;

/// [[support]]: prescribed velocity of corners
template <class RegionConfig, class Vector>
struct SupportConfigOf {
  std::string name;
  RegionConfig region;
  std::vector<std::string> fix = directions_of<Vector>();
  OverTime<Vector> velocity;  ///<  [m/s]
  HistoryConfig history;
  ServoOf<Vector> servo;              ///< instead of the velocity along its axis
  OverTime<SpinOf<Vector>> spin{};    ///<  [rad/s]
  Vector point{};                     ///< of the axis; where a stage begins: at that time  [m]
  std::vector<std::string> free{};    ///< directions in which forces move what it holds
  OverTime<Vector> force{};           ///< on that  [N; in 2D N/m]
  OverTime<SpinOf<Vector>> torque{};  ///< likewise  [N m; in 2D N]

  bool is_free() const { return !free.empty(); }
  bool is_turning() const { return std::find(free.begin(), free.end(), "turn") != free.end(); }
  /// Bits of x, y, z.
  int free_directions() const {
    int bits = 0;
    for (const std::string& word : free)
      bits |= word == "x" ? 1 : word == "y" ? 2 : word == "z" ? 4 : 0;
    return bits;
  }
  template <class Visit>
  void each_key(Visit&& key) {
    constexpr bool plane = std::is_same_v<Vector, Vec2>;
    key("name", name, "name of the support: probes read its corners by it");
    key.required("name");
    region.each_key(key);
    key("fix", fix,
        plane ? "directions that are prescribed: x, y" : "directions that are prescribed: x, y, z");
    key("velocity", velocity, "m/s", any_number,
        plane
            ? "prescribed velocity of these directions, or a table [[t, x, y], ...] of it over "
              "time, linear in between and constant beyond its ends"
            : "prescribed velocity of these directions, or a table [[t, x, y, z], ...] of it over "
              "time, linear in between and constant beyond its ends");
    key("spin", spin, "rad/s", Range{-1e6, 1e6},
        plane ? "how fast it turns about point, anticlockwise, or a table [[t, w], ...] of it over "
                "time; it must fix x and y"
              : "how fast it turns about an axis through point, or a table [[t, x, y, z], ...] of "
                "it over time; it must fix the directions across the axis");
    key("point", point, "m", any_number,
        plane ? "about which spin turns it at the start; it goes along with velocity"
              : "a point of the axis about which spin turns it, at the start; it goes along with "
                "velocity");
    key("free", free,
        plane ? "of whole bodies: what it holds is rigid and moves by the forces on it, along x, y "
                "and by turn, as its mass and inertia let it; then velocity and spin are those "
                "with which it begins; []: it moves as it is told"
              : "of whole bodies: what it holds is rigid and moves by the forces on it, along x, "
                "y, z and by turn, as its mass and inertia let it; then velocity and spin are "
                "those with which it begins; []: it moves as it is told");
    key("force", force, plane ? "N/m" : "N", any_number,
        "free: given force at its centre of mass, or a table of it over time");
    key("torque", torque, plane ? "N m/m" : "N m", any_number,
        plane ? "free: given torque about its centre of mass, anticlockwise, or a table of it"
              : "free: given torque about its centre of mass, or a table of it over time");
    history.each_key(key);
    key.table("servo", servo, "moves it along an axis so that it pushes with a given force");
  }
};

/// [[stage.support]]: what a support prescribes from a stage on
template <class Vector>
struct SupportChangeOf {
  std::string name;
  std::vector<std::string> fix{"same"};
  OverTime<Vector> velocity;  ///<  [m/s]
  double ramp = 0.0;          ///<  [s]
  ServoOf<Vector> servo;
  OverTime<SpinOf<Vector>> spin{};                                    ///<  [rad/s]
  Vector point = from_space<Vector>({no_limit, no_limit, no_limit});  ///<  [m]
  std::vector<std::string> free{"same"};
  OverTime<Vector> force{};           ///<  [N; in 2D N/m]
  OverTime<SpinOf<Vector>> torque{};  ///<  [N m; in 2D N]

  bool keeps_free() const { return free == std::vector<std::string>{"same"}; }
  bool is_free() const { return !free.empty() && !keeps_free(); }

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the support");
    key.required("name");
    key("fix", fix,
        "directions that it prescribes from now on; [] sets its corners free; left out: the same "
        "as before");
    key("velocity", velocity, "m/s", any_number,
        "their velocity from now on, or a table of it over time since the stage began; left out: "
        "they stand still");
    key("spin", spin, "rad/s", Range{-1e6, 1e6},
        "how fast it turns from now on, or a table of it over time since the stage began; left "
        "out: it does not turn");
    key("point", point, "m", any_number,
        "a point of the axis of its turn, as the stage begins; left out: where its velocity has "
        "brought the one of before");
    key("free", free,
        "directions in which forces move what it holds, from now on; []: it goes where it is told; "
        "left out: the same as before");
    key("force", force, std::is_same_v<Vector, Vec2> ? "N/m" : "N", any_number,
        "free: given force from now on, or a table of it over time since the stage began; left "
        "out: none");
    key("torque", torque, std::is_same_v<Vector, Vec2> ? "N m/m" : "N m", any_number,
        "free: given torque from now on, likewise");
    key("ramp", ramp, "s", not_negative,
        "time since the stage began in which all of them grow from zero, linearly");
    key.table("servo", servo, "from now on it pushes with a given force; left out: no longer");
  }
};

/// [[load]]: forces on free sides. A method adds its kinds.
template <class RegionConfig, class Vector>
struct LoadConfigOf {
  std::string name;
  RegionConfig region;
  std::string kind = "pressure";
  OverTime<double> pressure;  ///<  [Pa]
  OverTime<Vector> traction;  ///<  [Pa]
  OverTime<Vector> force;     ///<  [N; in 2D N/m]
  HistoryConfig history;
  std::string dug_by;  ///< a stage; empty: sides on the border at the start
  bool dug = false;    ///< no key: that stage has begun

  /// Whether its sides bear it by now.
  bool acts() const { return dug_by.empty() || dug; }

 protected:
  template <class Visit>
  void keys_of_place(Visit&& key) {
    key("name", name, "name of the load");
    key.required("name");
    region.each_key(key);
    key("dug_by", dug_by,
        std::is_same_v<Vector, Vec2>
            ? "stage that takes bodies out: the load acts on the edges that this lays bare, from "
              "then on; empty: on those on the border at the start"
            : "stage that takes bodies out: the load acts on the faces that this lays bare, from "
              "then on; empty: on those on the border at the start");
  }
  template <class Visit>
  void keys_of_size(Visit&& key) {
    constexpr bool plane = std::is_same_v<Vector, Vec2>;
    key("pressure", pressure, "Pa", any_number,
        "pressure, positive pushes; or a table [[t, p], ...] of it over time");
    key("traction", traction, "Pa", any_number,
        plane ? "force per area, or a table [[t, x, y], ...] of it over time"
              : "force per area, or a table [[t, x, y, z], ...] of it over time");
    key("force", force, plane ? "N/m" : "N", any_number,
        plane ? "force per unit thickness, of all edges together, or a table [[t, x, y], ...] of it"
              : "force of all faces together, or a table [[t, x, y, z], ...] of it");
  }
};

/// [[load.outlet]]: where a fluid that flows leaves
template <class RegionConfig, class Vector>
struct OutletConfigOf {
  RegionConfig region;
  double pressure = 0.0;  ///<  [Pa]

  template <class Visit>
  void each_key(Visit&& key) {
    region.each_key(key);
    key("pressure", pressure, "Pa", any_number,
        std::is_same_v<Vector, Vec2>
            ? "pressure at the vertices in the region: another water level, or 0 where it runs out"
            : "pressure at the edges in the region: another water level, or 0 where it runs out");
  }
};

/// [[load]] with fluids.
template <class RegionConfig, class Vector>
struct FluidLoadConfigOf : LoadConfigOf<RegionConfig, Vector> {
  double speed = 0.0;      ///< of a fluid's front; 0: at once  [m/s]
  double viscosity = 0.0;  ///< of a fluid that flows; 0: its pressure is alike  [Pa s]
  double bulk = 2.2e9;     ///< its bulk modulus  [Pa]
  double aperture = 1e-5;  ///< of cracks that are closed  [m]
  OverTime<double> rate;   ///< at which it comes in, instead of a pressure  [m3/s; in 2D m2/s]
  bool filled = false;     ///< whether cracks that are open at the start hold it
  std::vector<OutletConfigOf<RegionConfig, Vector>> outlets{};  ///< at most one

  bool flows() const { return this->kind == "fluid" && viscosity > 0.0; }

 protected:
  template <class Visit>
  void keys_of_fluid(Visit&& key) {
    constexpr bool plane = std::is_same_v<Vector, Vec2>;
    key("speed", speed, "m/s", not_negative,
        "fluid: how fast its front runs in cracks that are broken; 0: it fills them as they break");
    key("viscosity", viscosity, "Pa s", Range{0.0, 1e9},
        "fluid: it flows through cracks by the cubic law, with this viscosity; 0: no flow, its "
        "pressure is alike everywhere");
    key("bulk", bulk, "Pa", sane_strength, "fluid that flows: its bulk modulus");
    key("aperture", aperture, "m", Range{1e-9, 1.0},
        "fluid that flows: aperture of a broken crack whose sides touch; their opening adds to it");
    key("rate", rate, plane ? "m2/s" : "m3/s", Range{0.0, 1e9},
        plane
            ? "fluid that flows: how much comes in at its region per metre of thickness, or a "
              "table [[t, q], ...] of it; then pressure is left out"
            : "fluid that flows: how much comes in at its region, or a table [[t, q], ...] of it; "
              "then pressure is left out");
    key("filled", filled,
        "fluid that flows: cracks that are open at the start hold it, without pressure");
    key.list("outlet", outlets, "fluid that flows: where it leaves, one region at most");
  }
};

/// [[stage.load]]: how large a load is from a stage on
template <class Vector>
struct LoadChangeOf {
  std::string name;
  OverTime<double> pressure;  ///<  [Pa]
  OverTime<Vector> traction;  ///<  [Pa]
  OverTime<Vector> force;     ///<  [N; in 2D N/m]
  double ramp = 0.0;          ///<  [s]
  OverTime<double> rate{};    ///<  [m3/s; in 2D m2/s]

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the load");
    key.required("name");
    key("pressure", pressure, "Pa", any_number,
        "pressure from now on, or a table of it over time since the stage began; left out: 0");
    key("traction", traction, "Pa", any_number, "traction from now on, likewise");
    key("force", force, std::is_same_v<Vector, Vec2> ? "N/m" : "N", any_number,
        "force from now on, likewise");
    key("ramp", ramp, "s", not_negative,
        "time since the stage began in which it grows from zero, linearly");
    key("rate", rate, std::is_same_v<Vector, Vec2> ? "m2/s" : "m3/s", Range{0.0, 1e9},
        "rate of inflow from now on, likewise");
  }
};

/// Strength of joints from a stage on.
struct StrengthChange {
  double tension = -1.0;         ///< below 0: as before  [Pa]
  double cohesion = -1.0;        ///< likewise  [Pa]
  double friction_angle = -1.0;  ///< likewise  [rad]
  double energy_open = -1.0;     ///< likewise  [J/m2]
  double energy_slide = -1.0;    ///< likewise  [J/m2]

  template <class Visit>
  void each_key(Visit&& key) {
    const Range strength{-1.0, 1e15};
    key("tension", tension, "Pa", strength, "tensile strength from now on; below 0: as before");
    key("cohesion", cohesion, "Pa", strength, "cohesion from now on; below 0: as before");
    key("friction_angle", friction_angle, "rad", Range{-1.0, 1.5707, Open::high},
        "internal friction angle of whole joints from now on; below 0: as before");
    key("energy_open", energy_open, "J/m2", strength,
        "fracture energy of opening from now on; below 0: as before");
    key("energy_slide", energy_slide, "J/m2", strength,
        "fracture energy of sliding from now on; below 0: as before");
  }
  bool any() const {
    return std::max({tension, cohesion, friction_angle, energy_open, energy_slide}) >= 0.0;
  }
  template <class Strength>
  void apply_to(Strength& of) const {
    const auto take = [](double now, double& value) {
      if (now >= 0.0) value = now;
    };
    take(tension, of.tension);
    take(cohesion, of.cohesion);
    take(friction_angle, of.friction_angle);
    take(energy_open, of.energy_open);
    take(energy_slide, of.energy_slide);
  }
};

/// [[stage.joint]]: how strong joints of a law are from a stage on
struct JointChange {
  std::string name;
  StrengthChange strength;

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the [joint.<name>]");
    key.required("name");
    key.table("strength", strength,
              "its strength; what has softened keeps its damage, and its stiffness stays");
  }
};

/// [[stage.material]]: what a material is from a stage on
struct MaterialChange {
  std::string name;
  double young = 0.0;      ///< 0: as before  [Pa]
  double in_situ = -1.0;   ///< below 0: as before  [-]
  double friction = -1.0;  ///< below 0: as before  [-]
  StrengthChange joint;

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the material");
    key.required("name");
    key("young", young, "Pa", Range{0.0, 1e15},
        "Young's modulus of its elements from now on; joints and contacts keep their stiffnesses; "
        "0: as before");
    key("in_situ", in_situ, "-", Range{-1.0, 1.0},
        "share of the stress at the start that it bears from now on: a core that is dug slowly "
        "bears less and less; below 0: as before");
    key("friction", friction, "-", Range{-1.0, 1e3},
        "coefficient of friction of its contacts from now on; between two materials the lower one "
        "counts; below 0: as before");
    key.table("joint", joint,
              "strength of the joints within it; what has softened keeps its damage");
  }
};

/// [[stage]]: keys of both methods
template <class Vector, class LoadChange = LoadChangeOf<Vector>>
struct MeshStageConfig : StageEnd {
  OverTime<Vector> gravity = from_space<Vector>({no_limit, no_limit, no_limit});  ///<  [m/s2]
  std::vector<SupportChangeOf<Vector>> supports;
  std::vector<LoadChange> loads;
  std::vector<MaterialChange> materials;
  std::vector<JointChange> joints;

  /// Whether it makes joints stronger or weaker.
  bool changes_strengths() const {
    return !joints.empty() || std::any_of(materials.begin(), materials.end(),
                                          [](const auto& m) { return m.joint.any(); });
  }
  template <class Visit>
  void each_key(Visit&& key) {
    StageEnd::each_key(key);
    key("gravity", gravity, "m/s2", any_number,
        "acceleration of gravity from its beginning on, or a table of it over time since then; "
        "left "
        "out (inf): as before");
    key.list("support", supports, "supports that prescribe something else from its beginning on");
    key.list("load", loads, "loads that are another from its beginning on");
    key.list("material", materials, "materials that are softer or stiffer from its beginning on");
    key.list("joint", joints, "laws of joints that are weaker or stronger from its beginning on");
  }
};

/// [search]
struct SearchConfig {
  double margin = 0.1;  ///< over the mean edge  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("margin", margin, "-", Range{0.0, 1.0, Open::low},
        "how far two elements may approach before a new search, over the mean edge");
  }
};

}  // namespace breccia::fdem_shared
