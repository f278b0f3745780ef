#include "fdem3/emission.hpp"

#include <cmath>

#include "core/on_host.hpp"
#include "fdem_shared/emission.hpp"
#include "fdem_shared/joint_stages.hpp"

namespace breccia::fdem3 {
namespace {

/// Unit, in the joint's plane at the start; along its first edge if its sides lie nowhere apart.
Vec3 slip_direction(const JointPlace& place, const JointOpening& o) {
  if (!(o.twice > 0.0)) return place.along;
  const Vec3 slide = o.slide[0] + o.slide[1] + o.slide[2], side = cross(o.normal, o.along);
  const double first = dot(slide, o.along), second = dot(slide, side);
  const double size = std::sqrt(first * first + second * second);
  if (!(size > 0.0)) return place.along;
  return (first / size) * place.along + (second / size) * cross(place.normal, place.along);
}

}  // namespace

JointPlace place_of(const Vec3 (&x)[3]) {
  const Vec3 edge = x[1] - x[0], twice = cross(edge, x[2] - x[0]);
  return {(1.0 / 3.0) * (x[0] + x[1] + x[2]), (1.0 / norm(twice)) * twice,
          (1.0 / norm(edge)) * edge};
}

std::vector<EmissionEvent> emission(const World& w, const PlaceOfFace& place_at_start) {
  if (!fdem_shared::any_broken(w)) return {};
  const OnHost<Joints> joints(w.joints, w.exec.space);
  const OnHost nodes(w.tetrahedra.nodes, w.exec.space);
  const OnHost material(w.tetrahedra.material, w.exec.space);
  const OnHost laws(w.given->laws, w.exec.space);
  const bool graded = w.given->in_situ.graded();
  const auto law_at = [&](Index face) {
    return laws->data()[graded ? face / 4 : material->data()[face / 4]];
  };
  std::vector<Break> breaks;
  for (Index i = 0; i < joints->size(); ++i) {
    if (joints->stage.data()[i] != JointStage::broken) continue;
    double opening = 0.0, slip = 0.0;  // means over the joint
    const JointPoints points = points_of(*joints, i);
    for (const auto& point : points.point) {
      opening += point.opening / 3.0;
      slip += point.slip / 3.0;
    }
    const JointPlace place = place_at_start(joints->face_b.data()[i]);
    const JointEnds e =
        JointEnds::of(joints->face_a.data()[i], joints->face_b.data()[i], joints->turn.data()[i]);
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = nodes->data()[e.a[k] / 4].at[e.a[k] % 4].position;
      b[k] = nodes->data()[e.b[k] / 4].at[e.b[k] % 4].position;
    }
    const Vec3 along = slip_direction(place, opening_of(a, b));
    breaks.push_back(
        {broke_at(*joints, i), place.middle,
         fdem_shared::moment_of(fdem_shared::mean_of_sides(law_at(joints->face_a.data()[i]),
                                                           law_at(joints->face_b.data()[i])),
                                place.normal, along, joints->shape.data()[i].area(), opening, slip),
         fdem_shared::spent_by(*joints, i)});
  }
  return fdem_shared::near_events(w, breaks);
}

}  // namespace breccia::fdem3
