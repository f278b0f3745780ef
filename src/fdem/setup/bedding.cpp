#include "fdem/setup/bedding.hpp"

#include <cmath>

#include "exec/error.hpp"

namespace breccia::fdem {

AcrossPlanes across_planes(const MaterialConfig& m) {
  const BeddingConfig& b = m.bedding;
  AcrossPlanes a{b.young > 0.0 ? b.young : m.young, b.poisson, b.shear};
  if (!(a.poisson > -1.0)) a.poisson = m.poisson * a.young / m.young;
  if (!(a.shear > 0.0)) a.shear = 1.0 / (1.0 / m.young + 1.0 / a.young + 2.0 * a.poisson / a.young);
  return a;
}

PlaneModuli PlaneModuli::inverted() const {
  const double over = 1.0 / (c11 * c22 - c12 * c12);
  return {c22 * over, c11 * over, -c12 * over, 1.0 / c66};
}
bool PlaneModuli::is_positive() const {
  return c11 > 0.0 && c22 > 0.0 && c11 * c22 > c12 * c12 && c66 > 0.0;
}

PlaneModuli compliance_of(const MaterialConfig& material, bool plane_stress) {
  const double young = material.young, nu = material.poisson;
  const AcrossPlanes a = across_planes(material);
  if (plane_stress) return {1.0 / young, 1.0 / a.young, -a.poisson / a.young, 1.0 / a.shear};
  return {(1.0 - nu * nu) / young,
          1.0 / a.young - a.poisson * a.poisson * young / (a.young * a.young),
          -a.poisson * (1.0 + nu) / a.young, 1.0 / a.shear};
}

void refuse_impossible_bedding(const MaterialConfig& material) {
  // In all directions of space, whichever problem is computed.
  if (!compliance_of(material, false).is_positive() || !compliance_of(material, true).is_positive())
    throw InputError(
        "material." + material.name +
        ".bedding: no rock has these moduli: 2 poisson'^2 young must be below young' "
        "(1 - poisson), of young', poisson' and shear' across its planes, which must be "
        "above 0");
}

ElasticTriangle bedded_law(const MaterialConfig& material, bool plane_stress) {
  refuse_impossible_bedding(material);
  const PlaneModuli compliance = compliance_of(material, plane_stress);
  const PlaneModuli c = compliance.inverted();
  ElasticTriangle law{};
  law.shear = c.c66;
  law.tilt = 0.25 * (c.c11 - c.c22);
  law.bend = 0.25 * (c.c11 + c.c22 - 2.0 * c.c12) - c.c66;
  law.lambda = c.c12 + law.bend;
  law.planes = std::tan(material.bedding.angle);
  return law;
}

OutOfPlane out_of_plane_of(const MaterialConfig& material) {
  const AcrossPlanes a = across_planes(material);
  return {material.poisson, a.poisson * material.young / a.young};
}

LineCompliance on_line(const PlaneModuli& s, double angle) {
  const double c = std::cos(angle), n = std::sin(angle), cc = c * c, nn = n * n;
  const double mixed = 2.0 * s.c12 + s.c66;
  return {s.c11 * cc * cc + mixed * cc * nn + s.c22 * nn * nn,
          (s.c11 + s.c22 - s.c66) * cc * nn + s.c12 * (cc * cc + nn * nn),
          c * n * ((2.0 * s.c22 - mixed) * nn - (2.0 * s.c11 - mixed) * cc)};
}

WaveModuli on_normal(const PlaneModuli& s, double angle) {
  const double c = std::cos(angle), n = std::sin(angle), cc = c * c, nn = n * n;
  return {s.c11 * cc * cc + (2.0 * s.c12 + 4.0 * s.c66) * cc * nn + s.c22 * nn * nn,
          (s.c11 + s.c22 - 2.0 * s.c12) * cc * nn + s.c66 * (cc - nn) * (cc - nn)};
}

}  // namespace breccia::fdem
