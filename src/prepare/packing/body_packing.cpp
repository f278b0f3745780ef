#include "prepare/packing/body_packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "exec/error.hpp"
#include "exec/tasks.hpp"
#include "math/constants.hpp"

namespace breccia::prepare {
namespace {

using dem::BodyConfig;
using dem::PackConfig;

std::array<bool, 3> periodic_axes(const PackConfig& pack) {
  const auto has = [&](const char* axis) {
    return std::find(pack.periodic.begin(), pack.periodic.end(), axis) != pack.periodic.end();
  };
  return {has("x"), has("y"), has("z")};
}

Grading grading_of(const PackConfig& pack) {
  return {pack.sieves, pack.passing};
}

/// Whether the body is repeated, or cut from a cell that is larger or of another shape.
bool is_cut(const BodyConfig& body) {
  const auto periodic = periodic_axes(body.pack);
  const Vec3& c = body.pack.cell;
  return c.x > 0.0 || c.y > 0.0 || c.z > 0.0 || (body.shape != "box" && periodic[0]);
}

/// The cell of a body: its own shape, but a box around it where its round faces are cut.
Container cell_of(const BodyConfig& body) {
  Container cell = container_of(body);
  const Vec3 half = cell.half(), asked = body.pack.cell;
  const Vec3 edges{asked.x > 0.0 ? asked.x : 2.0 * half.x, asked.y > 0.0 ? asked.y : 2.0 * half.y,
                   asked.z > 0.0 ? asked.z : 2.0 * half.z};
  if (cell.shape == Container::Shape::box || periodic_axes(body.pack)[0])
    return {.shape = Container::Shape::box, .size = edges};
  cell.length = edges.z;
  return cell;
}

/// Elements of a repeated cell whose centres lie in the body.
class Cutter {
 public:
  explicit Cutter(const BodyConfig& body)
      : container_(container_of(body)), periodic_(periodic_axes(body.pack)) {}

  bool holds(const Vec3& x) const {
    const Vec3 half = container_.half();
    const auto within = [](double at, double face, bool open) {
      return !open || (at >= -face && at < face);
    };
    if (!within(x.x, half.x, periodic_[0]) || !within(x.y, half.y, periodic_[1]) ||
        !within(x.z, half.z, periodic_[2]))
      return false;
    if (container_.shape == Container::Shape::box || !periodic_[0]) return true;
    const Vec3 out{x.x, x.y, container_.shape == Container::Shape::sphere ? x.z : 0.0};
    return dot(out, out) <= container_.radius * container_.radius;
  }
  /// Copies of a cell on each side that cover the body.
  int copies(double edge, double face, bool open) const {
    return open ? static_cast<int>(std::max(0.0, std::ceil((face - 0.5 * edge) / edge))) : 0;
  }

  BodyPacking cut(const Packing& packed, const Container& cell, double volume, int threads) const {
    const Vec3 edge = 2.0 * cell.half(), half = container_.half();
    const int nx = copies(edge.x, half.x, periodic_[0]), ny = copies(edge.y, half.y, periodic_[1]),
              nz = copies(edge.z, half.z, periodic_[2]);
    const int rows = 2 * ny + 1, columns = 2 * nz + 1, cells = (2 * nx + 1) * rows * columns;
    const auto place = [&](int copy, std::size_t e) {
      const int i = copy / (rows * columns) - nx, j = copy / columns % rows - ny;
      const int k = copy % columns - nz;
      return packed.position[e] + Vec3{i * edge.x, j * edge.y, k * edge.z};
    };
    std::vector<std::size_t> first(static_cast<std::size_t>(cells) + 1, 0);  // of each copy
    for_each_task(threads, cells, [&](int copy) {
      for (std::size_t e = 0; e < packed.position.size(); ++e)
        if (holds(place(copy, e))) ++first[static_cast<std::size_t>(copy) + 1];
    });
    std::partial_sum(first.begin(), first.end(), first.begin());
    if (first.back() > at(std::numeric_limits<Index>::max()))
      throw InputError("a body holds at most 2,147,483,647 elements");
    BodyPacking body;
    body.position.resize(first.back());
    body.radius.resize(first.back());
    for_each_task(threads, cells, [&](int copy) {
      std::size_t to = first[static_cast<std::size_t>(copy)];
      for (std::size_t e = 0; e < packed.position.size(); ++e) {
        const Vec3 x = place(copy, e);
        if (!holds(x)) continue;
        body.position[to] = x;
        body.radius[to++] = packed.radius[e];
      }
    });
    double solid = 0.0;
    for (const double r : body.radius) solid += 4.0 / 3.0 * pi * r * r * r;
    body.compactness = solid / volume;
    return body;
  }

 private:
  Container container_;
  std::array<bool, 3> periodic_;
};

}  // namespace

double compactness_of(const PackConfig& pack) {
  return pack.porosity > 0.0 ? 1.0 - pack.porosity : pack.compactness;
}

double elements_in(const PackConfig& pack, double volume) {
  if (pack.sieves.empty()) return pack.count;
  const Grading grading = grading_of(pack);
  if (!grading.problem().empty()) return 0.0;
  return std::round(compactness_of(pack) * volume / grading.mean_volume());
}

PackingTask packing_task(const BodyConfig& body, const std::vector<Capsule>& bars,
                         double bars_volume, const Random& random) {
  const PackConfig& pack = body.pack;
  PackingTask task{.container = cell_of(body),
                   .obstacles = bars,
                   .count = pack.count,
                   .size_ratio = pack.size_ratio,
                   .solid_volume = 0.0,
                   .random = random,
                   .periodic = periodic_axes(pack),
                   .grading = grading_of(pack)};
  const double volume = task.container.volume() - bars_volume;
  task.solid_volume = compactness_of(pack) * volume;
  double count = elements_in(pack, volume);
  if (pack.sieves.empty() && is_cut(body))
    count = std::round(count * volume / container_of(body).volume());
  task.count = static_cast<int>(std::clamp(count, 1.0, 2e9));
  return task;
}

std::vector<std::string> pack_problems(const BodyConfig& body) {
  const PackConfig& pack = body.pack;
  std::vector<std::string> problems;
  const auto require = [&](bool holds, const std::string& text) {
    if (!holds) problems.push_back(text);
  };
  if (pack.sieves.empty() && pack.passing.empty()) {
    require(pack.count >= 1, ".count is missing: how many elements fill the body?");
  } else {
    const std::string problem = grading_of(pack).problem();
    require(problem.empty(), problem);
    require(pack.count == 0,
            ".count and .sieves are both given: the sizes of the sieves say how "
            "many elements fill the body");
  }
  require(pack.porosity == 0.0 || pack.compactness == PackConfig{}.compactness,
          ".porosity and .compactness are both given: leave one out; porosity is 1 less "
          "compactness, without overlaps");
  require(pack.porosity == 0.0 || pack.porosity >= 0.15,
          fmt::format(".porosity = {:.4g} is below 0.15, which no packing reaches", pack.porosity));
  for (const std::string& axis : pack.periodic)
    require(axis == "x" || axis == "y" || axis == "z",
            fmt::format(".periodic: {:?} is none of x, y, z", axis));
  const auto periodic = periodic_axes(pack);
  const bool all = periodic[0] && periodic[1] && periodic[2];
  const bool any = periodic[0] || periodic[1] || periodic[2];
  require(
      !any || all || (body.shape != "sphere" && body.shape != "stl"),
      fmt::format(".periodic: a body of shape {} is cut from a cell that is periodic along x, y "
                  "and z",
                  body.shape));
  require(body.shape != "cylinder" || periodic[0] == periodic[1],
          ".periodic: the round face of a cylinder is cut along x and y together");
  for (int k = 0; k < 3; ++k)
    require(!(component(pack.cell, k) > 0.0) || periodic[static_cast<std::size_t>(k)],
            fmt::format(".cell has a length along {0}, but .periodic does not name {0}", "xyz"[k]));
  return problems;
}

BodyPacking pack_body(const BodyConfig& body, const std::vector<Capsule>& bars, double bars_volume,
                      const Random& random, int threads) {
  const PackingTask task = packing_task(body, bars, bars_volume, random);
  if (const std::string problem = misfit(task, packing_radii(task)); !problem.empty())
    throw InputError(fmt::format("body.{}.pack.{}: {}", body.name,
                                 body.pack.sieves.empty() ? "count" : "sieves", problem));
  const Packing packing = pack(task, threads);
  if (body.pack.porosity > 0.0 && packing.overlap > overlap_tolerance)
    throw InputError(fmt::format(
        "body.{}.pack.porosity = {:.4g} is not reached: pushed apart as far as they go, elements "
        "still overlap by up to {:.3g} of the smaller radius ({:.3g} are allowed)\n"
        "  ask for more pores, or for sizes that spread wider; random packings of spheres of one "
        "size have 0.37 at least",
        body.name, body.pack.porosity, packing.overlap, overlap_tolerance));
  if (!is_cut(body))
    return {{packing.position.begin(), packing.position.end()},
            {packing.radius.begin(), packing.radius.end()},
            compactness_of(body.pack)};
  BodyPacking cut = Cutter(body).cut(packing, task.container, container_of(body).volume(), threads);
  if (cut.position.empty())
    throw InputError(fmt::format(
        "body.{}.pack: no element of the cell has its centre in the body; it needs more elements",
        body.name));
  return cut;
}

}  // namespace breccia::prepare
