// Copies of the items that lists between spheres and tetrahedra lead to.

#include "coupled/border.hpp"

#include "coupled/sorted_keys.hpp"
#include "coupled/world.hpp"
#include "domain/together.hpp"
#include "exec/for_each.hpp"
#include "exec/timers.hpp"

namespace breccia::coupled {
namespace {

/// Place of a number in an ascending list, -1: it is not there.
BR_HD Index place_in(const View<const Index>& sorted, Index number) {
  const Index first = first_from(sorted.size, number, [&sorted](Index i) { return sorted[i]; });
  return first < sorted.size && sorted[first] == number ? first : -1;
}

struct FindOwn {
  static constexpr const char* name = "coupled.find_own";
  View<const Index> numbers, ids;
  OwnedView owned;
  View<Index> here;
  BR_HD void operator()(Index r) const {
    const Index place = place_in(ids, numbers[r]);
    here[r] = place >= 0 && owned(place) ? place : -1;
  }
};
struct TieRows {
  static constexpr const char* name = "coupled.tie_rows";
  View<const Index> spheres, solids;  ///< numbers by row
  View<const BallBond> numbered;
  View<BallBond> tie;
  BR_HD void operator()(Index i) const {
    tie[i] = numbered[i];
    tie[i].sphere = place_in(spheres, numbered[i].sphere);
    tie[i].tetrahedron = place_in(solids, numbered[i].tetrahedron);
  }
};
struct FaceRows {
  static constexpr const char* name = "coupled.face_rows";
  View<const Index> solids, numbered;
  View<Index> face;
  BR_HD void operator()(Index j) const {
    face[j] = 4 * place_in(solids, numbered[j] / 4) + numbered[j] % 4;
  }
};

struct PackSpheres {
  static constexpr const char* name = "coupled.pack_spheres";
  View<const Index> here;
  View<const dem::ElementState> state;
  View<const Quaternion> orientation;
  View<const std::int16_t> material;
  View<const std::uint8_t> fixed;
  View<BorderSphere> items;
  BR_HD void operator()(Index r) const {
    const Index e = here[r];
    if (e >= 0) items[r] = {state[e], orientation[e], material[e], fixed[e]};
  }
};
struct UnpackSpheres {
  static constexpr const char* name = "coupled.unpack_spheres";
  View<const BorderSphere> items;
  View<dem::ElementState> state;
  View<Quaternion> orientation;
  View<std::int16_t> material;
  View<std::uint8_t> fixed;
  BR_HD void operator()(Index r) const {
    const BorderSphere& item = items[r];
    state[r] = item.state;
    orientation[r] = item.orientation;
    material[r] = static_cast<std::int16_t>(item.material);
    fixed[r] = static_cast<std::uint8_t>(item.fixed);
  }
};
struct PackSolids {
  static constexpr const char* name = "coupled.pack_solids";
  View<const Index> here;
  View<const fdem3::TetrahedronNodes> nodes;
  View<const Index> material;
  View<const std::int16_t> body;
  View<const std::uint8_t> exposed;
  View<BorderSolid> items;
  BR_HD void operator()(Index r) const {
    const Index t = here[r];
    if (t >= 0) items[r] = {nodes[t], material[t], body[t], exposed[t]};
  }
};
struct UnpackSolids {
  static constexpr const char* name = "coupled.unpack_solids";
  View<const BorderSolid> items;
  View<fdem3::TetrahedronNodes> nodes;
  View<Index> material;
  View<std::int16_t> body;
  View<std::uint8_t> exposed;
  BR_HD void operator()(Index r) const {
    const BorderSolid& item = items[r];
    nodes[r] = item.nodes;
    material[r] = item.material;
    body[r] = item.body;
    exposed[r] = static_cast<std::uint8_t>(item.exposed);
  }
};

/// Finds this rank's own items among the numbers of rows, and those of others as ghosts.
void find_own(const Exec& exec, const Domain& domain, const Buffer<GlobalId>& ids,
              const Buffer<Index>& numbers, Buffer<Index>& here, Halo& halo) {
  Communicator& ranks = *domain.ranks;
  here.resize(numbers.size());
  for_each(exec, numbers.size(),
           FindOwn{numbers.view(), ids.view(), domain.owned_view(), here.view()});
  std::vector<Index> places, own;
  copy_to(places, here);
  for (std::size_t r = 0; r < places.size(); ++r)
    if (places[r] >= 0) own.push_back(static_cast<Index>(r));
  Message message;
  put_array(message, own);
  std::vector<int> owner(places.size(), -1);
  int rank = 0;
  for (const Message& told : ranks.from_all(message)) {
    for (const Index row : Unpacking(told).array<Index>())
      owner[static_cast<std::size_t>(row)] = rank;
    ++rank;
  }
  std::vector<Ghost> ghosts;
  for (std::size_t r = 0; r < owner.size(); ++r) {
    BR_ASSERT(owner[r] >= 0);
    if (owner[r] != ranks.rank()) ghosts.push_back({static_cast<Index>(r), owner[r]});
  }
  Buffer<GlobalId> rows;
  copy_to(rows, numbers);
  halo.build(ranks, rows, ghosts, exec.space);
}

}  // namespace

Meeting meeting(const World& w) {
  const dem::Elements& e = w.spheres->elements;
  const fdem3::Tetrahedra& t = w.tetrahedra->tetrahedra;
  if (w.spheres->domain.single_rank())
    return {e.state.view(),
            e.orientation.view(),
            e.material.view(),
            e.fixed.view(),
            t.nodes.view(),
            t.material.view(),
            t.group.view(),
            t.exposed.view(),
            w.bonds.tie.view(),
            w.faces.pairs.b.view(),
            w.around.tetrahedron.view()};
  const Border& b = w.border;
  return {b.spheres.view(), b.orientation.view(), b.sphere_material.view(),
          b.fixed.view(),   b.nodes.view(),       b.material.view(),
          b.body.view(),    b.exposed.view(),     b.tie.view(),
          b.face.view(),    b.solid_here.view()};
}

void make_border(World& w, const Buffer<Index>& spheres) {
  const Exec& exec = w.spheres->exec;
  Border& b = w.border;
  const Buffer<Index>& solids = w.around.tetrahedron;
  find_own(exec, w.spheres->domain, w.spheres->elements.id, spheres, b.sphere_here, b.of_spheres);
  find_own(exec, w.tetrahedra->domain, w.tetrahedra->tetrahedra.id, solids, b.solid_here,
           b.of_solids);
  b.tie.resize(w.bonds.size());
  for_each(exec, b.tie.size(),
           TieRows{spheres.view(), solids.view(), std::as_const(w.bonds.tie).view(), b.tie.view()});
  b.face.resize(w.faces.size());
  for_each(exec, b.face.size(),
           FaceRows{solids.view(), std::as_const(w.faces.pairs.b).view(), b.face.view()});
  b.sphere_items.resize(spheres.size());
  b.spheres.resize(spheres.size());
  b.orientation.resize(spheres.size());
  b.sphere_material.resize(spheres.size());
  b.fixed.resize(spheres.size());
  b.solid_items.resize(solids.size());
  b.nodes.resize(solids.size());
  b.material.resize(solids.size());
  b.body.resize(solids.size());
  b.exposed.resize(solids.size());
  b.sharings = sharings(w);
  follow_owners(w);
}

void follow_owners(World& w) {
  if (w.spheres->domain.single_rank()) return;
  const Exec& exec = w.spheres->exec;
  const StageTime timed(exec, "halo");
  Communicator& ranks = *w.spheres->domain.ranks;
  Border& b = w.border;
  const dem::Elements& e = w.spheres->elements;
  const fdem3::Tetrahedra& t = w.tetrahedra->tetrahedra;
  if (const Index rows = b.sphere_items.size(); rows > 0) {  // on all ranks
    for_each(exec, rows,
             PackSpheres{std::as_const(b.sphere_here).view(), e.state.view(), e.orientation.view(),
                         e.material.view(), e.fixed.view(), b.sphere_items.view()});
    b.of_spheres.refresh(exec, ranks, b.sphere_items);
    for_each(exec, rows,
             UnpackSpheres{std::as_const(b.sphere_items).view(), b.spheres.view(),
                           b.orientation.view(), b.sphere_material.view(), b.fixed.view()});
  }
  if (const Index rows = b.solid_items.size(); rows > 0) {
    for_each(exec, rows,
             PackSolids{std::as_const(b.solid_here).view(), t.nodes.view(), t.material.view(),
                        t.group.view(), t.exposed.view(), b.solid_items.view()});
    b.of_solids.refresh(exec, ranks, b.solid_items);
    for_each(exec, rows,
             UnpackSolids{std::as_const(b.solid_items).view(), b.nodes.view(), b.material.view(),
                          b.body.view(), b.exposed.view()});
  }
}

}  // namespace breccia::coupled
