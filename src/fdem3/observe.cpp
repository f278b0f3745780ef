#include "fdem3/observe.hpp"

#include "fdem3/setup/removal.hpp"
#include "fdem_shared/observations.hpp"

namespace breccia::fdem3 {

std::vector<Sym3> stresses(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
  const OnHost laws(w.given->laws, w.exec.space);
  const OnHost nodes(t.nodes, w.exec.space);
  const OnHost shape(t.shape, w.exec.space);
  const OnHost law(w.given->in_situ.graded() ? t.id : t.material, w.exec.space);
  std::vector<Sym3> all;
  all.reserve(at(t.size()));
  for (Index i = 0; i < t.size(); ++i) {
    Vec3 x[4];
    places(nodes->data()[i], x);
    all.push_back(laws->data()[law->data()[i]].stress(deformation(shape->data()[i], x)));
  }
  return all;
}

std::vector<Corners> velocities_now(World& w) {
  return fdem_shared::corner_velocities(w);
}

std::vector<std::int32_t> visible_faces(const World& w) {
  const OnHost faces(w.faces, w.exec.space);
  const OnHost stage(w.joints.stage, w.exec.space);
  const auto is_seen = [&](Index entry) {
    if (entry < 0) return entry == face_free;
    const JointStage of = stage->data()[pair_of(entry)];
    return is_damaged(of) || is_parted(of);
  };
  std::vector<std::int32_t> all;
  all.reserve(at(faces->size()));
  for (const FaceJoints& f : faces->host()) {
    std::int32_t bits = 0;
    for (int k = 0; k < 4; ++k)
      if (is_seen(f.at[k])) bits |= 1 << k;
    all.push_back(bits);
  }
  return all;
}

std::vector<Crack> cracks(const World& w) {
  if (!fdem_shared::any_broken(w)) return {};
  const OnHost<Joints> joints(w.joints, w.exec.space);
  const Joints& j = *joints;
  const OnHost nodes(w.tetrahedra.nodes, w.exec.space);
  return fdem_shared::cracks_of<World, Crack>(j, gone_tetrahedra(w), [&](Index i, double work) {
    const JointEnds e = JointEnds::of(j.face_a.data()[i], j.face_b.data()[i], j.turn.data()[i]);
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = nodes->data()[e.a[k] / 4].at[e.a[k] % 4].position;
      b[k] = nodes->data()[e.b[k] / 4].at[e.b[k] % 4].position;
    }
    const JointOpening o = opening_of(a, b);
    return Crack{
        i,        broke_at(j, i),           (1.0 / 3.0) * (o.middle[0] + o.middle[1] + o.middle[2]),
        o.normal, j.shape.data()[i].area(), mode_of(j, i),
        work};
  });
}

Fragments fragments(const World& w) {
  return fragments(w, fdem_shared::parted_joints(w));
}

Fragments fragments(const World& w, const std::vector<std::uint8_t>& broken) {
  const std::vector<std::uint8_t> gone = gone_tetrahedra(w);
  Pieces joined = fdem_shared::joined_elements(w, broken, gone);
  const Index count = w.tetrahedra.size();
  const OnHost masses(w.tetrahedra.mass, w.exec.space);
  std::vector<double> mass(at(count), 0.0);
  for (Index i = 0; i < count; ++i)
    if (gone[at(i)] == 0) mass[at(joined.root(i))] += 4.0 * masses->data()[i];
  fdem_shared::OrderedPieces ordered = fdem_shared::by_mass(joined, mass);
  Fragments f;
  f.of = std::move(ordered.of);
  f.pieces.resize(ordered.root.size());
  const OnHost nodes(w.tetrahedra.nodes, w.exec.space);
  for (Index i = 0; i < count; ++i) {
    if (gone[at(i)] != 0) continue;
    Piece& p = f.pieces[at(f.of[at(i)])];
    const double corner = masses->data()[i];
    Vec3 x[4], v[4];
    split(nodes->data()[i], x, v);
    p.mass += 4.0 * corner;
    p.volume += dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6.0;
    for (int k = 0; k < 4; ++k) {
      p.centre += corner * x[k];
      p.velocity += corner * v[k];
    }
  }
  for (Piece& p : f.pieces) {
    p.centre = (1.0 / p.mass) * p.centre;
    p.velocity = (1.0 / p.mass) * p.velocity;
  }
  return f;
}

}  // namespace breccia::fdem3

namespace breccia::fdem_shared {

template std::uint64_t state_hash(const fdem3::World&);
template UnsoundLater find_unsound_later(const fdem3::World&);
template Fastest fastest(const fdem3::World&);
template std::vector<double> damage(const fdem3::World&);
template RuledStep ruled_step(const fdem3::World&, bool);
template std::vector<StepOfElement> stable_steps(const fdem3::World&);

}  // namespace breccia::fdem_shared
