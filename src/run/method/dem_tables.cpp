#include "run/method/dem_tables.hpp"

#include <algorithm>

#include "core/on_host.hpp"
#include "core/pieces.hpp"
#include "dem/emission.hpp"
#include "dem/observe.hpp"
#include "run/method/emission_table.hpp"

namespace breccia {
namespace {

using dem::ElementState;
using dem::is_gone;

/// Where a pair is: its ends by global id, the middle between its surfaces, the way from a to b.
struct PairPlace {
  double a, b;
  Vec3 middle, normal;

  PairPlace(const dem::Elements& e, Index i, Index j) : a(e.id.data()[i]), b(e.id.data()[j]) {
    const ElementState &one = e.state.data()[i], &other = e.state.data()[j];
    const Vec3 way = other.position - one.position;
    const double distance = norm(way);
    if (distance > 0.0) normal = (1.0 / distance) * way;
    middle = one.position + (one.radius + 0.5 * (distance - one.radius - other.radius)) * normal;
  }
  std::vector<double> row() const {
    return {a, b, middle.x, middle.y, middle.z, normal.x, normal.y, normal.z};
  }
};

Table broken_links(const dem::World& w, const dem::Elements& e) {
  Table table{"broken_links",
              {"a", "b", "x", "y", "z", "nx", "ny", "nz", "kind", "time"},
              {"-", "-", "m", "m", "m", "-", "-", "-", "-", "s"},
              {}};
  w.each_set([&](const auto& set) {
    const OnHost links(set.arrays(), w.exec.space);
    with_number(w.exec.precision, [&](auto number) {
      const auto is_broken = links->template broken<decltype(number)>();
      for (Index i = 0; i < links->size(); ++i) {
        const Index a = links->a.data()[i], b = links->b.data()[i];
        if (!is_broken(i) || is_gone(e.fixed.data()[a]) || is_gone(e.fixed.data()[b])) continue;
        table.rows.push_back(PairPlace(e, a, b).row());
        table.rows.back().push_back(static_cast<double>(set.kind));
        const double seen = links->seen_broken.data()[i];
        table.rows.back().push_back(seen < 0.0 ? w.time : seen);
      }
    });
  });
  return table;
}

Table fragments(const dem::World& w, const dem::Elements& e) {
  Pieces pieces(static_cast<std::size_t>(e.size()));
  w.each_set([&](const auto& set) {
    const OnHost links(set.arrays(), w.exec.space);
    with_number(w.exec.precision, [&](auto number) {
      const auto is_broken = links->template broken<decltype(number)>();
      for (Index i = 0; i < links->size(); ++i)
        if (!is_broken(i)) pieces.join(links->a.data()[i], links->b.data()[i]);
    });
  });
  const dem::MotionNow now = dem::motion_now(w);
  struct Piece {
    double mass = 0.0, elements = 0.0;
    Vec3 moment{}, momentum{};
  };
  std::vector<Piece> of(static_cast<std::size_t>(e.size()));
  double total = 0.0;
  for (Index i = 0; i < e.size(); ++i) {
    if (is_gone(e.fixed.data()[i])) continue;
    Piece& piece = of[static_cast<std::size_t>(pieces.root(i))];
    const double m = e.mass.data()[i];
    piece.mass += m;
    piece.elements += 1.0;
    piece.moment += m * e.state.data()[i].position;
    piece.momentum += m * now.velocity[static_cast<std::size_t>(i)];
    total += m;
  }
  std::erase_if(of, [](const Piece& piece) { return piece.elements == 0.0; });
  std::stable_sort(of.begin(), of.end(),
                   [](const Piece& a, const Piece& b) { return a.mass > b.mass; });
  Table table{"fragments",
              {"fragment", "mass", "share", "elements", "x", "y", "z", "vx", "vy", "vz"},
              {"-", "kg", "-", "-", "m", "m", "m", "m/s", "m/s", "m/s"},
              {}};
  for (const Piece& piece : of) {
    const Vec3 x = (1.0 / piece.mass) * piece.moment, v = (1.0 / piece.mass) * piece.momentum;
    table.rows.push_back({static_cast<double>(table.rows.size()),
                          piece.mass / w.given->time.mass_scaling, piece.mass / total,
                          piece.elements, x.x, x.y, x.z, v.x, v.y, v.z});
  }
  return table;
}

}  // namespace

std::vector<Table> dem_tables(const dem::World& w) {
  const OnHost elements(w.elements, w.exec.space);
  return {fragments(w, *elements), broken_links(w, *elements), table_of(dem::emission(w))};
}

}  // namespace breccia
