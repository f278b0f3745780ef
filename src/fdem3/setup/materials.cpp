#include "fdem3/setup/materials.hpp"

#include <cmath>

#include "exec/error.hpp"
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

std::vector<ElasticTetrahedron> elastic_table(const Config& config) {
  std::vector<ElasticTetrahedron> laws;
  for (const MaterialConfig& m : config.materials) {
    if (m.poisson >= 0.5)
      throw InputError("material." + m.name + ".poisson: must be below 0.5 in three dimensions");
    const double young = m.young_now > 0.0 ? m.young_now : m.young;
    laws.push_back({lame_lambda(young, m.poisson), fdem::shear_modulus(young, m.poisson), {}});
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
    rocks.push_back(rock);
  }
  return rocks;
}

}  // namespace breccia::fdem3
