#include "prepare/meshing/heterogeneity.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "math/constants.hpp"

namespace breccia::prepare {
namespace {

std::int64_t cell_of(double x, double edge) {
  return static_cast<std::int64_t>(std::floor(x / edge));
}

/// Visits squares of a lattice through the whole plane, from `below` before that of a place to
/// `above` behind it: each with a number of its own, and its lower corner over the edge.
template <class Visit>
void cells_near(const Vec2& place, double edge, int below, int above, const Visit& visit) {
  const std::int64_t i0 = cell_of(place.x, edge), j0 = cell_of(place.y, edge);
  for (std::int64_t i = i0 - below; i <= i0 + above; ++i)
    for (std::int64_t j = j0 - below; j <= j0 + above; ++j)
      visit((static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32) |
                static_cast<std::uint32_t>(j),
            Vec2{static_cast<double>(i), static_cast<double>(j)});
}
/// Numbers of the cubes of a lattice through all space, which repeat after 2^21 cubes.
template <class Visit>
void cells_near(const Vec3& place, double edge, int below, int above, const Visit& visit) {
  const std::int64_t i0 = cell_of(place.x, edge), j0 = cell_of(place.y, edge),
                     k0 = cell_of(place.z, edge);
  const auto bits = [](std::int64_t n) { return static_cast<std::uint64_t>(n) & 0x1fffffU; };
  for (std::int64_t i = i0 - below; i <= i0 + above; ++i)
    for (std::int64_t j = j0 - below; j <= j0 + above; ++j)
      for (std::int64_t k = k0 - below; k <= k0 + above; ++k)
        visit((bits(i) << 42) | (bits(j) << 21) | bits(k),
              Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
}

/// A place in a square or cube, in its edges.
void draw_in_cell(const Random& random, std::uint64_t key, Vec2& place) {
  place = {random.uniform(key, 0), random.uniform(key, 1)};
}
void draw_in_cell(const Random& random, std::uint64_t key, Vec3& place) {
  place = {random.uniform(key, 0), random.uniform(key, 1), random.uniform(key, 3)};
}

/// Standard normal, by Box and Muller.
double normal(const Random& random, std::uint64_t index) {
  const double u = 1.0 - random.uniform(index, 0), v = random.uniform(index, 1);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * pi * v);
}

/// A Gaussian field of variance 1 and correlation exp(-r^2 / length^2): normals on a lattice,
/// weighted by exp(-2 r^2 / length^2).
class GaussianField {
 public:
  GaussianField(double length, const Random& random) : length_(length), random_(random) {}

  template <class Place>
  double at(const Place& place) {
    const double edge = 0.5 * length_;
    double sum = 0.0, squares = 0.0;
    cells_near(place, edge, 3, 4, [&](std::uint64_t key, const Place& cell) {
      const Place away = place - edge * cell;
      const double weight = std::exp(-2.0 * dot(away, away) / (length_ * length_));
      sum += weight * node(key);
      squares += weight * weight;
    });
    return sum / std::sqrt(squares);
  }

 private:
  double node(std::uint64_t key) {
    const auto [found, is_new] = nodes_.try_emplace(key, 0.0);
    if (is_new) found->second = normal(random_, key);
    return found->second;
  }

  double length_;
  Random random_;
  std::unordered_map<std::uint64_t, double> nodes_;
};

template <class Place>
std::vector<std::uint64_t> grains_at(const std::vector<Place>& places, double size,
                                     const Random& random) {
  std::vector<std::uint64_t> grains;
  grains.reserve(places.size());
  for (const Place& place : places) {
    double least = 1e300;
    std::uint64_t nearest = 0;
    // The seed of the place's own cell is at most its diagonal away: two cells reach further.
    cells_near(place, size, 2, 2, [&](std::uint64_t key, const Place& cell) {
      Place within{};
      draw_in_cell(random, key, within);
      const Place away = place - size * (cell + within);
      if (dot(away, away) < least) {
        least = dot(away, away);
        nearest = key;
      }
    });
    grains.push_back(nearest);
  }
  return grains;
}

template <class Place>
std::vector<float> factors_at(const std::vector<Place>& places, double modulus, double length,
                              const Random& random) {
  const double mean = std::tgamma(1.0 + 1.0 / modulus);
  std::vector<float> factors;
  factors.reserve(places.size());
  GaussianField field(length, random);
  for (std::size_t k = 0; k < places.size(); ++k) {
    // -ln U with U = 1 - Phi(g) = erfc(g / sqrt 2) / 2: strong where the field is high.
    const double u = length > 0.0 ? 0.5 * std::erfc(field.at(places[k]) * std::sqrt(0.5))
                                  : 1.0 - random.uniform(k, 0);
    const double minus_log = -std::log(std::max(u, 1e-300));
    factors.push_back(
        static_cast<float>(std::pow(std::max(minus_log, 1e-12), 1.0 / modulus) / mean));
  }
  return factors;
}

}  // namespace

std::vector<std::uint64_t> voronoi_grains(const std::vector<Vec2>& places, double size,
                                          const Random& random) {
  return grains_at(places, size, random);
}
std::vector<std::uint64_t> voronoi_grains(const std::vector<Vec3>& places, double size,
                                          const Random& random) {
  return grains_at(places, size, random);
}

std::vector<int> minerals_by_share(const std::vector<double>& areas,
                                   const std::vector<std::uint64_t>& keys,
                                   const std::vector<double>& shares, const Random& random) {
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(areas.size());
  for (std::size_t k = 0; k < areas.size(); ++k) order.emplace_back(random.uniform(keys[k], 2), k);
  std::sort(order.begin(), order.end());
  std::vector<int> minerals(areas.size());
  std::vector<double> given(shares.size());
  double total = 0.0;
  for (const auto& [draw, k] : order) {
    total += areas[k];
    std::size_t neediest = 0;
    for (std::size_t m = 1; m < shares.size(); ++m)
      if (shares[m] * total - given[m] > shares[neediest] * total - given[neediest]) neediest = m;
    given[neediest] += areas[k];
    minerals[k] = static_cast<int>(neediest);
  }
  return minerals;
}

std::vector<int> minerals_by_picture(const std::vector<Vec2>& places, const Image& picture,
                                     const Vec2& low, const Vec2& high,
                                     const std::vector<std::array<int, 3>>& colors) {
  std::vector<int> minerals;
  minerals.reserve(places.size());
  for (const Vec2& place : places) {
    const auto pixel = [](double share, int pixels) {
      return static_cast<std::size_t>(std::clamp(static_cast<int>(share * pixels), 0, pixels - 1));
    };
    const std::size_t column = pixel((place.x - low.x) / (high.x - low.x), picture.width),
                      row = pixel((high.y - place.y) / (high.y - low.y), picture.height);
    const std::size_t first = 3 * (row * static_cast<std::size_t>(picture.width) + column);
    int nearest = 0, least = 1 << 30;
    for (std::size_t m = 0; m < colors.size(); ++m) {
      int away = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const int d = colors[m][c] - picture.rgb[first + c];
        away += d * d;
      }
      if (away < least) {
        least = away;
        nearest = static_cast<int>(m);
      }
    }
    minerals.push_back(nearest);
  }
  return minerals;
}

std::vector<float> weibull_factors(const std::vector<Vec2>& places, double modulus, double length,
                                   const Random& random) {
  return factors_at(places, modulus, length, random);
}
std::vector<float> weibull_factors(const std::vector<Vec3>& places, double modulus, double length,
                                   const Random& random) {
  return factors_at(places, modulus, length, random);
}

}  // namespace breccia::prepare
