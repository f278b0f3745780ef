#include "prepare/ldpm/body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/packing/cell_grid.hpp"

namespace breccia::prepare {
namespace {

/// Newton's iteration from above: the standard library's cube root differs between machines.
double ball_radius(double volume) {
  const double cube = volume / (4.0 / 3.0 * pi);
  double root = 1.0;
  for (;;) {
    const double next = (2.0 * root + cube / (root * root)) / 3.0;
    if (!(next < root)) return root;
    root = next;
  }
}

/// Radii of balls as large as the cells, reduced where balls without a common facet overlap.
std::vector<double> contact_radii(const LdpmBody& body) {
  std::vector<double> radius;
  for (const LdpmCell& cell : body.cells) radius.push_back(ball_radius(cell.volume));
  std::set<std::pair<Index, Index>> edges;
  for (const LdpmFacet& f : body.facets) edges.insert({f.a, f.b});
  part_strangers(body.position, edges, radius);
  return radius;
}

}  // namespace

void part_strangers(const std::vector<Vec3>& position,
                    const std::set<std::pair<Index, Index>>& edges, std::vector<double>& radius) {
  const std::vector<double> full = radius;
  const double reach = 2.0 * *std::max_element(full.begin(), full.end());
  const CellGrid grid(position, reach);
  for (Index a = 0; a < static_cast<Index>(radius.size()); ++a)
    grid.visit(position[at(a)], reach, [&](Index b) {
      if (b <= a || edges.contains({a, b})) return;
      const double apart = norm(position[at(b)] - position[at(a)]);
      const double share = apart / (full[at(a)] + full[at(b)]);
      if (share >= 1.0) return;
      for (const Index e : {a, b}) radius[at(e)] = std::min(radius[at(e)], share * full[at(e)]);
    });
}

MixDesign mix_of(const dem::MaterialConfig& m) {
  const dem::MixConfig& c = m.mix;
  const double cement =
      c.aggregate_ratio > 0.0 ? cement_of(m.density, c.water_ratio, c.aggregate_ratio) : c.cement;
  return {cement,     c.water_ratio, c.cement_density, c.air,
          c.smallest, c.largest,     c.fuller,         {c.sieves, c.passing}};
}

LdpmBody ldpm_body(const Container& container, const dem::MaterialConfig& material,
                   const Random& random, const std::vector<Capsule>& bars) {
  const MixDesign mix = mix_of(material);
  LdpmParticles particles = place_particles(container, mix, random, bars);
  auto tetrahedra = tetrahedra_of(particles.position, mix.smallest);
  return ldpm_body(
      {std::move(particles.position), std::move(particles.diameter), std::move(tetrahedra)},
      material);
}

LdpmBody ldpm_body(const LdpmMesh& mesh, const dem::MaterialConfig& material) {
  std::vector<double> diameter = mesh.diameter;
  for (double& d : diameter)
    if (d == 0.0) d = surface_diameter * material.mix.smallest;
  LdpmBody body;
  body.position = mesh.position;
  body.facets =
      mesh.facets.empty() ? facets_of(body.position, diameter, mesh.tetrahedra) : mesh.facets;
  body.cells = cells_of(body.position, body.facets);
  body.radius = contact_radii(body);
  double longest = 0.0;
  for (const LdpmFacet& f : body.facets)
    longest = std::max(longest, norm(body.position[at(f.b)] - body.position[at(f.a)]));
  if (longest >= 0.99 * material.ldpm.tensile_length)
    throw InputError(fmt::format(
        "material.{}.ldpm.tensile_length = {:.4g} m is too short for particles {:.4g} m apart: "
        "they would have no softening; smaller grains or a larger fracture energy is needed",
        material.name, material.ldpm.tensile_length, longest));
  return body;
}

void link_facets(dem::Model& model) {
  if (model.facets.empty()) return;
  for (dem::Model::Facet& f : model.facets) {
    if (f.b < f.a) std::swap(f.a, f.b);
    if (f.d < f.c) std::swap(f.c, f.d);
  }
  std::stable_sort(model.facets.begin(), model.facets.end(), [](const auto& p, const auto& q) {
    return std::tie(p.a, p.b) < std::tie(q.a, q.b);
  });
  for (std::size_t k = 0; k < model.facets.size(); ++k) {
    const dem::Model::Facet& f = model.facets[k];
    model.links.push_back(
        {f.a, f.b, dem::LinkKind::ldpm, model.material[at(f.a)], 1.0, static_cast<Index>(k)});
  }
  std::stable_sort(model.links.begin(), model.links.end(), [](const auto& p, const auto& q) {
    return std::tie(p.a, p.b) < std::tie(q.a, q.b);
  });
}

}  // namespace breccia::prepare
