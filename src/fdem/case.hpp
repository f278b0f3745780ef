#pragma once
// Constants that a case gives to an FDEM run: written by set-up, read by all else.
//
// `stage` marks what configure() writes anew where a stage of the case begins, and after loading a
// checkpoint. Constants of single triangles and joints (mass, shape, length, strength) lie beside
// their state, with which they migrate: fdem/triangles/triangles.hpp, fdem/joints/joints.hpp.

#include <cstdint>
#include <string>
#include <vector>

#include "core/added_mass.hpp"
#include "core/emission_config.hpp"
#include "core/gauge.hpp"
#include "core/output_config.hpp"
#include "exec/buffer.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem/setup/config.hpp"
#include "fdem/setup/effective.hpp"
#include "fdem/triangles/loads.hpp"
#include "fdem/triangles/motion.hpp"
#include "fdem_shared/bolts/bolts.hpp"
#include "fdem_shared/fluid/gas_source.hpp"

namespace breccia::fdem {

/// A named set of corners that probes and servos read: a body, a support or a line of the mesh.
struct NodeSet {
  std::string name;
  std::vector<Index> nodes;  ///< 3 triangle + corner, ascending, in the whole mesh  [-]
};

/// Of a fluid; its ports are vertices. Holes: border edges in the order in which they run around.
using FluidSource = fdem_shared::GasSourceOf<LoadedEdge, std::vector<Index>, Vec2, 2>;

using Bolt = fdem_shared::BoltOf<Vec2>;
using FlowCase = fdem_shared::FlowCaseOf<LoadedEdge>;
using CrackSide = fdem_shared::LineCrack;

struct Case {
  TimeConfig time;
  AddedMass added_mass;        ///< to the triangles that rule the step
  Vec2 gravity{};              ///< stage  [m/s2]
  InSituConfig in_situ;        ///< stress at the start
  bool plane_strain = false;   ///< nothing moves out of the plane; else there is no stress
  double local_damping = 0.0;  ///< stage  [-]
  double mean_edge = 0.0;      ///<  [m]
  double free_step = 0.0;  ///< stable one of all at the start without contact, where corners move
                           ///< as one; else 0  [s]
  double skin = 0.0;       ///< margin of the search between two triangles at rest  [m]
  bool conservative = false;  ///< whether forces of contact are
  Rebound rebound;            ///< what contacts give back
  bool extrinsic = false;     ///< some joints are dormant, or were
  MoreFields shown;           ///< in frames
  Index materials = 0;        ///< how many there are  [-]

  std::vector<std::string> groups;             ///< names of bodies  (bodies)
  std::vector<std::uint8_t> removed;           ///< stage; 1: taken out by now  (bodies)
  std::vector<NodeSet> removable;              ///< vertices of bodies that stages take out
  std::vector<EffectiveRock> rocks;            ///< each material with its joints  (materials)
  std::vector<std::string> warnings;           ///< what set-up found doubtful, for people
  std::vector<NodeSet> sets;                   ///< bodies, then supports
  std::vector<LoadLaw> loads;                  ///< stage: sizes; all factors 1  (loads)
  std::vector<std::string> load_names;         ///<  (loads)
  std::vector<LoadAmplitude> load_amplitudes;  ///< stage: factors over time  (loads)
  std::vector<LoadedEdge> loaded;              ///< by global id, ascending; without cracks
  std::vector<FluidSource> fluids;             ///< empty: no load is a fluid
  FlowCase flow;
  std::vector<Bolt> bolts;
  PlaneEmissionConfig emission;        ///< which breaks are one event
  std::vector<CrackSide> open_cracks;  ///< edges of discontinuities open from the start
  Buffer<ElasticTriangle> laws;        ///< stage  (materials; where stress in situ has a slope:
                                       ///< triangles of the whole mesh)
  std::vector<Index> materials_of;     ///< likewise, else empty  (triangles of the whole mesh)
  std::vector<Vec2> middles;           ///< likewise, at the start  [m]
  Buffer<ElasticLaw<float>> laws_in_single;  ///< `laws`, of a run that computes so, else empty
  Buffer<JointBond> bonds;                   ///< stage; indexed by Joints::law  (laws of joints)
  Buffer<BondOf<float>> bonds_in_single;     ///< likewise
  std::vector<Index> base_bond;              ///< the one of the case that each is made of  (bonds)
  Buffer<ContactPair> contact_pairs;  ///< stage; of materials p, q at p materials + q (materials^2)
  Buffer<Hold> holds;                 ///< stage; indexed by Triangles::hold  (held triangles)
  /// Each vertex of the mesh: bit 0: at the border or an edge that nothing joins, bit 1 such
  /// an edge between two triangles.  [-]  (vertices of the whole mesh)
  std::vector<std::uint8_t> open_vertex;

  Buffer<Vec2> starts;  ///< places of corners at the start, by global number; empty: nothing needs
                        ///< them  [m]  (3 triangles of the whole mesh)
  std::vector<ProbeFit> strain_fits;  ///< of probes of strain

  /// Visits the arrays that kernels read.
  template <class Visit>
  void each_array(Visit&& visit) {
    visit(laws), visit(laws_in_single), visit(bonds), visit(bonds_in_single), visit(contact_pairs),
        visit(holds), visit(starts);
  }
};

}  // namespace breccia::fdem
