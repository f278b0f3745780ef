// The ledger of an FDEM run: every joule, summed exactly, per unit thickness.

#include "fdem/energy.hpp"

#include "exec/fold_sum.hpp"

namespace breccia::fdem {
namespace {

struct TriangleShares {
  OwnedView owned;
  MoveTriangles move;
  View<const Index> material;
  View<const ElasticTriangle> laws;
  View<const Mat2> shape_inverse;
  View<const double> viscous_work, damping_work, load_work;

  BR_HD void add_to(Energies& s, Index t) const {
    if (!owned(t)) return;
    const Kick& kick = move.kick;
    s.damping.add(viscous_work[t]);
    s.damping.add(damping_work[t]);
    s.work.add(load_work[t]);
    if (is_gone(kick.holds, kick.hold[t])) return;
    const Kick::Result next = kick(t);
    const double span = 0.5 * (kick.last_dt + kick.next_dt);
    for (int k = 0; k < 3; ++k) {
      // m/2 (v.v - dt_- dt_+ a.a / 4): the leapfrog's own balance closes with it
      const Vec2 before = kick.nodes[t].at[k].velocity;
      const Vec2 a = span > 0.0 ? (1.0 / span) * (next.velocity[k] - before) : Vec2{};
      const Vec2 now = before + (0.5 * kick.last_dt) * a;
      s.kinetic.add(0.5 * kick.mass[t] *
                    (dot(now, now) - 0.25 * kick.last_dt * kick.next_dt * dot(a, a)));
      // Moving books the work of these forces in the last and the next step; half is done.
      const Vec2 came = (0.5 * kick.last_dt) * before;
      s.damping.add(dot(next.damped[k], came));
      if (move.external.size > 0) s.work.add(dot(move.external[t].at[k], came));
      if (kick.hold[t] >= 0) s.work.add(dot(move.reaction(kick.given(t), k, next), came));
    }
    Vec2 x[3], v[3];
    split(kick.nodes[t], x, v);
    const Mat2& inverse_shape = shape_inverse[t];
    const double area = 0.5 / determinant(inverse_shape);
    s.elastic.add(area * laws[material[t]].energy(deformation(inverse_shape, x, v)));
  }
};

struct GravityPotential {
  OwnedView owned;
  Vec2 gravity;
  View<const TriangleNodes> nodes;
  View<const double> mass;
  BR_HD void add_to(Energies& sum, Index t) const {
    if (!owned(t)) return;
    for (const NodeState& n : nodes[t].at) sum.potential.add(mass[t] * dot(gravity, n.position));
  }
};

struct JointShares {
  OwnedView owned;  ///< the owner of side a books it
  View<const NodeState> nodes;
  View<const JointBond> bonds;
  View<const JointEnds> ends;
  View<const Index> law;
  View<const double> length, strength;
  View<const Vec2> preset;
  View<const JointStage> stage;
  View<const JointPoints> points;
  View<const JointWork> work, inherited_work;

  BR_HD void add_to(Energies& s, Index i) const {
    if (stage[i] == JointStage::dormant || !owned(ends[i].a0 / 3)) return;
    if (stage[i] == JointStage::cut) {  // after that it took work out of the model
      s.fracture.add(inherited_work[i].open);
      s.sliding.add(inherited_work[i].slide);
      s.work.add(inherited_work[i].open - work[i].open);
      s.work.add(inherited_work[i].slide - work[i].slide);
      return;
    }
    if (stage[i] != JointStage::whole) {
      s.fracture.add(work[i].open);
      s.sliding.add(work[i].slide);
    }
    if (stage[i] == JointStage::broken) {
      s.fracture.add(-inherited_work[i].open);
      s.sliding.add(-inherited_work[i].slide);
      return;
    }
    const JointEnds& e = ends[i];
    const JointOpening<double> o = opening_of(nodes[e.a0].position, nodes[e.a1].position,
                                              nodes[e.b0].position, nodes[e.b1].position);
    const Vec2 offset = preset.size > 0 ? preset[i] : Vec2{};
    const StoredEnergy held =
        stored_in(bonds[law[i]], strength[i], length[i], offset, o, points[i]);
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
  const Triangles& t = w.triangles;
  FoldSum<Energies> all(w.exec);
  all.add(t.size(), TriangleShares{owned,
                                   {kick(w), t.external.view(), {}, {}, {}, {}},
                                   laws_of(w),
                                   w.given->laws.view(),
                                   t.shape_inverse.view(),
                                   t.viscous_work.view(),
                                   t.damping_work.view(),
                                   t.load_work.view()});
  const Joints& j = w.joints;
  all.add(j.size(),
          JointShares{owned, by_number(t.nodes.view()), w.given->bonds.view(), w.joint_ends.view(),
                      j.law.view(), j.length.view(), j.strength.view(), j.preset.view(),
                      j.stage.view(), j.points.view(), j.work.view(), j.inherited_work.view()});
  all.add(w.couples.size(),
          CoupleShares{owned, w.couples.pairs.a.view(), w.couples.history.state.view()});
  const Vec2 gravity = w.given->gravity;
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

}  // namespace breccia::fdem
