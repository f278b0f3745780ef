#pragma once
// Observations of an FDEM run: those of fdem_shared/observe.hpp, stresses, cracks, fragments.

#include "fdem/shape.hpp"
#include "fdem_shared/observe.hpp"

namespace breccia::fdem {

using fdem_shared::damage;
using fdem_shared::fastest;
using fdem_shared::find_unsound;
using fdem_shared::find_unsound_later;
using fdem_shared::mode_of;
using fdem_shared::probe;
using fdem_shared::probe_later;
using fdem_shared::read_own;
using fdem_shared::ruled_step;
using fdem_shared::RuledStep;
using fdem_shared::ruling_term;
using fdem_shared::state_hash;

/// Cauchy stress of each triangle, without viscosity.  [Pa]
std::vector<Sym2> stresses(const World& w);
/// Stress across the plane that the deformation makes: 0 in plane stress. What lay on the rock in
/// that direction at the start is not known.  [Pa]
std::vector<double> stresses_across(const World& w);

/// Velocities of the corners at the time of the positions. On ranks all call it: ghosts follow
/// their owners.  [m/s]
std::vector<Corners> velocities_now(World& w);

/// A joint that broke.
struct Crack {
  Index joint;
  double time;      ///<  [s]
  Vec2 begin, end;  ///< of its middle line now  [m]
  double mode;      ///< share of sliding in its work: 0 opening, 1 sliding  [-]
  double energy;    ///< work that it took  [J/m]
};
/// By time of break, then by number; without those beside elements that have been taken out.
std::vector<Crack> cracks(const World& w);

/// A piece held together by joints and bonds.
struct Piece {
  double area = 0.0;  ///< present  [m2]
  Vec2 centre{};      ///< of mass  [m]
  Vec2 velocity{};    ///<  [m/s]
};
/// Of each triangle the number of its piece; pieces by falling mass.
struct Fragments {
  std::vector<Index> of;      ///< of each triangle
  std::vector<double> mass;   ///< of each piece, falling  [kg/m]
  std::vector<Piece> pieces;  ///< likewise
};
Fragments fragments(const World& w);
/// Fragments where other joints are broken than the world knows.
/// @param broken  1: of each joint
Fragments fragments(const World& w, const std::vector<std::uint8_t>& broken);

}  // namespace breccia::fdem
