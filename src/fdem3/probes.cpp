// Readings of probes: quantities of corners, stresses of tetrahedra, cracks of joints.

#include <algorithm>
#include <utility>

#include "core/case_config.hpp"
#include "exec/error.hpp"
#include "exec/for_each.hpp"
#include "fdem3/observe.hpp"

namespace breccia::fdem3 {
namespace {

/// Quantities of corners.
struct ReadProbe {
  OwnedView owned;
  Quantity quantity;
  View<const Index> members;  ///< corners; empty: all
  View<const GlobalId> id;
  Kick kick;  ///< velocities are read at the time of the positions
  View<const double> damage;
  View<const Vec3> starts;  ///< by global number
  ReadBox box;
  Vec3 about;     ///<  [m]
  StrainFit fit;  ///< of a probe of strain

  BR_HD double part(const Vec3& v) const { return on_axis(v, quantity.axis); }
  BR_HD bool from_start() const {
    return quantity.kind == Quantity::Kind::displacement || quantity.kind == Quantity::Kind::strain;
  }
  BR_HD double value(Index t, Index k) const {
    const NodeState& node = kick.nodes[t].at[k];
    const Vec3 velocity = kick.between(node.velocity, kick(t).velocity[k]);
    const Vec3 arm = node.position - about;
    switch (quantity.kind) {
      case Quantity::Kind::position:
        return part(node.position);
      case Quantity::Kind::displacement:
        return part(node.position - starts[4 * id[t] + k]);
      case Quantity::Kind::strain: {
        const Vec3& start = starts[4 * id[t] + k];
        return fit.term(start, node.position - start, quantity.axis, quantity.other);
      }
      case Quantity::Kind::velocity:
        return part(velocity);
      case Quantity::Kind::force:
        return part(kick.force[t].at[k]);
      case Quantity::Kind::torque:
        return part(cross(arm, kick.force[t].at[k]));
      case Quantity::Kind::momentum:
        return kick.mass[t] * part(velocity);
      case Quantity::Kind::angular_momentum:
        return kick.mass[t] * part(cross(arm, velocity));
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
    const Index t = n / 4, k = n % 4;
    if (!owned(t)) return Readings();
    const Vec3 place = from_start() ? starts[4 * id[t] + k] : kick.nodes[t].at[k].position;
    if (!box.holds(place)) return Readings();
    return Readings(value(t, k), 4 * id[t] + k);
  }
};

/// 1: a corner of the tetrahedron is one of a set's.
struct Mark {
  static constexpr const char* name = "fdem3.mark_members";
  View<const Index> members;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const { fdem::set_flag(marked, members[i] / 4); }
};

/// Cauchy stress of tetrahedra, without viscosity, each by its volume.
struct ReadStress {
  OwnedView owned;
  Quantity quantity;
  ReadBox box;
  View<const std::uint8_t> marked;  ///< empty: all
  View<const GlobalId> id;
  View<const Index> material;
  View<const TetrahedronNodes> nodes;
  View<const ShapeGradients> shape;
  View<const ElasticTetrahedron> laws;

  BR_HD Readings operator()(Index t) const {
    if (!owned(t) || (marked.size > 0 && marked[t] == 0)) return Readings();
    if (!box.holds(centroid(nodes[t]))) return Readings();
    Vec3 x[4];
    places(nodes[t], x);
    const Deformation d = deformation(shape[t], x);
    const Sym3 s = laws[material[t]].stress(d);
    return Readings::weighted(component(s, quantity.axis, quantity.other),
                              d.jacobian * shape[t].volume(), id[t]);
  }
};

/// Joints: 1 for each broken one, 0 for each other; or how far those that soften or are broken have
/// opened and slipped on average.
struct ReadJoints {
  OwnedView owned;  ///< the owner of side a reads it
  Quantity::Kind kind;
  ReadBox box;
  View<const std::uint8_t> marked;  ///< of tetrahedra; empty: all
  View<const GlobalId> id;
  View<const TetrahedronNodes> nodes;
  View<const Index> face_a, face_b;
  View<const std::uint8_t> turn;
  View<const JointStage> stage;

  BR_HD Readings operator()(Index i) const {
    const Index p = face_a[i] / 4, q = face_b[i] / 4;
    if (!owned(p) || (marked.size > 0 && marked[p] == 0 && marked[q] == 0)) return Readings();
    const JointEnds e = JointEnds::of(face_a[i], face_b[i], turn[i]);
    Vec3 a[3], b[3], middle{};
    for (int k = 0; k < 3; ++k) {
      a[k] = nodes[e.a[k] / 4].at[e.a[k] % 4].position;
      b[k] = nodes[e.b[k] / 4].at[e.b[k] % 4].position;
      middle += (1.0 / 6.0) * (a[k] + b[k]);
    }
    if (!box.holds(middle)) return Readings();
    const Index number = 4 * id[p] + face_a[i] % 4;
    if (kind == Quantity::Kind::broken)
      return Readings(stage[i] == JointStage::broken ? 1.0 : 0.0, number);
    if (!is_damaged(stage[i])) return Readings();
    const JointOpening o = opening_of(a, b);
    if (kind == Quantity::Kind::opening)
      return Readings((o.open[0] + o.open[1] + o.open[2]) / 3.0, number);
    return Readings(norm((1.0 / 3.0) * (o.slide[0] + o.slide[1] + o.slide[2])), number);
  }
};

Readings read_corners(const World& w, const ProbeConfig& p, const Quantity& quantity,
                      const Buffer<Index>& members) {
  Buffer<double> lost(w.exec.space);
  if (quantity.kind == Quantity::Kind::damage) copy_to(lost, damage(w));
  StrainFit fit;
  for (const ProbeFit& of_probe : w.given->strain_fits)
    if (of_probe.probe == p.name) fit = of_probe.fit;
  const Tetrahedra& t = w.tetrahedra;
  return fold(w.exec, p.on.empty() ? 4 * t.size() : members.size(), Readings{},
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
  const Tetrahedra& t = w.tetrahedra;
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
                ReadStress{owned, quantity, box, marked, t.id.view(), t.material.view(),
                           t.nodes.view(), t.shape.view(), w.given->laws.view()},
                Sum{});
  const Joints& j = w.joints;
  return fold(w.exec, j.size(), Readings{},
              ReadJoints{owned, kind, box, marked, t.id.view(), t.nodes.view(), j.face_a.view(),
                         j.face_b.view(), j.turn.view(), j.stage.view()},
              Sum{});
}

}  // namespace

double probe(const World& w, const ProbeConfig& p) {
  for (const std::string& problem : probe_problems(p, in_solid)) throw InputError(problem);
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
  keep_here(here, part.domain, part.tetrahedra.id, set->nodes, 4, part.exec.space);
  return read(part, p, here.places);
}

}  // namespace breccia::fdem3
