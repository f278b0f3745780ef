#pragma once
// From a model to a world: elements with corners of their own, bodies, corners that move as one,
// places at the start.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "core/case_config.hpp"
#include "core/gauge.hpp"
#include "core/most_steps.hpp"
#include "exec/error.hpp"
#include "exec/filling.hpp"
#include "fdem_shared/observe.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "fdem_shared/shape.hpp"
#include "math/mat3.hpp"

namespace breccia::fdem_shared {

/// Steps from one evaluation of the critical step to the next, as usual. The bound walks all
/// elements and their joints: in every step it would cost more than the forces. Elements that could
/// meet until the next evaluation count as met (stable_parts.hpp).
inline constexpr int usual_evaluation = 20;

/// More inertia under the weight that bodies have: time.mass_scaling.
template <class Config>
Config with_inertia(Config config) {
  const double scale = config.time.mass_scaling;
  for (auto& material : config.materials) material.density *= scale;
  config.gravity.value = (1.0 / scale) * config.gravity.value;
  return config;
}

/// Elements that follow each other in the mesh, as they are at the start.
template <class Shape>
struct ElementsAtStart {
  std::vector<GlobalId> id;
  std::vector<Index> material;
  std::vector<typename Shape::Nodes> nodes;
  std::vector<typename Shape::Reference> reference;
  std::vector<double> mass, viscosity, edge;

  explicit ElementsAtStart(Index size)
      : id(at(size)),
        material(at(size)),
        nodes(at(size)),
        reference(at(size)),
        mass(at(size)),
        viscosity(at(size)),
        edge(at(size)) {}
};

/// Splits the mesh: each element gets its own corners. @throws InputError where one is inside out
template <class World, class Config, class Model>
void set_up_elements(World& w, const Config& config, const Model& model) {
  using Shape = ShapeOf<World>;
  constexpr Index at_once = Index{1} << 18;
  const int threads = w.exec.threads;
  const auto& corners = Shape::corners_of(model);
  const auto count = static_cast<Index>(corners.size());
  auto& e = Shape::elements(w);
  const auto hold = [count](auto&... arrays) { (arrays.resize(count), ...); };
  hold(e.id, e.material, e.nodes, Shape::reference(e), e.mass, e.viscosity, e.force, e.viscous_work,
       e.damping_work, e.load_work);
  w.vertex.resize(at(Shape::corners * count));
  double edges = 0.0;
  for (Index first = 0; first < count; first += at_once) {
    const Index size = std::min(at_once, count - first);
    ElementsAtStart<Shape> some(size);
    each_portion(threads, size, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        const std::size_t t = at(first + i), own = at(i);
        for (std::size_t k = 0; k < corners[t].size(); ++k) {
          some.nodes[own].at[k] = {model.point[at(corners[t][k])], model.velocity[t]};
          w.vertex[at(Shape::corners) * t + k] = corners[t][k];
        }
        const auto& m = config.materials[static_cast<std::size_t>(model.material[t])];
        const auto start = Shape::at_start(some.nodes[own], m.density, t);
        some.id[own] = first + i;
        some.material[own] = model.material[t];
        some.reference[own] = start.reference;
        some.mass[own] = start.mass;
        some.edge[own] = start.edge;
        some.viscosity[own] = m.damping * 2.0 * start.edge * std::sqrt(m.young * m.density);
      }
    });
    for (const double edge : some.edge) edges += edge;
    const auto put = [&](auto& to, const auto& items) { put_items(to, first, items, threads); };
    put(e.id, some.id);
    put(e.material, some.material);
    put(e.nodes, some.nodes);
    put(Shape::reference(e), some.reference);
    put(e.mass, some.mass);
    put(e.viscosity, some.viscosity);
  }
  auto& given = set_up(w);
  given.mean_edge = edges / static_cast<double>(corners.size());
  given.skin = config.search.margin * given.mean_edge;
  copy_to(e.group, model.group);
}

/// Materials and middles of elements, for their laws where the stress in situ has a slope.
template <class World, class Model>
void set_up_middles(World& w, const Model& model) {
  using Shape = ShapeOf<World>;
  auto& given = set_up(w);
  if (!given.in_situ.graded()) return;
  given.materials_of.assign(model.material.begin(), model.material.end());
  for (const auto& corners : Shape::corners_of(model)) {
    typename Shape::Vector sum{};
    for (const Index corner : corners) sum += model.point[at(corner)];
    given.middles.push_back((1.0 / static_cast<double>(Shape::corners)) * sum);
  }
}

inline Sym2 part_of_stress(double share, const Sym2& s) {
  return {share * s.xx, share * s.yy, share * s.xy};
}
inline Sym3 part_of_stress(double share, const Sym3& s) {
  return {share * s.xx, share * s.yy, share * s.zz, share * s.yz, share * s.xz, share * s.xy};
}

/// Laws of materials, or, where the stress in situ has a slope, of elements.
template <class Law, class Config, class Case>
std::vector<Law> laws_with_stress(std::vector<Law> of_materials, const Config& config,
                                  const Case& given) {
  const auto under = [&](std::size_t material, const auto& stress) {
    Law law = of_materials[material];
    law.preset = part_of_stress(config.materials[material].in_situ_share, stress);
    return law;
  };
  std::vector<Law> laws;
  if (config.in_situ.graded())
    for (std::size_t t = 0; t < given.middles.size(); ++t)
      laws.push_back(under(static_cast<std::size_t>(given.materials_of[t]),
                           config.in_situ.at(given.middles[t])));
  else
    for (std::size_t m = 0; m < of_materials.size(); ++m)
      laws.push_back(under(m, config.in_situ.stress()));
  return laws;
}

/// Names of bodies, and their corners.
template <class World, class Model>
void set_up_bodies(World& w, const Model& model) {
  constexpr Index corners = ShapeOf<World>::corners;
  auto& given = set_up(w);
  given.groups = model.groups;
  for (const std::string& group : model.groups) given.sets.push_back({group, {}});
  std::vector<std::size_t> sizes(model.groups.size(), 0);
  for (const auto group : model.group) sizes[static_cast<std::size_t>(group)] += at(corners);
  for (std::size_t g = 0; g < sizes.size(); ++g) given.sets[g].nodes.reserve(sizes[g]);
  for (Index t = 0; t < model.size(); ++t)
    for (Index k = 0; k < corners; ++k)
      given.sets[static_cast<std::size_t>(model.group[at(t)])].nodes.push_back(corners * t + k);
}

/// Vertices with several corners, some of which move as one, at least at the start.
/// @param tied  1: of each vertex
template <class World>
void set_up_bundles(World& w, const std::vector<std::uint8_t>& tied) {
  using Shape = ShapeOf<World>;
  if (std::none_of(tied.begin(), tied.end(), [](std::uint8_t is) { return is != 0; })) return;
  std::vector<std::vector<Index>> corners(tied.size());
  for (Index n = 0; n < Shape::corners * Shape::elements(w).size(); ++n)
    if (tied[at(w.vertex[at(n)])] != 0) corners[at(w.vertex[at(n)])].push_back(n);
  std::vector<Index> starts{0}, nodes;
  for (const std::vector<Index>& ring : corners) {
    if (ring.empty()) continue;
    nodes.insert(nodes.end(), ring.begin(), ring.end());
    starts.push_back(static_cast<Index>(nodes.size()));
  }
  if (nodes.empty()) return;
  copy_to(w.bundles.starts, starts);
  copy_to(w.bundles.nodes, nodes);
  derive_bundles(w);
}

/// Joints that nothing has happened to yet.
template <class Joints>
void begin_joints(Joints& j, Index count) {
  j.work.resize(count);
  if constexpr (requires { j.failure; }) {
    j.failure.resize(count);
  } else {
    copy_to(j.broke_at, std::vector<double>(at(count), -1.0));
    j.points.resize(count);
    j.handover.resize(count);
    j.inherited_work.resize(count);
    j.rubbed.resize(count);
  }
}

/// Places of corners at the start, for displacements and strains.
template <class World, class Config, class Model>
void set_up_starts(World& w, const Config& config, const Model& model) {
  using Shape = ShapeOf<World>;
  auto& given = set_up(w);
  const auto& of_elements = Shape::corners_of(model);
  const auto start_of = [&](Index n) {
    return model.point[at(of_elements[at(n / Shape::corners)][at(n % Shape::corners)])];
  };
  bool any = given.shown.displacement;
  for (const ProbeConfig& p : config.probes) {
    const Quantity::Kind kind = quantity_named(p.quantity).quantity.kind;
    any |= kind == Quantity::Kind::displacement || kind == Quantity::Kind::strain;
    if (kind != Quantity::Kind::strain) continue;
    std::vector<Index> corners(at(Shape::corners) * of_elements.size());
    std::iota(corners.begin(), corners.end(), 0);
    for (const auto& set : given.sets)
      if (set.name == p.on) corners = set.nodes;
    const ReadBox box(p.min, p.max);
    std::vector<Vec3> points;
    for (const Index n : corners)
      if (const Vec3 x = to_space(start_of(n)); box.holds(x)) points.push_back(x);
    bool fits = false;
    given.strain_fits.push_back({p.name, strain_fit(points, Shape::dimension, fits)});
    if (!fits)
      throw InputError("probe." + p.name + ": strain needs corners that do not lie " +
                       (Shape::dimension == 2 ? "on a line" : "in a plane") +
                       "; its region holds " + std::to_string(points.size()));
  }
  if (!any) return;
  std::vector<typename Shape::Vector> starts;
  starts.reserve(at(Shape::corners) * of_elements.size());
  for (const auto& corners : of_elements)
    for (const Index vertex : corners) starts.push_back(model.point[at(vertex)]);
  copy_to(given.starts, starts);
}

/// Refuses steps of which nobody can take as many as the case needs. That of time.max_step is
/// looked at before.
template <class World>
void refuse_endless(const World& w) {
  const TimeConfig& time = w.given->time;
  const RuledStep least = ruled_step(w, true);
  const double dt = std::min(w.next_dt, time.safety * least.step);
  if (dt * most_steps > time.end) return;
  char text[300];
  if (least.step * most_steps > time.end)
    std::snprintf(text, sizeof text,
                  "time.safety = %.3g of the stable time step, %.3g s: time.end = %.3g s is more "
                  "than 1e15 steps away",
                  time.safety, least.step, time.end);
  else
    std::snprintf(text, sizeof text,
                  "the stable time step is %.3g s, ruled by %s: time.end = %.3g s is more than "
                  "1e15 steps away; see the densities, moduli and stiffnesses of the materials",
                  dt, least.term, time.end);
  throw InputError(text);
}

}  // namespace breccia::fdem_shared
