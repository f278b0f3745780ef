#include "fdem3/observe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/on_host.hpp"
#include "core/pieces.hpp"
#include "core/state_hash.hpp"
#include "exec/for_each.hpp"

namespace breccia::fdem3 {
namespace {

struct HashElement {
  OwnedView owned;
  View<const GlobalId> id;
  View<const TetrahedronNodes> nodes;
  BR_HD std::uint64_t operator()(Index t) const {
    if (!owned(t)) return 0;
    ItemHash hash(id[t]);
    for (const NodeState& n : nodes[t].at) {
      hash.add(n.position);
      hash.add(n.velocity);
    }
    return hash.value();
  }
};

/// Of the fastest corner.
struct SpeedOf {
  OwnedView owned;
  View<const GlobalId> id;
  View<const TetrahedronNodes> nodes;
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
  View<const TetrahedronNodes> nodes;
  View<const ShapeGradients> shape;
  BR_HD GlobalId operator()(Index t) const {
    if (!owned(t)) return Unsound::none;
    Vec3 x[4], v[4];
    split(nodes[t], x, v);
    double fastest = 0.0, sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      fastest = max(fastest, dot(v[k], v[k]));
      sum += x[k].x + x[k].y + x[k].z + v[k].x + v[k].y + v[k].z;
    }
    const bool finite = sum - sum == 0.0;
    // Its size: the largest height at the start.
    const double reach = 100.0 * near_reach(shape[t]);
    const double jacobian = deformation(shape[t], x).jacobian;
    return finite && jacobian > 0.0 && dt * dt * fastest <= reach * reach ? Unsound::none : id[t];
  }
};

/// Velocities of the corners at the time of the positions.
struct CentreVelocities {
  static constexpr const char* name = "fdem3.centre_velocities";
  Kick kick;
  View<Corners> now;
  BR_HD void operator()(Index t) const {
    const Kick::Result next = kick(t);
    for (int k = 0; k < 4; ++k)
      now[t].at[k] = kick.between(kick.nodes[t].at[k].velocity, next.velocity[k]);
  }
};

/// Cause of the step of a tetrahedron.
struct Ruling {
  StableStep::Parts parts{};
  Index tetrahedron = 0x7fffffff;

  BR_HD bool operator<(const Ruling& other) const {
    if (parts.step != other.parts.step) return parts.step < other.parts.step;
    return tetrahedron < other.tetrahedron;
  }
};
struct RulingOf {
  StableStep stable;
  bool pressed;
  BR_HD Ruling operator()(Index t) const {
    return {pressed ? stable.parts_pressed(t) : stable.parts(t), t};
  }
};

}  // namespace

std::uint64_t state_hash(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
  return fold(w.exec, t.size(), std::uint64_t{0},
              HashElement{w.domain.owned_view(), t.id.view(), t.nodes.view()}, Sum{});
}

Fastest fastest(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
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
  std::snprintf(text, sizeof text, "tetrahedron %d (%.100s) moves fastest, at %.3g m/s", speed.id,
                w.given->groups.at(group).c_str(), std::sqrt(speed.squared));
  return {speed, text};
}

Unsound find_unsound(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
  const GlobalId bad = fold(
      w.exec, t.size(), Unsound::none,
      FindUnsound{w.domain.owned_view(), w.last_dt, t.id.view(), t.nodes.view(), t.shape.view()},
      Least{});
  if (bad == Unsound::none) return {};
  const Tetrahedra host = host_copy(t);
  const auto ids = host.id.host();
  const auto i = static_cast<Index>(std::find(ids.begin(), ids.end(), bad) - ids.begin());
  Vec3 x[4], v[4];
  split(host.nodes.data()[i], x, v);
  const double jacobian = deformation(host.shape.data()[i], x).jacobian;
  char message[400];  // snprintf, because nvcc does not take fmt's headers
  std::snprintf(
      message, sizeof message,
      "step %lld, t = %.6e s: tetrahedron %d (%s) is %s: %.3g of its volume is left, it moves at "
      "%.3e m/s in steps of %.3e s; a smaller time.safety (now %g) may help",
      static_cast<long long>(w.step), w.time, bad,
      w.given->groups[static_cast<std::size_t>(host.group.data()[i])].c_str(),
      jacobian > 0.0 ? "too fast or not finite" : "inside out", jacobian, norm(v[0]), w.last_dt,
      w.given->time.safety);
  return {bad, message};
}

std::vector<Corners> velocities_now(World& w) {
  Buffer<Corners> now(w.exec.space, w.tetrahedra.size());
  for_each(w.exec, now.size(), CentreVelocities{kick(w), now.view()});
  if (!w.domain.single_rank()) w.domain.halo.refresh(w.exec, *w.domain.ranks, now);
  std::vector<Corners> velocities;
  copy_to(velocities, now);
  return velocities;
}

std::vector<double> damage(const World& w) {
  std::vector<double> worst(at(w.tetrahedra.size()), 0.0);
  const OnHost<Joints> joints(w.joints, w.exec.space);
  const Joints& j = *joints;
  for (Index i = 0; i < j.size(); ++i) {
    if (!is_damaged(j.stage.data()[i])) continue;
    double d = j.stage.data()[i] == JointStage::broken ? 1.0 : 0.0;
    for (const auto& point : j.points.data()[i].point) d = std::max(d, point.damage);
    for (const Index face : {j.face_a.data()[i], j.face_b.data()[i]})
      worst[at(face / 4)] = std::max(worst[at(face / 4)], d);
  }
  return worst;
}

std::vector<Sym3> stresses(const World& w) {
  const OnHost<Tetrahedra> elements(w.tetrahedra, w.exec.space);
  const Tetrahedra& t = *elements;
  std::vector<ElasticTetrahedron> laws;
  copy_to(laws, w.given->laws);
  std::vector<Sym3> all;
  all.reserve(at(t.size()));
  for (Index i = 0; i < t.size(); ++i) {
    Vec3 x[4];
    places(t.nodes.data()[i], x);
    all.push_back(laws[at(t.material.data()[i])].stress(deformation(t.shape.data()[i], x)));
  }
  return all;
}

double mode_of(const Joints& joints, Index i) {
  const JointWork &work = joints.work.data()[i], &inherited = joints.inherited_work.data()[i];
  const double open = std::max(work.open - inherited.open, 0.0);
  const double slide = std::max(work.slide - inherited.slide, 0.0);
  return open + slide > 0.0 ? slide / (open + slide) : 0.0;
}

std::vector<std::int32_t> visible_faces(const World& w) {
  std::vector<FaceJoints> faces;
  copy_to(faces, w.faces);
  std::vector<JointStage> stage;
  copy_to(stage, w.joints.stage);
  std::vector<std::int32_t> all;
  all.reserve(faces.size());
  for (const FaceJoints& f : faces) {
    std::int32_t bits = 0;
    for (int k = 0; k < 4; ++k)
      if (f.at[k] == face_free || (f.at[k] >= 0 && is_damaged(stage[at(pair_of(f.at[k]))])))
        bits |= 1 << k;
    all.push_back(bits);
  }
  return all;
}

std::vector<Crack> cracks(const World& w) {
  const Joints j = host_copy(w.joints);
  std::vector<TetrahedronNodes> nodes;
  copy_to(nodes, w.tetrahedra.nodes);
  std::vector<Crack> all;
  for (Index i = 0; i < j.size(); ++i) {
    if (j.stage.data()[i] != JointStage::broken) continue;
    const JointEnds e = JointEnds::of(j.face_a.data()[i], j.face_b.data()[i], j.turn.data()[i]);
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = nodes[at(e.a[k] / 4)].at[e.a[k] % 4].position;
      b[k] = nodes[at(e.b[k] / 4)].at[e.b[k] % 4].position;
    }
    const JointOpening o = opening_of(a, b);
    const JointWork &work = j.work.data()[i], &inherited = j.inherited_work.data()[i];
    all.push_back({i, j.broke_at.data()[i], (1.0 / 3.0) * (o.middle[0] + o.middle[1] + o.middle[2]),
                   o.normal, j.shape.data()[i].area(), mode_of(j, i),
                   work.open + work.slide - inherited.open - inherited.slide});
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
  std::vector<Index> face_a, face_b;
  copy_to(face_a, w.joints.face_a);
  copy_to(face_b, w.joints.face_b);
  std::vector<FaceJoints> faces;
  copy_to(faces, w.faces);
  const OnHost<Tetrahedra> elements(w.tetrahedra, w.exec.space);
  const Tetrahedra& t = *elements;
  const auto count = static_cast<std::size_t>(t.size());
  Pieces joined(count);
  for (std::size_t i = 0; i < broken.size(); ++i)
    if (broken[i] == 0) joined.join(face_a[i] / 4, face_b[i] / 4);
  for (std::size_t face = 0; face < w.across.size(); ++face)
    if (faces[face / 4].at[face % 4] == face_bonded)
      joined.join(static_cast<Index>(face / 4), w.across[face] / 4);
  std::vector<Piece> of_root(count);
  for (std::size_t i = 0; i < count; ++i) {
    Piece& p = of_root[at(joined.root(static_cast<Index>(i)))];
    const TetrahedronNodes& n = t.nodes.data()[i];
    const double corner = t.mass.data()[i];
    Vec3 x[4], v[4];
    split(n, x, v);
    p.mass += 4.0 * corner;
    p.volume += dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6.0;
    for (int k = 0; k < 4; ++k) {
      p.centre += corner * x[k];
      p.velocity += corner * v[k];
    }
  }
  std::vector<Index> order;
  for (std::size_t i = 0; i < count; ++i)
    if (of_root[i].mass > 0.0) order.push_back(static_cast<Index>(i));
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return of_root[at(a)].mass > of_root[at(b)].mass; });
  Fragments f;
  std::vector<Index> number(count, 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    number[at(order[i])] = static_cast<Index>(i);
    Piece p = of_root[at(order[i])];
    p.centre = (1.0 / p.mass) * p.centre;
    p.velocity = (1.0 / p.mass) * p.velocity;
    f.pieces.push_back(p);
  }
  for (std::size_t i = 0; i < count; ++i)
    f.of.push_back(number[at(joined.root(static_cast<Index>(i)))]);
  return f;
}

RuledStep ruled_step(const World& w, bool pressed) {
  Ruling none;
  none.parts.step = no_limit;
  const StableStep::Parts least =
      fold(w.exec, w.tetrahedra.size(), none, RulingOf{stable_step(w), pressed}, Least{}).parts;
  const double undamped = 2.0 / std::sqrt(least.square);
  const char* term = least.joint >= least.contact ? "joints" : "contact";
  if (least.element >= least.joint && least.element >= least.contact) term = "elements";
  if (least.step < 0.5 * undamped)
    term = least.absorbed > least.viscous ? "absorbing faces" : "viscosity";
  return {least.step, term};
}

const char* ruling_term(const World& w) {
  return ruled_step(w, false).term;
}

}  // namespace breccia::fdem3
