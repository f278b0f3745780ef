#include "core/emission.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "core/pieces.hpp"

namespace breccia {
namespace {

/// Eigenvalues of a symmetric matrix, by the angle of its invariants.
struct Eigenvalues {
  double at[3];
  explicit Eigenvalues(const Sym3& m) {
    const double mean = trace(m) / 3.0;
    const Sym3 d{m.xx - mean, m.yy - mean, m.zz - mean, m.yz, m.xz, m.xy};
    const double second = 0.5 * contract(d, d), radius = std::sqrt(second / 3.0);
    const double third = d.xx * (d.yy * d.zz - d.yz * d.yz) - d.xy * (d.xy * d.zz - d.yz * d.xz) +
                         d.xz * (d.xy * d.yz - d.yy * d.xz);
    const double cube = radius * radius * radius;
    const double cosine = cube > 0.0 ? std::clamp(0.5 * third / cube, -1.0, 1.0) : 1.0;
    const double angle = std::acos(cosine) / 3.0, turn = 2.0 * std::acos(-1.0) / 3.0;
    for (int k = 0; k < 3; ++k) at[k] = mean + 2.0 * radius * std::cos(angle + k * turn);
  }
};

using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

void add(Sym3& sum, const Sym3& m) {
  sum.xx += m.xx;
  sum.yy += m.yy;
  sum.zz += m.zz;
  sum.yz += m.yz;
  sum.xz += m.xz;
  sum.xy += m.xy;
}

}  // namespace

double EmissionEvent::scalar() const {
  return std::sqrt(0.5 * contract(moment, moment));
}
double EmissionEvent::magnitude() const {
  return 2.0 / 3.0 * (std::log10(std::max(scalar(), 1e-30)) - 9.1);
}
double EmissionEvent::isotropic() const {
  const double all = trace(moment);
  double rest = 0.0;
  for (const double m : Eigenvalues(moment).at) rest += std::abs(m - all / 3.0);
  return std::abs(all) + rest > 0.0 ? all / (std::abs(all) + rest) : 0.0;
}

std::vector<EmissionEvent> events_of(const std::vector<Break>& breaks, double distance,
                                     double window) {
  std::vector<std::size_t> order(breaks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return breaks[a].time < breaks[b].time; });
  const auto cell_of = [&](const Vec3& x) {
    const auto along = [&](double value) {
      return static_cast<std::int64_t>(std::floor(value / distance));
    };
    return Cell{along(x.x), along(x.y), along(x.z)};
  };
  Pieces pieces(breaks.size());
  std::map<Cell, std::vector<std::size_t>> cells;  // by time
  for (const std::size_t i : order) {
    const Cell here = cell_of(breaks[i].place);
    for (int k = 0; k < 27; ++k) {
      const auto found =
          cells.find({std::get<0>(here) + k % 3 - 1, std::get<1>(here) + k / 3 % 3 - 1,
                      std::get<2>(here) + k / 9 - 1});
      if (found == cells.end()) continue;
      for (auto j = found->second.rbegin(); j != found->second.rend(); ++j) {
        if (breaks[i].time - breaks[*j].time > window) break;
        if (norm(breaks[i].place - breaks[*j].place) <= distance)
          pieces.join(static_cast<Index>(i), static_cast<Index>(*j));
      }
    }
    cells[here].push_back(i);
  }
  std::map<Index, std::size_t> number;  // of the event of each root
  std::vector<EmissionEvent> events;
  std::vector<double> weight;
  for (const std::size_t i : order) {
    const Break& b = breaks[i];
    const auto [place, is_new] = number.emplace(pieces.root(static_cast<Index>(i)), events.size());
    if (is_new) {
      events.emplace_back();
      events.back().time = b.time;
      weight.push_back(0.0);
    }
    EmissionEvent& event = events[place->second];
    const double size = std::max(std::sqrt(contract(b.moment, b.moment)), 1e-30);
    event.duration = b.time - event.time;
    event.place += size * b.place;
    event.breaks += 1;
    event.energy += b.energy;
    add(event.moment, b.moment);
    weight[place->second] += size;
  }
  for (std::size_t k = 0; k < events.size(); ++k)
    events[k].place = (1.0 / weight[k]) * events[k].place;
  return events;
}

std::optional<Frequency> frequency_of(const std::vector<double>& magnitudes) {
  constexpr std::int64_t least = 20;
  std::map<std::int64_t, std::int64_t> bins;
  for (const double m : magnitudes) ++bins[static_cast<std::int64_t>(std::floor(10.0 * m))];
  if (bins.empty()) return {};
  const auto most = std::max_element(
      bins.begin(), bins.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  Frequency f{0, 0.1 * static_cast<double>(most->first), 0.0, 0.0};
  double sum = 0.0, squares = 0.0;
  const auto each = [&](const auto& visit) {
    for (const double m : magnitudes)
      if (std::floor(10.0 * m) >= static_cast<double>(most->first)) visit(m);
  };
  each([&](double m) {
    sum += m;
    ++f.count;
  });
  if (f.count < least) return {};
  const auto n = static_cast<double>(f.count);
  const double mean = sum / n;
  if (!(mean > f.completeness)) return {};
  each([&](double m) { squares += (m - mean) * (m - mean); });
  f.b = std::log10(std::exp(1.0)) / (mean - f.completeness);
  f.deviation = 2.30 * f.b * f.b * std::sqrt(squares / (n * (n - 1.0)));
  return f;
}

}  // namespace breccia
