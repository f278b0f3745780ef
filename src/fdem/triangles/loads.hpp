#pragma once
// Forces on edges, and velocities and forces that follow a table over time.

#include "fdem/triangles/triangle_kernels.hpp"
#include "fdem_shared/over_time.hpp"

namespace breccia::fdem {

using fdem_shared::LoadKind;
using LoadAmplitude = fdem_shared::AmplitudeOf<Vec2>;
using LoadLaw = fdem_shared::LoadLawOf<Vec2>;
using PrescribedMotion = fdem_shared::PrescribedMotionOf<Vec2>;

/// A loaded edge: edge k of a triangle.
struct LoadedEdge {
  Index triangle;
  std::int16_t edge;
  std::int16_t load;  ///< index into the laws
  double share;       ///< of the load's edges, by length at the start; of a fluid: filled part  [-]
  /// rho c_p and rho c_s of its triangle  [Pa s/m]; of a bolt: x and y of what it pulls with  [N/m]
  double impedance_p, impedance_s;

  static LoadedEdge of(Index number, std::int16_t load, double share) {
    return {number / 3, static_cast<std::int16_t>(number % 3), load, share, 0.0, 0.0};
  }
  /// An edge that a bolt pulls at. @param pull  of its whole, shared out evenly  [N/m]
  static LoadedEdge pulled(Index number, std::int16_t load, double share, const Vec2& pull) {
    return {number / 3, static_cast<std::int16_t>(number % 3), load, share, pull.x, pull.y};
  }
  Index number() const { return 3 * triangle + edge; }
  Index& element() { return triangle; }
  BR_HD Index element() const { return triangle; }
  BR_HD Vec2 pull() const { return {impedance_p, impedance_s}; }
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
        const double size = norm(along), half = 0.5 * size * law.factor.x;
        const Vec2 normal = (1.0 / size) * outward;
        sum.at[k] += half * resisted(edges[e], normal, a.velocity);
        sum.at[next] += half * resisted(edges[e], normal, b.velocity);
        continue;
      }
      const Vec2 whole = law.kind == LoadKind::pressure ? -law.pressure * outward
                         : law.kind == LoadKind::fluid  ? (-law.pressure * edges[e].share) * outward
                         : law.kind == LoadKind::traction ? norm(along) * law.traction
                         : law.kind == LoadKind::bolt     ? edges[e].share * edges[e].pull()
                                                          : edges[e].share * law.force;
      const Vec2 half{(0.5 * law.factor.x) * whole.x, (0.5 * law.factor.y) * whole.y};
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
