// The ledger of a run of tetrahedra: every joule, summed exactly.

#include "exec/fold_sum.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {
namespace {

struct ElementShares {
  OwnedView owned;
  Kick kick;
  View<const Corners> external;
  View<const Index> material;
  View<const ElasticTetrahedron> laws;
  View<const ShapeGradients> shape;
  View<const double> viscous_work, damping_work, load_work;

  BR_HD void add_to(Energies& s, Index t) const {
    if (!owned(t)) return;
    s.damping.add(viscous_work[t]);
    s.damping.add(damping_work[t]);
    s.work.add(load_work[t]);
    const Kick::Result next = kick(t);
    const double span = kick.span();
    for (int k = 0; k < 4; ++k) {
      // m/2 (v.v - dt_- dt_+ a.a / 4): the leapfrog's own balance closes with it
      const Vec3 before = kick.nodes[t].at[k].velocity;
      const Vec3 a = span > 0.0 ? (1.0 / span) * (next.velocity[k] - before) : Vec3{};
      const Vec3 now = before + (0.5 * kick.last_dt) * a;
      s.kinetic.add(0.5 * kick.mass[t] *
                    (dot(now, now) - 0.25 * kick.last_dt * kick.next_dt * dot(a, a)));
      // Moving books the work of these forces in the last and the next step; half is done.
      const Vec3 came = (0.5 * kick.last_dt) * before;
      s.damping.add(dot(next.damped[k], came));
      if (external.size > 0) s.work.add(dot(external[t].at[k], came));
      s.work.add(dot(kick.reaction(t, k, next), came));
    }
    Vec3 x[4];
    places(kick.nodes[t], x);
    const ShapeGradients& g = shape[t];
    s.elastic.add(g.volume() * laws[material[t]].energy(deformation(g, x)));
  }
};

struct GravityPotential {
  OwnedView owned;
  Vec3 gravity;
  View<const TetrahedronNodes> nodes;
  View<const double> mass;
  BR_HD void add_to(Energies& sum, Index t) const {
    if (!owned(t)) return;
    for (const NodeState& n : nodes[t].at) sum.potential.add(mass[t] * dot(gravity, n.position));
  }
};

struct JointShares {
  OwnedView owned;  ///< the owner of side a books it
  View<const TetrahedronNodes> nodes;
  View<const JointBond> bonds;
  View<const Index> face_a, face_b;
  View<const std::uint8_t> turn;
  View<const Index> law;
  View<const FaceShape> shape;
  View<const double> length, strength;
  View<const Vec3> preset;
  View<const JointStage> stage;
  View<const JointPoints> points;
  View<const JointWork> work, inherited_work;

  BR_HD void add_to(Energies& s, Index i) const {
    if (!owned(face_a[i] / 4)) return;
    if (stage[i] != JointStage::whole) {
      s.fracture.add(work[i].open);
      s.sliding.add(work[i].slide);
    }
    if (is_parted(stage[i])) {
      s.fracture.add(-inherited_work[i].open);
      s.sliding.add(-inherited_work[i].slide);
      return;
    }
    const JointEnds e = JointEnds::of(face_a[i], face_b[i], turn[i]);
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = nodes[e.a[k] / 4].at[e.a[k] % 4].position;
      b[k] = nodes[e.b[k] / 4].at[e.b[k] % 4].position;
    }
    const Vec3 offset = preset.size > 0 ? preset[i] : Vec3{};
    const fdem::StoredEnergy held = stored_in(bonds[law[i]], strength[i], length[i],
                                              shape[i].area(), offset, opening_of(a, b), points[i]);
    s.elastic.add(held.open);
    s.elastic.add(held.slide);
    if (stage[i] == JointStage::whole) return;
    s.fracture.add(-held.open);
    s.sliding.add(-held.slide);
  }
};

struct CoupleShares {
  OwnedView owned;  ///< the owner of a books it
  View<const Index> a;
  View<const CoupleState> state;
  BR_HD void add_to(Energies& s, Index i) const {
    if (!owned(a[i])) return;
    s.elastic.add(state[i].work - state[i].slid);
    s.friction.add(state[i].slid);
    s.friction.add(state[i].rubbed);
    s.contact.add(state[i].lost);
  }
};

}  // namespace

Energies held(const World& w) {
  const OwnedView owned = w.domain.owned_view();
  const Tetrahedra& t = w.tetrahedra;
  FoldSum<Energies> all(w.exec);
  all.add(t.size(), ElementShares{owned, kick(w), t.external.view(), t.material.view(),
                                  w.given->laws.view(), t.shape.view(), t.viscous_work.view(),
                                  t.damping_work.view(), t.load_work.view()});
  const Joints& j = w.joints;
  all.add(j.size(), JointShares{owned, t.nodes.view(), w.given->bonds.view(), j.face_a.view(),
                                j.face_b.view(), j.turn.view(), j.law.view(), j.shape.view(),
                                j.length.view(), j.strength.view(), j.preset.view(), j.stage.view(),
                                j.points.view(), j.work.view(), j.inherited_work.view()});
  all.add(w.couples.size(),
          CoupleShares{owned, w.couples.pairs.a.view(), w.couples.history.state.view()});
  const Vec3 gravity = w.given->gravity;
  if (dot(gravity, gravity) > 0.0)
    all.add(t.size(), GravityPotential{owned, gravity, t.nodes.view(), t.mass.view()});
  return all.sum();
}

void begin_ledger(World& w) {
  w.ledger = {};
  const Energies all = held(w);
  w.ledger.start_potential = all.potential;
  w.ledger.start = all.kinetic.value() + all.elastic.value();
}

EnergySplit energy_split(const World& w) {
  return split_of(w.ledger, held(w));
}

EnergySplit energies(Ledger& ledger, const Energies& all) {
  return split_and_note(ledger, all);
}
EnergySplit energies(World& w) {
  return energies(w.ledger, held(w));
}

}  // namespace breccia::fdem3
