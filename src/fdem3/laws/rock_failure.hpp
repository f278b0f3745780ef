#pragma once
// Failure of the rock at a joint in space (joints.criterion = "rock"): as in the plane
// (fdem/laws/rock_failure.hpp), a joint of a free mesh fails where the stress of the rock beside it
// fails on any plane near its face, with the traction it then carries.
//
// The stress in the face follows from the stretch of the middle surface, which both sides share,
// and from the traction across it (docs/theory-fdem3.md, 2.5).

#include "fdem/laws/rock_failure.hpp"
#include "fdem3/joints/joints.hpp"

namespace breccia::fdem3 {

/// Stress of the rock at a joint in the frame (along edge 0-1, across it, normal).  [Pa]
template <class R>
struct RockStressOf {
  Sym3Of<R> s;
};
using RockStress = RockStressOf<double>;

/// Of plane stress in the face under a normal stress, from Green's strain of the middle surface.
/// @param young, poisson  of the rock  @param traction  mean, on side b's outer face  [Pa]
/// @param in_situ  S_0, taken along the present axes  [Pa]
template <class R>
BR_HD RockStressOf<R> rock_stress(const R& young, const R& poisson, const FaceShapeOf<R>& face,
                                  const JointOpeningOf<R>& o, const Vec3Of<R>& traction,
                                  const Sym3Of<R>& in_situ) {
  const Vec3Of<R> edge = o.middle[1] - o.middle[0], other = o.middle[2] - o.middle[0];
  const Vec3Of<R> across = cross(o.normal, o.along);
  // F in the plane from the reference edges (size, 0), (along, across) to the present ones.
  const R present = dot(edge, o.along);  // edge has no part across
  const R f11 = present / face.size;
  const R f12 = (dot(other, o.along) - f11 * face.along) / face.across;
  const R f22 = dot(other, across) / face.across;
  const R e11 = 0.5 * (f11 * f11 - 1.0), e22 = 0.5 * (f12 * f12 + f22 * f22 - 1.0);
  const R e12 = 0.5 * f11 * f12;
  const R flat = young / (1.0 - poisson * poisson);
  const R z_start = dot(o.normal, in_situ * o.normal);
  const R normal = dot(traction, o.normal);
  const R lifted = poisson / (1.0 - poisson) * (normal - z_start);
  RockStressOf<R> r;
  r.s.xx = flat * (e11 + poisson * e22) + lifted + dot(o.along, in_situ * o.along);
  r.s.yy = flat * (e22 + poisson * e11) + lifted + dot(across, in_situ * across);
  r.s.xy = young / (1.0 + poisson) * e12 + dot(o.along, in_situ * across);
  r.s.zz = normal;
  r.s.xz = dot(traction, o.along);
  r.s.yz = dot(traction, across);
  return r;
}

/// Whether the largest eigenvalue is above a number: exact, by the signs of the leading minors of
/// number - s.
template <class R>
BR_HD auto exceeds(const Sym3Of<R>& s, const R& number) {
  const R a = number - s.xx, b = number - s.yy, c = number - s.zz;
  const R minor = a * b - s.xy * s.xy;
  const R whole =
      a * (b * c - s.yz * s.yz) - s.xy * (s.xy * c + s.yz * s.xz) - s.xz * (s.xy * s.yz + b * s.xz);
  return !(a > 0.0 && minor > 0.0 && whole > 0.0);
}

/// Whether the rock can have failed on any plane at all. Cheap, and never false where rock_failure
/// finds a failure: by the largest eigenvalue, and by a bound on the difference of the outer two.
/// @param tension, cohesion  of this joint  [Pa]  @param friction  tan phi_i
template <class R>
BR_HD auto may_fail(const R& tension, const R& cohesion, const R& friction,
                    const RockStressOf<R>& rock) {
  const Sym3Of<R>& s = rock.s;
  // With s' the deviator: sigma_1 - sigma_3 <= sqrt(2 s':s'), |sigma_2 - mean| <= sqrt(s':s'/6).
  const R mean = trace(s) / 3.0;
  const Sym3Of<R> away{s.xx - mean, s.yy - mean, s.zz - mean, s.yz, s.xz, s.xy};
  const R size = sqrt(contract(away, away));
  const R radius = 0.7071067811865476 * size, centre = mean + 0.2041241452319315 * size;
  return exceeds(s, tension) ||
         friction * centre + radius * sqrt(1.0 + friction * friction) > cohesion;
}

/// Principal stresses, falling, and their directions.
struct Principal {
  double value[3];
  Vec3 axis[3];
};
/// By Jacobi's rotations: only + - * / and square roots.
BR_HD inline Principal principal(const Sym3& s) {
  double a[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  double v[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (int sweep = 0; sweep < 6; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0.0) continue;
        const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
        const double size = abs(theta) + sqrt(theta * theta + 1.0);
        const double t = theta < 0.0 ? -1.0 / size : 1.0 / size;
        const double c = 1.0 / sqrt(t * t + 1.0), n = t * c;
        for (int k = 0; k < 3; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - n * kq;
          a[k][q] = n * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - n * qk;
          a[q][k] = n * pk + c * qk;
          const double vp = v[k][p], vq = v[k][q];
          v[k][p] = c * vp - n * vq;
          v[k][q] = n * vp + c * vq;
        }
      }
  int order[3] = {0, 1, 2};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2 - i; ++j)
      if (a[order[j]][order[j]] < a[order[j + 1]][order[j + 1]]) {
        const int kept = order[j];
        order[j] = order[j + 1];
        order[j + 1] = kept;
      }
  Principal r;
  for (int i = 0; i < 3; ++i) {
    const int k = order[i];
    r.value[i] = a[k][k];
    r.axis[i] = {v[0][k], v[1][k], v[2][k]};
  }
  return r;
}

/// How far the rock is from failure on a plane near this face, as in the plane method: with theta
/// between its normal and the direction of sigma_1,
///   torn     sigma_n/f_t, or, if sigma_n > 0, sigma_1 min(1, cos^2 theta/cos^2 35 deg)/f_t
///   sheared  (C tan phi + radius/cos phi)/c of the largest circle, if the traction on the face is
///            nearly as critical as that of the planes that slide
BR_HD inline fdem::RockFailure rock_failure(const fdem::JointBond& law, double strength,
                                            const RockStress& rock) {
  const Sym3& s = rock.s;
  const double tension = law.tension * strength, cohesion = law.cohesion * strength;
  const Principal p = principal(s);
  fdem::RockFailure f{s.zz / tension, 0.0};
  const double cos2 = p.axis[0].z * p.axis[0].z;
  if (s.zz > 0.0 && cos2 >= fdem::torn_at_all)
    f.torn = max(f.torn, p.value[0] * min(1.0, cos2 / fdem::torn_in_full) / tension);
  const double centre = 0.5 * (p.value[0] + p.value[2]), radius = 0.5 * (p.value[0] - p.value[2]);
  const double reach = radius * sqrt(1.0 + law.friction * law.friction);
  const double middle = centre * law.friction;
  const double shear = sqrt(s.xz * s.xz + s.yz * s.yz);
  const double own = shear + s.zz * law.friction;
  if (own > 0.0 && own - middle >= fdem::sheared_at_all * reach)
    f.sheared = (middle + reach) / cohesion;
  return f;
}

}  // namespace breccia::fdem3
