#include "fdem/setup/bolts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/named.hpp"
#include "exec/error.hpp"
#include "fdem/setup/materials.hpp"
#include "fdem/shape.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "math/constants.hpp"

namespace breccia::fdem {
namespace {

constexpr double most_nodes = 1e5;

double pieces_of(double leg, const BoltConfig& bolt) {
  return std::max(1.0, std::ceil(leg / bolt.segment - 1e-9));
}

/// Points of a polyline, each leg in even pieces no longer than a segment.
std::vector<Vec2> divided(const BoltConfig& bolt) {
  const std::vector<Vec2> corners = corners_of(bolt);
  std::vector<Vec2> nodes{corners.front()};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec2 &from = corners[i], way = corners[i + 1] - from;
    const double pieces = pieces_of(norm(way), bolt);
    for (double k = 1.0; k <= pieces; k += 1.0) nodes.push_back(from + (k / pieces) * way);
  }
  return nodes;
}

/// The first triangle that holds a point, and the shares of its corners. Below 0: none does.
BoltPlace place_of(const Model& model, const Vec2& point) {
  constexpr double at_the_rim = -1e-9;
  for (std::size_t t = 0; t < model.triangle.size(); ++t) {
    const auto corner = [&](std::size_t k) { return model.point[at(model.triangle[t][k % 3])]; };
    std::array<double, 3> share{};
    const double twice = cross(corner(1) - corner(0), corner(2) - corner(0));
    for (std::size_t k = 0; k < 3; ++k)
      share[k] = cross(corner(k + 1) - point, corner(k + 2) - point) / twice;
    if (*std::min_element(share.begin(), share.end()) >= at_the_rim)
      return {static_cast<Index>(t), share, point};
  }
  return {-1, {}, point};
}

std::string short_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
}

BoltLaw law_of(const BoltConfig& bolt) {
  const double square = bolt.diameter * bolt.diameter;
  const double area = (bolt.area > 0.0 ? bolt.area : 0.25 * pi * square) / bolt.spacing;
  const double bending = bolt.young * pi / 64.0 * square * square;  // E I
  const double beta = std::sqrt(std::sqrt(0.25 * bolt.bedding / bending));
  return {bolt.young * area,
          bolt.yield * area,
          bolt.bond_stiffness / bolt.spacing,
          bolt.bond_strength / bolt.spacing,
          {bending * beta * beta * beta / bolt.spacing,
           1.27 * square * std::sqrt(bolt.grout * bolt.yield) / bolt.spacing}};
}

/// The problem of a segment that turns triangles too stiffly as it acts across; empty: none.
/// @param height  of the flattest triangle at its ends
std::string problem_across(const std::string& where, const BoltLaw& law, double segment,
                           double height, double corners) {
  const double turns = 1.0 + 0.5 * segment / height;
  if (law.dowel.stiffness * turns * turns <= corners) return "";
  return where + ".bedding: segments of " + short_text(segment) + " m that act across with " +
         short_text(law.dowel.stiffness) + " N/m2 turn triangles " + short_text(height) +
         " m high more stiffly than their corners are; shorter segments, or a softer bedding";
}

/// The problem of segments that pull at corners of this stiffness; empty: none.
std::string problem_of_segment(const std::string& where, const BoltLaw& law, double segment,
                               double corners) {
  if (2.0 * law.stiffness / segment <= corners) return "";
  return where + ".segment: " + short_text(segment) +
         " m are stiffer than the corners of triangles that they pull at; at least " +
         short_text(2.0 * law.stiffness / corners) + " m";
}

/// @throws InputError
void look_at(const Bolt& bolt, double segment, const BoltPlace& place, const Vec2& point,
             const World& w, const Model& model, const Config& config) {
  const std::string where = "bolt." + bolt.name;
  const std::string at_point = "(" + short_text(point.x) + ", " + short_text(point.y) + ") m";
  if (place.triangle < 0) throw InputError(where + ".points: " + at_point + " lies in no triangle");
  const auto t = at(place.triangle);
  const std::string& body = model.groups[at(model.group[t])];
  for (const StageConfig& stage : config.stages)
    if (std::count(stage.remove.begin(), stage.remove.end(), body) > 0)
      throw InputError(where + ".points: " + at_point + " lies in body " + body + ", which stage " +
                       stage.name + " takes out");
  std::vector<ElasticTriangle> laws;
  copy_to(laws, w.given->laws);
  const std::size_t law = w.given->in_situ.graded() ? t : at(model.material[t]);
  const std::string problem =
      problem_of_segment(where, bolt.law, segment, Shape::corner_stiffness(laws[law], {}));
  if (!problem.empty()) throw InputError(problem);
  const auto corner = [&](std::size_t k) { return model.point[at(model.triangle[t][k % 3])]; };
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, norm(corner(k + 1) - corner(k)));
  const double height = cross(corner(1) - corner(0), corner(2) - corner(0)) / longest;
  const std::string turned =
      problem_across(where, bolt.law, segment, height, Shape::corner_stiffness(laws[law], {}));
  if (!turned.empty()) throw InputError(turned);
}

/// The stiffest corners that the case may have; no limit where its materials are in error.
double stiffest_corners(const Config& config) {
  try {
    double most = 0.0;
    for (const ElasticTriangle& law : elastic_table(config))
      most = std::max(most, Shape::corner_stiffness(law, {}));
    return most > 0.0 ? most : no_limit;
  } catch (const InputError&) {  // told by itself
    return no_limit;
  }
}

/// Problems of how finely a bolt is divided, told before it is.
void look_at_segments(const BoltConfig& bolt, double corners, std::vector<std::string>& problems) {
  const std::vector<Vec2> points = corners_of(bolt);
  double nodes = 1.0, shortest = no_limit;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double leg = norm(points[i + 1] - points[i]), pieces = pieces_of(leg, bolt);
    nodes += pieces;
    shortest = std::min(shortest, leg / pieces);
  }
  const std::string where = "bolt." + bolt.name;
  const std::string problem = problem_of_segment(where, law_of(bolt), shortest, corners);
  if (!problem.empty())
    problems.push_back(problem);
  else if (nodes > most_nodes)
    problems.push_back(where + ".segment: " + short_text(nodes) + " nodes; at most " +
                       short_text(most_nodes));
}

}  // namespace

void set_up_bolts(World& w, const Config& config, const Model& model) {
  std::vector<Bolt> bolts;
  std::size_t nodes = 0;
  for (const BoltConfig& given : config.bolts) {
    Bolt bolt;
    bolt.name = given.name;
    bolt.law = law_of(given);
    const bool closed = given.radius > 0.0, both = closed || given.anchored == "both";
    bolt.anchored[0] = both || given.anchored == "start";
    bolt.anchored[1] = both || given.anchored == "end";
    for (std::size_t k = 0; k < config.stages.size(); ++k)
      if (config.stages[k].name == given.stage) bolt.stage = static_cast<std::int32_t>(k);
    const std::vector<Vec2> points = divided(given);
    for (std::size_t i = 0; i < points.size(); ++i) {
      bolt.places.push_back(place_of(model, points[i]));
      const Vec2& other = points[i > 0 ? i - 1 : 1];
      look_at(bolt, norm(points[i] - other), bolt.places.back(), points[i], w, model, config);
    }
    nodes += points.size();
    bolts.push_back(std::move(bolt));
  }
  fdem_shared::set_up(w).bolts = std::move(bolts);
  copy_to(w.bolts.nodes, std::vector<BoltNode>(nodes));
}

std::vector<Vec2> corners_of(const BoltConfig& bolt) {
  if (!(bolt.radius > 0.0)) return bolt.points;
  constexpr double fewest = 12.0;
  const double sides =
      std::clamp(std::ceil(2.0 * pi * bolt.radius / bolt.segment), fewest, most_nodes + 1.0);
  std::vector<Vec2> corners;
  for (double k = 0.0; k < sides; k += 1.0) {
    const double angle = 2.0 * pi * k / sides;
    corners.push_back(bolt.center + bolt.radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  corners.push_back(corners.front());
  return corners;
}

std::vector<std::string> bolt_problems(const Config& config) {
  std::vector<std::string> problems;
  for (const BoltConfig& bolt : config.bolts) {
    const std::string where = "bolt." + bolt.name;
    if (bolt.radius > 0.0 ? !bolt.points.empty() : bolt.points.size() < 2)
      problems.push_back(where + ".points: at least two, or the radius of a ring and none");
    if (bolt.radius > 0.0 && bolt.anchored != "none")
      problems.push_back(where + ".anchored: a ring has no ends");
    if (bolt.area > 0.0 && bolt.bedding > 0.0)
      problems.push_back(where + ".bedding: across acts a round bar alone; leave area out");
    for (std::size_t i = 0; i + 1 < bolt.points.size(); ++i)
      if (!(norm(bolt.points[i + 1] - bolt.points[i]) > 0.0))
        problems.push_back(where + ".points: two in succession are the same");
    if (problems.empty()) look_at_segments(bolt, stiffest_corners(config), problems);
    if (!bolt.stage.empty())
      add_unknown(where + ".stage", bolt.stage, "stage", names_of(config.stages), problems);
    if (std::count_if(config.bolts.begin(), config.bolts.end(),
                      [&](const BoltConfig& other) { return other.name == bolt.name; }) > 1)
      problems.push_back(where + ".name: two bolts have this name");
  }
  return problems;
}

}  // namespace breccia::fdem
