#include "fdem/fluid/fluid.hpp"

#include <algorithm>

#include "core/on_host.hpp"
#include "core/select.hpp"
#include "domain/owned.hpp"
#include "domain/redistribute.hpp"
#include "domain/together.hpp"
#include "fdem/edges_now.hpp"
#include "fdem/fluid/cavity.hpp"
#include "fdem/fluid/flow.hpp"
#include "fdem_shared/loaded_sides.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem {
namespace {

/// Broken joints up to a time, with those that soften if asked for.
struct IsOpenCrack {
  double until;  ///<  [s]
  bool softened;
  View<const JointStage> stage;
  View<const double> broke_at;
  BR_HD bool operator()(Index i) const {
    const bool open = stage[i] == JointStage::broken && broke_at[i] <= until;
    return open || (softened && stage[i] == JointStage::softened);
  }
};

struct TellCrack {
  static constexpr const char* name = "fdem.tell_cracks";
  View<const Index> joint, edge_a, edge_b, vertex;
  View<const GlobalId> id;
  View<const double> length, broke_at;
  View<CrackSide> crack;
  BR_HD void operator()(Index i) const {
    const Index j = joint[i], a = edge_a[j], b = edge_b[j];
    crack[i] = {3 * id[a / 3] + a % 3,
                3 * id[b / 3] + b % 3,
                vertex[a],
                vertex[JointEnds::next_corner(a)],
                length[j],
                broke_at[j]};
  }
};

std::vector<CrackSide> cracks_until(World& part, double until, bool softened = false) {
  const Joints& j = part.joints;
  const Buffer<Index> broken = items_where(
      part.exec, j.size(),
      of_owned(part.domain, false, IsOpenCrack{until, softened, j.stage.view(), j.broke_at.view()},
               ListedElement<3>{j.edge_a.view()}));
  Buffer<CrackSide> told(part.exec.space, broken.size());
  for_each(part.exec, broken.size(),
           TellCrack{broken.view(), j.edge_a.view(), j.edge_b.view(),
                     fdem_shared::node_vertices(part), std::as_const(part.triangles.id).view(),
                     j.length.view(), j.broke_at.view(), told.view()});
  std::vector<CrackSide> all;
  copy_to(all, told);
  if (!part.domain.single_rank()) all = joined(*part.domain.ranks, all);
  all.insert(all.end(), part.given->open_cracks.begin(), part.given->open_cracks.end());
  std::sort(all.begin(), all.end(),
            [](const CrackSide& p, const CrackSide& q) { return p.a < q.a; });
  return all;
}

/// A crack with its place now.
struct CrackNow {
  CrackSide side;
  double size, opening;  ///< of its middle line, and in its middle  [m]
};

/// Cracks of the whole mesh, and joints that soften, where they are now, by their first edges.
std::vector<CrackNow> cracks_now(World& part) {
  const std::vector<CrackSide> sides = cracks_until(part, part.time, true);
  std::vector<Index> wanted;
  for (const CrackSide& side : sides) wanted.insert(wanted.end(), {side.a, side.b});
  const std::vector<EdgeNow> edges = edges_now(part, wanted);
  std::vector<CrackNow> cracks;
  for (const CrackSide& side : sides) {
    const EdgeNow &a = edge_in(edges, side.a), &b = edge_in(edges, side.b);
    const JointOpening<double> o = opening_of(a.from, a.to, b.to, b.from);
    cracks.push_back({side, o.size, o.open[1]});
  }
  return cracks;
}

std::vector<FlowCell> cells_of(const FlowCase& flow, const std::vector<CrackNow>& cracks,
                               const View<const double>& volume) {
  std::vector<FlowCell> cells;
  for (const CrackNow& crack : cracks) {
    const double aperture = flow.aperture + std::max(crack.opening, 0.0);
    // A change of its volume must not act more stiffly than the joint did that was here.
    const double bulk = std::min(flow.bulk, 0.5 * flow.stiffness * aperture / crack.size);
    cells.push_back(
        {crack.side.from, crack.side.to, crack.size, aperture, bulk, volume[crack.side.a]});
  }
  return cells;
}

/// Presses on both sides of each crack that is full, and on the border of the source.
void list_pressures(World& part, const std::vector<CrackNow>& cracks,
                    const std::vector<FlowCell>& cells) {
  const FlowCase& flow = part.given->flow;
  part.fluid.wet.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double pressure = cells[i].pressure();
    if (!(pressure > 0.0)) continue;
    for (const Index edge : {cracks[i].side.a, cracks[i].side.b})
      part.fluid.wet.push_back(
          {edge / 3, static_cast<std::int16_t>(edge % 3), flow.load, pressure, 0.0, 0.0});
  }
  for (LoadedEdge edge : flow.borders) {
    edge.share = part.fluid.pressure;
    part.fluid.wet.push_back(edge);
  }
  list_loaded_edges(part);
}

void flow_until(World& part, double now) {
  const FlowCase& given = part.given->flow;
  FluidState& fluid = part.fluid;
  const std::vector<CrackNow> cracks = cracks_now(part);
  if (fluid.volume.size() == 0) {
    fluid.volume = Buffer<double>(Space::host, 3 * given.triangles);
    std::fill_n(fluid.volume.data(), fluid.volume.size(), 0.0);
    if (given.filled)
      for (const CrackNow& crack : cracks)
        fluid.volume.data()[crack.side.a] =
            crack.size * (given.aperture + std::max(crack.opening, 0.0));
  }
  std::vector<FlowCell> cells = cells_of(given, cracks, std::as_const(fluid.volume).view());
  const double span = fluid.time < 0.0 ? 0.0 : now - fluid.time;
  const FlowSource source{given.vertices, given.by_rate,
                          given.input.scale * given.input.amplitude.at(now), given.outlet,
                          given.outlet_pressure};
  const Flowed flowed = flow(cells, source, given.viscosity, span);
  fluid.length = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    fluid.volume.data()[cracks[i].side.a] = cells[i].fluid;
    fluid.length += cells[i].length * std::min(1.0, cells[i].fluid / cells[i].room());
  }
  fluid.injected += flowed.injected;
  fluid.released += flowed.released;
  fluid.pressure = flowed.pressure;
  fluid.time = now;
  list_pressures(part, cracks, cells);
}

/// @param expands  whether gas takes the pressure of its volume now, or keeps that which it has
void spread_until(World& part, double now, bool expands) {
  std::vector<LoadedEdge> wet;
  const std::vector<CrackSide> cracks = cracks_until(part, now);
  for (const FluidSource& source : part.given->fluids)
    for (const FilledCrack& filled : filled_cracks(cracks, source.vertices, source.speed, now))
      for (const Index edge : {filled.a, filled.b})
        wet.push_back(
            {edge / 3, static_cast<std::int16_t>(edge % 3), source.load, filled.share, 0.0, 0.0});
  part.fluid.time = now;
  const bool same = std::equal(wet.begin(), wet.end(), part.fluid.wet.begin(), part.fluid.wet.end(),
                               [](const auto& p, const auto& q) {
                                 return p.triangle == q.triangle && p.edge == q.edge &&
                                        p.load == q.load && p.share == q.share;
                               });
  const bool gas = has_gas(part);
  if (same && !gas) return;
  part.fluid.wet = std::move(wet);
  if (gas && expands) expand_gas(part);
  list_loaded_edges(part);
}

/// Volume is that which cracks hold without pressure; of a crack that is not full the length counts
/// by its fluid: the front is in it.
FilledPart flowed_part(const World& whole) {
  FilledPart sum{whole.fluid.length, 0.0};
  for (Index i = 0; i < whole.fluid.volume.size(); ++i) sum.volume += whole.fluid.volume.data()[i];
  return sum;
}

/// Of gas: lets cracks bear its pressure, and adds the walls of its holes.
void list_gas(const World& w, std::vector<LoadedEdge>& all) {
  const std::vector<FluidSource>& sources = w.given->fluids;
  for (std::size_t k = 0; k < sources.size() && w.fluid.gas.size() > 0; ++k) {
    if (sources[k].holes.empty()) continue;
    const double pressure = w.fluid.gas.data()[k];
    for (LoadedEdge& edge : all)
      if (edge.load == sources[k].load) edge.share *= pressure;
    for (LoadedEdge edge : sources[k].borders) {
      edge.share = pressure;
      all.push_back(edge);
    }
  }
}

}  // namespace

std::vector<CrackSide> open_cracks(World& part) {
  return cracks_until(part, part.time);
}

void flow_on(World& part) {
  const StageTime timed(part.exec, "fluid");
  flow_until(part, part.time);
}

void spread_fluid(World& part) {
  if (part.given->flow.on) return;  // it flows in each step
  const StageTime timed(part.exec, "fluid");
  spread_until(part, part.time, true);
}
void restore_fluid(World& part) {
  if (part.fluid.time < 0.0) return;
  if (part.given->flow.on)
    flow_until(part, part.fluid.time);
  else
    spread_until(part, part.fluid.time, false);
}

void list_loaded_edges(World& w) {
  std::vector<LoadedEdge> all = w.given->loaded;
  all.insert(all.end(), w.fluid.wet.begin(), w.fluid.wet.end());
  list_gas(w, all);
  all.insert(all.end(), w.bolts.pull.begin(), w.bolts.pull.end());
  std::stable_sort(all.begin(), all.end(), [](const LoadedEdge& a, const LoadedEdge& b) {
    return a.triangle < b.triangle;
  });
  const auto here = fdem_shared::loaded_here(
      all, w.triangles.id, [](auto& edge) -> auto& { return edge.triangle; });
  copy_to(w.loaded_edges, here.sides);
  copy_to(w.load_starts, here.starts);
  w.amplitudes.clear();  // listed anew by the next launches
  w.clock.clear();
  w.graph.clear();
}

FilledPart filled_part(const World& whole, std::size_t load) {
  FilledPart sum;
  if (whole.given->flow.on && static_cast<std::size_t>(whole.given->flow.load) == load)
    return flowed_part(whole);
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, whole.triangles.nodes);
  const auto corner = [&](Index n) {
    return nodes[static_cast<std::size_t>(n / 3)].at[n % 3].position;
  };
  const std::vector<LoadedEdge>& wet = whole.fluid.wet;
  for (std::size_t i = 0; i + 1 < wet.size(); i += 2) {
    if (static_cast<std::size_t>(wet[i].load) != load) continue;
    const JointEnds e =
        JointEnds::of(3 * wet[i].triangle + wet[i].edge, 3 * wet[i + 1].triangle + wet[i + 1].edge);
    const JointOpening<double> o =
        opening_of(corner(e.a0), corner(e.a1), corner(e.b0), corner(e.b1));
    sum.length += wet[i].share * o.size;
    sum.volume += wet[i].share * o.size * std::max(o.open[1], 0.0);
  }
  return sum;
}

}  // namespace breccia::fdem
