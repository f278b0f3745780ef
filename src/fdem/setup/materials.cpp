#include "fdem/setup/materials.hpp"

#include <algorithm>
#include <cmath>

#include "core/named.hpp"
#include "exec/error.hpp"
#include "fdem/setup/bedding.hpp"
#include "fdem_shared/setup/elements.hpp"

namespace breccia::fdem {
namespace {

JointBond bond_of(const StrengthConfig& s, double young, const JointsConfig& common) {
  JointBond b{};
  b.stiffness = s.stiffness * young;
  b.tension = s.tension;
  b.cohesion = s.cohesion;
  b.friction = std::tan(s.friction_angle);
  b.residual = std::min(std::tan(s.residual_angle), b.friction);
  b.softening_open = common.softening_factor * s.energy_open;
  b.softening_slide = common.softening_factor * s.energy_slide;
  b.reversible = common.unloading == "reversible" ? 1.0 : 0.0;
  return b;
}

/// A joint within rock: it fails with the rock if the case says so.
JointBond bond_within(const MaterialConfig& m, const Config& config) {
  JointBond b = bond_of(m.joint, m.young, config.joints);
  if (config.joints.criterion != "rock") return b;
  const bool stress = config.plane == "stress";
  b.young = stress ? m.young : m.young / (1.0 - m.poisson * m.poisson);
  b.poisson = stress ? m.poisson : m.poisson / (1.0 - m.poisson);
  return b;
}

JointBond weaker(const JointBond& a, const JointBond& b) {
  JointBond w = a;
  w.stiffness = std::min(a.stiffness, b.stiffness);
  w.tension = std::min(a.tension, b.tension);
  w.cohesion = std::min(a.cohesion, b.cohesion);
  w.friction = std::min(a.friction, b.friction);
  w.residual = std::min({a.residual, b.residual, w.friction});
  w.softening_open = std::min(a.softening_open, b.softening_open);
  w.softening_slide = std::min(a.softening_slide, b.softening_slide);
  // The rock on its two sides stretches along the edge alike: its stress is the mean of both.
  w.young = 0.5 * (a.young + b.young);
  w.poisson = 0.5 * (a.poisson + b.poisson);
  w.skew = 0.5 * (a.skew + b.skew);
  return w;
}

}  // namespace

std::int16_t material_index(const Config& config, const std::string& name,
                            const std::string& where) {
  for (std::size_t i = 0; i < config.materials.size(); ++i)
    if (config.materials[i].name == name) return static_cast<std::int16_t>(i);
  std::vector<std::string> problem;
  add_unknown(where, name, "material", breccia::names_of(config.materials), problem);
  throw InputError(problem.front());
}

BondTable bond_table(const Config& config) {
  BondTable table;
  const std::size_t n = config.materials.size();
  table.of_pair.assign(n * n, BondTable::nothing);
  const auto add = [&](const JointBond& bond) {
    table.bonds.push_back(bond);
    return static_cast<Index>(table.bonds.size() - 1);
  };
  for (const MaterialConfig& m : config.materials) table.dormant.push_back(m.joints == "extrinsic");
  const auto own = [&](const MaterialConfig& m) { return bond_within(m, config); };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const MaterialConfig &a = config.materials[i], &b = config.materials[j];
      Index law = BondTable::nothing;
      if (a.joints == "none" && b.joints == "none")
        law = BondTable::bonded;
      else if (a.joints != "none" && b.joints != "none")
        law = add(i == j ? own(a) : weaker(own(a), own(b)));
      table.of_pair[i * n + j] = table.of_pair[j * n + i] = law;
    }
  double stiffest = 0.0;
  for (const MaterialConfig& m : config.materials) stiffest = std::max(stiffest, m.young);
  for (const JointConfig& joint : config.joint_laws) {  // planes: their edges fail by themselves
    const std::string where = "joint." + joint.name + ".between";
    if (joint.between.empty()) {
      table.of_joint.push_back(add(bond_of(joint.strength, stiffest, config.joints)));
      continue;
    }
    if (joint.between.size() != 2)
      throw InputError(where + ": takes two materials, or none for a discontinuity's joint");
    const auto a = static_cast<std::size_t>(material_index(config, joint.between[0], where));
    const auto b = static_cast<std::size_t>(material_index(config, joint.between[1], where));
    const double young = std::max(config.materials[a].young, config.materials[b].young);
    const Index law = add(bond_of(joint.strength, young, config.joints));
    table.of_pair[a * n + b] = table.of_pair[b * n + a] = law;
    table.of_joint.push_back(law);
  }
  return table;
}

std::vector<JointBond> with_strengths(std::vector<JointBond> bonds, const BondTable& table,
                                      const std::vector<Index>& base) {
  for (std::size_t k = 0; k < bonds.size(); ++k) {
    const JointBond& now = table.bonds[base.empty() ? k : static_cast<std::size_t>(base[k])];
    bonds[k].tension = now.tension;
    bonds[k].cohesion = now.cohesion;
    bonds[k].friction = now.friction;
    bonds[k].residual = now.residual;
    bonds[k].softening_open = now.softening_open;
    bonds[k].softening_slide = now.softening_slide;
  }
  return bonds;
}

bool depends_on_line(const Config& config, const MaterialConfig& a, const MaterialConfig& b) {
  return config.joints.criterion == "rock" &&
         (a.bedding.has_stiffness() || b.bedding.has_stiffness());
}

JointBond bond_along(const Config& config, const MaterialConfig& a, const MaterialConfig& b,
                     const JointBond& bond, const Vec2& line) {
  JointBond own = bond;
  own.young = own.poisson = own.skew = 0.0;
  const double angle = std::atan2(line.y, line.x);
  for (const MaterialConfig* const m : {&a, &b}) {
    const LineCompliance s =
        on_line(compliance_of(*m, config.plane == "stress"), angle - m->bedding.angle);
    own.young += 0.5 / s.along;
    own.poisson -= 0.5 * s.beside / s.along;
    own.skew -= 0.5 * s.skew / s.along;
  }
  return own;
}

std::vector<ContactPair> contact_table(const Config& config) {
  const std::size_t n = config.materials.size();
  std::vector<ContactPair> pairs(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const MaterialConfig &a = config.materials[i], &b = config.materials[j];
      const double pa = a.contact_stiffness * a.young, pb = b.contact_stiffness * b.young;
      pairs[i * n + j] = {std::min(pa, pb),
                          std::min(pa * a.tangential_stiffness, pb * b.tangential_stiffness),
                          std::min(a.friction, b.friction)};
    }
  for (std::size_t k = 0; k < config.frictions.size(); ++k) {
    const FrictionConfig& f = config.frictions[k];
    const std::string where = "friction[" + std::to_string(k) + "].between";
    if (f.between.size() != 2) throw InputError(where + ": takes two materials");
    const auto a = static_cast<std::size_t>(material_index(config, f.between[0], where));
    const auto b = static_cast<std::size_t>(material_index(config, f.between[1], where));
    pairs[a * n + b].friction = pairs[b * n + a].friction = f.coefficient;
  }
  return pairs;
}

std::vector<ElasticTriangle> elastic_table(const Config& config) {
  std::vector<ElasticTriangle> laws;
  const bool stress = config.plane == "stress";
  for (const MaterialConfig& m : config.materials) {
    if (!stress && m.poisson >= 0.5)
      throw InputError(
          "material." + m.name +
          ".poisson: must be below 0.5 in plane strain; plane = \"stress\" takes more");
    ElasticTriangle law{};
    const double young = m.young_now > 0.0 ? m.young_now : m.young;
    law.lambda = plane_lambda(young, m.poisson, stress);
    law.shear = shear_modulus(young, m.poisson);
    if (m.bedding.has_stiffness()) {
      law = bedded_law(m, stress);
      for (double* const modulus : {&law.lambda, &law.shear, &law.tilt, &law.bend})
        *modulus *= young / m.young;
    }
    laws.push_back(law);
  }
  return laws;
}

std::vector<ElasticTriangle> elastic_laws(const Config& config, const Case& given) {
  return fdem_shared::laws_with_stress(elastic_table(config), config, given);
}

}  // namespace breccia::fdem
