#include "prepare/packing/packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/packing/soft_spheres.hpp"

namespace breccia::prepare {
namespace {

/// Spheres are pushed apart a little further than they need be, so that they end without overlap
/// after finitely many steps.  [-]
constexpr double growth = 1.0 + 0.5 * overlap_tolerance;

constexpr int most_iterations = 6000;
/// Pushing helps no more once the energy falls by less than a hundredth in this many steps.
constexpr int energy_window = 250;
constexpr double energy_fall = 0.01;

/// Newton's iteration from above: the standard library's cube root differs between machines.
double cube_root(double a) {
  double root = std::max(a, 1.0);
  for (;;) {
    const double next = (2.0 * root + a / (root * root)) / 3.0;
    if (!(next < root)) return root;
    root = next;
  }
}

Vec3 random_centre(const PackingTask& task, std::uint64_t index, double r) {
  const Container& c = task.container;
  const Vec3 half = c.half();
  const auto reach = [&](double face, bool open) { return open ? face : face - r; };
  const Vec3 free{reach(half.x, task.periodic[0]), reach(half.y, task.periodic[1]),
                  reach(half.z, task.periodic[2])};
  for (std::uint32_t draw = 1;; draw += 3) {
    const Vec3 p{(2.0 * task.random.uniform(index, draw) - 1.0) * free.x,
                 (2.0 * task.random.uniform(index, draw + 1) - 1.0) * free.y,
                 (2.0 * task.random.uniform(index, draw + 2) - 1.0) * free.z};
    if (c.shape == Container::Shape::box) return p;
    if (c.holds({p.x, p.y, task.periodic[2] ? 0.0 : p.z}, r)) return p;
  }
}

/// Least edge of a periodic cell over the largest radius: no sphere has two images near another.
constexpr double least_cell = 5.0;

}  // namespace

double Container::volume() const {
  switch (shape) {
    case Shape::sphere:
      return 4.0 / 3.0 * pi * radius * radius * radius;
    case Shape::cylinder:
      return pi * radius * radius * length;
    case Shape::box:
      break;
  }
  return size.x * size.y * size.z;
}

Vec3 Container::half() const {
  switch (shape) {
    case Shape::sphere:
      return {radius, radius, radius};
    case Shape::cylinder:
      return {radius, radius, 0.5 * length};
    case Shape::box:
      break;
  }
  return 0.5 * size;
}

std::array<double, 3> Container::depths(const Vec3& p) const {
  if (shape == Shape::sphere) return {radius - norm(p), no_limit, no_limit};
  if (shape == Shape::cylinder)
    return {radius - sqrt(p.x * p.x + p.y * p.y), 0.5 * length - std::abs(p.z), no_limit};
  return {0.5 * size.x - std::abs(p.x), 0.5 * size.y - std::abs(p.y), 0.5 * size.z - std::abs(p.z)};
}

double Container::depth(const Vec3& p) const {
  const auto [x, y, z] = depths(p);
  return std::min({x, y, z});
}

Container container_of(const dem::BodyConfig& body) {
  const auto shape = body.shape == "sphere"     ? Container::Shape::sphere
                     : body.shape == "cylinder" ? Container::Shape::cylinder
                                                : Container::Shape::box;
  return {.shape = shape, .size = body.size, .radius = body.radius, .length = body.length};
}

bool Container::holds(const Vec3& p, double r) const {
  const Vec3 h = half();
  const bool in_box =
      std::abs(p.x) <= h.x - r && std::abs(p.y) <= h.y - r && std::abs(p.z) <= h.z - r;
  if (shape == Shape::box || !in_box) return in_box;
  const Vec3 out{p.x, p.y, shape == Shape::sphere ? p.z : 0.0};
  return dot(out, out) <= (radius - r) * (radius - r);
}

Vec3 from_axis(const Capsule& capsule, const Vec3& point) {
  const Vec3 axis = capsule.b - capsule.a, to = point - capsule.a;
  const double squared = dot(axis, axis);
  const double along = squared > 0.0 ? std::clamp(dot(to, axis) / squared, 0.0, 1.0) : 0.0;
  return to - along * axis;
}

std::vector<double> packing_radii(const PackingTask& task) {
  const auto count = static_cast<std::size_t>(task.count);
  std::vector<double> radius(count);
  double volume = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = (static_cast<double>(i) + task.random.uniform(i)) / task.count;
    radius[i] = task.grading.empty() ? 1.0 + (task.size_ratio - 1.0) * part
                                     : 0.5 * task.grading.diameter_at(part);
    volume += 4.0 / 3.0 * pi * radius[i] * radius[i] * radius[i];
  }
  const double scale = cube_root(task.solid_volume / volume);
  for (double& r : radius) r *= scale;
  return radius;
}

std::string misfit(const PackingTask& task, const std::vector<double>& radius) {
  const Vec3 half = task.container.half();
  const double largest = *std::max_element(radius.begin(), radius.end());
  const double edges[3] = {2.0 * half.x, 2.0 * half.y, 2.0 * half.z};
  for (std::size_t k = 0; k < 3; ++k)
    if (task.periodic[k] && edges[k] < least_cell * growth * largest)
      return fmt::format(
          "{} elements are too few for a periodic cell of {:.4g} m along {}: the largest has a "
          "radius of {:.4g} m, and a cell needs five of them",
          task.count, edges[k], "xyz"[k], largest);
  if (growth * largest <= std::min({half.x, half.y, half.z})) return "";
  return fmt::format("{} elements are too few: one of radius {:.4g} m does not fit into the body",
                     task.count, largest);
}

Packing pack(const PackingTask& task, int threads) {
  std::vector<double> radius = packing_radii(task);
  if (const std::string problem = misfit(task, radius); !problem.empty()) throw InputError(problem);
  std::vector<Vec3> position;
  for (std::size_t i = 0; i < radius.size(); ++i) {
    radius[i] *= growth;
    position.push_back(random_centre(task, i, radius[i]));
  }

  SoftSpheres spheres(task, std::move(position), std::move(radius), threads);
  Packing packing;
  // Grown radii that overlap by less than their growth belong to spheres that do not overlap.
  const double free_of_overlap = 2.0 * (growth - 1.0) / growth;
  double before = 0.0;
  for (; packing.iterations < most_iterations; ++packing.iterations) {
    const bool looks = packing.iterations % energy_window == 0;
    if (spheres.push(looks) <= free_of_overlap) break;
    if (looks) {
      if (packing.iterations > 0 && spheres.energy() > (1.0 - energy_fall) * before) break;
      before = spheres.energy();
    }
    spheres.move();
  }
  if (task.is_periodic()) spheres.wrap();
  packing.position = spheres.position();
  packing.radius = spheres.radius();
  for (double& r : packing.radius) r /= growth;
  packing.overlap = SoftSpheres(task, packing.position, packing.radius).push();
  return packing;
}

}  // namespace breccia::prepare
