#include "fdem/observe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/on_host.hpp"
#include "core/pieces.hpp"
#include "core/state_hash.hpp"
#include "exec/error.hpp"
#include "exec/for_each.hpp"
#include "fdem/setup/removal.hpp"

namespace breccia::fdem {
namespace {

struct HashTriangle {
  OwnedView owned;
  View<const GlobalId> id;
  View<const TriangleNodes> nodes;
  BR_HD std::uint64_t operator()(Index t) const {
    if (!owned(t)) return 0;
    ItemHash hash(id[t]);
    for (const NodeState& n : nodes[t].at) {
      hash.add(n.position.x);
      hash.add(n.position.y);
      hash.add(n.velocity.x);
      hash.add(n.velocity.y);
    }
    return hash.value();
  }
};

/// Of the fastest corner.
struct SpeedOf {
  OwnedView owned;
  View<const GlobalId> id;
  View<const TriangleNodes> nodes;
  BR_HD Speed operator()(Index t) const {
    Speed speed;
    if (!owned(t)) return speed;
    for (const NodeState& n : nodes[t].at)
      speed = Faster{}(speed, {dot(n.velocity, n.velocity), id[t]});
    return speed;
  }
};

/// The lowest global id whose numbers are unsound, or none.
struct FindUnsound {
  OwnedView owned;
  double dt;
  View<const GlobalId> id;
  View<const TriangleNodes> nodes;
  View<const Mat2> shape_inverse;
  BR_HD GlobalId operator()(Index t) const {
    if (!owned(t)) return Unsound::none;
    Vec2 x[3], v[3];
    split(nodes[t], x, v);
    const double area = cross(x[1] - x[0], x[2] - x[0]);
    const double jacobian = area * determinant(shape_inverse[t]);
    double fastest = 0.0, sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      fastest = max(fastest, dot(v[k], v[k]));
      sum += x[k].x + x[k].y + v[k].x + v[k].y;
    }
    const bool finite = sum - sum == 0.0;
    return finite && jacobian > 0.0 && dt * dt * fastest <= area ? Unsound::none : id[t];
  }
};

/// Velocities of a triangle's corners at the time of the positions.
struct CentreVelocities {
  static constexpr const char* name = "fdem.centre_velocities";
  Kick kick;
  View<Corners> now;
  BR_HD void operator()(Index t) const {
    const Kick::Result next = kick(t);
    for (int k = 0; k < 3; ++k)
      now[t].at[k] = kick.between(kick.nodes[t].at[k].velocity, next.velocity[k]);
  }
};

/// A triangle's stable step by its parts, and the triangle.
struct Ruling {
  StableStep::Parts parts{};
  Index triangle = 0x7fffffff;

  BR_HD bool operator<(const Ruling& other) const {
    if (parts.step != other.parts.step) return parts.step < other.parts.step;
    return triangle < other.triangle;
  }
};
struct RulingOf {
  StableStep stable;
  bool pressed;
  BR_HD Ruling operator()(Index t) const {
    return {pressed ? stable.parts_pressed(t) : stable.parts(t), t};
  }
};

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

std::uint64_t state_hash(const World& w) {
  const Triangles& t = w.triangles;
  return fold(w.exec, t.size(), std::uint64_t{0},
              HashTriangle{w.domain.owned_view(), t.id.view(), t.nodes.view()}, Sum{});
}

Fastest fastest(const World& w) {
  const Triangles& t = w.triangles;
  const Speed speed = fold(w.exec, t.size(), Speed{},
                           SpeedOf{w.domain.owned_view(), t.id.view(), t.nodes.view()}, Faster{});
  std::vector<GlobalId> ids;
  std::vector<std::int16_t> groups;
  copy_to(ids, t.id);
  copy_to(groups, t.group);
  const auto place = std::find(ids.begin(), ids.end(), speed.id) - ids.begin();
  if (place == static_cast<std::ptrdiff_t>(ids.size())) return {};
  const auto group = static_cast<std::size_t>(groups[static_cast<std::size_t>(place)]);
  char text[200];  // snprintf, because nvcc does not take fmt's headers
  std::snprintf(text, sizeof text, "triangle %d (%.100s) moves fastest, at %.3g m/s", speed.id,
                w.given->groups.at(group).c_str(), std::sqrt(speed.squared));
  return {speed, text};
}

Unsound find_unsound(const World& w) {
  const Triangles& t = w.triangles;
  const GlobalId bad = fold(w.exec, t.size(), Unsound::none,
                            FindUnsound{w.domain.owned_view(), w.last_dt, t.id.view(),
                                        t.nodes.view(), t.shape_inverse.view()},
                            Least{});
  if (bad == Unsound::none) return {};
  const Triangles host = host_copy(t);
  const auto ids = host.id.host();
  const auto i = static_cast<Index>(std::find(ids.begin(), ids.end(), bad) - ids.begin());
  Vec2 x[3], v[3];
  split(host.nodes.data()[i], x, v);
  const double area = cross(x[1] - x[0], x[2] - x[0]);
  const double jacobian = area * determinant(host.shape_inverse.data()[i]);
  char message[400];  // snprintf, because nvcc does not take fmt's headers
  std::snprintf(
      message, sizeof message,
      "step %lld, t = %.6e s: triangle %d (%s) is %s: %.3g of its area is left, it moves at %.3e "
      "m/s in steps of %.3e s; a smaller time.safety (now %g) may help",
      static_cast<long long>(w.step), w.time, bad,
      w.given->groups[static_cast<std::size_t>(host.group.data()[i])].c_str(),
      jacobian > 0.0 ? "too fast or not finite" : "inside out", jacobian, norm(v[0]), w.last_dt,
      w.given->time.safety);
  return {bad, message};
}

std::vector<Corners> velocities_now(World& w) {
  Buffer<Corners> now(w.exec.space, w.triangles.size());
  for_each(w.exec, now.size(), CentreVelocities{kick(w), now.view()});
  if (!w.domain.single_rank()) w.domain.halo.refresh(w.exec, *w.domain.ranks, now);
  std::vector<Corners> velocities;
  copy_to(velocities, now);
  return velocities;
}

std::vector<double> damage(const World& w) {
  std::vector<double> worst(at(w.triangles.size()), 0.0);
  const OnHost<Joints> joints(w.joints, w.exec.space);
  const Joints& j = *joints;
  for (Index i = 0; i < j.size(); ++i) {
    if (!is_damaged(j.stage.data()[i])) continue;
    double d = j.stage.data()[i] == JointStage::broken ? 1.0 : 0.0;
    for (const auto& point : j.points.data()[i].point) d = std::max(d, point.damage);
    for (const Index edge : {j.edge_a.data()[i], j.edge_b.data()[i]})
      worst[at(edge / 3)] = std::max(worst[at(edge / 3)], d);
  }
  return worst;
}

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

double mode_of(const Joints& joints, Index i) {
  const JointWork &work = joints.work.data()[i], &inherited_work = joints.inherited_work.data()[i];
  const double open = std::max(work.open - inherited_work.open, 0.0);
  const double slide = std::max(work.slide - inherited_work.slide, 0.0);
  return open + slide > 0.0 ? slide / (open + slide) : 0.0;
}

std::vector<Crack> cracks(const World& w) {
  const Joints j = host_copy(w.joints);
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, w.triangles.nodes);
  const auto corner = [&](Index n) { return nodes[at(n / 3)].at[n % 3].position; };
  std::vector<Crack> all;
  for (Index i = 0; i < j.size(); ++i) {
    if (j.stage.data()[i] != JointStage::broken) continue;
    const JointEnds e = JointEnds::of(j.edge_a.data()[i], j.edge_b.data()[i]);
    const JointWork& work = j.work.data()[i];
    const JointWork& inherited_work = j.inherited_work.data()[i];
    all.push_back({i, j.broke_at.data()[i], 0.5 * (corner(e.a0) + corner(e.b0)),
                   0.5 * (corner(e.a1) + corner(e.b1)), mode_of(j, i),
                   work.open + work.slide - inherited_work.open - inherited_work.slide});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Crack& a, const Crack& b) { return a.time < b.time; });
  return all;
}

Fragments fragments(const World& w) {
  std::vector<JointStage> stage;
  copy_to(stage, w.joints.stage);
  std::vector<std::uint8_t> broken;
  broken.reserve(stage.size());
  for (const JointStage now : stage) broken.push_back(is_parted(now) ? 1 : 0);
  return fragments(w, broken);
}

Fragments fragments(const World& w, const std::vector<std::uint8_t>& broken) {
  std::vector<Index> edge_a, edge_b;
  copy_to(edge_a, w.joints.edge_a);
  copy_to(edge_b, w.joints.edge_b);
  std::vector<double> mass;
  copy_to(mass, w.triangles.mass);
  std::vector<EdgeJoints> edges;
  copy_to(edges, w.edges);
  const std::vector<std::uint8_t> gone = gone_triangles(w);
  for (std::size_t t = 0; t < mass.size(); ++t)
    if (gone[t] != 0) mass[t] = 0.0;
  Pieces pieces(mass.size());
  for (std::size_t i = 0; i < broken.size(); ++i)
    if (broken[i] == 0 && gone[at(edge_a[i] / 3)] == 0 && gone[at(edge_b[i] / 3)] == 0)
      pieces.join(edge_a[i] / 3, edge_b[i] / 3);
  for (std::size_t edge = 0; edge < w.across.size(); ++edge)
    if (edges[edge / 3].at[edge % 3] == edge_bonded)
      pieces.join(static_cast<Index>(edge / 3), w.across[edge] / 3);
  std::vector<double> of_root(mass.size(), 0.0);
  for (std::size_t t = 0; t < mass.size(); ++t)
    of_root[at(pieces.root(static_cast<Index>(t)))] += 3.0 * mass[t];
  std::vector<Index> order;
  for (std::size_t t = 0; t < mass.size(); ++t)
    if (of_root[t] > 0.0) order.push_back(static_cast<Index>(t));
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return of_root[at(a)] > of_root[at(b)]; });
  Fragments f;
  f.of.reserve(mass.size());
  std::vector<Index> number(mass.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    number[at(order[i])] = static_cast<Index>(i);
    f.mass.push_back(of_root[at(order[i])]);
  }
  for (std::size_t t = 0; t < mass.size(); ++t)
    f.of.push_back(number[at(pieces.root(static_cast<Index>(t)))]);
  return f;
}

RuledStep ruled_step(const World& w, bool pressed) {
  Ruling none;
  none.parts.step = no_limit;
  const StableStep::Parts least =
      fold(w.exec, w.triangles.size(), none, RulingOf{stable_step(w), pressed}, Least{}).parts;
  const double undamped = 2.0 / std::sqrt(least.square);
  const char* term = least.joint >= least.contact ? "joints" : "contact";
  if (least.element >= least.joint && least.element >= least.contact) term = "elements";
  if (least.step < 0.5 * undamped)
    term = least.absorbed > least.viscous ? "absorbing edges" : "viscosity";
  return {least.step, term};
}

const char* ruling_term(const World& w) {
  return ruled_step(w, false).term;
}

}  // namespace breccia::fdem
