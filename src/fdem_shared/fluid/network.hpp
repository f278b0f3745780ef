#pragma once
// The solution of a step of flow: fdem_shared/fluid/flow.hpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fdem_shared/fluid/flow.hpp"

namespace breccia::fdem_shared {

/// Cracks that meet at places, of which the source is the first. All sums go over cracks in their
/// order, so that every machine gets the same bits.
template <class Cell>
class Network {
  static constexpr auto ports = static_cast<std::size_t>(Cell::ports);

 public:
  Network(std::vector<Cell>& cells, const FlowSource& source, double viscosity)
      : cells_(cells), source_(source), viscosity_(viscosity), has_outlet_(!source.outlet.empty()) {
    list_places();
    for (const Cell& c : cells) {
      full_.push_back(c.fluid >= c.room() ? 1 : 0);
      passes_.push_back(c.passes(viscosity, full_.back() != 0));
      before_.push_back(c.bulk * (c.fluid / c.room() - 1.0));
      own_.push_back(c.pressure());
    }
    begin_places();
  }
  Flowed run(double span) {
    Flowed done;
    if (span > 0.0) {
      do solve(span);
      while (fills_more(span));
      move_fluid(span, done);
    }
    done.pressure = there_[0];
    return done;
  }

 private:
  using Ports = std::array<double, ports>;

  void list_places() {
    std::vector<Port> others;
    const auto is_in = [](const std::vector<Port>& all, Port v) {
      return std::binary_search(all.begin(), all.end(), v);
    };
    const auto is_source = [&](Port v) {
      return is_in(source_.ports, v) || is_in(source_.outlet, v);
    };
    const std::size_t first = has_outlet_ ? 2 : 1;
    for (const Cell& c : cells_)
      for (const Port v : c.port)
        if (!is_source(v)) others.push_back(v);
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    const auto place = [&](Port v) -> std::size_t {
      if (is_source(v)) return is_in(source_.ports, v) ? 0 : 1;
      return first + static_cast<std::size_t>(std::lower_bound(others.begin(), others.end(), v) -
                                              others.begin());
    };
    for (const Cell& c : cells_) {
      at_.emplace_back();
      for (std::size_t k = 0; k < ports; ++k) at_.back()[k] = place(c.port[k]);
    }
    there_.resize(others.size() + first);
  }
  /// Whether the pressure of a place is given.
  bool is_held(std::size_t place) const {
    return (place == 0 && !source_.by_rate) || (place == 1 && has_outlet_);
  }
  /// Places begin at the mean of the cracks that they join.
  void begin_places() {
    std::vector<double> weight(there_.size(), 0.0);
    for (std::size_t i = 0; i < cells_.size(); ++i)
      for (std::size_t k = 0; k < ports; ++k) {
        weight[at_[i][k]] += passes_[i][k][k];
        there_[at_[i][k]] += passes_[i][k][k] * own_[i];
      }
    for (std::size_t p = 0; p < there_.size(); ++p)
      there_[p] = weight[p] > 0.0 ? there_[p] / weight[p] : 0.0;
    if (!source_.by_rate)
      there_[0] = source_.given;
    else if (weight[0] > 0.0)
      there_[0] += source_.given / weight[0];
    if (has_outlet_) there_[1] = source_.outlet_pressure;
  }

  /// Lets cracks have a pressure that get more in this step than they have room for. What comes in
  /// then only grows elsewhere, so none of them has to give it back.
  bool fills_more(double span) {
    bool more = false;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (full_[i] != 0) continue;
      double fluid = cells_[i].fluid;
      for (const double in : inflow(i)) fluid += span * in;
      if (!(fluid > cells_[i].room())) continue;
      full_[i] = 1;
      passes_[i] = cells_[i].passes(viscosity_, true);
      more = true;
    }
    return more;
  }
  /// Flow into a crack at its ports.  [m2/s; in space m3/s]
  Ports inflow(std::size_t i) const {
    Ports in{};
    for (std::size_t k = 0; k < ports; ++k)
      for (std::size_t j = 0; j < ports; ++j)
        in[k] += passes_[i][k][j] * (there_[at_[i][j]] - own_[i]);
    return in;
  }
  /// As much comes out of a place as goes in, to rounding: what conjugate gradients have left goes
  /// to all of its cracks alike.
  void move_fluid(double span, Flowed& done) {
    std::vector<Ports> in;
    std::vector<double> sum(there_.size(), 0.0), count(there_.size(), 0.0);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      in.push_back(inflow(i));
      for (std::size_t k = 0; k < ports; ++k) {
        sum[at_[i][k]] += in[i][k];
        count[at_[i][k]] += 1.0;
      }
    }
    if (source_.by_rate) sum[0] -= source_.given;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      for (std::size_t k = 0; k < ports; ++k) {
        const std::size_t place = at_[i][k];
        if (!is_held(place)) in[i][k] -= sum[place] / count[place];
        const double came = span * in[i][k];
        cells_[i].fluid += came;
        if (place == 0) done.injected += came;
        if (has_outlet_ && place == 1) done.released -= came;
      }
  }

  /// Of a crack: its equation is solved for its pressure, and what is left joins its places.
  struct Joined {
    std::array<Ports, ports> matrix;
    Ports right, over;  ///< `over` of places: its pressure is first + over . there
    double first;       ///<  [Pa]
  };
  /// V/(K dt) (p - p_before) + sum over ports of T (p - p_place) = 0.
  Joined joined(std::size_t i, double span) const {
    Joined j{passes_[i], {}, {}, 0.0};
    if (full_[i] == 0) return j;  // it has no pressure
    const double storage = cells_[i].room() / (cells_[i].bulk * span);
    Ports sum{};
    double all = storage;
    for (std::size_t k = 0; k < ports; ++k) {
      for (std::size_t m = 0; m < ports; ++m) sum[k] += passes_[i][k][m];
      all += sum[k];
    }
    j.first = storage * before_[i] / all;
    for (std::size_t k = 0; k < ports; ++k) {
      j.over[k] = sum[k] / all;
      j.right[k] = sum[k] * j.first;
      for (std::size_t m = 0; m < ports; ++m) j.matrix[k][m] -= sum[k] * sum[m] / all;
    }
    return j;
  }
  /// Pressures at the end of the step, of places by conjugate gradients, then of cracks.
  void solve(double span) {
    const std::size_t n = there_.size();
    std::vector<Joined> cracks;
    std::vector<double> over(n, 0.0), right(n, 0.0);
    if (source_.by_rate) right[0] = source_.given;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      cracks.push_back(joined(i, span));
      for (std::size_t k = 0; k < ports; ++k) {
        over[at_[i][k]] += cracks[i].matrix[k][k];
        right[at_[i][k]] += cracks[i].right[k];
      }
    }
    for (std::size_t p = 0; p < n; ++p)
      over[p] = !is_held(p) && over[p] > 0.0 ? 1.0 / over[p] : 0.0;
    const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
      std::fill(y.begin(), y.end(), 0.0);
      for (std::size_t i = 0; i < cells_.size(); ++i)
        for (std::size_t k = 0; k < ports; ++k)
          for (std::size_t m = 0; m < ports; ++m)
            y[at_[i][k]] += cracks[i].matrix[k][m] * x[at_[i][m]];
    };
    std::vector<double> rest(n, 0.0), way(n, 0.0), turned(n, 0.0);
    std::vector<double> given(n, 0.0);  // what held places and cracks ask for
    for (std::size_t p = 0; p < n; ++p)
      if (is_held(p)) given[p] = there_[p];
    apply(given, turned);
    apply(there_, rest);
    double size = 0.0, start = 0.0;
    for (std::size_t p = 0; p < n; ++p) {
      const double asked = right[p] - turned[p];
      rest[p] = right[p] - rest[p];
      way[p] = over[p] * rest[p];
      size += rest[p] * way[p];
      start += asked * over[p] * asked;
    }
    constexpr double tolerance = 1e-24;  // of squares
    for (std::size_t k = 0; k < 4 * n + 20 && size > tolerance * start; ++k) {
      apply(way, turned);
      double along = 0.0;
      for (std::size_t p = 0; p < n; ++p) along += way[p] * turned[p];
      if (!(along > 0.0)) break;
      const double far = size / along;
      double next = 0.0;
      for (std::size_t p = 0; p < n; ++p) {
        there_[p] += far * way[p];
        rest[p] -= far * turned[p];
        next += rest[p] * over[p] * rest[p];
      }
      for (std::size_t p = 0; p < n; ++p) way[p] = over[p] * rest[p] + (next / size) * way[p];
      size = next;
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      own_[i] = cracks[i].first;
      for (std::size_t k = 0; k < ports; ++k) own_[i] += cracks[i].over[k] * there_[at_[i][k]];
    }
  }

  std::vector<Cell>& cells_;
  const FlowSource& source_;
  double viscosity_;
  bool has_outlet_;
  std::vector<std::array<std::size_t, ports>> at_;
  std::vector<Conductance<Cell::ports>> passes_;  ///< T  [m2/(Pa s); in space m3/(Pa s)]
  std::vector<std::uint8_t> full_;                ///< 1: it has a pressure
  std::vector<double> before_;  ///< pressures of full cracks, below 0 of others  [Pa]
  std::vector<double> own_;     ///< pressures of cracks at the end of the step  [Pa]
  std::vector<double> there_;   ///< and of places  [Pa]
};

template <class Cell>
Flowed flow(std::vector<Cell>& cells, const FlowSource& source, double viscosity, double span) {
  return Network<Cell>(cells, source, viscosity).run(span);
}

}  // namespace breccia::fdem_shared
