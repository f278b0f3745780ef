#include "fdem/fluid/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace breccia::fdem {
namespace {

/// Cracks that meet at places, of which the source is the first. All sums go over cracks in their
/// order, so that every machine gets the same bits.
class Network {
 public:
  Network(std::vector<FlowCell>& cells, const FlowSource& source, double viscosity)
      : cells_(cells), source_(source), has_outlet_(!source.outlet.empty()) {
    list_places();
    for (const FlowCell& c : cells) {
      passes_.push_back(c.aperture * c.aperture * c.aperture / (6.0 * viscosity * c.length));
      full_.push_back(c.fluid >= c.room() ? 1 : 0);
      before_.push_back(c.bulk * (c.fluid / c.room() - 1.0));
      own_.push_back(c.pressure());
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (const std::size_t place : at_[i]) sum_[place] += passes_[i];
    source_sum_ = sum_[0];
  }
  Flowed run(double span) {
    if (span > 0.0) {
      do solve(span);
      while (fills_more(span));
    }
    const std::vector<double> there = with_source(at_places(own_));
    Flowed done;
    for (std::size_t i = 0; i < cells_.size() && span > 0.0; ++i)
      for (const std::size_t place : at_[i]) {
        const double in = span * (passes_[i] * (there[place] - own_[i]));
        cells_[i].fluid += in;
        if (place == 0) done.injected += in;
        if (has_outlet_ && place == 1) done.released -= in;
      }
    done.pressure = there[0];
    return done;
  }

 private:
  void list_places() {
    std::vector<Index> others;
    const auto is_in = [](const std::vector<Index>& all, Index v) {
      return std::binary_search(all.begin(), all.end(), v);
    };
    const auto is_source = [&](Index v) {
      return is_in(source_.vertices, v) || is_in(source_.outlet, v);
    };
    const std::size_t first = has_outlet_ ? 2 : 1;
    for (const FlowCell& c : cells_)
      for (const Index v : {c.from, c.to})
        if (!is_source(v)) others.push_back(v);
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    const auto place = [&](Index v) -> std::size_t {
      if (is_source(v)) return is_in(source_.vertices, v) ? 0 : 1;
      return first + static_cast<std::size_t>(std::lower_bound(others.begin(), others.end(), v) -
                                              others.begin());
    };
    for (const FlowCell& c : cells_) at_.push_back({place(c.from), place(c.to)});
    sum_.resize(others.size() + first);
  }
  /// Pressures of places by those of cracks, without what the source gives.
  std::vector<double> at_places(const std::vector<double>& own) const {
    std::vector<double> there(sum_.size(), 0.0);
    for (std::size_t i = 0; i < cells_.size(); ++i)
      for (const std::size_t place : at_[i]) there[place] += passes_[i] * own[i];
    for (std::size_t k = 0; k < there.size(); ++k)
      there[k] = sum_[k] > 0.0 ? there[k] / sum_[k] : 0.0;
    if (!source_.by_rate) there[0] = 0.0;
    if (has_outlet_) there[1] = 0.0;
    return there;
  }
  std::vector<double> with_source(std::vector<double> there) const {
    if (!source_.by_rate)
      there[0] = source_.given;
    else if (source_sum_ > 0.0)
      there[0] += source_.given / source_sum_;
    if (has_outlet_) there[1] = source_.outlet_pressure;
    return there;
  }

  /// Lets cracks have a pressure that get more in this step than they have room for. What comes in
  /// then only grows elsewhere, so none of them has to give it back.
  bool fills_more(double span) {
    const std::vector<double> there = with_source(at_places(own_));
    bool more = false;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (full_[i] != 0) continue;
      double fluid = cells_[i].fluid;
      for (const std::size_t place : at_[i]) fluid += span * (passes_[i] * there[place]);
      if (!(fluid > cells_[i].room())) continue;
      full_[i] = 1;
      more = true;
    }
    return more;
  }
  /// Pressures at the end of the step, of cracks that are full: conjugate gradients on
  ///   V/(K dt) (p - p_before) + sum over both ends of T (p - p_place) = 0.
  void solve(double span) {
    const std::size_t n = cells_.size();
    std::vector<double> storage(n, 0.0), over(n, 0.0), right(n, 0.0);
    const std::vector<double> given = with_source(std::vector<double>(sum_.size(), 0.0));
    for (std::size_t i = 0; i < n; ++i) {
      if (full_[i] == 0) continue;
      storage[i] = cells_[i].room() / (cells_[i].bulk * span);
      double diagonal = storage[i];
      right[i] = storage[i] * before_[i];
      for (const std::size_t place : at_[i]) {
        const bool held = (place == 0 && !source_.by_rate) || (place == 1 && has_outlet_);
        diagonal += passes_[i] * (held ? 1.0 : 1.0 - passes_[i] / sum_[place]);
        right[i] += passes_[i] * given[place];
      }
      over[i] = 1.0 / diagonal;
    }
    const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
      const std::vector<double> there = at_places(x);
      for (std::size_t i = 0; i < n; ++i) {
        if (full_[i] == 0) continue;
        y[i] = storage[i] * x[i];
        for (const std::size_t place : at_[i]) y[i] += passes_[i] * (x[i] - there[place]);
      }
    };
    std::vector<double> rest(n, 0.0), way(n, 0.0), turned(n, 0.0);
    apply(own_, rest);
    double size = 0.0, start = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      rest[i] = full_[i] != 0 ? right[i] - rest[i] : 0.0;
      way[i] = over[i] * rest[i];
      size += rest[i] * way[i];
      start += right[i] * over[i] * right[i];
    }
    constexpr double tolerance = 1e-24;  // of squares
    for (std::size_t k = 0; k < 4 * n + 20 && size > tolerance * start; ++k) {
      apply(way, turned);
      double along = 0.0;
      for (std::size_t i = 0; i < n; ++i) along += way[i] * turned[i];
      if (!(along > 0.0)) break;
      const double far = size / along;
      double next = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        own_[i] += far * way[i];
        rest[i] -= far * turned[i];
        next += rest[i] * over[i] * rest[i];
      }
      for (std::size_t i = 0; i < n; ++i) way[i] = over[i] * rest[i] + (next / size) * way[i];
      size = next;
    }
  }

  std::vector<FlowCell>& cells_;
  const FlowSource& source_;
  bool has_outlet_;
  std::vector<std::array<std::size_t, 2>> at_;
  std::vector<double> passes_;      ///< T: q over p, to either end  [m2/(Pa s)]
  std::vector<std::uint8_t> full_;  ///< 1: it has a pressure
  std::vector<double> before_;      ///< pressures of full cracks, below 0 of others  [Pa]
  std::vector<double> own_;         ///< pressures of cracks at the end of the step  [Pa]
  std::vector<double> sum_;         ///< of T at each place
  double source_sum_ = 0.0;
};

}  // namespace

Flowed flow(std::vector<FlowCell>& cells, const FlowSource& source, double viscosity, double span) {
  return Network(cells, source, viscosity).run(span);
}

}  // namespace breccia::fdem
