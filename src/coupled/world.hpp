#pragma once
// Spheres and tetrahedra in one run: what there is between the worlds of both methods.

#include <string>
#include <vector>

#include "core/broad_phase.hpp"
#include "core/energy.hpp"
#include "core/read_only.hpp"
#include "core/servo.hpp"
#include "core/step_clock.hpp"
#include "coupled/border.hpp"
#include "coupled/setup/config.hpp"
#include "coupled/sums.hpp"
#include "dem/world.hpp"
#include "fdem3/world.hpp"

namespace breccia::coupled {

/// Constants of a case.
struct Case {
  double safety = 0.7;                ///< share of the stable step  [-]
  double skin = 0.0;                  ///< margin of the search beyond those of both methods  [m]
  Index materials = 0;                ///< of tetrahedra
  Index spheres = 0, tetrahedra = 0;  ///< of all ranks
  Buffer<PressLaw> laws;          ///< of materials p of spheres, q of tetrahedra at p materials + q
  Buffer<fdem::JointBond> bonds;  ///< indexed by BallBond::law
  std::vector<std::string> bond_names;  ///< likewise
  std::vector<std::string> warnings;    ///< what set-up found doubtful, for people

  /// Visits the arrays that kernels read.
  template <class Visit>
  void each_array(Visit&& visit) {
    visit(laws), visit(bonds);
  }
};

/// When the list of near faces was made, and how both drifts have parted since.
struct LastSearch {
  std::int64_t of_spheres = -1, of_tetrahedra = -1;  ///< searches of both methods until then
  double time = 0.0;                                 ///< [s]
  double reach = 0.0;                                ///< way of the drifts that is covered  [m]
};

/// Each line tells meaning and unit, then (length; who writes it), in the words of dem/world.hpp.
/// On ranks both worlds are parts, and each rank holds all that is between the wholes, by numbers
/// of the whole.
struct World {
  /// Empty, every array in the space of both.
  World(dem::World& of_spheres, fdem3::World& of_tetrahedra);

  dem::World* spheres;
  fdem3::World* tetrahedra;
  ReadOnly<Case> given;  ///< (set-up)

  /// Visits the arrays that kernels read.
  template <class Visit>
  void each_array(Visit&& visit) {
    const auto state = [&](auto& s) {
      s.each_field([&](const char*, const char*, auto& array) { visit(array); });
    };
    state(bonds);
    state(touches);
    state(faces);
    given.each_array(visit);
    border.each_array(visit);
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(rows, row_of_touch, around.tetrahedron, around.face_starts, around.faces,
         around.bond_starts, around.bonds, broad_phase, bonded, pressed, step);
  }

  // State: what a checkpoint holds.
  BallBonds bonds;            ///< by sphere (bonds; set-up, pairs)
  Touches touches;            ///< by sphere, then body (touches; search, pairs)
  NearFaces faces;            ///< by sphere, then face (near faces; search, pairs)
  LastSearch last;            ///< (search)
  Ledger ledger;              ///< (search)
  double stable_step = 0.0;   ///< of the tetrahedra by themselves, when last evaluated  [s]  (dt)
  std::int64_t searches = 0;  ///< for near faces  [-]  (search)

  // Follows from a search.
  Buffer<SphereRow> rows;      ///< (spheres that are near or bonded; derive)
  Buffer<Index> row_of_touch;  ///< (touches; derive)
  TetrahedronRows around;      ///< (derive)
  Border border;               ///< on ranks (derive; what moves: pairs)
  BroadPhase broad_phase;      ///< scratch of the search (search)

  // Results of a step, overwritten by the next one.
  Buffer<std::int16_t> bonded;  ///< see PressFaces (rows; pairs)
  Buffer<Pressed> pressed;      ///< (near faces; pairs)
  Buffer<double> step;          ///< (rows of `around`; sums)  [s]
};

/// Both worlds have evaluated their own forces; those between them come on top. All ranks call it,
/// with their parts.
/// @throws InputError naming what does not fit
World make_world(const Config& config, dem::World& spheres, fdem3::World& tetrahedra);

/// Fills what follows from the state, after set-up, loading and a search. All ranks call it.
void derive(World& w);
/// How often ranks have shared out items of both.
std::int64_t sharings(const World& w);
/// After items may have been shared out between two steps. All ranks call it.
void derive_if_shared_anew(World& w);

/// One step of the spheres and the tetrahedra.
void step(World& w);

/// Adds the forces between spheres and tetrahedra to the forces of each.
void press(World& w);
/// Adds those of the last step to the forces of spheres, which have evaluated their own anew.
void press_spheres_again(World& w);
/// The stable step of the tetrahedra by themselves, where it is evaluated,
void note_stable_step(World& w);
/// and the step to come, of all.
void choose_common_step(World& w);
/// The step to come where a stage has set something free in either.
void shorten_common_step(World& w);

/// Forces and energies between what a stage has taken out and all else end; what was stored in them
/// leaves as (negative) work.
void cut_off_removed(World& w);

/// Stiffnesses with which tetrahedra meet the spheres that servos of supports lead, and masses of
/// these spheres, for each servo of the spheres' world.
std::vector<ServoReading> touched_by_servos(const World& w);

bool faces_are_due(const World& w);
void find_faces(World& w);

/// Bonds as kernels read them.
struct BondsView {
  Meeting of;
  View<const fdem::JointBond> laws;

  /// [J]
  BR_HD double stored(Index i, const BallBondState& bond) const {
    const BallBond& b = of.tie[i];
    const BondGap g =
        gap_of(b, of.spheres[b.sphere], of.orientation[b.sphere], of.nodes[b.tetrahedron]);
    const fdem::StoredEnergy energy =
        fdem::edge_stored(laws[b.law], 1.0, b.length, g.open, g.slide, bond.point);
    return b.area * (energy.open + energy.slide);
  }
};
BondsView bonds_view(const World& w);
/// Energies stored and spent between spheres and tetrahedra.
Energies held(const World& w);

struct Counts {
  double touching = 0.0;  ///< spheres and bodies that press on each other
  double bonds = 0.0, broken = 0.0;
};
Counts count(const World& w);

}  // namespace breccia::coupled
