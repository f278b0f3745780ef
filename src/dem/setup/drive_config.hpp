#pragma once
// The case file of the DEM: what drives a model, walls, supports and stages.

#include <algorithm>
#include <string>
#include <vector>

#include "core/keys.hpp"
#include "core/servo.hpp"
#include "core/stages.hpp"
#include "core/table_over_time.hpp"

namespace breccia::dem {

/// [[wall]]: a rigid body that is met from outside
struct WallConfig {
  std::string name;
  Vec3 point{};                ///< on the face  [m]
  Vec3 normal{0.0, 0.0, 1.0};  ///< out of the wall, towards the elements  [-]
  OverTime<Vec3> velocity;     ///<  [m/s]
  double stiffness = 1.0;      ///< over the contact stiffness of an element with its like  [-]
  double friction = -1.0;      ///< of its contacts; below 0: that of contacts  [-]
  ServoConfig servo{};         ///< instead of the velocity
  double begin = 0.0;          ///< no key: where its time begins  [s]
  std::string shape = "plane";
  std::string file{};      ///< of an STL surface
  double file_unit = 1.0;  ///<  [m]
  double radius = 0.0;     ///< of cylinder or sphere  [m]
  double length = 0.0;     ///< of cylinder or box, behind the face  [m]
  Vec2 size{};             ///< of a box's face  [m]
  Vec3 along{};            ///< of a box; zero: some direction across the normal  [-]
  OverTime<Vec3> spin{};   ///<  [rad/s]
  std::string nose = "flat";
  double nose_length = 0.0;         ///<  [m]
  double mass = no_limit;           ///< infinite: it moves as it is told  [kg]
  OverTime<Vec3> force{};           ///< with mass: on it  [N]
  std::vector<std::string> free{};  ///< with mass: directions in which it moves

  bool has_mass() const { return mass < no_limit; }
  bool has_nose() const { return nose != "flat"; }
  /// Whether it turns by the torques on it.
  bool is_turning() const { return std::find(free.begin(), free.end(), "turn") != free.end(); }
  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the wall");
    key.required("name");
    key("shape", shape, OneOf{"plane", "cylinder", "box", "sphere", "stl"},
        "plane: all that lies behind its face; cylinder, box: a round or rectangular face and what "
        "lies behind it, to length: platens, rollers, punches; sphere: around point; stl: a "
        "surface of triangles");
    key("file", file,
        "stl: the file, relative to the case; a closed surface is solid, or a hole in solid where "
        "its triangles are turned over; an open one is a thin sheet with two sides");
    key("file_unit", file_unit, "m", positive, "stl: length of one unit of the file's coordinates");
    key("point", point, "m", any_number,
        "a point of the wall's face; the middle of a round or rectangular one, the tip of a nose; "
        "centre of a sphere; where the origin of an STL file comes to lie");
    key("normal", normal, "-", any_number,
        "direction out of the wall's face, towards the elements; stl: in which the file's z "
        "points");
    key("radius", radius, "m", not_negative, "radius of a cylinder or sphere");
    key("length", length, "m", not_negative,
        "how far a cylinder, with its nose, or a box reaches behind its face");
    key("nose", nose, OneOf{"flat", "cone", "ogive", "hemisphere"},
        "how a cylinder ends: a flat face, or a nose whose tip is point; an ogive meets the flank "
        "without a bend");
    key("nose_length", nose_length, "m", not_negative,
        "length of a cone or ogive; an ogive of caliber radius head c has radius * sqrt(4 c - 1)");
    key("size", size, "m", not_negative, "sides of a box's face: along, and across");
    key("along", along, "-", any_number,
        "direction of the first side of a box's face, or near it; [0, 0, 0]: some direction across "
        "the normal; stl: of the file's x; [0, 0, 0]: the file is turned the shortest way");
    key("spin", spin, "rad/s", Range{-1e6, 1e6},
        "how fast it turns about an axis through point, or a table [[t, x, y, z], ...] of it over "
        "time; a plane only about its normal; with mass: about its centre of mass as it begins");
    key("velocity", velocity, "m/s", Range{-1e6, 1e6},
        "velocity of the wall, or a table [[t, x, y, z], ...] of it over time; with mass: the one "
        "with which it begins, of its centre of mass if it turns");
    key("mass", mass, "kg", positive,
        "with it the wall moves by the forces on it, and by gravity; inf: as it is told");
    key("force", force, "N", any_number,
        "given force on a wall with mass, or a table [[t, x, y, z], ...] of it over time");
    key("free", free,
        "how a wall with mass moves: normal, or some of x, y, z, and turn: by the torques on it, "
        "about its centre of mass, as a solid of even density; []: along its normal, a sphere "
        "everywhere, without turning");
    key("stiffness", stiffness, "-", positive,
        "stiffness of its linear contacts over that of two like elements");
    key("friction", friction, "-", Range{-1.0, no_limit},
        "coefficient of friction of its contacts; below 0: that of all contacts");
    key.table("servo", servo, "moves it along its normal so that it pushes with a given force");
  }
};

/// [[support]]: prescribed motion of the elements in a region
struct SupportConfig {
  std::string name;
  std::string on;  ///< group; empty: all
  Vec3 min{-no_limit, -no_limit, -no_limit}, max{no_limit, no_limit, no_limit};  ///<  [m]
  std::vector<std::string> fix{"x", "y", "z"};
  OverTime<Vec3> velocity;      ///< of the fixed directions  [m/s]
  double ramp = 0.0;            ///< time from rest to that velocity  [s]
  SupportServoConfig servo{};   ///< instead of the velocity along its axis
  double begin = 0.0;           ///< no key: where its time begins  [s]
  Vec3 center{};                ///<  [m]
  double radius = 0.0;          ///< of a cylinder or sphere; 0: none  [m]
  std::string around{};         ///< axis of the cylinder; empty: a sphere
  std::vector<Vec2> polygon{};  ///< seen along `around`, or z; empty: none  [m]
  bool outside = false;         ///< of box, cylinder, sphere or polygon
  std::string absorb{};         ///< axis along which waves come; empty: it holds its elements
  std::string wave = "body";    ///< that is absorbed
  double area = 0.0;            ///< of the face that absorbs  [m2]
  OverTime<Vec3> force{};       ///< on its elements, which are free: a dead load  [N]
  double friction = 0.0;        ///< across the direction that it holds  [-]

  bool absorbs() const { return !absorb.empty(); }
  bool pushes() const { return force.is_table() || norm(force.value) > 0.0; }
  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the support");
    key.required("name");
    key("on", on, "body whose elements are held; empty: of all bodies");
    key("min", min, "m", any_number, "lower corner of the region that holds the elements' centres");
    key("max", max, "m", any_number, "upper corner of that region");
    key("center", center, "m", any_number, "a point of the cylinder's axis; centre of the sphere");
    key("radius", radius, "m", not_negative,
        "the region takes only what lies in this cylinder or sphere, too; 0: none");
    key("around", around, OneOf{"", "x", "y", "z"},
        "direction of the axis of that cylinder, and in which a polygon is seen; empty: it is a "
        "sphere, and the polygon is seen along z");
    key("polygon", polygon, "m", any_number,
        "the region takes only what lies in this prism, too, given by the corners of its section: "
        "(x, y), of `around` = \"x\" (y, z), of \"y\" (z, x); empty: none");
    key("outside", outside, "the region takes what box, cylinder, sphere and polygon leave out");
    key("fix", fix,
        "degrees of freedom that are prescribed: x, y, z, spin_x, spin_y, spin_z, or all; supports "
        "that share elements prescribe other directions, or the same motion");
    key("absorb", absorb, OneOf{"", "x", "y", "z"},
        "normal of a face that takes waves up: its elements are free, and dashpots act on them in "
        "the directions of fix (Lysmer and Kuhlemeyer); empty: they are held");
    key("wave", wave, OneOf{"body", "bar"},
        "absorb: waves along the normal are those of a body, rho c_p, or of a slender bar, rho "
        "sqrt(E / rho); waves across it have rho c_s");
    key("area", area, "m2", not_negative,
        "absorb: area of the face, which its elements share by their sections");
    key("force", force, "N", any_number,
        "dead load: a given force on its elements, which share it by their masses and are free, so "
        "fix must be []; or a table [[t, x, y, z], ...] of it over time");
    key("velocity", velocity, "m/s", Range{-1e6, 1e6},
        "prescribed velocity of the fixed directions, or a table [[t, x, y, z], ...] of it over "
        "time, linear in between and constant beyond its ends");
    key("ramp", ramp, "s", not_negative,
        "time in which that velocity, or force, grows from zero, linearly; 0: the elements have it "
        "from the start");
    key("friction", friction, "-", Range{0.0, 1e3},
        "of a platen: it holds one of x, y, z, and rubs at the centres of its elements across it, "
        "with at most so many times the force along it; 0: smooth");
    key.table("servo", servo, "moves it along an axis so that it pushes with a given force");
  }
};

/// [[stage.support]]: what a support prescribes from a stage on
struct SupportChange {
  std::string name;
  std::vector<std::string> fix{"same"};
  OverTime<Vec3> velocity;  ///<  [m/s]
  double ramp = 0.0;        ///<  [s]
  SupportServoConfig servo;
  OverTime<Vec3> force{};  ///<  [N]

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the support");
    key.required("name");
    key("fix", fix,
        "degrees of freedom that it prescribes from now on; [] sets its elements free; left out: "
        "the same as before");
    key("velocity", velocity, "m/s", Range{-1e6, 1e6},
        "their velocity from now on, or a table of it over time since the stage began; left out: "
        "they stand still");
    key("ramp", ramp, "s", not_negative,
        "time since the stage began in which velocity and force grow from zero, linearly");
    key("force", force, "N", any_number,
        "dead load on its elements from now on, or a table of it over time since the stage began; "
        "left out: none");
    key.table("servo", servo, "from now on it pushes with a given force; left out: no longer");
  }
};

/// [[stage.wall]]: how a wall moves from a stage on
struct WallChange {
  std::string name;
  OverTime<Vec3> velocity;  ///<  [m/s]
  ServoConfig servo;
  OverTime<Vec3> spin{};       ///<  [rad/s]
  OverTime<Vec3> force{};      ///<  [N]
  double friction = no_limit;  ///< infinite: as before  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the wall");
    key.required("name");
    key("force", force, "N", any_number,
        "given force on a wall with mass from now on, or a table of it over time since the stage "
        "began; left out: none");
    key("velocity", velocity, "m/s", Range{-1e6, 1e6},
        "its velocity from now on, or a table of it over time since the stage began; left out: it "
        "stands still");
    key("spin", spin, "rad/s", Range{-1e6, 1e6},
        "how fast it turns from now on, or a table of it over time since the stage began; left "
        "out: "
        "no more");
    key("friction", friction, "-", Range{-1.0, no_limit},
        "friction of its contacts from now on; below 0: that of all contacts; left "
        "out (inf): as before");
    key.table("servo", servo, "from now on it pushes with a given force; left out: no longer");
  }
};

/// [[stage.material]]: how strong links of a material are from a stage on
struct MaterialChange {
  std::string name;
  double tensile_strength = -1.0;  ///< below 0: as before  [Pa]
  double cohesion = -1.0;          ///< likewise  [Pa]
  double broken_friction = -1.0;   ///< likewise  [-]
  double young = -1.0;             ///< likewise  [Pa]

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the material, of law concrete, parallel or grain");
    key.required("name");
    key("tensile_strength", tensile_strength, "Pa", Range{-1.0, 1e15},
        "tensile strength of its links from now on; below 0: as before");
    key("cohesion", cohesion, "Pa", Range{-1.0, 1e15},
        "cohesion of its links from now on; below 0: as before");
    key("broken_friction", broken_friction, "-", Range{-1.0, 1e6},
        "friction of its broken links from now on; below 0: as before");
    key("young", young, "Pa", Range{-1.0, 1e13},
        "modulus from now on: its links and contacts bear so much more or less at once, with the "
        "same strain; below 0: as before");
  }
};

/// [[stage]]
struct StageConfig : StageEnd {
  OverTime<Vec3> gravity{no_limit, no_limit, no_limit};  ///<  [m/s2]
  double restitution = 0.0;                              ///< 0: as before  [-]
  std::vector<SupportChange> supports;
  std::vector<WallChange> walls;
  std::vector<MaterialChange> materials;

  template <class Visit>
  void each_key(Visit&& key) {
    StageEnd::each_key(key);
    key("gravity", gravity, "m/s2", Range{-1e6, no_limit},
        "acceleration of gravity from its beginning on, or a table of it over time since then; "
        "left "
        "out (inf): as before");
    key("restitution", restitution, "-", Range{0.0, 1.0},
        "coefficient of restitution of contacts from its beginning on; 0: as before");
    key.list("support", supports, "supports that prescribe something else from its beginning on");
    key.list("wall", walls, "walls that move otherwise from its beginning on");
    key.list("material", materials, "materials that are weaker or stronger from its beginning on");
  }
};

}  // namespace breccia::dem
