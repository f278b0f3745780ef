#pragma once
// Planes of bedding in the law of a tetrahedron: transverse isotropy.

#include "math/mat3.hpp"

namespace breccia::fdem3 {

template <class R>
BR_HD void add_to(Mat3Of<R>& sum, const Mat3Of<R>& more) {
  sum.a += more.a;
  sum.b += more.b;
  sum.c += more.c;
}

/// Green's strain (F^T F - 1)/2, by differences that vanish at rest.
BR_HD inline Sym3 green_strain(const Mat3& f) {
  const Vec3 a = f.a - Vec3{1.0, 0.0, 0.0}, b = f.b - Vec3{0.0, 1.0, 0.0},
             c = f.c - Vec3{0.0, 0.0, 1.0};
  return {a.x + 0.5 * dot(a, a),         b.y + 0.5 * dot(b, b),
          c.z + 0.5 * dot(c, c),         0.5 * (b.z + c.y + dot(b, c)),
          0.5 * (a.z + c.x + dot(a, c)), 0.5 * (a.y + b.x + dot(a, b))};
}

/// Rock with planes across the unit vector a has an energy more, in Green's strain E:
///
///   p tr E (a . E a) + 2 m (E a . E a) + q (a . E a)^2 / 2
///   S = p ((a . E a) 1 + tr E a (x) a) + 2 m (E a (x) a + a (x) E a) + q (a . E a) a (x) a
///
/// besides lambda and mu, those of its planes. So with 1 and 2 along the planes and 3 across them
/// C11 = lambda + 2 mu, C12 = lambda, C13 = lambda + p, C33 = lambda + 2 mu + 2 p + 4 m + q,
/// C44 = mu + m (docs/theory-fdem3.md, 1). Eight numbers side by side: packs gather them.
template <class R>
struct PlanesOf {
  Vec3Of<R> across{};  ///< a, in the reference; 0: no bedding  [-]
  R pressed{};         ///< p  [Pa]
  R slid{};            ///< m  [Pa]
  R bent{};            ///< q  [Pa]
  /// Lame's constants of an even rock that is nowhere softer than this one, for the bound on the
  /// step; without bedding what they are more than the rock's own is 0.  [Pa]
  R more_lambda{}, more_shear{};

  /// Their share of the first Piola tensor: F S.  [Pa]
  BR_HD Mat3Of<R> piola(const Mat3Of<R>& f) const {
    const Vec3Of<R> to = f * across;  // F a
    const Vec3Of<R> strain{0.5 * (dot(f.a, to) - across.x), 0.5 * (dot(f.b, to) - across.y),
                           0.5 * (dot(f.c, to) - across.z)};  // E a
    const R stretch = dot(across, strain);
    const R sum = 0.5 * (dot(f.a, f.a) + dot(f.b, f.b) + dot(f.c, f.c) - 3.0);
    const Vec3Of<R> along = (pressed * sum + bent * stretch) * to + (2.0 * slid) * (f * strain);
    const R even = pressed * stretch, twice = 2.0 * slid;
    return {even * f.a + across.x * along + (twice * strain.x) * to,
            even * f.b + across.y * along + (twice * strain.y) * to,
            even * f.c + across.z * along + (twice * strain.z) * to};
  }
  /// Energy per volume of a strain.  [J/m3]
  BR_HD double energy(const Sym3& e) const {
    const Vec3 strain = e * across;
    const double stretch = dot(across, strain);
    return (pressed * trace(e) + 0.5 * bent * stretch) * stretch + 2.0 * slid * dot(strain, strain);
  }
  /// S : C^-1 S / 2 of a small stress.  [J/m3]  @param lambda, shear  of the planes  [Pa]
  BR_HD double energy_of(const Sym3& s, double lambda, double shear) const {
    const Vec3 on = s * across;
    const double normal = dot(across, on), in_plane = trace(s) - normal;
    const double slides = max(0.0, dot(on, on) - normal * normal);  // traction along the planes
    // Of the stress within the planes, the part that is not alike in all their directions.
    const double uneven =
        max(0.0, contract(s, s) - normal * normal - 2.0 * slides - 0.5 * in_plane * in_plane);
    // (s1 + s2, s3) = ((C11 + C12) e, 2 C13 e) + (2 C13 e3, C33 e3), e = e1 + e2
    const double c13 = lambda + pressed;
    const double c33 = lambda + 2.0 * shear + 2.0 * pressed + 4.0 * slid + bent;
    const double both = lambda + shear;  // (C11 + C12)/2
    const double det = both * c33 - c13 * c13;
    const double e = (0.5 * in_plane * c33 - normal * c13) / det,
                 e3 = (normal * both - 0.5 * in_plane * c13) / det;
    return 0.5 * (0.5 * in_plane * e + normal * e3) + 0.5 * slides / (shear + slid) +
           0.25 * uneven / shear;
  }
};
using Planes = PlanesOf<double>;

}  // namespace breccia::fdem3
