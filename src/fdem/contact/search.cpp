// New couples of triangles: fdem_shared/search.hpp.

#include "fdem_shared/search.hpp"

#include "fdem/ranks.hpp"
#include "fdem/stepping/busy_pairs.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem_shared/kept_lists.hpp"

namespace breccia::fdem {

using fdem_shared::begin_empty;
using fdem_shared::begin_list;

MarginRule margin_rule(const World& w) {
  return fdem_shared::mesh_margin_rule(w);
}

void ask_ranks_for_search(World& w) {
  fdem_shared::ask_mesh_for_search(w);
}

bool couples_are_due(World& w) {
  return fdem_shared::mesh_couples_are_due(w);
}

bool follow_marks(World& w) {
  return fdem_shared::follow_mesh_marks(w);
}

void expect_marks(World& w) {
  with_number(w.exec.precision, [&w](auto number) {
    fdem_shared::expect_marks_of(w, joint_kernel<decltype(number)>(w));
  });
}

void find_couples(World& w) {
  fdem_shared::find_mesh_couples(w);
}

void derive_couples(World& w) {
  fdem_shared::derive_mesh_couples(w);
  if (w.exec.space == Space::host) return;
  const Index couples = w.couples.size(), joints = w.joints.size();
  if (keeps_lists(w)) {
    begin_list(w.exec, w.busy, couples, ActingCouple(w));
    begin_list(w.exec, w.busy_joints, joints, SoftenedJoint(w));
  } else {
    begin_empty(w.busy, couples);
    begin_empty(w.busy_joints, joints);
  }
}

}  // namespace breccia::fdem
