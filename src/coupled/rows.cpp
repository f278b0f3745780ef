// Rows of the lists: what follows from the pairs of a search and from the bonds.

#include "coupled/sorted_keys.hpp"
#include "coupled/world.hpp"
#include "exec/for_each.hpp"

namespace breccia::coupled {
namespace {

struct TetrahedronOfFace {
  View<const Index> face;
  BR_HD Index operator()(Index j) const { return face[j] / 4; }
};
struct TetrahedronOfBond {
  View<const BallBond> tie;
  BR_HD Index operator()(Index i) const { return tie[i].tetrahedron; }
};
struct SphereOfTouch {
  View<const Index> sphere;
  BR_HD Index operator()(Index i) const { return sphere[i]; }
};
struct SphereOfBond {
  View<const BallBond> tie;
  BR_HD Index operator()(Index i) const { return tie[i].sphere; }
};

template <class Number>
struct NumberPlaces {
  static constexpr const char* name = "coupled.number_places";
  Number number;
  View<KeyedIndex> keyed;
  BR_HD void operator()(Index i) const { keyed[i] = {static_cast<std::uint64_t>(number(i)), i}; }
};
struct FirstOfRow {
  static constexpr const char* name = "coupled.first_of_row";
  View<const Index> rows;
  View<const KeyedIndex> keyed;
  View<Index> starts;
  BR_HD void operator()(Index r) const {
    const auto number = [this](Index i) { return static_cast<Index>(keyed[i].key); };
    starts[r] = r == rows.size ? keyed.size : first_from(keyed.size, rows[r], number);
  }
};
struct PlaceOfKey {
  static constexpr const char* name = "coupled.place_of_key";
  View<const KeyedIndex> keyed;
  View<Index> places;
  BR_HD void operator()(Index i) const { places[i] = keyed[i].item; }
};
/// Lists rows of places: those of `count` whose number is that of a row, ascending.
template <class Number>
void list_rows(const Exec& exec, const Buffer<Index>& rows, Index count, const Number& number,
               Buffer<Index>& starts, Buffer<Index>& places) {
  Buffer<KeyedIndex> keyed(exec.space, count);
  for_each(exec, count, NumberPlaces<Number>{number, keyed.view()});
  sort_by_key(exec, keyed);
  starts.resize(rows.size() + 1);
  places.resize(count);
  for_each(exec, starts.size(),
           FirstOfRow{rows.view(), std::as_const(keyed).view(), starts.view()});
  for_each(exec, count, PlaceOfKey{std::as_const(keyed).view(), places.view()});
}

template <class Number>
struct PlaceNumbers {
  static constexpr const char* name = "coupled.place_numbers";
  Number number;
  Index first;
  View<PairKey> keys;
  BR_HD void operator()(Index i) const { keys[first + i] = key_of(number(i), 0); }
};
/// All numbers of two lists, each once, ascending.
template <class First, class Second>
void list_once(const Exec& exec, Index count, const First& first, Index more, const Second& second,
               Index below, Buffer<Index>& numbers) {
  Buffer<PairKey> keys(exec.space, count + more);
  for_each(exec, count, PlaceNumbers<First>{first, 0, keys.view()});
  for_each(exec, more, PlaceNumbers<Second>{second, count, keys.view()});
  sort_once(exec, keys, below);
  numbers.resize(keys.size());
  Buffer<Index> unused(exec.space, keys.size());
  for_each(exec, keys.size(),
           EndsOfKeys{std::as_const(keys).view(), numbers.view(), unused.view()});
}

/// Where the touches, faces and bonds of a sphere are listed, all of them by sphere.
struct ListSphereRows {
  static constexpr const char* name = "coupled.list_sphere_rows";
  View<const Index> spheres;  ///< numbers
  View<const Index> here;     ///< places on this rank; empty: alone, where numbers are places
  View<const Index> touching, near;
  View<const BallBond> tie;
  View<SphereRow> rows;
  View<Index> row_of_touch;
  BR_HD void operator()(Index r) const {
    const Index sphere = spheres[r];
    const auto begin = [](const auto& of, Index count, Index value) {
      return first_from(count, value, of);
    };
    const SphereOfTouch of_touch{touching}, of_face{near};
    const SphereOfBond of_bond{tie};
    const bool alone = here.size == 0;
    const SphereRow row{alone ? sphere : r,
                        alone ? sphere : here[r],
                        begin(of_touch, touching.size, sphere),
                        begin(of_touch, touching.size, sphere + 1),
                        begin(of_face, near.size, sphere),
                        begin(of_face, near.size, sphere + 1),
                        begin(of_bond, tie.size, sphere),
                        begin(of_bond, tie.size, sphere + 1)};
    rows[r] = row;
    for (Index i = row.touch; i < row.touch_end; ++i) row_of_touch[i] = r;
  }
};

}  // namespace

void derive(World& w) {
  const Exec& exec = w.spheres->exec;
  const Index near = w.faces.size(), touching = w.touches.size(), tied = w.bonds.size();
  const View<const BallBond> tie = std::as_const(w.bonds.tie).view();
  const TetrahedronOfFace of_face{std::as_const(w.faces.pairs.b).view()};
  const TetrahedronOfBond of_bond{tie};
  list_once(exec, near, of_face, tied, of_bond, w.given->tetrahedra, w.around.tetrahedron);
  list_rows(exec, w.around.tetrahedron, near, of_face, w.around.face_starts, w.around.faces);
  list_rows(exec, w.around.tetrahedron, tied, of_bond, w.around.bond_starts, w.around.bonds);

  const SphereOfTouch of_touch{std::as_const(w.touches.pairs.a).view()};
  Buffer<Index> spheres(exec.space);
  list_once(exec, touching, of_touch, tied, SphereOfBond{tie}, w.given->spheres, spheres);
  if (!w.spheres->domain.single_rank()) make_border(w, spheres);
  w.rows.resize(spheres.size());
  w.row_of_touch.clear();
  w.row_of_touch.resize(touching);
  for_each(exec, spheres.size(),
           ListSphereRows{std::as_const(spheres).view(), std::as_const(w.border.sphere_here).view(),
                          of_touch.sphere, std::as_const(w.faces.pairs.a).view(), tie,
                          w.rows.view(), w.row_of_touch.view()});
  if (!w.spheres->domain.single_rank()) share_out_between(w, spheres);
  w.bonded.resize(w.rows.size());
  w.pressed.clear();
  w.pressed.resize(near);
  w.step.resize(w.around.tetrahedron.size());
}

std::int64_t sharings(const World& w) {
  return w.spheres->domain.counts.migrations + w.tetrahedra->domain.counts.migrations;
}
void derive_if_shared_anew(World& w) {
  if (!w.spheres->domain.single_rank() && w.border.sharings != sharings(w)) derive(w);
}

}  // namespace breccia::coupled
