#include "run/frames/coupled_frame.hpp"

#include "core/on_host.hpp"

namespace breccia {

void add_presses(const coupled::World& w, std::vector<FrameContact>& contacts) {
  const Space space = w.spheres->exec.space;
  const OnHost spheres(w.spheres->elements.state, space);
  const OnHost sphere_id(w.spheres->elements.id, space);
  const OnHost nodes(w.tetrahedra->tetrahedra.nodes, space);
  const OnHost solid_id(w.tetrahedra->tetrahedra.id, space);
  const OnHost a(w.faces.pairs.a, space), face(w.faces.pairs.b, space);
  const OnHost forces(w.faces.history.force, space);
  const auto behind = static_cast<GlobalId>(w.spheres->elements.size());
  const Index all = w.faces.size();
  for (Index i = 0; i < all;) {  // by sphere, then face: those of one tetrahedron follow each other
    const Index from = a->data()[i], to = face->data()[i] / 4;
    Vec3 force{};
    for (; i < all && a->data()[i] == from && face->data()[i] / 4 == to; ++i)
      for (const Vec3& corner : forces->data()[i].at) force += corner;
    if (dot(force, force) == 0.0) continue;
    contacts.push_back({sphere_id->data()[from], behind + solid_id->data()[to],
                        spheres->data()[from].position, centroid(nodes->data()[to]), force});
  }
}

}  // namespace breccia
