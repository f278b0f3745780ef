#include "fdem/emission.hpp"

#include <cmath>

#include "core/on_host.hpp"
#include "fdem_shared/emission.hpp"

namespace breccia::fdem {
namespace {

/// Mean over a joint by the weights of its points, up to its break; 0 where it did not leave the
/// elastic branch.
template <class Value>
double mean_of(const JointPoints& points, const Value& value) {
  return (value(points.point[0]) + 4.0 * value(points.point[1]) + value(points.point[2])) / 6.0;
}

}  // namespace

std::vector<EmissionEvent> emission(const World& w, const std::vector<JointLine>& lines) {
  const OnHost<Joints> joints(w.joints, w.exec.space);
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, w.triangles.nodes);
  std::vector<Index> material;
  copy_to(material, w.triangles.material);
  std::vector<ElasticTriangle> laws;
  copy_to(laws, w.given->laws);
  const bool graded = w.given->in_situ.graded();
  const auto corner = [&](Index n) { return nodes[at(n / 3)].at[n % 3].position; };
  const auto law_at = [&](Index edge) {
    return laws[at(graded ? edge / 3 : material[at(edge / 3)])];
  };
  const double thickness = w.given->emission.thickness;
  std::vector<Break> breaks;
  for (Index i = 0; i < joints->size(); ++i) {
    if (joints->stage.data()[i] != JointStage::broken) continue;
    const Index a = joints->edge_a.data()[i], b = joints->edge_b.data()[i];
    const JointEnds e = JointEnds::of(a, b);
    const JointOpening<double> now =
        opening_of(corner(e.a0), corner(e.a1), corner(e.b0), corner(e.b1));
    const JointPoints& points = joints->points.data()[i];
    const double opening = mean_of(points, [](const auto& p) { return p.opening; });
    const double slip =
        std::copysign(mean_of(points, [](const auto& p) { return p.slip; }), now.slide[1]);
    const JointLine& line = lines[at(i)];
    const Vec2 way = line.end - line.begin, middle = 0.5 * (line.begin + line.end);
    const double length = norm(way);
    const Vec3 along{way.x / length, way.y / length, 0.0}, normal{-along.y, along.x, 0.0};
    Sym3 moment = fdem_shared::moment_of(fdem_shared::mean_of_sides(law_at(a), law_at(b)), normal,
                                         along, length * thickness, opening, slip);
    if (!w.given->plane_strain) moment.zz = 0.0;  // nothing acts across the plane
    breaks.push_back({joints->broke_at.data()[i],
                      {middle.x, middle.y, 0.0},
                      moment,
                      thickness * fdem_shared::spent_by(*joints, i)});
  }
  return fdem_shared::near_events(w, breaks);
}

}  // namespace breccia::fdem
