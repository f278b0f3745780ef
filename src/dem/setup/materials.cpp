#include "dem/setup/materials.hpp"

#include <algorithm>
#include <cmath>

#include "dem/setup/restitution.hpp"
#include "math/constants.hpp"

namespace breccia::dem {
namespace {

double harmonic(double a, double b) {
  return a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0;
}
double shear_modulus(const MaterialConfig& m) {
  return m.young / (2.0 * (1.0 + m.poisson));
}

}  // namespace

LocalElasticity local_elasticity(const MaterialConfig& m) {
  const double shear = 1.0 - m.alpha * m.poisson;
  return {m.young * (1.0 + m.alpha) / (m.beta * (1.0 + m.poisson) + m.gamma * std::max(0.0, shear)),
          std::max(0.0, shear / (1.0 + m.poisson))};
}

LocalElasticity local_elasticity(const MaterialConfig& a, const MaterialConfig& b) {
  MaterialConfig mean = a;
  mean.young = harmonic(a.young, b.young);
  mean.poisson = harmonic(a.poisson, b.poisson);
  return local_elasticity(mean);
}

std::optional<LinkKind> kind_within(const std::string& law) {
  if (law == "concrete") return LinkKind::concrete;
  if (law == "parallel") return LinkKind::parallel;
  if (law == "ldpm") return LinkKind::ldpm;
  return std::nullopt;
}
std::string laws_within() {
  return "concrete, parallel, ldpm or ";
}

namespace {

double lesser_radius(const Model& m, const Model::Link& link) {
  return std::min(m.radius[static_cast<std::size_t>(link.a)],
                  m.radius[static_cast<std::size_t>(link.b)]);
}

}  // namespace

BeddingShare bedding_share(const Model& m, const Model::Link& link,
                           const MaterialConfig& material) {
  const BeddingConfig& bedding = material.bedding;
  if (bedding.is_none()) return {};
  const Vec3 apart =
      m.position[static_cast<std::size_t>(link.b)] - m.position[static_cast<std::size_t>(link.a)];
  const double along = dot(apart, bedding.normal);
  const double across = along * along / (dot(apart, apart) * dot(bedding.normal, bedding.normal));
  return {1.0 - (1.0 - bedding.strength) * across, 1.0 - (1.0 - bedding.stiffness) * across};
}

double link_section(const Model& m, const Model::Link& link) {
  const double least = lesser_radius(m, link);
  return pi * least * least * link.share;
}

double link_stiffness(const Model& m, const Model::Link& link, const MaterialConfig& material) {
  const Vec3 apart =
      m.position[static_cast<std::size_t>(link.b)] - m.position[static_cast<std::size_t>(link.a)];
  const double modulus = local_elasticity(material).modulus * m.bulk_of(link.a).factor;
  const double least = lesser_radius(m, link);
  const double stiffness = modulus * pi * least * least * link.share / norm(apart);
  return bedding_share(m, link, material).stiffness * stiffness;
}

RateCurve rate_curve(const MaterialConfig& m) {
  if (m.rate == "none") return {};
  const bool malvar = m.rate == "malvar_ross";
  const double exponent = malvar ? 1.0 / (1.0 + 8.0 * m.rate_strength / 10e6) : 0.018;
  const double bend = std::log((malvar ? 1.0 : 10.0) / 1e-6);
  return {exponent, bend, std::sqrt(m.young / m.density) / m.rate_crossings};
}

DampingBranch damping_branch(const MaterialConfig& m) {
  return {m.link_damping, std::sqrt(m.young / m.density) / m.link_damping_time};
}

SofteningKnee softening_knee(const MaterialConfig& m) {
  if (m.knee_strength == 0.0) return {};
  const double s = m.knee_strength, x = m.knee_opening;
  return {(1.0 - s) / x, s / (1.0 - x), s + x};
}

ConcreteLink concrete_law(const MaterialConfig& m, const ContactConfig& contact) {
  const LocalElasticity local = local_elasticity(m);
  ConcreteLink law{};
  law.tensile_strength = m.tensile_strength;
  law.cohesion = m.cohesion;
  law.softening = m.softening;
  law.friction = std::tan(m.friction_angle);
  law.broken_friction = m.broken_friction < 0.0 ? contact.friction : m.broken_friction;
  law.friction_cap = m.friction_cap;
  law.friction_fades = m.friction_bound == "smooth" ? 1.0 : 0.0;
  law.hyperbolic = m.criterion == "hyperbola" ? 1.0 : 0.0;
  law.shear_ratio = local.ratio;
  law.rolling_ratio = m.rolling_stiffness;
  law.rolling_limit = m.rolling_limit;
  law.broken_rolling_limit =
      m.broken_rolling_limit < 0.0 ? m.rolling_limit : m.broken_rolling_limit;
  law.rolling_cap = m.rolling_cap;
  law.brittle_shear = m.shear == "brittle" ? 1.0 : 0.0;
  law.slip_wear = m.slip_wear;
  law.turn_wear = m.turn_wear;
  law.modulus = local.modulus;
  law.compaction_strength = m.compaction_strength;
  law.compaction_slope = m.compaction_slope;
  law.crushing_strength = m.crushing_strength;
  law.crushing_slope = m.crushing_slope;
  law.closing_strain = m.closing_strain;
  law.damping = damping_branch(m);
  law.rate = rate_curve(m);
  law.knee = softening_knee(m);
  return law;
}

SteelLink steel_law(const MaterialConfig& m) {
  return {m.young, shear_modulus(m), m.yield, m.hardening, m.failure_strain};
}

InterfaceLink interface_law(const MaterialConfig& m, const ContactConfig& contact) {
  InterfaceLink law{};
  BondSlip& bond = law.bond;
  bond = {m.bond_strength, m.bond_residual, m.slip1, m.slip2, m.slip3, {}};
  if (m.bond != "mc90") {
    bond.strength = bond.residual = m.bond == "perfect" ? 1e300 : m.bond_strength;
    bond.slip1 = bond.slip2 = bond.slip3 = 0.0;
  }
  // tau / tau_max = (s / s_1)^0.4 = t^0.8 with t = sqrt(s / s_1)
  for (int k = 0; k <= BondSlip::intervals; ++k)
    bond.rise[k] = std::pow(static_cast<double>(k) / BondSlip::intervals, 0.8);
  law.slip_ratio = 0.4;  // G_b / E_c: bond layer as stiff in shear as concrete
  law.tensile_strength = m.tensile_strength;
  law.softening = m.softening;
  law.friction = contact.friction;
  law.rib_height = m.rib_height;
  // S is true surface: S T_B u_2 / 2 = S G_F
  if (m.tensile_strength > 0.0) law.rupture_opening = 2.0 * m.fracture_energy / m.tensile_strength;
  return law;
}

ParallelBond parallel_bond(const MaterialConfig& m, const ContactConfig& contact) {
  return {m.tensile_strength,
          m.cohesion,
          std::tan(m.friction_angle),
          m.broken_friction < 0.0 ? contact.friction : m.broken_friction,
          local_elasticity(m).ratio,
          m.bond_radius,
          m.moment_share};
}

LdpmFacet ldpm_facet(const MaterialConfig& m) {
  const LdpmConfig& c = m.ldpm;
  const double young = m.young / (1.0 - 2.0 * m.poisson);
  return {young,
          (1.0 - 4.0 * m.poisson) / (1.0 + m.poisson),
          m.tensile_strength,
          c.tensile_length,
          m.cohesion / m.tensile_strength,
          c.softening_exponent,
          c.unloading,
          c.collapse_strength,
          c.hardening * young,
          c.final_hardening * young,
          c.compaction_strain,
          c.deviatoric_start,
          c.deviatoric_slope,
          c.friction,
          c.final_friction,
          c.friction_stress,
          c.densification * young,
          c.rate_factor,
          c.rate_reference};
}

ContactLaw contact_law(const ContactConfig& c) {
  const bool hertz = c.law == "hertz";
  return {hertz, c.friction,
          hertz ? damping_ratio_hertz(c.restitution) : damping_ratio_linear(c.restitution),
          c.rolling_stiffness, c.rolling_limit};
}

ContactPair contact_pair(const ContactConfig& c, const MaterialConfig& a, const MaterialConfig& b) {
  if (c.law == "hertz") {
    const double compliance =
        (1.0 - a.poisson * a.poisson) / a.young + (1.0 - b.poisson * b.poisson) / b.young;
    const double shear =
        (2.0 - a.poisson) / shear_modulus(a) + (2.0 - b.poisson) / shear_modulus(b);
    return {1.0 / compliance, 1.0 / shear};
  }
  const LocalElasticity local = local_elasticity(a, b);
  return {local.modulus * pi, local.ratio};
}

ContactPair wall_pair(const ContactConfig& c, const MaterialConfig& m) {
  if (c.law == "hertz")
    return {m.young / (1.0 - m.poisson * m.poisson), shear_modulus(m) / (2.0 - m.poisson)};
  return contact_pair(c, m, m);
}

}  // namespace breccia::dem
