#pragma once
// Forces on edges, and velocities and forces that follow a table over time.

#include <vector>

#include "fdem/triangles/triangle_kernels.hpp"

namespace breccia::fdem {

/// A factor over time: a table, linear in between and constant beyond, times a ramp from zero.
struct Amplitude {
  double ramp = 0.0;                   ///<  [s]
  std::vector<double> times, factors;  ///< ascending  [s], [-]

  double at(double time) const;
  /// Largest size of its factors.  [-]
  double largest() const;
};

/// The same where kernels can read it: entries first to end - 1 of all amplitudes' tables.
struct AmplitudeTable {
  double ramp;  ///<  [s]
  Index first, end;

  BR_HD double at(double time, const View<const double>& times,
                  const View<const double>& factors) const {
    const double grown = ramp > 0.0 ? min(max(time / ramp, 0.0), 1.0) : 1.0;
    if (first == end) return grown;
    Index next = first;  // the first entry later than `time`
    for (Index step = end - first; step > 0;) {
      const Index half = step / 2;
      if (times[next + half] <= time) {
        next += half + 1;
        step -= half + 1;
      } else {
        step = half;
      }
    }
    if (next == first) return grown * factors[first];
    if (next == end) return grown * factors[end - 1];
    const double share = (time - times[next - 1]) / (times[next] - times[next - 1]);
    return grown * (factors[next - 1] + share * (factors[next] - factors[next - 1]));
  }
};

/// A support's velocity over time; the host puts its value of each step into World::motions.
struct PrescribedMotion {
  Vec2 velocity{};  ///<  [m/s]
  Amplitude amplitude;
};

/// What acts on an edge. Pressure and traction act per present length; a force is dead: it stays as
/// given however its edges deform.
enum class LoadKind : std::uint8_t { pressure, traction, force, absorbing };

/// A load with its value at this moment.
struct LoadLaw {
  LoadKind kind;
  double factor;    ///< of the amplitude, now  [-]
  double pressure;  ///<  [Pa]
  Vec2 traction;    ///<  [Pa]
  Vec2 force;       ///<  [N/m]
};

/// A loaded edge: edge k of a triangle.
struct LoadedEdge {
  Index triangle;
  std::int16_t edge;
  std::int16_t load;                ///< index into the laws
  double share;                     ///< of the load's edges, by length at the start  [-]
  double impedance_p, impedance_s;  ///< rho c_p and rho c_s of its triangle  [Pa s/m]
};

/// Adds the loads of one triangle's edges, half to each end.
struct LoadForces {
  static constexpr const char* name = "fdem.loads";
  View<const Index> starts;  ///< first loaded edge of each loaded triangle, and the end
  View<const LoadedEdge> edges;
  View<const LoadLaw> laws;
  View<const TriangleNodes> nodes;
  View<Corners> external, force;

  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index i) const {
    const Index t = edges[starts[i]].triangle;
    Corners sum{};
    for (Index e = starts[i]; e < starts[i + 1]; ++e) {
      const int k = edges[e].edge, next = (k + 1) % 3;
      const NodeState &a = nodes[t].at[k], &b = nodes[t].at[next];
      const LoadLaw& law = laws[edges[e].load];
      const Vec2 along = b.position - a.position, outward{along.y, -along.x};  // times the length
      if (law.kind == LoadKind::absorbing) {
        const double size = norm(along), half = 0.5 * size * law.factor;
        const Vec2 normal = (1.0 / size) * outward;
        sum.at[k] += half * resisted(edges[e], normal, a.velocity);
        sum.at[next] += half * resisted(edges[e], normal, b.velocity);
        continue;
      }
      const Vec2 whole = law.kind == LoadKind::pressure   ? -law.pressure * outward
                         : law.kind == LoadKind::traction ? norm(along) * law.traction
                                                          : edges[e].share * law.force;
      const Vec2 half = (0.5 * law.factor) * whole;
      sum.at[k] += half;
      sum.at[next] += half;
    }
    external[t] = sum;
    for (int k = 0; k < 3; ++k) force[t].at[k] += sum.at[k];
  }

 private:
  /// t = -rho (c_p n n + c_s (1 - n n)) v (Lysmer and Kuhlemeyer 1969).
  BR_HD static Vec2 resisted(const LoadedEdge& edge, const Vec2& normal, const Vec2& velocity) {
    const Vec2 straight = dot(velocity, normal) * normal;
    return -(edge.impedance_p * straight + edge.impedance_s * (velocity - straight));
  }
};

}  // namespace breccia::fdem
