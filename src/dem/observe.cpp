#include "dem/observe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/state_hash.hpp"
#include "exec/error.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

struct HashElement {
  View<const GlobalId> id;
  View<const ElementState> state;
  View<const Quaternion> orientation;
  BR_HD std::uint64_t operator()(Index e) const {
    ItemHash hash(id[e]);
    hash.add(state[e].position);
    hash.add(state[e].velocity);
    hash.add(state[e].spin);
    const Quaternion& q = orientation[e];
    hash.add(Vec3{q.x, q.y, q.z});
    hash.add(q.w);
    return hash.value();
  }
};

/// The lowest global id whose numbers are unsound, or the largest id there can be.
struct FindUnsound {
  static constexpr GlobalId none = 0x7fffffff;
  double dt;
  View<const GlobalId> id;
  View<const ElementState> state;
  BR_HD GlobalId operator()(Index e) const {
    const Vec3 x = state[e].position, v = state[e].velocity, spin = state[e].spin;
    const double radius = state[e].radius;
    const double travelled = dt * dt * dot(v, v);
    const double sum = x.x + x.y + x.z + dot(spin, spin);
    const bool finite = sum - sum == 0.0;            // false for NaN and infinity
    const bool slow = travelled <= radius * radius;  // false for NaN, too
    return finite && slow ? none : id[e];
  }
};

double pick(const std::string& quantity, const Elements& e, std::size_t i) {
  const Vec3& x = e.state.data()[i].position;
  const Vec3& v = e.state.data()[i].velocity;
  const Vec3& f = e.force.data()[i];
  const double m = e.mass.data()[i];
  const char axis = quantity.back();
  const auto part = [axis](const Vec3& a) { return axis == 'x' ? a.x : axis == 'y' ? a.y : a.z; };
  if (quantity.starts_with("position")) return part(x);
  if (quantity.starts_with("velocity")) return part(v);
  if (quantity.starts_with("force")) return part(f);
  if (quantity.starts_with("momentum")) return m * part(v);
  if (quantity == "speed") return norm(v);
  const Vec3& s = e.state.data()[i].spin;
  return 0.5 * m * dot(v, v) + 0.5 * e.inertia.data()[i] * dot(s, s);  // kinetic
}

/// Pieces held together by unbroken links: each element's lowest reachable member.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), 0); }
  Index root(Index e) {
    while (root_[at(e)] != e) e = root_[at(e)] = root_[at(root_[at(e)])];
    return e;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    root_[at(std::max(a, b))] = std::min(a, b);
  }

 private:
  static std::size_t at(Index e) { return static_cast<std::size_t>(e); }
  std::vector<Index> root_;
};

}  // namespace

std::uint64_t state_hash(const World& w) {
  const Elements& e = w.elements;
  return fold(w.exec, e.size(), std::uint64_t{0},
              HashElement{e.id.view(), e.state.view(), e.orientation.view()},
              [](std::uint64_t a, std::uint64_t b) { return a + b; });
}

void verify(const World& w) {
  const Elements& e = w.elements;
  const GlobalId bad =
      fold(w.exec, e.size(), FindUnsound::none, FindUnsound{w.last_dt, e.id.view(), e.state.view()},
           [](GlobalId a, GlobalId b) { return a < b ? a : b; });
  if (bad == FindUnsound::none) return;
  const Elements host = host_copy(e);
  const auto ids = host.id.host();
  const auto i = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), bad) - ids.begin());
  const std::string group = w.sets.at(static_cast<std::size_t>(host.group.data()[i])).name;
  char message[400];  // snprintf, because nvcc does not take fmt's headers
  std::snprintf(
      message, sizeof message,
      "step %lld, t = %.6e s: element %d (%s) moves at %.3e m/s, more than its radius %.3e m in a "
      "step of %.3e s, or is not finite; a smaller time.safety (now %g) may help",
      static_cast<long long>(w.step), w.time, bad, group.c_str(),
      norm(host.state.data()[i].velocity), host.state.data()[i].radius, w.last_dt,
      w.parameters.time.safety);
  throw NumericsError(message);
}

std::vector<double> damage(const World& w) {
  const auto count = static_cast<std::size_t>(w.elements.size());
  std::vector<double> lost(count, 0.0), links(count, 0.0);
  const ConcreteLinks c = host_copy(w.concrete);
  const auto book = [&](Index a, Index b, double share) {
    for (const Index e : {a, b}) {
      lost[static_cast<std::size_t>(e)] += share;
      links[static_cast<std::size_t>(e)] += 1.0;
    }
  };
  for (Index i = 0; i < c.size(); ++i)
    book(c.a.data()[i], c.b.data()[i], c.opening.data()[i] < 0.0 ? 1.0 : 0.0);
  const InterfaceLinks b = host_copy(w.interface);
  for (Index i = 0; i < b.size(); ++i)
    book(b.a.data()[i], b.b.data()[i], b.state.data()[i].opening < 0.0 ? 1.0 : 0.0);
  const SteelLinks s = host_copy(w.steel);
  for (Index i = 0; i < s.size(); ++i)
    book(s.a.data()[i], s.b.data()[i], s.state.data()[i].hardening < 0.0 ? 1.0 : 0.0);
  for (std::size_t e = 0; e < count; ++e)
    if (links[e] > 0.0) lost[e] /= links[e];
  return lost;
}

double probe(const World& w, const ProbeConfig& p) {
  std::vector<Index> members;
  if (p.on.empty()) {
    members.resize(static_cast<std::size_t>(w.elements.size()));
    std::iota(members.begin(), members.end(), 0);
  } else {
    const auto set = std::find_if(w.sets.begin(), w.sets.end(),
                                  [&](const ElementSet& s) { return s.name == p.on; });
    if (set == w.sets.end()) throw InputError("probe " + p.name + ": there is no group " + p.on);
    copy_to(members, set->members);
  }
  const std::vector<double> lost = p.quantity == "damage" ? damage(w) : std::vector<double>{};
  const Elements e = host_copy(w.elements);
  ExactSum sum;
  double low = no_limit, high = -no_limit;
  for (const Index member : members) {
    const auto i = static_cast<std::size_t>(member);
    const double value = lost.empty() ? pick(p.quantity, e, i) : lost[i];
    sum.add(value);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (p.reduce == "min") return low;
  if (p.reduce == "max") return high;
  return p.reduce == "sum" ? sum.value() : sum.value() / static_cast<double>(members.size());
}

Counts count(const World& w) {
  Counts n;
  Pieces pieces(static_cast<std::size_t>(w.elements.size()));
  const ConcreteLinks c = host_copy(w.concrete);
  for (Index i = 0; i < c.size(); ++i) {
    if (c.opening.data()[i] < 0.0)
      ++n.broken_concrete;
    else
      pieces.join(c.a.data()[i], c.b.data()[i]);
  }
  const SteelLinks s = host_copy(w.steel);
  for (Index i = 0; i < s.size(); ++i) {
    if (s.state.data()[i].hardening < 0.0)
      ++n.broken_steel;
    else
      pieces.join(s.a.data()[i], s.b.data()[i]);
  }
  const InterfaceLinks b = host_copy(w.interface);
  for (Index i = 0; i < b.size(); ++i) {
    if (b.state.data()[i].opening < 0.0)
      ++n.broken_interface;
    else
      pieces.join(b.a.data()[i], b.b.data()[i]);
  }
  Buffer<ContactState> contacts;
  copy_to(contacts, w.contacts.history.state);
  for (const ContactState& contact : contacts.host())
    if (contact.overlap > 0.0) ++n.touching;
  const Elements e = host_copy(w.elements);
  std::vector<double> mass(static_cast<std::size_t>(e.size()), 0.0);
  double total = 0.0;
  for (Index i = 0; i < e.size(); ++i) {
    mass[static_cast<std::size_t>(pieces.root(i))] += e.mass.data()[i];
    total += e.mass.data()[i];
  }
  for (const double m : mass) {
    if (m > 0.0) ++n.fragments;
    n.largest_fragment = std::max(n.largest_fragment, m / total);
  }
  return n;
}

}  // namespace breccia::dem
