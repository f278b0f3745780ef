#pragma once
// Output of a run of tetrahedra: hash, probes, counts, cracks, fragments, and whether its numbers
// are sound.

#include "core/probe.hpp"
#include "core/unsound.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// Hash of positions and velocities of all corners by global id. A rank's is that of its own; the
/// sum over all ranks is that of the whole.
std::uint64_t state_hash(const World& w);

/// The first tetrahedron of its own that is inside out, not finite, or moves more than its size in
/// a step.
Unsound find_unsound(const World& w);
/// The tetrahedron of its own that moves fastest: where energy is lost, it may be the one to look
/// at.
Fastest fastest(const World& w);

/// Largest damage of the joints of each tetrahedron.  [-]
std::vector<double> damage(const World& w);

/// Cauchy stress of each tetrahedron, without viscosity.  [Pa]
std::vector<Sym3> stresses(const World& w);

/// Velocities of the corners at the time of the positions. On ranks all call it: ghosts follow
/// their owners.  [m/s]
std::vector<Corners> velocities_now(World& w);

double probe(const World& w, const ProbeConfig& probe);
/// Readings of a probe on a rank's own tetrahedra; their sum over all ranks is that of the mesh.
Readings read_own(World& part, const ProbeConfig& probe);

/// Share of sliding in what a joint has spent: 0 opening, 1 sliding  [-]
double mode_of(const Joints& joints, Index i);

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
/// By time of break, then by number.
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

/// The least stable step of all, without its safety, and what rules it, in a word.
struct RuledStep {
  double step;  ///<  [s]
  const char* term;
};
/// @param pressed  as if something touched wherever it can
RuledStep ruled_step(const World& w, bool pressed);
/// Which term rules the time step now: elements, joints, contact or viscosity.
const char* ruling_term(const World& w);

}  // namespace breccia::fdem3
