#include "fdem/setup/effective.hpp"

#include <cmath>

#include "fdem/setup/materials.hpp"
#include "math/constants.hpp"

namespace breccia::fdem {
namespace {

/// Most that an edge counts of sigma_1 by its joint's criterion, where sigma_2 is `other` of it.
/// @param cos2  of the angle between its normal and sigma_1
double share_of_tension(bool by_rock, double cos2, double other) {
  const double across = cos2 + other * (1.0 - cos2);
  if (!by_rock || !(across > 0.0) || cos2 < torn_at_all) return across;
  return std::max(across, std::min(1.0, cos2 / torn_in_full));
}

/// Over f_t: a triangle tears at that of its edges which counts most of sigma_1.
double least_tension(const std::vector<std::vector<std::pair<Vec2, bool>>>& edges,
                     const std::vector<double>& area, const std::vector<Index>& material, Index of,
                     double other) {
  constexpr int directions = 18;
  const std::size_t step = 1 + edges.size() / 20000;  // that many tell the mean
  double sum = 0.0, weight = 0.0;
  for (std::size_t t = 0; t < edges.size(); t += step) {
    if (material[t] != of || edges[t].size() < 3) continue;  // of others an edge is the border
    weight += area[t];
    for (int k = 0; k < directions; ++k) {
      const double angle = pi * (k + 0.5) / directions;
      const Vec2 first{std::cos(angle), std::sin(angle)};
      double most = 0.0;
      for (const auto& [along, by_rock] : edges[t]) {
        const double sine = cross(first, along);  // along: unit
        most = std::max(most, share_of_tension(by_rock, sine * sine, other));
      }
      sum += area[t] * most / directions;
    }
  }
  return weight > 0.0 ? weight / sum : 0.0;
}

/// Bedded rock: joints add the same compliance in all directions.
void soften(EffectiveRock& rock, const MaterialConfig& material, bool stress) {
  PlaneModuli s = compliance_of(material, stress);
  s.c11 += rock.compliance;
  s.c22 += rock.compliance;
  s.c66 += 2.0 * rock.compliance;
  rock.bedded = true;
  rock.angle = material.bedding.angle;
  rock.out_of_plane = out_of_plane_of(material);
  rock.stiffness = s.inverted();
  // Pressed along its planes with nothing held: of plane strain E, whose S11 is (1 - nu^2)/E.
  rock.young = (stress ? 1.0 : 1.0 - material.poisson * material.poisson) / s.c11;
  rock.fast = std::sqrt(rock.stiffness.c11 / material.density);
  rock.slow = std::sqrt(rock.stiffness.c66 / material.density);
}

}  // namespace

EffectiveRock::Impedances EffectiveRock::across(const Vec2& edge) const {
  if (!bedded) return {density * fast, density * slow};
  const WaveModuli met = on_normal(stiffness, std::atan2(-edge.x, edge.y) - angle);
  return {std::sqrt(density * met.pressing), std::sqrt(density * met.shearing)};
}

std::vector<EffectiveRock> effective_rocks(const Config& config, const JointedMesh& mesh) {
  const std::size_t count = config.materials.size();
  std::vector<double> area(count, 0.0), given(count, 0.0);
  for (std::size_t t = 0; t < mesh.material.size(); ++t) area[at(mesh.material[t])] += mesh.area[t];
  // A joint of length h opens by t h/p_f under a traction t: strains of h^2/p_f sym(t n) over the
  // area, half of it for the triangle on each side. Edges point everywhere alike: <n n> = 1/2.
  for (std::size_t i = 0; i < mesh.law.size(); ++i) {
    if (mesh.stage[i] == JointStage::dormant) continue;
    const double h = mesh.length[i], each = 0.5 * h * h / mesh.bonds[at(mesh.law[i])].stiffness;
    for (const Index edge : {mesh.edge_a[i], mesh.edge_b[i]})
      given[at(mesh.material[at(edge / 3)])] += 0.5 * each;
  }
  std::vector<std::vector<std::pair<Vec2, bool>>> edges(mesh.material.size());
  for (std::size_t i = 0; i < mesh.law.size(); ++i)
    for (const Index edge : {mesh.edge_a[i], mesh.edge_b[i]})
      edges[at(edge / 3)].emplace_back((1.0 / mesh.length[i]) * mesh.along[i],
                                       mesh.bonds[at(mesh.law[i])].by_rock());
  const std::vector<ElasticTriangle> laws = elastic_table(config);
  const bool stress = config.plane == "stress";
  std::vector<EffectiveRock> rocks;
  for (std::size_t m = 0; m < count; ++m) {
    const MaterialConfig& material = config.materials[m];
    EffectiveRock rock{material.name, area[m] > 0.0 ? given[m] / area[m] : 0.0, material.young,
                       material.poisson};
    rock.density = material.density;
    const auto least = [&](double other) {
      return least_tension(edges, mesh.area, mesh.material, static_cast<Index>(m), other);
    };
    rock.tension = least(0.0);
    rock.splitting = least(-3.0);
    if (material.bedding.has_stiffness()) {
      soften(rock, material, stress);
      rocks.push_back(std::move(rock));
      continue;
    }
    // As the material is, whatever modulus the first stage gives it.
    const double stage = material.young_now > 0.0 ? material.young / material.young_now : 1.0;
    double pressing = stage * (laws[m].lambda + 2.0 * laws[m].shear), shear = stage * laws[m].shear;
    if (rock.compliance > 0.0) {
      // In the plane: 1/E' and (1 + nu')/E' grow by it, nu'/E' stays.
      const double nu = material.poisson;
      const double plane_young = stress ? material.young : material.young / (1.0 - nu * nu);
      const double plane_poisson = stress ? nu : nu / (1.0 - nu);
      const double young = 1.0 / (1.0 / plane_young + rock.compliance);
      const double poisson = plane_poisson * young / plane_young;
      pressing = young / (1.0 - poisson * poisson);
      shear = 0.5 * young / (1.0 + poisson);
      rock.poisson = stress ? poisson : poisson / (1.0 + poisson);
      rock.young = stress ? young : young * (1.0 - rock.poisson * rock.poisson);
    }
    rock.fast = std::sqrt(pressing / material.density);
    rock.slow = std::sqrt(shear / material.density);
    rocks.push_back(std::move(rock));
  }
  return rocks;
}

}  // namespace breccia::fdem
