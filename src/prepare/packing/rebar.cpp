#include "prepare/packing/rebar.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "math/constants.hpp"

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

/// The shortest way between two straight bars.
struct Nearest {
  double distance;  ///< of their axes  [m]
  Vec3 at;          ///< on the first one
};
Nearest nearest(const Bar& p, const Bar& q) {
  const Vec3 u = p.b - p.a, v = q.b - q.a, w = p.a - q.a;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double across = uu * vv - uv * uv;
  double s = across > 1e-12 * uu * vv ? std::clamp((uv * vw - vv * uw) / across, 0.0, 1.0) : 0.0;
  const double t = vv > 0.0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0.0;
  s = uu > 0.0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  const Vec3 at = p.a + s * u;
  return {norm(at - (q.a + t * v)), at};
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

std::vector<std::string> drawn_problems(const dem::RebarConfig& rebar,
                                        const dem::BodyConfig& host) {
  std::vector<std::string> problems;
  const Container container = container_of(host);
  const bool has_faces = container.volume() > 0.0;  // a file may have no box
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
      for (const Bar& part : chain.segments)
        for (const Vec3& end : {part.a, part.b}) {
          if (!has_faces || container.depth(end) >= chain.radius() * (1.0 - 1e-9)) continue;
          problems.push_back(
              fmt::format("{} is not inside the body at ({:.4g}, {:.4g}, {:.4g}) m of it: its axis "
                          "must lie half "
                          "a diameter, {:.3g} m, below the faces",
                          chain.name, end.x, end.y, end.z, chain.radius()));
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
  return rebar.drawn.empty() ? mat_problems(rebar, host.size) : drawn_problems(rebar, host);
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
          const Nearest near = nearest(p.segments[a], q.segments[b]);
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
