// New couples of tetrahedra: fdem_shared/search.hpp, and which faces are exposed.

#include "fdem_shared/search.hpp"

#include "fdem3/ranks.hpp"
#include "fdem3/stepping/launches.hpp"

namespace breccia::fdem3 {
namespace {

/// Notes the faces of tetrahedra that nothing joins.
struct NoteExposed {
  static constexpr const char* name = "fdem3.note_exposed";
  View<const FaceJoints> faces;
  View<const JointStage> stage;
  View<std::uint8_t> exposed;
  BR_HD void operator()(Index t) const {
    exposed[t] = static_cast<std::uint8_t>(exposed_faces(faces[t], stage));
  }
};

/// Room for records of joints that fail until the next search: for all joints where the host takes
/// each step, which would have to look whether some wait.
void make_room_for_failures(World& w) {
  RareArray<JointFailure>& records = w.joints.failure;
  if (w.domain.single_rank() && !w.meets_spheres)
    records.make_room(spare_records(w.exec.space, records.size()));
  else
    records.make_room_for_all();
}

}  // namespace

/// Ghosts hear from their owners which of their faces are exposed: not all their joints are here.
void Shape::note_exposed(World& w) {
  Tetrahedra& t = w.tetrahedra;
  for_each_owned(w.exec, w.domain, t.size(),
                 NoteExposed{std::as_const(w.faces).view(), std::as_const(w.joints.stage).view(),
                             t.exposed.view()});
  if (!w.domain.single_rank()) w.domain.halo.refresh(w.exec, *w.domain.ranks, t.exposed);
}

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
  fdem_shared::expect_marks_of(w, joint_kernel(w));
}

void find_couples(World& w) {
  fdem_shared::find_mesh_couples(w);
  if (w.exec.space != Space::host) make_room_for_failures(w);
}

void derive_couples(World& w) {
  fdem_shared::derive_mesh_couples(w);
  if (w.exec.space != Space::host) w.busy.resize(w.couples.size());
}

}  // namespace breccia::fdem3
