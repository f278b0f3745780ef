#include "fdem/observe.hpp"

#include "fdem/setup/removal.hpp"
#include "fdem_shared/observations.hpp"

namespace breccia::fdem {
namespace {

/// value(law, deformation, material) of each triangle.
template <class Value, class Of>
std::vector<Value> of_deformation(const World& w, const Of& value) {
  const OnHost<Triangles> triangles(w.triangles, w.exec.space);
  const Triangles& t = *triangles;
  std::vector<ElasticTriangle> laws;
  copy_to(laws, w.given->laws);
  const Buffer<Index>& law = w.given->in_situ.graded() ? t.id : t.material;
  std::vector<Value> all;
  all.reserve(at(t.size()));
  for (Index i = 0; i < t.size(); ++i) {
    Vec2 x[3], v[3];
    split(t.nodes.data()[i], x, v);
    all.push_back(value(laws[at(law.data()[i])], deformation(t.shape_inverse.data()[i], x, v),
                        t.material.data()[i]));
  }
  return all;
}

}  // namespace

std::vector<Sym2> stresses(const World& w) {
  return of_deformation<Sym2>(
      w, [](const ElasticTriangle& law, const auto& d, Index) { return law.stress(d, 0.0); });
}
std::vector<double> stresses_across(const World& w) {
  return of_deformation<double>(w, [&](const ElasticTriangle& law, const auto& d, Index material) {
    if (!w.given->plane_strain) return 0.0;
    if (!law.is_bedded()) return law.stress_across(d);
    const OutOfPlane p = w.given->rocks[at(material)].out_of_plane;
    ElasticTriangle strained = law;
    strained.preset = {};
    const Sym2 s = strained.stress(d, 0.0);
    const double angle = w.given->rocks[at(material)].angle;
    const Vec2 turned = d.gradient * Vec2{std::cos(angle), std::sin(angle)};
    const Vec2 along = (1.0 / norm(turned)) * turned;
    const double by_along = dot(s * along, along);
    return p.along * by_along + p.across * (s.xx + s.yy - by_along);
  });
}

std::vector<Corners> velocities_now(World& w) {
  return fdem_shared::corner_velocities(w);
}

std::vector<Crack> cracks(const World& w) {
  if (!fdem_shared::any_broken(w)) return {};
  const OnHost<Joints> joints(w.joints, w.exec.space);
  const Joints& j = *joints;
  const OnHost nodes(w.triangles.nodes, w.exec.space);
  const auto corner = [&](Index n) { return nodes->data()[n / 3].at[n % 3].position; };
  return fdem_shared::cracks_of<World, Crack>(j, gone_triangles(w), [&](Index i, double work) {
    const JointEnds e = JointEnds::of(j.edge_a.data()[i], j.edge_b.data()[i]);
    return Crack{i,
                 j.broke_at.data()[i],
                 0.5 * (corner(e.a0) + corner(e.b0)),
                 0.5 * (corner(e.a1) + corner(e.b1)),
                 mode_of(j, i),
                 work};
  });
}

Fragments fragments(const World& w) {
  return fragments(w, fdem_shared::parted_joints(w));
}

Fragments fragments(const World& w, const std::vector<std::uint8_t>& broken) {
  const std::vector<std::uint8_t> gone = gone_triangles(w);
  Pieces pieces = fdem_shared::joined_elements(w, broken, gone);
  const OnHost<Triangles> triangles(w.triangles, w.exec.space);
  const Triangles& t = *triangles;
  std::vector<double> of_root(gone.size(), 0.0);
  std::vector<Piece> found(gone.size());
  for (Index i = 0; i < t.size(); ++i) {
    if (gone[at(i)] != 0) continue;
    const std::size_t root = at(pieces.root(i));
    const double corner = t.mass.data()[i];
    Vec2 x[3], v[3];
    split(t.nodes.data()[i], x, v);
    of_root[root] += 3.0 * corner;
    found[root].area += 0.5 * cross(x[1] - x[0], x[2] - x[0]);
    for (int k = 0; k < 3; ++k) {
      found[root].centre += corner * x[k];
      found[root].velocity += corner * v[k];
    }
  }
  fdem_shared::OrderedPieces ordered = fdem_shared::by_mass(pieces, of_root);
  Fragments f;
  f.of = std::move(ordered.of);
  for (const Index root : ordered.root) {
    const double mass = of_root[at(root)];
    const Piece& p = found[at(root)];
    f.mass.push_back(mass);
    f.pieces.push_back({p.area, (1.0 / mass) * p.centre, (1.0 / mass) * p.velocity});
  }
  return f;
}

}  // namespace breccia::fdem

namespace breccia::fdem_shared {

template std::uint64_t state_hash(const fdem::World&);
template UnsoundLater find_unsound_later(const fdem::World&);
template Fastest fastest(const fdem::World&);
template std::vector<double> damage(const fdem::World&);
template RuledStep ruled_step(const fdem::World&, bool);
template std::vector<StepOfElement> stable_steps(const fdem::World&);

}  // namespace breccia::fdem_shared
