#pragma once
// Constants that a case gives to a run of tetrahedra: written by set-up, read by all else. As
// fdem/case.hpp.

#include <cstdint>
#include <string>
#include <vector>

#include "core/added_mass.hpp"
#include "core/emission_config.hpp"
#include "core/gauge.hpp"
#include "core/output_config.hpp"
#include "fdem3/contact/couples.hpp"
#include "fdem3/elements/loads.hpp"
#include "fdem3/elements/motion.hpp"
#include "fdem3/fluid/hole_wall.hpp"
#include "fdem3/setup/config.hpp"
#include "fdem_shared/bolts/bolts.hpp"
#include "fdem_shared/fluid/gas_source.hpp"

namespace breccia::fdem3 {

/// A named set of corners that probes and servos read: a body or a support.
struct NodeSet {
  std::string name;
  std::vector<Index> nodes;  ///< 4 tetrahedron + corner, ascending, in the whole mesh  [-]
};

/// Stiffness of transversely isotropic rock: 1 and 2 along its planes, 3 across them.
struct SolidModuli {
  double c11 = 0.0, c12 = 0.0, c13 = 0.0, c33 = 0.0, c44 = 0.0;  ///<  [Pa]
};

/// A material with its joints, as waves and loads meet it.
struct EffectiveRock {
  std::string material;
  double young, poisson;  ///<  [Pa], [-]
  double fast, slow;      ///< waves of pressure and of shear; of bedded rock along its planes [m/s]
  double density = 0.0;   ///<  [kg/m3]
  SolidModuli stiffness{};  ///< of bedded rock, with its joints  [Pa]
  Vec3 across{};            ///< its planes; 0: it has none  [-]

  /// Impedances of a face that waves press and shear: rho c_p and rho c_s along its normal.
  struct Impedances {
    double pressing, shearing;  ///<  [Pa s/m]
  };
  Impedances on(const Vec3& normal) const;
};

/// Of a fluid; its ports are edges.
using FluidSource = fdem_shared::GasSourceOf<LoadedFace, HoleWall, Vec3, 3>;
using Bolt = fdem_shared::BoltOf<Vec3>;
using FlowCase = fdem_shared::FlowCaseOf<LoadedFace>;
/// Two faces on each other that nothing joins, by global number.
using CrackSide = fdem_shared::FaceCrack;

struct Case {
  TimeConfig time;
  AddedMass added_mass;        ///< to the tetrahedra that rule the step
  Vec3 gravity{};              ///< stage  [m/s2]
  InSituConfig in_situ;        ///< stress at the start
  double local_damping = 0.0;  ///< stage  [-]
  double mean_edge = 0.0;      ///<  [m]
  double free_step = 0.0;   ///< stable one of all at the start without contact, where corners move
                            ///< as one; else 0  [s]
  double skin = 0.0;        ///< margin of the search between two at rest  [m]
  bool extrinsic = false;   ///< some joints are dormant, or were
  bool bedded = false;      ///< some rock is stiffer in one direction than in others
  MoreFields shown;         ///< in frames
  EmissionConfig emission;  ///< which breaks are one event
  Index materials = 0;      ///< how many there are  [-]

  std::vector<std::string> groups;            ///< names of bodies  (bodies)
  std::vector<std::uint8_t> removed;          ///< stage; 1: taken out by now  (bodies)
  std::vector<NodeSet> removable;             ///< vertices of bodies that stages take out
  std::vector<EffectiveRock> rocks;           ///< each material with its joints  (materials)
  std::vector<double> contact_lengths;        ///< h_c of each material  [m]  (materials)
  std::vector<std::string> warnings;          ///< what set-up found doubtful, for people
  std::vector<NodeSet> sets;                  ///< bodies, then supports
  std::vector<LoadLaw> loads;                 ///< stage: sizes; all factors 1  (loads)
  std::vector<std::string> load_names;        ///<  (loads)
  std::vector<AmplitudeOf3> load_amplitudes;  ///< stage: factors over time  (loads)
  std::vector<LoadedFace> loaded;             ///< by global id, ascending; without cracks
  std::vector<FluidSource> fluids;            ///< empty: no load is a fluid
  FlowCase flow;
  std::vector<Bolt> bolts;
  std::vector<CrackSide> open_cracks;  ///< faces of discontinuities open from the start
  Buffer<ElasticTetrahedron> laws;     ///< stage  (materials; where stress in situ has a
                                       ///< slope: tetrahedra of the whole mesh)
  std::vector<Index> materials_of;     ///< likewise, else empty  (tetrahedra of the whole
                                       ///< mesh)
  std::vector<Vec3> middles;           ///< likewise, at the start  [m]
  Buffer<JointBond> bonds;             ///< stage; indexed by Joints::law  (laws of joints)
  Buffer<ContactPair> contact_pairs;  ///< stage; of materials p, q at p materials + q (materials^2)
  Buffer<Hold> holds;                 ///< stage; indexed by Tetrahedra::hold
  /// Each vertex of the mesh: bit 0: at the border or a face that nothing joins, bit 1 such a face
  /// between two tetrahedra.  [-]  (vertices of the whole mesh)
  std::vector<std::uint8_t> open_vertex;

  Buffer<Vec3> starts;  ///< places of corners at the start, by global number; empty: nothing needs
                        ///< them  [m]  (4 tetrahedra of the whole mesh)
  std::vector<ProbeFit> strain_fits;  ///< of probes of strain

  /// Visits the arrays that kernels read.
  template <class Visit>
  void each_array(Visit&& visit) {
    visit(laws), visit(bonds), visit(contact_pairs), visit(holds), visit(starts);
  }
};

}  // namespace breccia::fdem3
