// Elements that other ranks wait for move first, all others while their ghosts travel.

#include <gtest/gtest.h>

#include "fdem/ranks.hpp"
#include "fdem/stepping/step.hpp"
#include "mpi/on_ranks.hpp"

namespace breccia {
namespace boundary_test {

using namespace mpi_testing;

/// How often each element is in some of the runs.
std::vector<int> taken(const std::vector<const std::vector<ElementRun>*>& lists, Index count) {
  std::vector<int> times(static_cast<std::size_t>(count), 0);
  for (const auto* runs : lists)
    Domain::each_run_of(*runs, 0, count, [&](Index from, Index to) {
      for (Index e = from; e < to; ++e) ++times[static_cast<std::size_t>(e)];
    });
  return times;
}

TEST(BoundaryElements, each_own_element_moves_once_and_those_with_copies_move_first) {
  std::int64_t first = 0, later = 0;
  simulate_ranks(4, 9, [&](Communicator& ranks) {
    auto whole = box().world();
    auto part = share_out(whole, ranks, {});
    for (int i = 0; i < 40; ++i) step(part);
    const Domain& d = part.domain;
    ASSERT_TRUE(d.ghosts_selected);
    const Index count = part.triangles.size();
    const auto all = taken({&d.runs}, count),
               both = taken({&d.boundary_runs, &d.interior_runs}, count);
    EXPECT_EQ(all, both);
    const auto boundary = taken({&d.boundary_runs}, count);
    for (const Index e : d.active_ghosts.sent().host())
      EXPECT_EQ(boundary[static_cast<std::size_t>(e)], 1);
    std::vector<std::int64_t> sums{0, 0};
    for (Index e = 0; e < count; ++e)
      if (d.owns(e)) ++sums[boundary[static_cast<std::size_t>(e)] != 0 ? 0 : 1];
    ranks.add_up(sums);
    if (ranks.rank() == 0) first = sums[0], later = sums[1];
  });
  EXPECT_GT(first, 20);
  EXPECT_GT(later, first);
}

/// Whether joint i lies between two own triangles.
bool is_inner(const fdem::World& w, Index i) {
  return w.domain.owns(w.joints.edge_a.data()[i] / 3) &&
         w.domain.owns(w.joints.edge_b.data()[i] / 3);
}

TEST(BoundaryElements,
     whole_joints_between_own_triangles_go_ahead_and_leave_nothing_but_their_forces) {
  std::int64_t ahead = 0, all = 0;
  simulate_ranks(4, 9, [&](Communicator& ranks) {
    auto whole = impact("intrinsic").world();
    auto part = share_out(whole, ranks, {});
    for (int i = 0; i < 100; ++i) step(part);  // most are whole yet
    const Index count = part.joints.size();
    // Once more at the same positions: what is evaluated is what was.
    auto again = part;
    again.joints.force.in_double.clear();
    again.joints.force.in_double.resize(count + 1);
    const auto state = [](auto& joints) {
      std::string bytes;
      joints.each_field([&](const char*, const char*, auto& array) {
        bytes.append(reinterpret_cast<const char*>(array.data()),
                     static_cast<std::size_t>(array.size()) * sizeof *array.data());
      });
      return bytes;
    };
    fdem::HostRun{}.inner_joint_forces(again);
    EXPECT_EQ(state(again.joints), state(part.joints));
    std::vector<std::int64_t> sums{0, count};
    for (Index i = 0; i < count; ++i) {
      const auto pack = again.joint_packs[static_cast<std::size_t>(i / fdem::joint_pack)];
      EXPECT_TRUE(pack == fdem::JointPack::outer || is_inner(part, i));
      if (pack != fdem::JointPack::done) continue;
      ++sums[0];
      EXPECT_EQ(part.joints.stage.data()[i], fdem::JointStage::whole);
      EXPECT_EQ(0, std::memcmp(&part.joints.force.in_double.data()[i],
                               &again.joints.force.in_double.data()[i], sizeof(fdem::JointForce)));
    }
    ranks.add_up(sums);
    if (ranks.rank() == 0) ahead = sums[0], all = sums[1];
  });
  EXPECT_GT(4 * ahead, all) << ahead << " of " << all;
}

}  // namespace boundary_test
}  // namespace breccia
