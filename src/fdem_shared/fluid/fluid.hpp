#pragma once
// Fluid in cracks: what a case gives, what a run keeps, which sides it presses on, of a world and
// on ranks.
//
// A method's sides that bear loads tell number(), and of(side, load, share) makes one. Its
// fluid.hpp has, for its cracks (cracks.hpp),
//
//   tell_cracks(part, joints, told)     cracks of some of its joints, by numbers of the whole mesh
//   opened(crack, a, b)                 `extent` and `opening` of one whose sides are there now
//   cell_of(flow, crack, opened)        and the cell that it is to a fluid that flows
//   list_loaded(part)                   lists all sides that bear loads

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/select.hpp"
#include "domain/owned.hpp"
#include "fdem_shared/fluid/cracks.hpp"
#include "fdem_shared/fluid/flow.hpp"
#include "fdem_shared/fluid/given.hpp"
#include "fdem_shared/fluid/spreading.hpp"
#include "fdem_shared/loaded_sides.hpp"
#include "fdem_shared/sides_now.hpp"
#include "fdem_shared/summed_apart.hpp"

namespace breccia::fdem_shared {

/// Broken joints up to a time, with those that soften if asked for.
template <class Stage, class Times>
struct IsOpenCrack {
  double until;  ///<  [s]
  bool softened;
  View<const Stage> stage;
  Times broke_at;
  BR_HD bool operator()(Index i) const {
    const bool open = stage[i] == Stage::broken && broke_at[i] <= until;
    return open || (softened && stage[i] == Stage::softened);
  }
};

/// Cracks of the whole mesh by their first sides. All ranks get all.
template <class World>
auto cracks_until(World& part, double until, bool softened = false) {
  using Shape = ShapeOf<World>;
  using Crack = typename Shape::Crack;
  const auto& j = part.joints;
  const Buffer<Index> broken =
      items_where(part.exec, j.size(),
                  of_owned(part.domain, false,
                           IsOpenCrack<typename Shape::Stage, decltype(times_of_break(j))>{
                               until, softened, j.stage.view(), times_of_break(j)},
                           ListedElement<Shape::corners>{Shape::side_a(j).view()}));
  Buffer<Crack> told(part.exec.space, broken.size());
  tell_cracks(part, broken, told);
  std::vector<Crack> all;
  copy_to(all, told);
  if (!part.domain.single_rank()) all = joined(*part.domain.ranks, all);
  all.insert(all.end(), part.given->open_cracks.begin(), part.given->open_cracks.end());
  std::sort(all.begin(), all.end(), [](const Crack& p, const Crack& q) { return p.a < q.a; });
  return all;
}

/// Their sides where they are now.
template <class World, class Cracks>
auto sides_of(const World& part, const Cracks& cracks) {
  std::vector<Index> wanted;
  for (const auto& crack : cracks) wanted.insert(wanted.end(), {crack.a, crack.b});
  return sides_now(part, wanted);
}

/// Lists the loaded sides that are here.
/// @param all  of the whole mesh
/// @param sides, starts  of the world
template <class World, class Side>
void list_here(World& w, std::vector<Side>& all, Buffer<Side>& sides, Buffer<Index>& starts) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Side& a, const Side& b) { return a.element() < b.element(); });
  const auto here = loaded_here(all, ShapeOf<World>::elements(w).id,
                                [](Side& side) -> Index& { return side.element(); });
  copy_to(sides, here.sides);
  copy_to(starts, here.starts);
  forget_apart(w);
  w.amplitudes.clear();  // listed anew by the next launches
  w.clock.clear();
  w.graph.clear();
}

/// Presses on both sides of each crack that is full, and on the border of the source. A side that
/// fluid has left is listed once more: it bears nothing from then on.
template <class World, class Cracks, class Cells>
void list_pressures(World& part, const Cracks& cracks, const Cells& cells) {
  using Side = typename ShapeOf<World>::LoadedSide;
  const auto& flow = part.given->flow;
  const std::vector<Side> before = std::exchange(part.fluid.wet, {});
  std::size_t last = 0;  // of `before`: in the order of cracks, too
  for (std::size_t i = 0; i < cells.size(); ++i) {
    while (last < before.size() && before[last].number() < cracks[i].a) last += 2;
    const bool was_wet =
        last < before.size() && before[last].number() == cracks[i].a && before[last].share > 0.0;
    const double pressure = cells[i].pressure();
    if (!(pressure > 0.0) && !was_wet) continue;
    const Index both[] = {cracks[i].a, cracks[i].b};
    for (const Index side : both) part.fluid.wet.push_back(Side::of(side, flow.load, pressure));
  }
  part.fluid.border = flow.borders;
  for (Side& side : part.fluid.border) side.share = part.fluid.pressure;
}

/// Lets a fluid that flows go on to a time, by the openings of cracks now.
template <class World>
void flow_until(World& part, double now) {
  using Shape = ShapeOf<World>;
  const auto& given = part.given->flow;
  auto& fluid = part.fluid;
  const auto cracks = cracks_until(part, part.time, true);
  const auto sides = sides_of(part, cracks);
  std::vector<typename Shape::FlowCell> cells;
  for (const auto& crack : cracks)
    cells.push_back(
        cell_of(given, crack, opened(crack, side_in(sides, crack.a), side_in(sides, crack.b))));
  if (fluid.volume.size() == 0) {
    fluid.volume = Buffer<double>(Space::host, Shape::corners * given.elements);
    std::fill_n(fluid.volume.data(), fluid.volume.size(), 0.0);
    if (given.filled)
      for (std::size_t i = 0; i < cells.size(); ++i)
        fluid.volume.data()[cracks[i].a] = cells[i].room();
  }
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].fluid = fluid.volume.data()[cracks[i].a];
  const double span = fluid.time < 0.0 ? 0.0 : now - fluid.time;
  const FlowSource source{given.ports, given.by_rate,
                          given.input.scale * given.input.amplitude.at(now), given.outlet,
                          given.outlet_pressure};
  const Flowed flowed = flow(cells, source, given.viscosity, span);
  fluid.extent = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    fluid.volume.data()[cracks[i].a] = cells[i].fluid;
    fluid.extent += cells[i].extent() * std::min(1.0, cells[i].fluid / cells[i].room());
  }
  fluid.injected += flowed.injected;
  fluid.released += flowed.released;
  fluid.pressure = flowed.pressure;
  fluid.time = now;
  list_pressures(part, cracks, cells);
  list_loaded(part);
}

/// Lets fluid spread to where it is at a time. Whether it presses elsewhere from now on.
template <class World>
bool spread_until(World& part, double now) {
  using Shape = ShapeOf<World>;
  using Side = typename Shape::LoadedSide;
  std::vector<Side> wet;
  std::vector<typename Shape::Crack> filled;
  const auto cracks = cracks_until(part, now);
  for (const auto& source : part.given->fluids)
    for (const auto& full : filled_cracks(cracks, source.ports, source.speed, now)) {
      filled.push_back(full.crack);
      const Index both[] = {full.crack.a, full.crack.b};
      for (const Index side : both) wet.push_back(Side::of(side, source.load, full.share));
    }
  part.fluid.time = now;
  const bool same =
      std::equal(wet.begin(), wet.end(), part.fluid.wet.begin(), part.fluid.wet.end(),
                 [](const Side& p, const Side& q) {
                   return p.number() == q.number() && p.load == q.load && p.share == q.share;
                 });
  if (same) return false;
  part.fluid.wet = std::move(wet);
  part.fluid.filled = std::move(filled);
  return true;
}

/// Of the whole mesh. Of a fluid that flows the volume is that which cracks hold without pressure;
/// of a crack that is not full the extent counts by its fluid: the front is in it.
/// @param load  index into Config::loads
template <class World>
FilledPart filled_part(const World& whole, std::size_t load) {
  FilledPart sum;
  if (whole.given->flow.on && static_cast<std::size_t>(whole.given->flow.load) == load) {
    sum.extent = whole.fluid.extent;
    for (Index i = 0; i < whole.fluid.volume.size(); ++i)
      sum.volume += whole.fluid.volume.data()[i];
    return sum;
  }
  const auto& wet = whole.fluid.wet;
  const auto& filled = whole.fluid.filled;
  const auto sides = sides_of(whole, filled);
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (static_cast<std::size_t>(wet[2 * i].load) != load) continue;
    const auto now = opened(filled[i], side_in(sides, filled[i].a), side_in(sides, filled[i].b));
    sum.extent += wet[2 * i].share * now.extent();
    sum.volume += wet[2 * i].share * now.extent() * std::max(now.opening, 0.0);
  }
  return sum;
}

}  // namespace breccia::fdem_shared
