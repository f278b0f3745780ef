#include "prepare/packing/rebar.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "math/constants.hpp"
#include "prepare/shapes/segments.hpp"
#include "prepare/shapes/solid.hpp"

namespace breccia::prepare {
namespace {

double along(double share, double edge) {
  return (share - 0.5) * edge;
}

/// The two directions of one mat; `face` is -1 at the bottom, +1 at the top.
void add_mat(std::vector<Bar>& bars, const dem::RebarConfig& rebar, const Vec3& size, double face) {
  const double r = 0.5 * rebar.diameter;
  const double outer = face * (0.5 * size.z - rebar.cover);
  const double inner = outer - face * rebar.diameter;
  const double end_x = 0.5 * size.x - r, end_y = 0.5 * size.y - r;
  for (int k = 0; k < rebar.along_x(); ++k) {
    const double y = along((k + 0.5) / rebar.along_x(), size.y);
    bars.push_back({{-end_x, y, outer}, {end_x, y, outer}, r});
  }
  for (int k = 0; k < rebar.along_y(); ++k) {
    const double x = along((k + 0.5) / rebar.along_y(), size.x);
    bars.push_back({{x, -end_y, inner}, {x, end_y, inner}, r});
  }
}

std::string bar_name(const dem::BarConfig& bar, std::size_t number, int copy) {
  std::string name = bar.mark.empty() ? fmt::format("bar {}", number + 1) : bar.mark;
  if (bar.copies > 1) name += fmt::format(" (copy {})", copy + 1);
  return name;
}

/// A drawn bar; each straight part is shared by whole pieces.
Chain chain_along(const dem::RebarConfig& rebar, std::size_t number, int copy) {
  const dem::BarConfig& drawn = rebar.drawn[number];
  Chain chain;
  chain.name = bar_name(drawn, number, copy);
  chain.closed = drawn.closed;
  chain.diameter = drawn.diameter > 0.0 ? drawn.diameter : rebar.diameter;
  const double wanted = rebar.spacing > 0.0 ? rebar.spacing : 2.0 * chain.diameter;
  const Vec3 moved = static_cast<double>(copy) * drawn.step;
  const std::size_t points = drawn.points.size(), parts = drawn.closed ? points : points - 1;
  std::vector<double> lengths;  // from each element to the next
  for (std::size_t k = 0; k < parts; ++k) {
    const Vec3 a = drawn.points[k] + moved, b = drawn.points[(k + 1) % points] + moved;
    chain.segments.push_back({a, b, chain.radius()});
    const double length = norm(b - a);
    const int pieces = std::max(1, static_cast<int>(length / wanted + 0.5));
    for (int i = 0; i < pieces; ++i) {
      chain.centres.push_back(a + (static_cast<double>(i) / pieces) * (b - a));
      lengths.push_back(length / pieces);
    }
  }
  if (!drawn.closed) chain.centres.push_back(drawn.points.back() + moved);
  const std::size_t count = chain.centres.size();
  for (std::size_t e = 0; e < count; ++e) {
    const bool first = !drawn.closed && e == 0, last = !drawn.closed && e + 1 == count;
    const double before = first ? 0.0 : lengths[(e + lengths.size() - 1) % lengths.size()];
    const double after = last ? 0.0 : lengths[e];
    chain.piece.push_back(0.5 * (before + after));
    chain.spacing.push_back(first || last ? before + after : 0.5 * (before + after));
  }
  return chain;
}

std::vector<std::string> mat_problems(const dem::RebarConfig& rebar, const Vec3& size) {
  std::vector<std::string> problems;
  const double d = rebar.diameter;
  const double shorter = std::min(size.x, size.y);
  if (rebar.cover < 0.5 * d)
    problems.push_back(fmt::format("cover {:.4g} m puts bars of diameter {:.4g} m outside the body",
                                   rebar.cover, d));
  const double depth = rebar.layers * (rebar.cover + 1.5 * d);  // a mat is two diameters thick
  if (depth > size.z)
    problems.push_back(
        fmt::format("{} layers of bars need {:.4g} m of depth; the body has {:.4g} m", rebar.layers,
                    depth, size.z));
  for (const auto& [bars, width] :
       {std::pair{rebar.along_x(), size.y}, {rebar.along_y(), size.x}}) {
    if (bars * d <= width) continue;
    problems.push_back(
        fmt::format("{} bars of diameter {:.4g} m do not fit beside each other", bars, d));
    break;
  }
  if ((shorter - d) / (rebar.elements - 1) < d)
    problems.push_back(fmt::format("{} elements along a bar of length {:.4g} m overlap; at most {}",
                                   rebar.elements, shorter - d, static_cast<int>(shorter / d)));
  return problems;
}

/// Points of a sphere of radius 1, spread evenly, and those on the axes.
std::vector<Vec3> directions_around() {
  constexpr int spread = 200;
  const double turn = pi * (3.0 - std::sqrt(5.0));  // golden angle
  std::vector<Vec3> all{{1.0, 0.0, 0.0},  {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0},
                        {0.0, -1.0, 0.0}, {0.0, 0.0, 1.0},  {0.0, 0.0, -1.0}};
  for (int k = 0; k < spread; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / spread, r = std::sqrt(1.0 - z * z);
    all.push_back({r * std::cos(turn * k), r * std::sin(turn * k), z});
  }
  return all;
}

/// Of a body with joins: lines on the skin of a part, and points of its round ends, must lie within
/// the union. To half a hundredth of the radius along the part, to two at its ends.
PlaceOutside outside_union(const dem::BodyConfig& host) {
  return [whole = Union(host), center = host.center, frame = frame_of(host.axis, host.across),
          around = directions_around()](const Bar& part) -> std::optional<Vec3> {
    constexpr int lines = 32;
    const double r = part.radius * (1.0 - 1e-9);
    const auto placed = [&](const Vec3& x) { return center + frame.out(x); };
    for (const Vec3& end : {part.a, part.b})
      for (const Vec3& d : around)
        if (whole.parts(placed(end), placed(end + r * d))) return end;
    const Vec3 along = part.b - part.a;
    if (!(norm(along) > 0.0)) return {};
    const Frame3 own = frame_of(along, {});
    for (int k = 0; k < lines; ++k) {
      const double angle = 2.0 * pi * k / lines;
      const Vec3 off = r * (std::cos(angle) * own.x + std::sin(angle) * own.y);
      if (whole.parts(placed(part.a + off), placed(part.b + off))) return 0.5 * (part.a + part.b);
    }
    return {};
  };
}

PlaceOutside outside_container(const dem::BodyConfig& host) {
  const Container container = container_of(host);
  if (!(container.volume() > 0.0)) return {};  // a file without a box; a surface
  return [container](const Bar& part) -> std::optional<Vec3> {
    for (const Vec3& end : {part.a, part.b})
      if (container.depth(end) < part.radius * (1.0 - 1e-9)) return end;
    return {};
  };
}

std::vector<std::string> drawn_problems(const dem::RebarConfig& rebar,
                                        const PlaceOutside& outside) {
  std::vector<std::string> problems;
  for (std::size_t k = 0; k < rebar.drawn.size(); ++k) {
    const dem::BarConfig& drawn = rebar.drawn[k];
    const std::size_t least = drawn.closed ? 3 : 2;
    if (drawn.points.size() < least) {
      problems.push_back(fmt::format("{} has {} points; it needs {}", bar_name(drawn, k, 0),
                                     drawn.points.size(), least));
      continue;
    }
    for (int copy = 0; copy < drawn.copies; ++copy) {
      const Chain chain = chain_along(rebar, k, copy);
      double shortest = no_limit;
      for (const double piece : chain.spacing) shortest = std::min(shortest, piece);
      if (shortest < chain.diameter * (1.0 - 1e-9))
        problems.push_back(fmt::format(
            "{} has elements {:.3g} m apart, which overlap; spacing and its straight parts "
            "must be at least its diameter, {:.3g} m",
            chain.name, shortest, chain.diameter));
      for (const Bar& part : chain.segments) {
        if (!outside) break;
        const std::optional<Vec3> at = outside(part);
        if (!at) continue;
        problems.push_back(
            fmt::format("{} is not inside the body at ({:.4g}, {:.4g}, {:.4g}) m of it: its axis "
                        "must lie half a diameter, {:.3g} m, below the faces",
                        chain.name, at->x, at->y, at->z, chain.radius()));
        return problems;
      }
      if (!problems.empty()) return problems;
    }
  }
  return problems;
}

}  // namespace

std::vector<Bar> bars_through(const dem::RebarConfig& rebar, const Vec3& size) {
  std::vector<Bar> bars;
  add_mat(bars, rebar, size, -1.0);
  if (rebar.layers == 2) add_mat(bars, rebar, size, 1.0);
  return bars;
}

bool has_bars(const std::vector<dem::BodyConfig>& bodies, const dem::BodyConfig& host) {
  return std::any_of(bodies.begin(), bodies.end(), [&](const dem::BodyConfig& other) {
    return other.shape == "rebar" && other.rebar.in == host.name;
  });
}

double Chain::area() const {
  return pi * diameter * diameter / 4.0;
}

double bars_volume(const std::vector<Chain>& chains) {
  double volume = 0.0;
  for (const Chain& chain : chains)
    for (const Bar& part : chain.segments) volume += chain.area() * norm(part.b - part.a);
  return volume;
}

double Chain::mass(double density, std::size_t element) const {
  return density * area() * piece[element];
}

double Chain::inertia(double element_mass, std::size_t element) const {
  const double length = spacing[element];
  return element_mass * (length * length / 12.0 + diameter * diameter / 16.0);
}

std::vector<Chain> chains_through(const dem::RebarConfig& rebar, const Vec3& size) {
  std::vector<Chain> chains;
  if (!rebar.drawn.empty()) {
    for (std::size_t k = 0; k < rebar.drawn.size(); ++k)
      for (int copy = 0; copy < rebar.drawn[k].copies; ++copy)
        chains.push_back(chain_along(rebar, k, copy));
    return chains;
  }
  for (const Bar& bar : bars_through(rebar, size)) {
    Chain chain;
    chain.name = "mat";
    chain.segments = {bar};
    chain.diameter = rebar.diameter;
    const double length = norm(bar.b - bar.a) / (rebar.elements - 1);
    for (int k = 0; k < rebar.elements; ++k) {
      const bool end = k == 0 || k == rebar.elements - 1;
      const double share = static_cast<double>(k) / (rebar.elements - 1);
      chain.centres.push_back(bar.a + share * (bar.b - bar.a));
      chain.piece.push_back(end ? 0.5 * length : length);
      chain.spacing.push_back(length);
    }
    chains.push_back(chain);
  }
  return chains;
}

std::vector<std::string> bar_problems(const dem::RebarConfig& rebar, const dem::BodyConfig& host) {
  if (rebar.drawn.empty()) return mat_problems(rebar, host.size);
  return drawn_problems(rebar, host.joins.empty() ? outside_container(host) : outside_union(host));
}

std::vector<std::string> bars_outside(const std::vector<dem::BodyConfig>& bodies,
                                      const dem::BodyConfig& host, const Surface& surface) {
  // Corners in a file are rounded to its digits, or to single precision.
  const double rounding = 1e-7 * norm(surface.high() - surface.low());
  const PlaceOutside outside = [&](const Bar& part) -> std::optional<Vec3> {
    if (!surface.holds(part.a)) return part.a;
    const Surface::Clearance least = surface.clearance(part.a, part.b, 2.0 * part.radius);
    if (least.distance < part.radius * (1.0 - 1e-9) - rounding) return least.at;
    return {};
  };
  std::vector<std::string> problems;
  for (const dem::BodyConfig& body : bodies)
    if (body.shape == "rebar" && body.rebar.in == host.name)
      for (const std::string& problem : drawn_problems(body.rebar, outside))
        problems.push_back(fmt::format("body.{}.rebar: {}", body.name, problem));
  return problems;
}

std::vector<std::string> crossing_problems(const std::vector<Chain>& bars,
                                           const std::vector<Chain>& others) {
  const bool same = &bars == &others;
  for (std::size_t i = 0; i < bars.size(); ++i)
    for (std::size_t j = same ? i : 0; j < others.size(); ++j) {
      const Chain &p = bars[i], &q = others[j];
      const double needed = p.radius() + q.radius();
      for (std::size_t a = 0; a < p.segments.size(); ++a)
        for (std::size_t b = same && i == j ? a + 1 : 0; b < q.segments.size(); ++b) {
          if (same && i == j && (b == a + 1 || (p.closed && a == 0 && b + 1 == q.segments.size())))
            continue;  // parts that share a corner
          const Bar &one = p.segments[a], &two = q.segments[b];
          const NearestOfSegments near = nearest_of_segments(one.a, one.b, two.a, two.b);
          if (near.distance >= needed * (1.0 - 1e-9)) continue;
          return {fmt::format(
              "{} and {} come as near as {:.3g} m at ({:.4g}, {:.4g}, {:.4g}) m of the body; their "
              "axes need {:.3g} m",
              p.name, same && i == j ? "another part of it" : q.name, near.distance, near.at.x,
              near.at.y, near.at.z, needed)};
        }
    }
  return {};
}

}  // namespace breccia::prepare
