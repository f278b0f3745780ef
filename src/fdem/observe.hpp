#pragma once
// Observations of an FDEM run: hash, probes, counts, cracks, fragments, and whether its numbers are
// sound.

#include "core/probe.hpp"
#include "core/unsound.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

/// Hash of positions and velocities of all triangles' corners by global id.
/// A rank's is that of its own; the sum over all ranks is that of the whole.
std::uint64_t state_hash(const World& w);

/// The first triangle of its own that is inside out, not finite, or moves more than its size in a
/// step.
Unsound find_unsound(const World& w);
/// The triangle of its own that moves fastest: where energy is lost, it may be the one to look at.
Fastest fastest(const World& w);

/// Largest damage of the joints of each triangle.  [-]
std::vector<double> damage(const World& w);

/// Cauchy stress of each triangle, without viscosity.  [Pa]
std::vector<Sym2> stresses(const World& w);
/// Stress across the plane that the deformation makes: 0 in plane stress. What lay on the rock in
/// that direction at the start is not known.  [Pa]
std::vector<double> stresses_across(const World& w);

/// Velocities of the corners at the time of the positions. On ranks all call it: ghosts follow
/// their owners.  [m/s]
std::vector<Corners> velocities_now(World& w);

double probe(const World& w, const ProbeConfig& probe);
/// A probe's reading of a rank's own triangles; the sum over all ranks is the reading of the
/// whole.
Readings read_own(World& part, const ProbeConfig& probe);

/// Share of sliding in what a joint has spent: 0 opening, 1 sliding  [-]
double mode_of(const Joints& joints, Index i);

/// A joint that broke.
struct Crack {
  Index joint;
  double time;      ///<  [s]
  Vec2 begin, end;  ///< of its middle line now  [m]
  double mode;      ///< share of sliding in its work: 0 opening, 1 sliding  [-]
  double energy;    ///< work that it took  [J/m]
};
/// By time of break, then by number.
std::vector<Crack> cracks(const World& w);

/// Pieces held together by joints and bonds: of each triangle the number of its piece, pieces by
/// falling mass.
struct Fragments {
  std::vector<Index> of;     ///< of each triangle
  std::vector<double> mass;  ///< of each piece, falling  [kg/m]
};
Fragments fragments(const World& w);
/// Fragments where other joints are broken than the world knows.
/// @param broken  1: of each joint
Fragments fragments(const World& w, const std::vector<std::uint8_t>& broken);

/// The least stable step of all triangles, without its safety, and what rules it, in a word.
struct RuledStep {
  double step;  ///<  [s]
  const char* term;
};
/// @param pressed  as if something touched wherever it can
RuledStep ruled_step(const World& w, bool pressed);
/// Which term rules the time step now: elements, joints, contact or viscosity.
const char* ruling_term(const World& w);

}  // namespace breccia::fdem
