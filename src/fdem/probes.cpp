// Readings of probes: quantities of corners, stresses of triangles, cracks of joints.

#include <algorithm>
#include <utility>

#include "core/case_config.hpp"
#include "core/gauge.hpp"
#include "core/probe.hpp"
#include "exec/error.hpp"
#include "exec/for_each.hpp"
#include "fdem/observe.hpp"

namespace breccia::fdem {
namespace {

BR_HD inline Vec3 in_the_plane(const Vec2& v) {
  return {v.x, v.y, 0.0};
}
BR_HD inline Vec2 middle_of(const TriangleNodes& t) {
  return (1.0 / 3.0) * (t.at[0].position + t.at[1].position + t.at[2].position);
}

/// Quantities of corners.
struct ReadProbe {
  OwnedView owned;
  Quantity quantity;
  View<const Index> members;  ///< corners; empty: all
  View<const GlobalId> id;
  Kick kick;  ///< velocities are read at the time of the positions
  View<const double> damage;
  View<const Vec2> starts;  ///< by global number
  ReadBox box;
  Vec3 about;     ///<  [m]
  StrainFit fit;  ///< of a probe of strain

  BR_HD double part(const Vec2& v) const { return quantity.axis == 0 ? v.x : v.y; }
  BR_HD bool from_start() const {
    return quantity.kind == Quantity::Kind::displacement || quantity.kind == Quantity::Kind::strain;
  }
  BR_HD double value(Index t, Index k) const {
    const NodeState& node = kick.nodes[t].at[k];
    const Vec2 velocity = kick.between(node.velocity, kick(t).velocity[k]);
    const Vec2 arm = node.position - Vec2{about.x, about.y};
    switch (quantity.kind) {
      case Quantity::Kind::position:
        return part(node.position);
      case Quantity::Kind::displacement:
        return part(node.position - starts[3 * id[t] + k]);
      case Quantity::Kind::strain: {
        const Vec2& start = starts[3 * id[t] + k];
        return fit.term(in_the_plane(start), in_the_plane(node.position - start), quantity.axis,
                        quantity.other);
      }
      case Quantity::Kind::velocity:
        return part(velocity);
      case Quantity::Kind::force:
        return part(kick.force[t].at[k]);
      case Quantity::Kind::torque:
        return cross(arm, kick.force[t].at[k]);
      case Quantity::Kind::momentum:
        return kick.mass[t] * part(velocity);
      case Quantity::Kind::angular_momentum:
        return kick.mass[t] * cross(arm, velocity);
      case Quantity::Kind::speed:
        return norm(velocity);
      case Quantity::Kind::damage:
        return damage[t];
      default:
        break;
    }
    return 0.5 * kick.mass[t] * dot(velocity, velocity);
  }
  BR_HD Readings operator()(Index i) const {
    const Index n = members.size > 0 ? members[i] : i;
    const Index t = n / 3, k = n % 3;
    if (!owned(t) || is_gone(kick.holds, kick.hold[t])) return Readings();
    const Vec2 place = from_start() ? starts[3 * id[t] + k] : kick.nodes[t].at[k].position;
    if (!box.holds(in_the_plane(place))) return Readings();
    return Readings(value(t, k), 3 * id[t] + k);
  }
};

/// 1: a corner of the triangle is one of a set's.
struct Mark {
  static constexpr const char* name = "fdem.mark_members";
  View<const Index> members;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const { marked[members[i] / 3] = 1; }
};

/// Cauchy stress of triangles, without viscosity, each by its area.
struct ReadStress {
  OwnedView owned;
  Quantity quantity;
  ReadBox box;
  View<const std::uint8_t> marked;  ///< empty: all triangles
  View<const GlobalId> id;
  View<const Index> material;
  View<const TriangleNodes> nodes;
  View<const Mat2> shape_inverse;
  View<const ElasticTriangle> laws;
  View<const Index> hold;
  View<const Hold> holds;

  BR_HD Readings operator()(Index t) const {
    if (!owned(t) || is_gone(holds, hold[t]) || (marked.size > 0 && marked[t] == 0))
      return Readings();
    if (!box.holds(in_the_plane(middle_of(nodes[t])))) return Readings();
    Vec2 x[3], v[3];
    split(nodes[t], x, v);
    const Sym2 s = laws[material[t]].stress(deformation(shape_inverse[t], x, v), 0.0);
    const double component = quantity.axis != quantity.other ? s.xy
                             : quantity.axis == 0            ? s.xx
                                                             : s.yy;
    return Readings::weighted(component, 0.5 * cross(x[1] - x[0], x[2] - x[0]), id[t]);
  }
};

/// Joints: 1 for each broken one, 0 for each other; or how far those that soften or are broken have
/// opened and slipped in their middle.
struct ReadJoints {
  OwnedView owned;  ///< the owner of side a reads it
  Quantity::Kind kind;
  ReadBox box;
  View<const std::uint8_t> marked;  ///< of triangles; empty: all
  View<const GlobalId> id;
  View<const TriangleNodes> nodes;
  View<const Index> edge_a, edge_b;
  View<const JointStage> stage;

  BR_HD Readings operator()(Index i) const {
    const Index a = edge_a[i] / 3, b = edge_b[i] / 3;
    if (!owned(a) || (marked.size > 0 && marked[a] == 0 && marked[b] == 0)) return Readings();
    const JointEnds e = JointEnds::of(edge_a[i], edge_b[i]);
    const Vec2 a0 = corner(e.a0), a1 = corner(e.a1), b0 = corner(e.b0), b1 = corner(e.b1);
    if (!box.holds(in_the_plane(0.25 * (a0 + a1 + b0 + b1)))) return Readings();
    const Index number = 3 * id[a] + edge_a[i] % 3;
    if (kind == Quantity::Kind::broken)
      return Readings(stage[i] == JointStage::broken ? 1.0 : 0.0, number);
    if (!is_damaged(stage[i])) return Readings();
    const JointOpening<double> o = opening_of(a0, a1, b0, b1);
    return Readings(kind == Quantity::Kind::opening ? o.open[1] : abs(o.slide[1]), number);
  }
  BR_HD Vec2 corner(Index n) const { return nodes[n / 3].at[n % 3].position; }
};

Readings read_corners(const World& w, const ProbeConfig& p, const Quantity& quantity,
                      const Buffer<Index>& members) {
  Buffer<double> lost(w.exec.space);
  if (quantity.kind == Quantity::Kind::damage) copy_to(lost, damage(w));
  StrainFit fit;
  for (const ProbeFit& of_probe : w.given->strain_fits)
    if (of_probe.probe == p.name) fit = of_probe.fit;
  const Triangles& t = w.triangles;
  return fold(w.exec, p.on.empty() ? 3 * t.size() : members.size(), Readings{},
              ReadProbe{w.domain.owned_view(), quantity, members.view(), t.id.view(), kick(w),
                        std::as_const(lost).view(), w.given->starts.view(), ReadBox(p.min, p.max),
                        point_of(p.about), fit},
              Sum{});
}

Readings read(const World& w, const ProbeConfig& p, const Buffer<Index>& members) {
  using Kind = Quantity::Kind;
  const Quantity quantity = quantity_named(p.quantity).quantity;
  const Kind kind = quantity.kind;
  const bool joints = kind == Kind::broken || kind == Kind::opening || kind == Kind::slip;
  if (kind != Kind::stress && !joints) return read_corners(w, p, quantity, members);
  const Triangles& t = w.triangles;
  Buffer<std::uint8_t> marks(w.exec.space);
  if (!p.on.empty()) {
    copy_to(marks, std::vector<std::uint8_t>(at(t.size()), 0));
    for_each(w.exec, members.size(), Mark{members.view(), marks.view()});
  }
  const View<const std::uint8_t> marked = std::as_const(marks).view();
  const OwnedView owned = w.domain.owned_view();
  const ReadBox box(p.min, p.max);
  if (kind == Kind::stress)
    return fold(w.exec, t.size(), Readings{},
                ReadStress{owned, quantity, box, marked, t.id.view(), laws_of(w), t.nodes.view(),
                           t.shape_inverse.view(), w.given->laws.view(), t.hold.view(),
                           w.given->holds.view()},
                Sum{});
  const Joints& j = w.joints;
  return fold(w.exec, j.size(), Readings{},
              ReadJoints{owned, kind, box, marked, t.id.view(), t.nodes.view(), j.edge_a.view(),
                         j.edge_b.view(), j.stage.view()},
              Sum{});
}

}  // namespace

double probe(const World& w, const ProbeConfig& p) {
  for (const std::string& problem : probe_problems(p, in_plane)) throw InputError(problem);
  Buffer<Index> members(w.exec.space);
  if (!p.on.empty()) {
    const auto set = std::find_if(w.given->sets.begin(), w.given->sets.end(),
                                  [&](const NodeSet& s) { return s.name == p.on; });
    if (set == w.given->sets.end())
      throw InputError("probe " + p.name + ".on: there is no body or support \"" + p.on + "\"");
    copy_to(members, set->nodes);
  }
  return read(w, p, members).reduced(p.reduce);
}

Readings read_own(World& part, const ProbeConfig& p) {
  const auto set = std::find_if(part.given->sets.begin(), part.given->sets.end(),
                                [&](const NodeSet& s) { return s.name == p.on; });
  if (set == part.given->sets.end()) return read(part, p, Buffer<Index>(part.exec.space));
  SetHere& here = part.sets_here[static_cast<std::size_t>(set - part.given->sets.begin())];
  keep_here(here, part.domain, part.triangles.id, set->nodes, 3, part.exec.space);
  return read(part, p, here.places);
}

}  // namespace breccia::fdem
