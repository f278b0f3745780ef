#pragma once
// Observations of a run of tetrahedra: those of fdem_shared/observe.hpp, stresses, cracks,
// fragments.

#include "fdem3/shape.hpp"
#include "fdem_shared/observe.hpp"

namespace breccia::fdem3 {

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

/// Cauchy stress of each tetrahedron, without viscosity.  [Pa]
std::vector<Sym3> stresses(const World& w);

/// Velocities of the corners at the time of the positions. On ranks all call it: ghosts follow
/// their owners.  [m/s]
std::vector<Corners> velocities_now(World& w);

/// Bits of the faces of each tetrahedron that nothing joins or whose joint is damaged: those that
/// may be seen.
std::vector<std::int32_t> visible_faces(const World& w);

/// A joint that broke.
struct Crack {
  Index joint;
  double time;    ///<  [s]
  Vec3 middle;    ///< of its middle surface now  [m]
  Vec3 normal;    ///< unit, of its middle surface now
  double area;    ///< at the start  [m2]
  double mode;    ///< share of sliding in its work: 0 opening, 1 sliding  [-]
  double energy;  ///< work that it took  [J]
};
/// By time of break, then by number; without those beside elements that have been taken out.
std::vector<Crack> cracks(const World& w);

/// A piece held together by joints and bonds.
struct Piece {
  double mass = 0.0;    ///<  [kg]
  double volume = 0.0;  ///< present  [m3]
  Vec3 centre{};        ///< of mass  [m]
  Vec3 velocity{};      ///<  [m/s]
};
/// Pieces by falling mass, and of each tetrahedron the number of its piece.
struct Fragments {
  std::vector<Index> of;
  std::vector<Piece> pieces;
};
Fragments fragments(const World& w);
/// The number of its piece alone, where other joints are broken than the world knows.
/// @param broken  1: of each joint
Fragments fragments(const World& w, const std::vector<std::uint8_t>& broken);

}  // namespace breccia::fdem3
