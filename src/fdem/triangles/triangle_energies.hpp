#pragma once
// Energies of triangles.

#include "fdem/triangles/motion.hpp"
#include "fdem_shared/element_energies.hpp"

namespace breccia::fdem {

/// Elastic energy of triangles.
struct StoredByTriangles {
  Kick kick;
  View<const Index> law;  ///< place among the laws
  View<const ElasticTriangle> laws;
  View<const Mat2> shape_inverse;
  Lanes lanes;

  BR_HD double elastic(Index t) const {
    Vec2 x[3], v[3];
    split(kick.nodes[t], x, v);
    return elastic(laws[law[t]], shape_inverse[t], x, v);
  }
  /// Of t and its neighbours in a pack.
  /// @param nodes  theirs, by columns
  template <class R>
  R elastic(Index t, const R (&nodes)[12]) const {
    const CornersOf<R> c(nodes);
    R inverse[4], numbers[8];
    gather_records(shape_inverse, consecutive<R>(t), inverse);
    gather_records(laws, load_indices<R>(law, t), numbers);
    const ElasticLaw<R> own{numbers[0], numbers[1], {numbers[2], numbers[3], numbers[4]},
                            numbers[5], numbers[6], numbers[7]};
    return elastic(own, {inverse[0], inverse[1], inverse[2], inverse[3]}, c.x, c.v);
  }

 private:
  template <class R>
  BR_HD static R elastic(const ElasticLaw<R>& own, const Mat2Of<R>& inverse,
                         const Vec2Of<R> (&x)[3], const Vec2Of<R> (&v)[3]) {
    const R area = 0.5 / determinant(inverse);
    return area * own.energy(deformation(inverse, x, v));
  }
};
using TriangleShares = fdem_shared::ElementShares<StoredByTriangles>;

/// Adds the energies of triangles [begin, end) to `sum`.
void add_energies(Lanes lanes, const TriangleShares& kernel, Index begin, Index end, Energies& sum);

}  // namespace breccia::fdem
