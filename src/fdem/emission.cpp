#include "fdem/emission.hpp"

#include <algorithm>
#include <cmath>

#include "core/on_host.hpp"

namespace breccia::fdem {
namespace {

/// Mean over a joint by the weights of its points, up to its break; 0 where it did not leave the
/// elastic branch.
template <class Value>
double mean_of(const JointPoints& points, const Value& value) {
  return (value(points.point[0]) + 4.0 * value(points.point[1]) + value(points.point[2])) / 6.0;
}

}  // namespace

Sym3 moment_of(const ElasticTriangle& law, bool plane_strain, const Vec2& along, double area,
               double opening, double slip) {
  const Vec2 n{-along.y, along.x};
  const double all = area * law.lambda * opening, open = 2.0 * area * law.shear * opening,
               slid = area * law.shear * slip;
  Sym3 m;
  m.xx = all + open * n.x * n.x + 2.0 * slid * n.x * along.x;
  m.yy = all + open * n.y * n.y + 2.0 * slid * n.y * along.y;
  m.xy = open * n.x * n.y + slid * (n.x * along.y + n.y * along.x);
  m.zz = plane_strain ? all : 0.0;
  return m;
}

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
  const EmissionConfig& asked = w.given->emission;
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
    ElasticTriangle law = law_at(a);
    const ElasticTriangle other = law_at(b);
    law.lambda = 0.5 * (law.lambda + other.lambda);
    law.shear = 0.5 * (law.shear + other.shear);
    const JointLine& line = lines[at(i)];
    const double length = norm(line.end - line.begin);
    const Vec2 middle = 0.5 * (line.begin + line.end);
    const JointWork &work = joints->work.data()[i], &before = joints->inherited_work.data()[i];
    breaks.push_back(
        {joints->broke_at.data()[i],
         {middle.x, middle.y, 0.0},
         moment_of(law, w.given->plane_strain, (1.0 / length) * (line.end - line.begin),
                   length * asked.thickness, opening, slip),
         asked.thickness * (work.open + work.slide - before.open - before.slide)});
  }
  const double distance = asked.distance > 0.0 ? asked.distance : 2.0 * w.given->mean_edge;
  double slowest = 1e300;
  for (const EffectiveRock& rock : w.given->rocks) slowest = std::min(slowest, rock.slow);
  return events_of(breaks, distance, asked.window > 0.0 ? asked.window : distance / slowest);
}

}  // namespace breccia::fdem
