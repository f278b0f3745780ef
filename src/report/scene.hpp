#pragma once
// Surroundings of the elements (walls, supports), from the case file of a result folder.

#include <map>
#include <string>
#include <vector>

#include "math/vec.hpp"

namespace breccia::report {

/// A rigid plane.
struct Wall {
  std::string name;
  Vec3 point{}, normal{0.0, 0.0, 1.0}, velocity{};  ///<  [m], [-], [m/s]
};

/// Where motion or load is prescribed.
struct Region {
  std::string name;
  Vec3 low{}, high{};  ///< without a bound: infinite  [m]
  bool load = false;   ///< a load, not a support
};

/// Strengths of the links or joints of a material.
struct Strength {
  std::string material;
  bool breaks = true;    ///< false: of what has no joints, or is steel
  double tension = 0.0;  ///<  [Pa]
};

/// A case as far as a report draws and judges it. What the file does not tell stays empty.
struct Scene {
  std::string title;
  std::string color, view;          ///< of the run's own pictures
  std::vector<std::string> curves;  ///< "force over deflection": a probe over another one
  std::vector<Wall> walls;
  std::vector<Region> regions;
  std::vector<Strength> strengths;               ///< in the order of the file
  std::map<std::string, std::string> materials;  ///< by the name of the body
  double bar_radius = 0.0;                       ///< of reinforcement  [m]
};

/// Reads the completed case that a run leaves. Nothing in it is an error: what cannot be read is
/// not in the scene.
Scene scene_of(const std::string& case_text);

}  // namespace breccia::report
