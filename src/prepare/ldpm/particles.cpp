#include "prepare/ldpm/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "math/elementary.hpp"

namespace breccia::prepare {
namespace {

constexpr double clearance = 0.2;   ///< of grains, over d_0
constexpr double narrowing = 0.75;  ///< of the clearance, where grains find no place
constexpr double least_clearance = 0.01;
constexpr int tries = 10'000;  ///< of a grain with one clearance

double power(double x, double p) {
  return exponential(p * logarithm(x));
}
int intervals(double length, double spacing) {
  return std::max(1, static_cast<int>(length / spacing + 0.5));
}

/// Cosine and sine of a share of a whole turn: those of the library differ between machines.
struct Turn {
  double cosine, sine;
};
Turn turn_by(double share) {
  // series at an eighth of the angle, |x| < 0.79, doubled three times
  const double x = 2.0 * pi * (share - std::floor(share + 0.5)) / 8.0, x2 = x * x;
  double sine = 0.0, cosine = 0.0;
  for (int k = 21; k > 0; k -= 2) sine = 1.0 - sine * x2 / ((k + 1.0) * (k + 2.0));
  for (int k = 20; k >= 0; k -= 2) cosine = 1.0 - cosine * x2 / ((k + 1.0) * (k + 2.0));
  sine = x * sine;
  for (int k = 0; k < 3; ++k) {
    const double doubled = 2.0 * sine * cosine;
    cosine = cosine * cosine - sine * sine;
    sine = doubled;
  }
  return {cosine, sine};
}

/// Particles by cells as wide as two may need to keep from each other.
class Placed {
 public:
  Placed(const Vec3& half, double reach) : half_(half), reach_(reach) {
    size_[0] = cells(half.x), size_[1] = cells(half.y), size_[2] = cells(half.z);
    cells_.resize(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                  static_cast<std::size_t>(size_[2]));
  }
  void add(const Vec3& at, double radius, bool grain) {
    cells_[index(cell(at.x, half_.x, 0), cell(at.y, half_.y, 1), cell(at.z, half_.z, 2))].push_back(
        {at, radius, grain});
  }
  /// Whether a grain keeps off all that are there.
  bool is_free(const Vec3& at, double radius, double clear) const {
    const int x = cell(at.x, half_.x, 0), y = cell(at.y, half_.y, 1), z = cell(at.z, half_.z, 2);
    for (int i = std::max(0, x - 1); i <= std::min(size_[0] - 1, x + 1); ++i)
      for (int j = std::max(0, y - 1); j <= std::min(size_[1] - 1, y + 1); ++j)
        for (int k = std::max(0, z - 1); k <= std::min(size_[2] - 1, z + 1); ++k)
          for (const Item& item : cells_[index(i, j, k)]) {
            const Vec3 d = at - item.at;
            const double least = radius + item.radius + (item.grain ? clear : 0.0);
            if (dot(d, d) < least * least) return false;
          }
    return true;
  }

 private:
  struct Item {
    Vec3 at;
    double radius;
    bool grain;
  };
  int cells(double half) const { return std::clamp(static_cast<int>(2.0 * half / reach_), 1, 400); }
  int cell(double x, double half, int axis) const {
    return std::clamp(static_cast<int>((x + half) / (2.0 * half) * size_[axis]), 0,
                      size_[axis] - 1);
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>((i * size_[1] + j) * size_[2] + k);
  }
  Vec3 half_;
  double reach_;
  int size_[3];
  std::vector<std::vector<Item>> cells_;
};

/// Nodes of a surface: those of edges are given, those of faces thrown at random, no nearer to
/// others than the spacing, until hardly any more finds a place. No direction is preferred.
class Surface {
 public:
  Surface(const Container& body, double spacing, const Random& random)
      : spacing_(spacing), random_(random), placed_(body.half(), spacing) {}

  void add(const Vec3& at) {
    nodes.push_back(at);
    placed_.add(at, spacing_, false);
  }
  /// Inner nodes of an edge of a length, 1.4 spacings apart and shifted at random: place(share).
  template <class Place>
  void along(double length, const Place& place) {
    const int count = intervals(length, 1.4 * spacing_);
    for (int k = 1; k < count; ++k) add(place((k + 0.2 * (2.0 * draw(0) - 1.0)) / count));
  }
  /// Nodes of a face of an area: place(u, v), uniform for u and v in [0, 1).
  template <class Place>
  void across(double area, const Place& place) {
    const int thrown = static_cast<int>(100.0 * area / (spacing_ * spacing_));
    for (int k = 0; k < thrown; ++k) {
      const double u = draw(0), v = random_.uniform(drawn_, 1);
      const Vec3 at = place(u, v);
      if (placed_.is_free(at, 0.0, 0.0)) add(at);
    }
  }
  std::vector<Vec3> nodes;

 private:
  double draw(std::uint32_t which) { return random_.uniform(++drawn_, which); }

  double spacing_;
  Random random_;
  Placed placed_;
  std::uint64_t drawn_ = 0;
};

std::vector<Vec3> box_nodes(const Vec3& size, Surface surface) {
  const Vec3 h = 0.5 * size;
  const double signs[2] = {-1.0, 1.0};
  for (const double x : signs)
    for (const double y : signs)
      for (const double z : signs) surface.add({x * h.x, y * h.y, z * h.z});
  const auto at = [](double share, double half) { return (2.0 * share - 1.0) * half; };
  for (const double p : signs)
    for (const double q : signs) {
      surface.along(size.x, [&](double s) { return Vec3{at(s, h.x), p * h.y, q * h.z}; });
      surface.along(size.y, [&](double s) { return Vec3{p * h.x, at(s, h.y), q * h.z}; });
      surface.along(size.z, [&](double s) { return Vec3{p * h.x, q * h.y, at(s, h.z)}; });
    }
  for (const double p : signs) {
    surface.across(size.y * size.z, [&](double u, double v) {
      return Vec3{p * h.x, at(u, h.y), at(v, h.z)};
    });
    surface.across(size.x * size.z, [&](double u, double v) {
      return Vec3{at(u, h.x), p * h.y, at(v, h.z)};
    });
    surface.across(size.x * size.y, [&](double u, double v) {
      return Vec3{at(u, h.x), at(v, h.y), p * h.z};
    });
  }
  return surface.nodes;
}

std::vector<Vec3> cylinder_nodes(double radius, double length, Surface surface) {
  const double h = 0.5 * length;
  const auto around = [&](double share, double r, double z) {
    const Turn t = turn_by(share);
    return Vec3{r * t.cosine, r * t.sine, z};
  };
  for (const double z : {-h, h}) {
    surface.add(around(0.0, radius, z));
    surface.along(2.0 * pi * radius, [&](double s) { return around(s, radius, z); });
  }
  surface.across(2.0 * pi * radius * length,
                 [&](double u, double v) { return around(u, radius, (2.0 * v - 1.0) * h); });
  for (const double z : {-h, h})
    surface.across(pi * radius * radius,
                   [&](double u, double v) { return around(u, sqrt(v) * radius, z); });
  return surface.nodes;
}

/// Whether the cube around a grain lies inside.
bool holds_cube(const Container& body, const Vec3& at, double radius) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 of{(corner & 1) != 0 ? radius : -radius, (corner & 2) != 0 ? radius : -radius,
                  (corner & 4) != 0 ? radius : -radius};
    if (!body.holds(at + of, 0.0)) return false;
  }
  return true;
}

bool keeps_off(const std::vector<Capsule>& bars, const Vec3& at, double radius) {
  for (const Capsule& bar : bars)
    if (norm(from_axis(bar, at)) < radius + bar.radius) return false;
  return true;
}
/// Of cylinders between the ends of axes.  [m3]
double volume_of(const std::vector<Capsule>& bars) {
  double volume = 0.0;
  for (const Capsule& bar : bars) volume += pi * bar.radius * bar.radius * norm(bar.b - bar.a);
  return volume;
}

}  // namespace

double MixDesign::aggregate() const {
  return 1.0 - cement / cement_density - water_ratio * cement / 1000.0 - air;
}
double MixDesign::placed() const {
  if (!curve.empty()) return (curve.passes(largest) - curve.passes(smallest)) * aggregate();
  return (1.0 - power(smallest / largest, fuller)) * aggregate();
}

double cement_of(double density, double water_ratio, double aggregate_ratio) {
  return density / (1.0 + water_ratio + aggregate_ratio);
}

std::vector<double> grain_diameters(const MixDesign& mix, double volume, const Random& random) {
  const double wanted = mix.placed() * volume, q = 3.0 - mix.fuller;
  const double span = 1.0 - power(mix.smallest / mix.largest, q);
  const Grading part = mix.curve.empty() ? Grading{} : mix.curve.part(mix.smallest, mix.largest);
  std::vector<double> diameters;
  double filled = 0.0;
  for (std::uint64_t k = 0;; ++k) {
    const double p = random.uniform(k);
    const double d =
        part.empty() ? mix.smallest * power(1.0 - p * span, -1.0 / q) : part.diameter_at(p);
    filled += pi / 6.0 * d * d * d;
    if (filled > wanted) break;
    diameters.push_back(d);
  }
  std::sort(diameters.begin(), diameters.end(), std::greater<>());
  return diameters;
}

std::vector<Vec3> surface_nodes(const Container& body, double spacing, const Random& random) {
  switch (body.shape) {
    case Container::Shape::box:
      return box_nodes(body.size, {body, spacing, random});
    case Container::Shape::cylinder:
      return cylinder_nodes(body.radius, body.length, {body, spacing, random});
    case Container::Shape::sphere:
      break;
  }
  throw InputError("bodies of law ldpm are boxes or cylinders");
}

LdpmParticles place_particles(const Container& body, const MixDesign& mix, const Random& random,
                              const std::vector<Capsule>& bars) {
  const Random of_nodes{random.seed, random.stream + 0x10000U};
  const Random of_places{random.seed, random.stream + 0x20000U};
  LdpmParticles all;
  all.position = surface_nodes(body, mix.smallest, of_nodes);
  all.on_surface = static_cast<Index>(all.position.size());
  all.diameter.assign(all.position.size(), 0.0);

  const std::vector<double> diameters =
      grain_diameters(mix, body.volume() - volume_of(bars), random);
  double clear = clearance * mix.smallest;
  const Vec3 half = body.half();
  Placed placed(half, mix.largest + clear);
  for (const Vec3& node : all.position)
    placed.add(node, 0.5 * surface_diameter * mix.smallest, false);
  std::uint64_t tried = 0;
  for (const double d : diameters) {
    const double radius = 0.5 * d;
    Vec3 at{};
    std::uint64_t last = tried + tries;
    do {
      if (tried == last) {
        clear *= narrowing;
        last += tries;
      }
      if (clear < least_clearance * mix.smallest)
        throw InputError(fmt::format(
            "no place for a grain of {:.4g} m after {} of {} others: a smaller share "
            "of aggregate or a larger body is needed",
            d, all.position.size() - static_cast<std::size_t>(all.on_surface), diameters.size()));
      at = {(2.0 * of_places.uniform(tried, 0) - 1.0) * half.x,
            (2.0 * of_places.uniform(tried, 1) - 1.0) * half.y,
            (2.0 * of_places.uniform(tried, 2) - 1.0) * half.z};
      ++tried;
    } while (!holds_cube(body, at, radius) || !placed.is_free(at, radius, clear) ||
             !keeps_off(bars, at, radius));
    placed.add(at, radius, true);
    all.position.push_back(at);
    all.diameter.push_back(d);
  }
  return all;
}

}  // namespace breccia::prepare
