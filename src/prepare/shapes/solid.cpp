#include "prepare/shapes/solid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace breccia::prepare {
namespace {

/// Narrows a span to where value + slope t lies within +-half.
void narrow(double value, double slope, double half, Solid::Span& span) {
  if (slope == 0.0) {
    if (std::abs(value) > half) span = {};
    return;
  }
  const double one = (-half - value) / slope, other = (half - value) / slope;
  span.low = std::max(span.low, std::min(one, other));
  span.high = std::min(span.high, std::max(one, other));
}

/// Narrows a span to where |start + t along| is at most the radius.
void narrow_round(const Vec3& start, const Vec3& along, double radius, Solid::Span& span) {
  const double squared = dot(along, along), middle = -dot(start, along);
  const double off = dot(start, start) - radius * radius;
  if (!(squared > 0.0)) {
    if (off > 0.0) span = {};
    return;
  }
  const double under = middle * middle - squared * off;
  if (under < 0.0) {
    span = {};
    return;
  }
  const double root = std::sqrt(under);
  span.low = std::max(span.low, (middle - root) / squared);
  span.high = std::min(span.high, (middle + root) / squared);
}

std::vector<Solid> solids_of(const dem::BodyConfig& body) {
  std::vector<Solid> solids{{container_of(body), body.center, frame_of(body.axis, body.across)}};
  for (const dem::CutConfig& join : body.joins) solids.push_back(solid_of(join));
  return solids;
}

}  // namespace

Frame3 frame_of(const Vec3& axis, const Vec3& across) {
  const double length = norm(axis);
  const Vec3 z = (1.0 / length) * axis;
  if (norm(across) > 0.0) {
    const Vec3 aside = across - dot(across, z) * z;
    const Vec3 x = (1.0 / norm(aside)) * aside;
    return {x, cross(z, x), z};
  }
  const double aside = z.x * z.x + z.y * z.y;
  if (z.z < 0.0 && aside == 0.0) return {{1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, z};
  // Rodrigues' formula about the cross product of the old z and the new; 1 - z^2 = x^2 + y^2.
  const double share = z.z < 0.0 ? (1.0 - z.z) / aside : 1.0 / (1.0 + z.z);
  return {{1.0 - share * z.x * z.x, -share * z.x * z.y, -z.x},
          {-share * z.x * z.y, 1.0 - share * z.y * z.y, -z.y},
          z};
}

Solid solid_of(const dem::CutConfig& config) {
  const auto shape = config.shape == "sphere"     ? Container::Shape::sphere
                     : config.shape == "cylinder" ? Container::Shape::cylinder
                                                  : Container::Shape::box;
  return {{.shape = shape, .size = config.size, .radius = config.radius, .length = config.length},
          config.center,
          frame_of(config.axis, config.across)};
}

Vec3 half_around(const Frame3& frame, const Vec3& half) {
  const auto along = [&](double x, double y, double z) {
    return std::abs(x) * half.x + std::abs(y) * half.y + std::abs(z) * half.z;
  };
  return {along(frame.x.x, frame.y.x, frame.z.x), along(frame.x.y, frame.y.y, frame.z.y),
          along(frame.x.z, frame.y.z, frame.z.z)};
}

Vec3 Solid::half() const {
  const Vec3 own = container.half();
  return container.shape == Container::Shape::sphere ? own : half_around(frame, own);
}

Solid::Span Solid::span(const Vec3& a, const Vec3& b) const {
  const Vec3 from = frame.in(a - center), along = frame.in(b - a), half = container.half();
  Span span{0.0, 1.0};
  if (container.shape == Container::Shape::box) {
    narrow(from.x, along.x, half.x, span);
    narrow(from.y, along.y, half.y, span);
    narrow(from.z, along.z, half.z, span);
    return span;
  }
  const bool ball = container.shape == Container::Shape::sphere;
  if (!ball) narrow(from.z, along.z, half.z, span);
  narrow_round({from.x, from.y, ball ? from.z : 0.0}, {along.x, along.y, ball ? along.z : 0.0},
               container.radius, span);
  return span;
}

Union::Union(std::vector<Solid> solids) : solids_(std::move(solids)) {
  low_ = solids_[0].center - solids_[0].half();
  high_ = solids_[0].center + solids_[0].half();
  for (const Solid& solid : solids_) {
    const Vec3 low = solid.center - solid.half(), high = solid.center + solid.half();
    low_ = {std::min(low_.x, low.x), std::min(low_.y, low.y), std::min(low_.z, low.z)};
    high_ = {std::max(high_.x, high.x), std::max(high_.y, high.y), std::max(high_.z, high.z)};
  }
}
Union::Union(const dem::BodyConfig& body) : Union(solids_of(body)) {}

double Union::volume() const {
  // Multiples of powers of 1/g, g^4 = g + 1, modulo 1: no plane holds more than its share of them.
  constexpr int points = 1'000'000;
  constexpr double step = 1.0 / 1.22074408460575947536;
  const Vec3 size = high_ - low_;
  const auto part = [](double x) { return x - std::floor(x); };
  int within = 0;
  for (int i = 1; i <= points; ++i) {
    const Vec3 at{low_.x + part(i * step) * size.x, low_.y + part(i * step * step) * size.y,
                  low_.z + part(i * step * step * step) * size.z};
    within += depth(at) > 0.0 ? 1 : 0;
  }
  return size.x * size.y * size.z * within / points;
}

double Union::depth(const Vec3& point) const {
  double deepest = solids_[0].depth(point);
  for (const Solid& solid : solids_) deepest = std::max(deepest, solid.depth(point));
  return deepest;
}

bool Union::parts(const Vec3& a, const Vec3& b) const {
  std::vector<std::pair<double, double>> spans;
  for (const Solid& solid : solids_)
    if (const Solid::Span span = solid.span(a, b); span.low <= span.high)
      spans.emplace_back(span.low, span.high);
  std::sort(spans.begin(), spans.end());
  constexpr double rounding = 1e-9;
  double reached = 0.0;
  for (const auto& [low, high] : spans) {
    if (low > reached + rounding) return true;
    reached = std::max(reached, high);
  }
  return reached < 1.0 - rounding;
}

}  // namespace breccia::prepare
