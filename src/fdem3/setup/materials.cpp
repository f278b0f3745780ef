#include "fdem3/setup/materials.hpp"

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "fdem/setup/bedding.hpp"
#include "fdem_shared/setup/elements.hpp"

namespace breccia::fdem3 {

fdem::Config shared_keys(const Config& config) {
  fdem::Config plane;
  plane.plane = "stress";  // moduli of joints that fail with the rock are Young's and Poisson's own
  plane.materials = config.materials;
  plane.joint_laws = config.joint_laws;
  plane.frictions = config.frictions;
  plane.joints = config.joints;
  return plane;
}

namespace {

/// Lame's constants of an even rock that is nowhere softer than this one: C_even - C has no
/// negative eigenvalue. Of those with larger and larger shear moduli the one with the least sum.
std::pair<double, double> even_bound(const SolidModuli& c, double shear) {
  const double both = c.c11 + c.c12;
  std::pair<double, double> best{0.0, 1e300};
  for (int k = 0; k <= 60; ++k) {
    const double mu = std::max(shear, c.c44) * (1.0 + 0.05 * k);
    // With (1, 1)/sqrt(2) along the planes and 3 across: 2 (l + mu) - both, sqrt(2) (l - c13),
    // l + 2 mu - c33; the square of l is not in the determinant.
    const double a = 2.0 * mu - both, b = 2.0 * mu - c.c33;
    const double slope = 2.0 * b + a + 4.0 * c.c13, at_zero = a * b - 2.0 * c.c13 * c.c13;
    double lambda = std::max(-0.5 * a, -b);
    const double tiny = 1e-9 * (both + c.c33);
    if (slope > tiny) lambda = std::max(lambda, -at_zero / slope);
    if (slope * lambda + at_zero < -tiny * (both + c.c33)) continue;
    if (std::abs(lambda) + 2.5 * mu < std::abs(best.first) + 2.5 * best.second) best = {lambda, mu};
  }
  return best;
}

/// Share of planes in the law of a rock that is alike in all directions otherwise.
Planes planes_of(const MaterialConfig& m, const ElasticTetrahedron& even) {
  const SolidModuli c = moduli_of(m);
  Planes planes;
  planes.across = (1.0 / norm(m.bedding.normal)) * m.bedding.normal;
  planes.pressed = c.c13 - even.lambda;
  planes.slid = c.c44 - even.shear;
  planes.bent = c.c33 - even.lambda - 2.0 * even.shear - 2.0 * planes.pressed - 4.0 * planes.slid;
  const auto [lambda, shear] = even_bound(c, even.shear);
  planes.more_lambda = lambda - even.lambda;
  planes.more_shear = shear - even.shear;
  return planes;
}

}  // namespace

bool has_bedded_rock(const Config& config) {
  return std::any_of(config.materials.begin(), config.materials.end(),
                     [](const MaterialConfig& m) { return m.bedding.has_stiffness(); });
}

SolidModuli moduli_of(const MaterialConfig& m) {
  fdem::refuse_impossible_bedding(m);
  const fdem::AcrossPlanes across = fdem::across_planes(m);
  const double along = (1.0 - m.poisson) / m.young;  // S11 + S12
  const double s13 = -across.poisson / across.young, s33 = 1.0 / across.young;
  const double det = along * s33 - 2.0 * s13 * s13;
  const double both = s33 / det, shear = fdem::shear_modulus(m.young, m.poisson);
  return {0.5 * both + shear, 0.5 * both - shear, -s13 / det, along / det, across.shear};
}

std::vector<ElasticTetrahedron> elastic_table(const Config& config) {
  std::vector<ElasticTetrahedron> laws;
  for (const MaterialConfig& m : config.materials) {
    if (m.poisson >= 0.5)
      throw InputError("material." + m.name + ".poisson: must be below 0.5 in three dimensions");
    const double young = m.young_now > 0.0 ? m.young_now : m.young;
    ElasticTetrahedron law{};
    law.lambda = lame_lambda(young, m.poisson);
    law.shear = fdem::shear_modulus(young, m.poisson);
    if (m.bedding.has_stiffness()) {
      const SolidModuli c = moduli_of(m);
      law.lambda = c.c12;
      law.shear = 0.5 * (c.c11 - c.c12);
      law.planes = planes_of(m, law);
      Planes& planes = law.planes;
      for (double* const modulus : {&law.lambda, &law.shear, &planes.pressed, &planes.slid,
                                    &planes.bent, &planes.more_lambda, &planes.more_shear})
        *modulus *= young / m.young;
    }
    laws.push_back(law);
  }
  return laws;
}

std::vector<ElasticTetrahedron> elastic_laws(const Config& config, const Case& given) {
  return fdem_shared::laws_with_stress(elastic_table(config), config, given);
}

std::vector<ContactPair> contact_table(const Config& config, const std::vector<double>& lengths) {
  const std::size_t n = config.materials.size();
  std::vector<ContactPair> pairs;
  const std::vector<fdem::ContactPair> plane = fdem::contact_table(shared_keys(config));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const fdem::ContactPair& p = plane[i * n + j];
      const double h = 0.5 * (lengths[i] + lengths[j]);
      const double friction = config.stage_friction >= 0.0 ? config.stage_friction : p.friction;
      pairs.push_back({p.penalty / h, p.tangential / h, friction});
    }
  return pairs;
}

std::vector<EffectiveRock> effective_rocks(const Config& config) {
  std::vector<EffectiveRock> rocks;
  for (const MaterialConfig& m : config.materials) {
    EffectiveRock rock{m.name, m.young, m.poisson, 0.0, 0.0};
    if (m.joints == "intrinsic") {
      const double share = 1.0 / (1.0 + 4.0 / (3.0 * m.joint.stiffness));
      rock.young *= share;
      rock.poisson *= share;
    }
    const double lambda = lame_lambda(rock.young, rock.poisson);
    const double shear = fdem::shear_modulus(rock.young, rock.poisson);
    rock.fast = std::sqrt((lambda + 2.0 * shear) / m.density);
    rock.slow = std::sqrt(shear / m.density);
    rock.density = m.density;
    if (m.bedding.has_stiffness()) {
      SolidModuli& c = rock.stiffness = moduli_of(m);
      for (double* const modulus : {&c.c11, &c.c12, &c.c13, &c.c33, &c.c44})
        *modulus *= rock.young / m.young;
      rock.across = (1.0 / norm(m.bedding.normal)) * m.bedding.normal;
      rock.fast = std::sqrt(c.c11 / m.density);
      rock.slow = std::sqrt(0.5 * (c.c11 - c.c12) / m.density);
    }
    rocks.push_back(rock);
  }
  return rocks;
}

EffectiveRock::Impedances EffectiveRock::on(const Vec3& normal) const {
  if (!(dot(across, across) > 0.0)) return {density * fast, density * slow};
  // Of Christoffel's matrix: its part along the normal, and the mean of both across it.
  const double cosine = dot(across, normal) / norm(normal), cc = cosine * cosine, ss = 1.0 - cc;
  const SolidModuli& c = stiffness;
  const double pressing = c.c11 * ss * ss + c.c33 * cc * cc + (2.0 * c.c13 + 4.0 * c.c44) * cc * ss;
  const double aside = 0.5 * (c.c11 - c.c12) * ss + c.c44 * cc;
  const double tilted = (c.c11 + c.c33 - 2.0 * c.c13) * cc * ss + c.c44 * (cc - ss) * (cc - ss);
  return {std::sqrt(density * pressing), std::sqrt(density * 0.5 * (aside + tilted))};
}

}  // namespace breccia::fdem3
