#pragma once
// The stable step of an element by Gershgorin's bound: every eigenfrequency is at most the largest
// sum of a row's |stiffness| over its mass. One text for triangles and tetrahedra, whose joints and
// contacts each adds by itself.

#include <cstdint>

#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem_shared {

/// Step of a mass that oscillates with at most omega and loses energy: central differences are
/// stable below 2/omega (sqrt(1 + xi^2) - xi).
/// @param square  omega^2  [1/s2]  @param lost  [N s/m]
BR_HD inline double stable_step_of(double square, double lost, double mass) {
  if (!(square > 0.0)) return 1e300;  // nothing acts on it
  const double omega = sqrt(square);
  const double xi = 0.5 * lost / (mass * omega);
  return 2.0 / omega * (sqrt(1.0 + xi * xi) - xi);
}

/// Shares of the row sum of a corner; in 2D per unit thickness.
struct StepParts {
  double element = 0.0, joint = 0.0, contact = 0.0;  ///<  [N/m]
  double viscous = 0.0, absorbed = 0.0;              ///<  [N s/m]
  double square = 0.0;                               ///< omega^2 bound  [1/s2]
  double step = 1e300;                               ///<  [s]

  /// The bound and the step, from the shares.
  BR_HD void finish(double mass) {
    square = (element + joint + contact) / mass;
    step = stable_step_of(square, viscous + absorbed, mass);
  }
  BR_HD bool operator<(const StepParts& other) const {
    if (step != other.step) return step < other.step;
    return square != other.square ? square > other.square : element > other.element;
  }
  /// Of corners that move as one.
  BR_HD void add(const StepParts& other) {
    element += other.element;
    joint += other.joint;
    contact += other.contact;
    viscous += other.viscous;
    absorbed += other.absorbed;
  }
};

/// Sums of the rows of a corner: all of StepParts that a step needs.
struct RowSums {
  double stiffness = 0.0;  ///<  [N/m]
  double lost = 0.0;       ///<  [N s/m]

  RowSums() = default;
  BR_HD explicit RowSums(const StepParts& p)
      : stiffness(p.element + p.joint + p.contact), lost(p.viscous + p.absorbed) {}
  BR_HD void add(const RowSums& other) {
    stiffness += other.stiffness;
    lost += other.lost;
  }
};

/// The step of a mass by its rows, and that of no mass.
BR_HD inline double bound_of(const RowSums& rows, double mass) {
  return stable_step_of(rows.stiffness / mass, rows.lost, mass);
}
BR_HD inline StepParts bound_of(StepParts rows, double mass) {
  rows.finish(mass);
  return rows;
}
BR_HD inline double no_bound(const RowSums&) {
  return 1e300;
}
BR_HD inline StepParts no_bound(const StepParts&) {
  return {};
}

/// The rows of an element's corners.
template <class Rows, int corners>
struct RowsOfCorners {
  Rows at[corners];
};

BR_HD inline void list(const Vec2& v, double (&component)[2]) {
  component[0] = v.x;
  component[1] = v.y;
}
BR_HD inline void list(const Vec3& v, double (&component)[3]) {
  component[0] = v.x;
  component[1] = v.y;
  component[2] = v.z;
}

/// Area of a triangle or volume of a tetrahedron: a factor of each term, or of their sum.
struct SizeOfElement {
  double each, all;
};

/// Sum of the absolute stiffnesses in the row of component c of corner i.
/// @param slope  of the corners' shape functions  [1/m]
template <int dim, class Vector>
BR_HD double row_sum(const Vector (&slope)[dim + 1], int i, int c, const SizeOfElement& size,
                     double lambda, double shear) {
  double sum = 0.0;
  double gi[dim], gj[dim];
  list(slope[i], gi);
  for (int j = 0; j <= dim; ++j) {
    const double dots = dot(slope[i], slope[j]);
    list(slope[j], gj);
    for (int d = 0; d < dim; ++d) {
      const double k =
          lambda * (gi[c] * gj[d]) + shear * (gi[d] * gj[c]) + (c == d ? shear * dots : 0.0);
      sum += size.each * abs(k);
    }
  }
  return size.all * sum;
}

/// The shares of an element's own stiffness and viscosity in the rows of corner i.
template <int dim, class Vector>
BR_HD void add_element(StepParts& p, const Vector (&slope)[dim + 1], int i,
                       const SizeOfElement& size, double lambda, double shear, double viscosity) {
  for (int c = 0; c < dim; ++c) {
    p.element = max(p.element, row_sum<dim>(slope, i, c, size, lambda, shear));
    p.viscous = max(p.viscous, row_sum<dim>(slope, i, c, size, 0.0, 0.5 * viscosity));
  }
}

/// Where contact counts in a stable step: nowhere; where something may touch until the next
/// evaluation; as if something were near everywhere.
enum class Pressed : std::uint8_t { nowhere, soon, everywhere };

/// Bits of the sides at which contact counts: those that another element is near to; all that can
/// touch of an element so fast that it might pass the reach of that before the next evaluation.
/// @param span  no longer until that  [s]
/// @param reach  called if needed  [m]
template <int corners, class Vector, class Reach>
BR_HD int pressed_until_next(int near, int exposed, const Vector (&velocity)[corners], double span,
                             const Reach& reach) {
  if (near == exposed) return near;
  double fastest = 0.0;
  for (int k = 0; k < corners; ++k) fastest = max(fastest, dot(velocity[k], velocity[k]));
  return span * sqrt(fastest) > reach() ? exposed : near;
}

/// The parts of an element that moves by itself, with contact as above.
/// @param rows  parts of the element with contact at the sides of these bits
template <int corners, class Rows, class Vector, class Reach>
BR_HD StepParts parts_until_next(const Rows& rows, int near, int exposed,
                                 const Vector (&velocity)[corners], int evaluate_every,
                                 const Reach& reach) {
  const StepParts least = rows(near);
  const double span = evaluate_every * least.step;
  return pressed_until_next(near, exposed, velocity, span, reach) == near ? least : rows(exposed);
}

}  // namespace breccia::fdem_shared
