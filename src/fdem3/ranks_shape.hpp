#pragma once
// How tetrahedra are shared among ranks, by the words of fdem_shared/ranks.hpp.

#include "fdem3/world.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem3 {

struct ShapeOfRanks {
  /// Costs on one core, in units of some 10 ns (bench/notes/cpu.md).
  static constexpr fdem_shared::Costs costs{
      .element = 8, .end_of_joint = 4, .end_of_couple = 6, .tied_corner = 3};
  /// Waking joints look at tetrahedra that nothing ties yet.
  static bool needs_all_ghosts(const World& w) { return w.given->extrinsic; }
  /// Calls visit(forces) with the forces of all joints, as many as there are joints.
  template <class Visit>
  static void with_joint_forces(World& w, const Visit& visit) {
    visit(w.joints.force);
  }
  static void drop_joint_forces(Joints& j) { j.force.resize(0); }
  static void forget_mesh_for_kernels(World& w) {
    w.node_vertex.clear();
    w.side_across.clear();
  }
  static void derive_part(World& w, Space);
  static void take_common(World& w, Communicator& ranks);
  static void collect_common(const World& part, World& whole) {
    whole.fluid = part.fluid;
    whole.bolts = part.bolts;
  }
};

}  // namespace breccia::fdem3
