#include "prepare/checks/cracks_beside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "io/round_numbers.hpp"
#include "prepare/checks/nearest_body.hpp"
#include "prepare/meshing/joint_sets.hpp"
#include "prepare/tetrahedra/joint_discs.hpp"

namespace breccia::prepare {
namespace {

constexpr Bounds no_bounds{{no_limit, no_limit, no_limit}, {-no_limit, -no_limit, -no_limit}};

/// The problem of a crack by the boxes around its parts.
std::string problem_of_parts(const std::string& key, const std::vector<Bounds>& parts,
                             const std::vector<Outline>& outlines) {
  Nearest least;
  for (const Bounds& part : parts) {
    const Nearest nearest = nearest_to(part, "", outlines);
    if (nearest.body == nullptr) return "";
    if (least.body == nullptr || nearest.away < least.away) least = nearest;
  }
  if (least.body == nullptr) return "";
  return fmt::format("{}: it lies in no body; {} is nearest, {} away", key, least.body->name,
                     length_text(least.away));
}

}  // namespace

std::string problem_of_discontinuity(const fdem::DiscontinuityConfig& d,
                                     const std::vector<Outline>& outlines) {
  std::vector<Bounds> pieces;
  for (std::size_t k = 1; k < d.points.size(); ++k) {
    Bounds piece = no_bounds;
    for (const Vec2& x : {d.points[k - 1], d.points[k]}) add_to(piece, {x.x, x.y, 0.0});
    pieces.push_back(piece);
  }
  return problem_of_parts("discontinuity." + d.name + ".points", pieces, outlines);
}

std::string problem_of_discontinuity(const fdem3::DiscontinuityConfig& d,
                                     const std::vector<Outline>& outlines) {
  Bounds all = no_bounds;
  for (const Vec3& x : d.points) add_to(all, {x.x, x.y, x.z});
  if (d.points.empty()) {
    const double length = norm(d.normal);
    if (!(length > 0.0)) return "";  // check_case tells
    const auto reach = [&](double along) {
      const double share = along / length;
      return d.radius * std::sqrt(std::max(0.0, 1.0 - share * share));
    };
    const Vec3 r{reach(d.normal.x), reach(d.normal.y), reach(d.normal.z)};
    for (const Vec3& x : {d.center - r, d.center + r}) add_to(all, {x.x, x.y, x.z});
  }
  const std::string key = d.points.empty() ? ".center" : ".points";
  return problem_of_parts("discontinuity." + d.name + key, {all}, outlines);
}

std::string problem_of_set(const fdem::JointSetConfig& set, const std::string* folder,
                           const std::vector<Outline>& outlines) {
  const std::string key = "joint_set." + set.name;
  if (set.file.empty())
    return problem_of(key, {{set.min.x, set.min.y, 0.0}, {set.max.x, set.max.y, 0.0}}, "",
                      outlines);
  if (folder == nullptr) return "";
  Bounds all{{no_limit, no_limit, 0.0}, {-no_limit, -no_limit, 0.0}};
  try {
    for (const fdem::DiscontinuityConfig& line : lines_of_set(set, 0, 0, *folder))
      for (const Vec2& x : line.points) add_to(all, {x.x, x.y, 0.0});
  } catch (const Error&) {
    return "";  // check_files tells
  }
  const Nearest nearest = nearest_to(all, "", outlines);
  if (nearest.body == nullptr) return "";
  return fmt::format("{}.file: its lines lie in no body; {} is nearest, {} away", key,
                     nearest.body->name, length_text(nearest.away));
}

std::string problem_of_set(const fdem3::JointSetConfig& set, const std::string* folder,
                           const std::vector<Outline>& outlines) {
  const std::string key = "joint_set." + set.name;
  if (set.file.empty())
    return problem_of(key, {{set.min.x, set.min.y, set.min.z}, {set.max.x, set.max.y, set.max.z}},
                      "", outlines);
  if (folder == nullptr) return "";
  Bounds all{{no_limit, no_limit, no_limit}, {-no_limit, -no_limit, -no_limit}};
  try {
    CrackNetwork any(0.0);
    for (const fdem3::DiscontinuityConfig& polygon : polygons_of_set(set, 0, 0, *folder, any))
      for (const Vec3& x : polygon.points) add_to(all, {x.x, x.y, x.z});
  } catch (const Error&) {
    return "";  // check_files tells
  }
  const Nearest nearest = nearest_to(all, "", outlines);
  if (nearest.body == nullptr) return "";
  return fmt::format("{}.file: its polygons lie in no body; {} is nearest, {} away", key,
                     nearest.body->name, length_text(nearest.away));
}

}  // namespace breccia::prepare
