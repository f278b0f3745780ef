#pragma once
// How triangles are shared among ranks, by the words of fdem_shared/ranks.hpp.

#include "fdem/world.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem {

struct ShapeOfRanks {
  /// Costs on one core, in units of some 3 ns (bench/notes/cpu.md).
  static constexpr fdem_shared::Costs costs{
      .element = 8, .end_of_joint = 3, .end_of_couple = 16, .tied_corner = 3};
  /// Waking joints look at triangles that nothing ties yet.
  static bool needs_all_ghosts(const World& w) { return w.given->extrinsic; }
  /// Calls visit(forces) with the forces of all joints, as many as there are joints.
  template <class Visit>
  static void with_joint_forces(World& w, const Visit& visit) {
    with_number(w.exec.precision, [&](auto of) {
      auto& forces = w.joints.force.template as<decltype(of)>();
      forces.resize(w.joints.size());
      visit(forces);
      forces.resize(w.joints.size() + 1);  // the last one is zero
    });
  }
  static void drop_joint_forces(Joints& j) {
    j.force.in_double.resize(0);
    j.force.in_single.resize(0);
  }
  static void forget_mesh_for_kernels(World& w) {
    w.node_vertex.clear();
    w.side_across.clear();
  }
  static void derive_part(World& w, Space space);
  static void take_common(World& w, Communicator& ranks);
  static void collect_common(const World& part, World& whole) {
    whole.fluid = part.fluid;
    whole.bolts = part.bolts;
  }
};

}  // namespace breccia::fdem
