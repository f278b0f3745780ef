#pragma once
// Rock bolts of a case: their nodes in the elements of a model, and what is wrong with them.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/named.hpp"
#include "exec/error.hpp"
#include "fdem_shared/bolts/bolts.hpp"
#include "fdem_shared/over_time.hpp"
#include "fdem_shared/setup/bolt_config.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "math/constants.hpp"

namespace breccia::fdem_shared {

inline constexpr double most_bolt_nodes = 1e5;

/// Two directions across an axis in space, and each other, of length 1.
inline std::array<Vec3, 2> across_axis(const Vec3& axis) {
  const double x = std::abs(axis.x), y = std::abs(axis.y), z = std::abs(axis.z);
  const Vec3 aside = x <= y && x <= z ? Vec3{1.0, 0.0, 0.0}
                     : y <= z         ? Vec3{0.0, 1.0, 0.0}
                                      : Vec3{0.0, 0.0, 1.0};
  const Vec3 first = cross(axis, aside), second = cross(axis, first);
  return {(1.0 / norm(first)) * first, (1.0 / norm(second)) * second};
}
inline Vec2 on_ring(const BoltConfigOf<Vec2>& ring, double angle) {
  return ring.center + ring.radius * Vec2{std::cos(angle), std::sin(angle)};
}
inline Vec3 on_ring(const BoltConfigOf<Vec3>& ring, double angle) {
  const std::array<Vec3, 2> across = across_axis(ring.axis);
  return ring.center + ring.radius * (std::cos(angle) * across[0] + std::sin(angle) * across[1]);
}

/// The points that a bolt runs along, of a ring the first one last, too.
template <class Vector>
std::vector<Vector> corners_of(const BoltConfigOf<Vector>& bolt) {
  if (!bolt.is_ring()) return bolt.points;
  constexpr double fewest = 12.0;
  const double sides =
      std::clamp(std::ceil(2.0 * pi * bolt.radius / bolt.segment), fewest, most_bolt_nodes + 1.0);
  std::vector<Vector> corners;
  for (double k = 0.0; k < sides; k += 1.0) corners.push_back(on_ring(bolt, 2.0 * pi * k / sides));
  corners.push_back(corners.front());
  return corners;
}

template <class Vector>
double pieces_of(double leg, const BoltConfigOf<Vector>& bolt) {
  return std::max(1.0, std::ceil(leg / bolt.segment - 1e-9));
}

/// Points of a polyline, each leg in even pieces no longer than a segment.
template <class Vector>
std::vector<Vector> divided(const BoltConfigOf<Vector>& bolt) {
  const std::vector<Vector> corners = corners_of(bolt);
  std::vector<Vector> nodes{corners.front()};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vector &from = corners[i], way = corners[i + 1] - from;
    const double pieces = pieces_of(norm(way), bolt);
    for (double k = 1.0; k <= pieces; k += 1.0) nodes.push_back(from + (k / pieces) * way);
  }
  return nodes;
}

template <class Vector>
BoltLaw law_of(const BoltConfigOf<Vector>& bolt) {
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

/// Shares of an element's corners in a point, and its least height.
inline std::array<double, 3> shares_at(const Vec2 (&corner)[3], const Vec2& point) {
  std::array<double, 3> share{};
  const double twice = cross(corner[1] - corner[0], corner[2] - corner[0]);
  for (std::size_t k = 0; k < 3; ++k)
    share[k] = cross(corner[(k + 1) % 3] - point, corner[(k + 2) % 3] - point) / twice;
  return share;
}
inline std::array<double, 4> shares_at(const Vec3 (&corner)[4], const Vec3& point) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return dot(b - a, cross(c - a, d - a));
  };
  const Vec3 &a = corner[0], &b = corner[1], &c = corner[2], &d = corner[3];
  const double over = 1.0 / volume(a, b, c, d);
  return {over * volume(point, b, c, d), over * volume(a, point, c, d),
          over * volume(a, b, point, d), over * volume(a, b, c, point)};
}
inline double least_height(const Vec2 (&corner)[3]) {
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, norm(corner[(k + 1) % 3] - corner[k]));
  return cross(corner[1] - corner[0], corner[2] - corner[0]) / longest;
}
inline double least_height(const Vec3 (&corner)[4]) {
  double largest = 0.0;  // twice the area of a face
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& from = corner[(k + 1) % 4];
    largest =
        std::max(largest, norm(cross(corner[(k + 2) % 4] - from, corner[(k + 3) % 4] - from)));
  }
  return dot(corner[1] - corner[0], cross(corner[2] - corner[0], corner[3] - corner[0])) / largest;
}

inline std::string short_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
}
inline std::string point_text(const Vec2& point) {
  return "(" + short_text(point.x) + ", " + short_text(point.y) + ") m";
}
inline std::string point_text(const Vec3& point) {
  return "(" + short_text(point.x) + ", " + short_text(point.y) + ", " + short_text(point.z) +
         ") m";
}

/// The problem of a segment that turns elements too stiffly as it acts across; empty: none.
/// @param height  of the flattest element at its ends
template <class Shape>
std::string problem_across(const std::string& where, const BoltLaw& law, double segment,
                           double height, double corners) {
  const double turns = 1.0 + 0.5 * segment / height;
  if (law.dowel.stiffness * turns * turns <= corners) return "";
  return where + ".bedding: segments of " + short_text(segment) + " m that act across with " +
         short_text(law.dowel.stiffness) + (Shape::dimension == 2 ? " N/m2" : " N/m") + " turn " +
         Shape::elements_word + " " + short_text(height) +
         " m high more stiffly than their corners are; shorter segments, or a softer bedding";
}

/// The problem of segments that pull at corners of this stiffness; empty: none.
/// @param slips  stiffness of the bond that they pull by; no_limit: of a node that does not slip
template <class Shape>
std::string problem_of_segment(const std::string& where, const BoltLaw& law, double segment,
                               double slips, double corners) {
  if (std::min(2.0 * law.stiffness / segment, slips) <= corners) return "";
  return where + ".segment: " + short_text(segment) + " m are stiffer than the corners of " +
         Shape::elements_word + " that they pull at; at least " +
         short_text(2.0 * law.stiffness / corners) + " m";
}

/// Puts the bolts of a case into a model.
template <class World, class Config, class Model>
class BoltPlacing {
  using Shape = ShapeOf<World>;
  using Vector = typename Shape::Vector;
  using Place = BoltPlaceOf<Vector>;
  static constexpr const char* stiffness_unit = Shape::dimension == 2 ? "N/m2" : "N/m";
  /// How stiffly bolts pull at the corners of an element, along and across.  [N/m; in 2D N/m2]
  struct Pull {
    double along = 0.0, across = 0.0;
    int bolts = 0;
  };

 public:
  BoltPlacing(const World& w, const Config& config, const Model& model)
      : config_(config), model_(model), graded_(w.given->in_situ.graded()) {
    copy_to(laws_, w.given->laws);
    copy_to(reference_, Shape::reference(Shape::elements(w)));
  }
  /// @throws InputError
  BoltOf<Vector> placed(const BoltConfigOf<Vector>& given) {
    BoltOf<Vector> bolt;
    bolt.name = given.name;
    bolt.law = law_of(given);
    const bool both = given.is_ring() || given.anchored == "both";
    bolt.anchored[0] = both || given.anchored == "start";
    bolt.anchored[1] = both || given.anchored == "end";
    for (std::size_t k = 0; k < config_.stages.size(); ++k)
      if (config_.stages[k].name == given.stage) bolt.stage = static_cast<std::int32_t>(k);
    const std::vector<Vector> points = divided(given);
    const std::vector<Index> near = elements_near(points);
    for (const Vector& point : points) {
      bolt.places.push_back(place_of(point, near));
      look_at(bolt.name, bolt.places.back());
    }
    std::map<Index, double> bonded;  // length in each element
    std::map<Index, Pull> pull;      // of this bolt, at its stiffest node in each element
    for (std::size_t i = 0; i + 1 < bolt.places.size(); ++i)
      for (const std::size_t end : {i, i + 1})
        bonded[bolt.places[end].element] += 0.5 * norm(way_of(bolt, i));
    for (std::size_t i = 0; i < bolt.places.size(); ++i) {
      const Index element = bolt.places[i].element;
      const Pull own = look_at_stiffness(bolt, i, bonded[element]);
      Pull& most = pull[element];
      most = {std::max(most.along, own.along), std::max(most.across, own.across)};
    }
    for (const auto& [element, own] : pull) add_to_others(bolt.name, element, own);
    return bolt;
  }

 private:
  void corners(Index element, Vector (&corner)[Shape::corners]) const {
    for (std::size_t k = 0; k < at(Shape::corners); ++k)
      corner[k] = model_.point[at(Shape::corners_of(model_)[at(element)][k])];
  }
  /// Elements whose box meets the box of these points.
  std::vector<Index> elements_near(const std::vector<Vector>& points) const {
    const auto low = [](const auto& of, int axis) {
      double least = no_limit;
      for (const Vector& x : of) least = std::min(least, part_of(x, axis));
      return least;
    };
    const auto high = [](const auto& of, int axis) {
      double most = -no_limit;
      for (const Vector& x : of) most = std::max(most, part_of(x, axis));
      return most;
    };
    constexpr double margin = 1e-6;  // of the size of an element
    Vector first{}, last{};
    for (int axis = 0; axis < Shape::dimension; ++axis) {
      part_of(first, axis) = low(points, axis);
      part_of(last, axis) = high(points, axis);
    }
    std::vector<Index> near;
    for (Index t = 0; t < model_.size(); ++t) {
      Vector corner[Shape::corners];
      corners(t, corner);
      bool meets = true;
      for (int axis = 0; axis < Shape::dimension; ++axis) {
        const double begin = low(corner, axis), end = high(corner, axis);
        const double beside = margin * (end - begin);
        meets =
            meets && begin - beside <= part_of(last, axis) && end + beside >= part_of(first, axis);
      }
      if (meets) near.push_back(t);
    }
    return near;
  }
  /// The first element that holds a point, and the shares of its corners. Below 0: none does.
  Place place_of(const Vector& point, const std::vector<Index>& near) const {
    constexpr double at_the_rim = -1e-9;
    for (const Index t : near) {
      Vector corner[Shape::corners];
      corners(t, corner);
      const auto share = shares_at(corner, point);
      if (*std::min_element(share.begin(), share.end()) >= at_the_rim) return {t, share, point};
    }
    return {-1, {}, point};
  }
  void look_at(const std::string& name, const Place& place) const {
    const std::string where = "bolt." + name + ".points: " + point_text(place.point);
    if (place.element < 0) throw InputError(where + " lies in no " + Shape::element);
    const std::string& body = model_.groups[at(model_.group[at(place.element)])];
    for (const auto& stage : config_.stages)
      if (std::count(stage.remove.begin(), stage.remove.end(), body) > 0)
        throw InputError(where + " lies in body " + body + ", which stage " + stage.name +
                         " takes out");
  }
  static Vector way_of(const BoltOf<Vector>& bolt, std::size_t segment) {
    return bolt.places[segment + 1].point - bolt.places[segment].point;
  }
  /// A node that does not slip, or where the bar bends, pulls with its segments. Elsewhere rock
  /// that moves along the bar feels no more than the bond in the element, which slips with it.
  /// @param bonded  length of the bar in the element of the node  [m]
  /// @returns how stiffly it pulls
  Pull look_at_stiffness(const BoltOf<Vector>& bolt, std::size_t i, double bonded) const {
    const std::size_t last = bolt.places.size() - 1;
    const Vector before = way_of(bolt, i > 0 ? i - 1 : 0),
                 after = way_of(bolt, i < last ? i : i - 1);
    const double segment = norm(before);
    const double bends = 0.5 * (1.0 - dot(before, after) / (segment * norm(after)));
    const bool anchored = (i == 0 && bolt.anchored[0]) || (i == last && bolt.anchored[1]);
    const double slips =
        bolt.law.bond_stiffness * bonded + 2.0 * bolt.law.stiffness / segment * bends;
    const auto t = at(bolt.places[i].element);
    const double stiffness =
        Shape::corner_stiffness(laws_[graded_ ? t : at(model_.material[t])], reference_[t]);
    Vector corner[Shape::corners];
    corners(bolt.places[i].element, corner);
    const std::string where = "bolt." + bolt.name;
    for (const std::string& problem :
         {problem_of_segment<Shape>(where, bolt.law, segment, anchored ? no_limit : slips,
                                    stiffness),
          problem_across<Shape>(where, bolt.law, segment, least_height(corner), stiffness)})
      if (!problem.empty()) throw InputError(problem);
    const double turns = 1.0 + 0.5 * segment / least_height(corner);
    return {std::min(2.0 * bolt.law.stiffness / segment, anchored ? no_limit : slips),
            bolt.law.dowel.stiffness * turns * turns};
  }
  /// Bolts in one element pull at its corners together.
  void add_to_others(const std::string& name, Index element, const Pull& own) {
    Pull& all = together_[element];
    all.along += own.along;
    all.across += own.across;
    all.bolts += 1;
    const auto t = at(element);
    const double corners =
        Shape::corner_stiffness(laws_[graded_ ? t : at(model_.material[t])], reference_[t]);
    const double most = std::max(all.along, all.across);
    if (most > corners)
      throw InputError(
          "bolt." + name + ": with it " + std::to_string(all.bolts) + " bolts pull at " +
          Shape::element + " " + std::to_string(element) + ", together with " + short_text(most) +
          " " + stiffness_unit + ", more stiffly than its corners are (" + short_text(corners) +
          "); fewer of them there, larger " + Shape::elements_word + ", or a softer bond");
  }

  const Config& config_;
  const Model& model_;
  bool graded_;
  std::vector<typename Shape::Law> laws_;
  std::vector<typename Shape::Reference> reference_;
  std::map<Index, Pull> together_;  ///< of all bolts so far, in each element
};

/// @throws InputError naming a bolt with a point outside all elements, in a body that a stage
/// takes out, or with segments stiffer than the rock that they are tied to
template <class World, class Config, class Model>
void set_up_bolts(World& w, const Config& config, const Model& model) {
  using Vector = typename ShapeOf<World>::Vector;
  if (config.bolts.empty()) return;
  BoltPlacing<World, Config, Model> placing(w, config, model);
  std::vector<BoltOf<Vector>> bolts;
  std::size_t nodes = 0;
  for (const BoltConfigOf<Vector>& given : config.bolts) {
    bolts.push_back(placing.placed(given));
    nodes += bolts.back().places.size();
  }
  set_up(w).bolts = std::move(bolts);
  copy_to(w.bolts.nodes, std::vector<BoltNodeOf<Vector>>(nodes));
}

/// The load that lists what bolts do, behind all others.
template <class World, class Config>
void prescribe_bolts(World& w, const Config& config) {
  if (config.bolts.empty()) return;
  auto& given = set_up(w);
  given.loads.push_back(
      {LoadKind::bolt, from_space<typename ShapeOf<World>::Vector>({1.0, 1.0, 1.0}), 1.0, {}, {}});
  given.load_amplitudes.emplace_back();
}

/// Problems of how finely a bolt is divided, told before it is.
template <class Shape, class Vector>
void look_at_segments(const BoltConfigOf<Vector>& bolt, double corners,
                      std::vector<std::string>& problems) {
  const std::vector<Vector> points = corners_of(bolt);
  double nodes = 1.0, shortest = no_limit;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double leg = norm(points[i + 1] - points[i]), pieces = pieces_of(leg, bolt);
    nodes += pieces;
    shortest = std::min(shortest, leg / pieces);
  }
  const std::string where = "bolt." + bolt.name;
  const BoltLaw law = law_of(bolt);
  const bool slips = bolt.anchored == "none" && !bolt.is_ring();
  const std::string problem = problem_of_segment<Shape>(
      where, law, shortest, slips ? law.bond_stiffness * shortest : no_limit, corners);
  if (!problem.empty())
    problems.push_back(problem);
  else if (nodes > most_bolt_nodes)
    problems.push_back(where + ".segment: " + short_text(nodes) + " nodes; at most " +
                       short_text(most_bolt_nodes));
}

/// Problems of bolts that a case file alone tells of.
/// @param corners  the stiffest ones that the case may have; no_limit where its mesh alone tells
template <class Shape, class Config>
std::vector<std::string> problems_of_bolts(const Config& config, double corners) {
  std::vector<std::string> problems;
  for (const auto& bolt : config.bolts) {
    const std::string where = "bolt." + bolt.name;
    if (bolt.is_ring() ? !bolt.points.empty() : bolt.points.size() < 2)
      problems.push_back(where + ".points: at least two, or the radius of a ring and none");
    if (bolt.is_ring() && bolt.anchored != "none")
      problems.push_back(where + ".anchored: a ring has no ends");
    if (Shape::dimension == 3 && bolt.is_ring() && !(norm(bolt.axis) > 0.0))
      problems.push_back(where + ".axis: a ring needs the direction of its axis");
    if (!bolt.is_ring() && norm(bolt.axis) > 0.0)
      problems.push_back(where + ".axis: a ring has one; give its center and radius");
    if (bolt.area > 0.0 && bolt.bedding > 0.0)
      problems.push_back(where + ".bedding: across acts a round bar alone; leave area out");
    for (std::size_t i = 0; i + 1 < bolt.points.size(); ++i)
      if (!(norm(bolt.points[i + 1] - bolt.points[i]) > 0.0))
        problems.push_back(where + ".points: two in succession are the same");
    if (problems.empty()) look_at_segments<Shape>(bolt, corners, problems);
    if (!bolt.stage.empty())
      add_unknown(where + ".stage", bolt.stage, "stage", names_of(config.stages), problems);
    if (std::count_if(config.bolts.begin(), config.bolts.end(),
                      [&](const auto& other) { return other.name == bolt.name; }) > 1)
      problems.push_back(where + ".name: two bolts have this name");
  }
  return problems;
}

/// Problems of probes, of bolts too. @param otherwise  what other probes read
template <class Config>
void add_probe_problems(const Config& config, Bearer otherwise, std::size_t axes,
                        std::vector<std::string>& problems) {
  for (const ProbeConfig& p : config.probes) {
    const bool bolt = std::any_of(config.bolts.begin(), config.bolts.end(),
                                  [&](const auto& each) { return each.name == p.on; });
    for (const std::string& problem : probe_problems(p, bolt ? of_bolt : otherwise, axes))
      problems.push_back(problem);
  }
}

}  // namespace breccia::fdem_shared
