#include "run/frames/coupled_frame.hpp"

#include "core/on_host.hpp"

namespace breccia {

void add_presses(const coupled::World& w, std::vector<FrameContact>& contacts) {
  const Space space = w.spheres->exec.space;
  const coupled::Border& border = w.border;
  const bool alone = w.spheres->domain.single_rank();
  const OnHost spheres(alone ? w.spheres->elements.state : border.spheres, space);
  const OnHost nodes(alone ? w.tetrahedra->tetrahedra.nodes : border.nodes, space);
  const OnHost place(alone ? w.faces.pairs.b : border.face, space);
  const OnHost a(w.faces.pairs.a, space), face(w.faces.pairs.b, space);
  const OnHost forces(w.faces.history.force, space);
  const OnHost rows(w.rows, space);
  const GlobalId behind = w.given->spheres;
  for (const coupled::SphereRow& row : rows->host())  // faces of one tetrahedron follow each other
    for (Index i = row.face; i < row.face_end;) {
      const Index to = face->data()[i] / 4, solid = place->data()[i] / 4;
      const Index number = a->data()[i];
      Vec3 force{};
      for (; i < row.face_end && face->data()[i] / 4 == to; ++i)
        for (const Vec3& corner : forces->data()[i].at) force += corner;
      if (dot(force, force) == 0.0) continue;
      contacts.push_back({number, behind + to, spheres->data()[row.sphere].position,
                          centroid(nodes->data()[solid]), force});
    }
}

}  // namespace breccia
