// Copies of the items that lists between spheres and tetrahedra lead to.

#include "coupled/border.hpp"

#include <algorithm>
#include <utility>

#include "core/select.hpp"
#include "coupled/sorted_keys.hpp"
#include "coupled/world.hpp"
#include "domain/together.hpp"
#include "exec/for_each.hpp"
#include "exec/timers.hpp"
#include "fdem_shared/exposed.hpp"

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

/// Rows of spheres that this rank evaluates.
struct IsEvaluated {
  View<const SphereRow> rows;
  View<const Index> face;
  View<const BallBond> tie;
  View<const Index> solid_here;
  BR_HD bool operator()(Index r) const {
    const SphereRow& row = rows[r];
    if (row.here >= 0) return true;
    for (Index j = row.face; j < row.face_end; ++j)
      if (solid_here[face[j] / 4] >= 0) return true;
    for (Index b = row.bond; b < row.bond_end; ++b)
      if (solid_here[tie[b].tetrahedron] >= 0) return true;
    return false;
  }
};
/// Marks these rows, and the tetrahedra that they meet.
struct MarkMet {
  static constexpr const char* name = "coupled.mark_met";
  View<const SphereRow> rows;
  View<const Index> face;
  View<const BallBond> tie;
  View<std::uint8_t> of_rows, solids;
  BR_HD void operator()(Index r) const {
    const SphereRow& row = rows[r];
    of_rows[r] = 1;
    for (Index j = row.face; j < row.face_end; ++j) fdem_shared::set_flag(solids, face[j] / 4);
    for (Index b = row.bond; b < row.bond_end; ++b)
      fdem_shared::set_flag(solids, tie[b].tetrahedron);
  }
};
struct IsMarked {
  View<const std::uint8_t> marked;
  BR_HD bool operator()(Index i) const { return marked[i] != 0; }
};
struct TouchIsMarked {
  View<const std::uint8_t> marked;
  View<const Index> row_of;
  BR_HD bool operator()(Index i) const { return marked[row_of[i]] != 0; }
};
struct BondIsMarked {
  View<const std::uint8_t> marked;
  View<const BallBond> tie;
  BR_HD bool operator()(Index i) const { return marked[tie[i].sphere] != 0; }
};

/// Exchange of the rows of a list that other ranks own.
void build_halo(const Exec& exec, Communicator& ranks, const Buffer<Index>& numbers,
                const std::vector<int>& owner, const std::vector<Index>& list, Halo& halo) {
  std::vector<Ghost> ghosts;
  for (const Index r : list)
    if (const int rank = owner[static_cast<std::size_t>(r)]; rank != ranks.rank())
      ghosts.push_back({r, rank});
  Buffer<GlobalId> ids;
  copy_to(ids, numbers);
  halo.build(ranks, ids, ghosts, exec.space);
}

/// Finds this rank's own items among the numbers of rows, and those of others as ghosts.
void find_own(const Exec& exec, const Domain& domain, const Buffer<GlobalId>& ids,
              const Buffer<Index>& numbers, Buffer<Index>& here, std::vector<int>& owner,
              Halo& halo) {
  Communicator& ranks = *domain.ranks;
  here.resize(numbers.size());
  for_each(exec, numbers.size(),
           FindOwn{numbers.view(), ids.view(), domain.owned_view(), here.view()});
  std::vector<Index> places, own, all;
  copy_to(places, here);
  for (std::size_t r = 0; r < places.size(); ++r) {
    all.push_back(static_cast<Index>(r));
    if (places[r] >= 0) own.push_back(static_cast<Index>(r));
  }
  Message message;
  put_array(message, own);
  owner.assign(places.size(), -1);
  int rank = 0;
  for (const Message& told : ranks.from_all(message)) {
    for (const Index row : Unpacking(told).array<Index>())
      owner[static_cast<std::size_t>(row)] = rank;
    ++rank;
  }
  BR_ASSERT(std::find(owner.begin(), owner.end(), -1) == owner.end());
  build_halo(exec, ranks, numbers, owner, all, halo);
}

/// Spheres and tetrahedra by their halos; rows of a list, or all.
/// @param each  each(count, list, kernel) carries a kernel out for them
template <class Each>
void follow(World& w, Halo& of_spheres, Halo& of_solids, const Each& each) {
  if (w.spheres->domain.single_rank()) return;
  const Exec& exec = w.spheres->exec;
  const StageTime timed(exec, "halo");
  Communicator& ranks = *w.spheres->domain.ranks;
  Border& b = w.border;
  const dem::Elements& e = w.spheres->elements;
  const fdem3::Tetrahedra& t = w.tetrahedra->tetrahedra;
  if (const Index rows = b.sphere_items.size(); rows > 0) {  // on all ranks
    each(rows, b.rows,
         PackSpheres{std::as_const(b.sphere_here).view(), e.state.view(), e.orientation.view(),
                     e.material.view(), e.fixed.view(), b.sphere_items.view()});
    of_spheres.refresh(exec, ranks, b.sphere_items);
    each(rows, b.rows,
         UnpackSpheres{std::as_const(b.sphere_items).view(), b.spheres.view(), b.orientation.view(),
                       b.sphere_material.view(), b.fixed.view()});
  }
  if (const Index rows = b.solid_items.size(); rows > 0) {
    each(rows, b.solids,
         PackSolids{std::as_const(b.solid_here).view(), t.nodes.view(), t.material.view(),
                    t.group.view(), t.exposed.view(), b.solid_items.view()});
    of_solids.refresh(exec, ranks, b.solid_items);
    each(rows, b.solids,
         UnpackSolids{std::as_const(b.solid_items).view(), b.nodes.view(), b.material.view(),
                      b.body.view(), b.exposed.view()});
  }
}

/// All ranks get the items of rows from the ranks that own their spheres.
/// @param range  the items of a row
template <class T, class Range>
void bring_items(Communicator& ranks, const std::vector<int>& owner,
                 const std::vector<SphereRow>& rows, const Range& range, Buffer<T>& items) {
  if (items.empty()) return;  // on all ranks
  std::vector<T> all, own;
  copy_to(all, items);
  const auto each_item = [&](int rank, const auto& visit) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (owner[r] != rank) continue;
      const auto [begin, end] = range(rows[r]);
      for (Index i = begin; i < end; ++i) visit(all[static_cast<std::size_t>(i)]);
    }
  };
  each_item(ranks.rank(), [&own](const T& item) { own.push_back(item); });
  Message message;
  put_array(message, own);
  int rank = 0;
  for (const Message& told : ranks.from_all(message)) {
    const std::vector<T> theirs = Unpacking(told).array<T>();
    std::size_t next = 0;
    each_item(rank++, [&](T& item) { item = theirs[next++]; });
  }
  copy_to(items, all);
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
  find_own(exec, w.spheres->domain, w.spheres->elements.id, spheres, b.sphere_here, b.sphere_owner,
           b.of_spheres);
  find_own(exec, w.tetrahedra->domain, w.tetrahedra->tetrahedra.id, solids, b.solid_here,
           b.solid_owner, b.of_solids);
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
  follow_all_owners(w);
}

void share_out_between(World& w, const Buffer<Index>& spheres) {
  const Exec& exec = w.spheres->exec;
  Communicator& ranks = *w.spheres->domain.ranks;
  Border& b = w.border;
  const View<const SphereRow> rows = std::as_const(w.rows).view();
  const View<const Index> face = std::as_const(b.face).view();
  const View<const BallBond> tie = std::as_const(b.tie).view();
  b.rows = items_where(exec, w.rows.size(),
                       IsEvaluated{rows, face, tie, std::as_const(b.solid_here).view()});
  Buffer<std::uint8_t> of_rows(exec.space, w.rows.size());
  Buffer<std::uint8_t> met(exec.space, w.around.tetrahedron.size());
  for_each(
      exec, b.rows.size(),
      OfList<MarkMet>{{rows, face, tie, of_rows.view(), met.view()}, std::as_const(b.rows).view()});
  const View<const std::uint8_t> marked = std::as_const(of_rows).view();
  b.touches = items_where(exec, w.touches.size(),
                          TouchIsMarked{marked, std::as_const(w.row_of_touch).view()});
  b.bonds = items_where(exec, w.bonds.size(), BondIsMarked{marked, tie});
  b.solids = items_where(exec, met.size(), IsMarked{std::as_const(met).view()});

  std::vector<Index> list;
  copy_to(list, b.rows);
  build_halo(exec, ranks, spheres, b.sphere_owner, list, b.near_spheres);
  copy_to(list, b.solids);
  build_halo(exec, ranks, w.around.tetrahedron, b.solid_owner, list, b.near_solids);
}

void follow_owners(World& w) {
  Border& b = w.border;
  follow(w, b.near_spheres, b.near_solids,
         [&w](Index, const Buffer<Index>& list, const auto& kernel) {
           using Kernel = std::remove_cvref_t<decltype(kernel)>;
           for_each(w.spheres->exec, list.size(), OfList<Kernel>{kernel, list.view()});
         });
}
void follow_all_owners(World& w) {
  Border& b = w.border;
  follow(w, b.of_spheres, b.of_solids, [&w](Index rows, const Buffer<Index>&, const auto& kernel) {
    for_each(w.spheres->exec, rows, kernel);
  });
}

void make_whole(World& w) {
  follow_all_owners(w);
  tell_states(w);
}

void tell_states(World& w) {
  if (w.spheres->domain.single_rank()) return;
  const StageTime timed(w.spheres->exec, "halo");
  std::vector<SphereRow> rows;
  copy_to(rows, w.rows);
  const auto bring = [&](auto& items, const auto& range) {
    bring_items(*w.spheres->domain.ranks, w.border.sphere_owner, rows, range, items);
  };
  const auto of_touches = [](const SphereRow& r) { return std::pair{r.touch, r.touch_end}; };
  bring(w.touches.history.state, of_touches);
  bring(w.touches.history.force, of_touches);
  bring(w.faces.history.force, [](const SphereRow& r) { return std::pair{r.face, r.face_end}; });
  bring(w.bonds.state, [](const SphereRow& r) { return std::pair{r.bond, r.bond_end}; });
}

}  // namespace breccia::coupled
