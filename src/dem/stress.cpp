#include "dem/stress.hpp"

#include <utility>

#include "core/energy.hpp"
#include "core/on_host.hpp"
#include "dem/observe.hpp"

namespace breccia::dem {
namespace {

/// Forces times ways, summed up element by element in no order.  [N m]
class Moments {
 public:
  explicit Moments(const Elements& elements) : elements_(elements), sums_(at(elements.size())) {}

  /// A force on the element, at a place.
  void add(Index e, const Vec3& place, const Vec3& force) {
    const Vec3 way = place - elements_.state.data()[e].position;
    const std::array<double, 6> terms{way.x * force.x,
                                      way.y * force.y,
                                      way.z * force.z,
                                      0.5 * (way.x * force.y + way.y * force.x),
                                      0.5 * (way.y * force.z + way.z * force.y),
                                      0.5 * (way.x * force.z + way.z * force.x)};
    for (std::size_t k = 0; k < terms.size(); ++k) sums_[at(e)][k].add(terms[k]);
  }
  /// Between two elements, where their spheres would touch if they grew alike.
  void add_pair(Index a, Index b, const Vec3& on_b) {
    const ElementState &s = elements_.state.data()[a], &t = elements_.state.data()[b];
    const Vec3 place = s.position + (s.radius / (s.radius + t.radius)) * (t.position - s.position);
    add(a, place, -on_b);
    add(b, place, on_b);
  }
  const std::array<ExactSum, 6>& of(Index e) const { return sums_[at(e)]; }

 private:
  const Elements& elements_;
  std::vector<std::array<ExactSum, 6>> sums_;
};

void add_links(const World& w, const Elements& elements, Moments& moments) {
  const OnHost actions(w.bar_actions, w.exec.space);
  Index first = 0;
  w.each_set([&](const auto& set) {
    const OnHost arrays(set.arrays(), w.exec.space);
    constexpr bool swept = std::remove_reference_t<decltype(set)>::swept;
    for (const auto& g : set.groups)
      for (Index i = g.begin; i < g.end; ++i) {
        Vec3 on_b;
        if constexpr (swept)
          on_b = link_force(g.law, *arrays, elements, i);
        else
          on_b = actions->data()[first + i].force_on_b();
        moments.add_pair(arrays->a.data()[i], arrays->b.data()[i], on_b);
      }
    if (!swept) first += set.size();
  });
}

void add_contacts(const World& w, const Elements& elements, Moments& moments) {
  const OnHost actions(w.contact_actions, w.exec.space);
  const OnHost a(w.contacts.pairs.a, w.exec.space), b(w.contacts.pairs.b, w.exec.space);
  const Index known = actions->size() == w.contacts.size() ? w.contacts.size() : 0;
  for (Index i = 0; i < known; ++i)
    moments.add_pair(a->data()[i], b->data()[i], actions->data()[i].force_on_b());
  const OnHost of(w.wall_contacts.pairs.a, w.exec.space);
  const OnHost wall(w.wall_contacts.pairs.b, w.exec.space);
  const OnHost on_wall(w.wall_contacts.history.on_wall, w.exec.space);
  const OnHost place(w.wall_contacts.history.place, w.exec.space);
  for (Index i = 0; i < w.wall_contacts.size(); ++i) {
    const Vec3& x = elements.state.data()[of->data()[i]].position;
    const Vec3 foot = foot_on(w.walls[at(wall->data()[i])], x, place->data()[i]);
    moments.add(of->data()[i], foot, -on_wall->data()[i]);
  }
}

}  // namespace

std::vector<Stress> stresses(const World& w) {
  const OnHost<Elements> elements(w.elements, w.exec.space);
  Moments moments(*elements);
  add_links(w, *elements, moments);
  add_contacts(w, *elements, moments);
  std::vector<Stress> stresses(at(elements->size()));
  for (Index e = 0; e < elements->size(); ++e) {
    const double volume =
        elements->mass.data()[e] / w.given->densities[at(elements->material.data()[e])];
    for (std::size_t k = 0; k < 6; ++k) stresses[at(e)][k] = moments.of(e)[k].value() / volume;
  }
  return stresses;
}

}  // namespace breccia::dem
