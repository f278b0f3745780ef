#include "prepare/packing/linking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "exec/error.hpp"
#include "prepare/packing/cell_grid.hpp"

namespace breccia::prepare {
namespace {

constexpr double widest_range = 3.0;

/// Overlaps below this share of the smaller radius are rounding  [-]
constexpr double rounding = 1e-6;

struct Candidate {
  Index a, b;    ///< a bar's element first; else a < b
  double ratio;  ///< distance over the sum of radii  [-]
};

double ratio_of(const dem::Model& m, Index a, Index b) {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return norm(m.position[j] - m.position[i]) / (m.radius[i] + m.radius[j]);
}

std::vector<std::vector<Index>> elements_by_body(const dem::Model& m, std::size_t bodies) {
  std::vector<std::vector<Index>> members(bodies);
  for (Index i = 0; i < m.size(); ++i)
    members[static_cast<std::size_t>(m.group[static_cast<std::size_t>(i)])].push_back(i);
  return members;
}

/// Some elements of a model and the grid that finds them.
struct Neighbourhood {
  const dem::Model& model;
  std::vector<Index> members;
  double largest = 0.0, mean = 0.0;  ///< radius  [m]
  CellGrid grid;

  Neighbourhood(const dem::Model& m, std::vector<Index> elements)
      : model(m), members(std::move(elements)), grid(make_grid()) {}

  CellGrid make_grid() {
    std::vector<Vec3> points;
    double sum = 0.0;
    for (const Index i : members) {
      const auto e = static_cast<std::size_t>(i);
      points.push_back(model.position[e]);
      largest = std::max(largest, model.radius[e]);
      sum += model.radius[e];
    }
    mean = members.empty() ? 1.0 : sum / static_cast<double>(members.size());
    return {points, 2.0 * mean};
  }

  /// visit(element) for each member whose centre is within `reach` of `center`, and some more.
  template <class Visit>
  void visit(const Vec3& center, double reach, Visit&& visit) const {
    grid.visit(center, reach, [&](Index item) { visit(members[static_cast<std::size_t>(item)]); });
  }
};

/// Each pair of members within `range` once.
std::vector<Candidate> concrete_candidates(const Neighbourhood& body, double range) {
  const dem::Model& m = body.model;
  std::vector<Candidate> found;
  for (const Index i : body.members) {
    const double mine = m.radius[static_cast<std::size_t>(i)];
    // Each pair is found from its larger element, so that few large ones cost little.
    body.visit(m.position[static_cast<std::size_t>(i)], range * 2.0 * mine, [&](Index j) {
      const double other = m.radius[static_cast<std::size_t>(j)];
      if (other > mine || (other == mine && j >= i)) return;
      const double ratio = ratio_of(m, i, j);
      if (ratio <= range) found.push_back({std::min(i, j), std::max(i, j), ratio});
    });
  }
  return found;
}

/// The partners of a bar's element within `range`, nearest first, and four at least.
std::vector<Candidate> partners(const Neighbourhood& host, Index steel, double range) {
  const dem::Model& m = host.model;
  const auto s = static_cast<std::size_t>(steel);
  const std::size_t least =
      std::min(host.members.size(), static_cast<std::size_t>(least_interface_links));
  std::vector<Candidate> found;
  for (double reach = range;; reach *= 1.5) {
    found.clear();
    host.visit(m.position[s], reach * (m.radius[s] + host.largest), [&](Index c) {
      const double ratio = ratio_of(m, steel, c);
      if (ratio <= reach) found.push_back({steel, c, ratio});
    });
    if (found.size() >= least) break;
  }
  std::sort(found.begin(), found.end(), [](const Candidate& p, const Candidate& q) {
    return p.ratio != q.ratio ? p.ratio < q.ratio : p.b < q.b;
  });
  std::size_t kept = found.size();
  while (kept > least && found[kept - 1].ratio > range) --kept;
  found.resize(kept);
  return found;
}

/// Everything that may be linked within a widest range, ready to be counted for a narrower one.
struct Candidates {
  std::vector<dem::Model::Link> always;  ///< along bars, and the four nearest of bars' elements
  std::vector<dem::Model::Link> link;    ///< the others, by ascending ratio
  std::vector<double> ratio;

  std::size_t count(double range) const {
    return always.size() + static_cast<std::size_t>(
                               std::upper_bound(ratio.begin(), ratio.end(), range) - ratio.begin());
  }
};

dem::Model::Link make_link(const Candidate& c, dem::LinkKind kind, std::int16_t material) {
  return {std::min(c.a, c.b), std::max(c.a, c.b), kind, material};
}

Candidates find_candidates(const dem::Model& m, const std::vector<BodyLinks>& bodies,
                           double range) {
  const auto members = elements_by_body(m, bodies.size());
  Candidates all;
  std::vector<std::pair<double, dem::Model::Link>> ranged;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const BodyLinks& body = bodies[k];
    if (body.kind == BodyLinks::Kind::range) {
      for (const Candidate& c : concrete_candidates({m, members[k]}, range))
        ranged.emplace_back(c.ratio, make_link(c, body.link, body.material));
    } else if (body.kind == BodyLinks::Kind::bars) {
      std::vector<Index> around = members[static_cast<std::size_t>(body.host)];
      if (body.within)
        std::erase_if(
            around, [&](Index e) { return !body.within(m.position[static_cast<std::size_t>(e)]); });
      const Neighbourhood host(m, std::move(around));
      for (const Index s : members[k]) {
        const Index next = m.bar_next[static_cast<std::size_t>(s)];
        if (next >= 0)
          all.always.push_back(make_link({s, next, 0.0}, dem::LinkKind::steel, body.material));
        int rank = 0;
        for (const Candidate& c : partners(host, s, range)) {
          const auto link = make_link(c, dem::LinkKind::interface, body.interface);
          if (rank++ < least_interface_links)
            all.always.push_back(link);
          else
            ranged.emplace_back(c.ratio, link);
        }
      }
    }
  }
  std::sort(ranged.begin(), ranged.end(), [](const auto& p, const auto& q) {
    if (p.first != q.first) return p.first < q.first;
    return p.second.a != q.second.a ? p.second.a < q.second.a : p.second.b < q.second.b;
  });
  for (const auto& [ratio, link] : ranged) {
    all.ratio.push_back(ratio);
    all.link.push_back(link);
  }
  return all;
}

/// The range whose number of links is nearest to `wanted`, by bisection.
double solve_range(const Candidates& all, std::size_t wanted, double widest) {
  double low = 1.0, high = widest;  // fewer than wanted; wanted or more
  if (all.count(low) >= wanted) return low;
  for (double middle = 0.5 * (low + high); low < middle && middle < high;
       middle = 0.5 * (low + high))
    (all.count(middle) < wanted ? low : high) = middle;
  return wanted - all.count(low) < all.count(high) - wanted ? low : high;
}

std::size_t wanted_links(const dem::Model& m, const dem::LinksConfig& config) {
  if (config.count > 0) return static_cast<std::size_t>(config.count);
  return static_cast<std::size_t>(0.5 * config.per_element * m.size() + 0.5);
}

/// Whether a bond joins elements that overlap, which no contact may take over.
bool overlap(const dem::Model& model, const dem::Model::Link& link) {
  if (link.kind != dem::LinkKind::concrete && link.kind != dem::LinkKind::parallel) return false;
  return ratio_of(model, link.a, link.b) < 1.0;
}

}  // namespace

void link_elements(dem::Model& model, const std::vector<BodyLinks>& bodies,
                   const dem::LinksConfig& config) {
  Candidates all;
  double range = config.range;
  const std::size_t wanted = wanted_links(model, config);
  if (wanted == 0) {
    all = find_candidates(model, bodies, range);
  } else {
    double widest = 0.0;
    for (const double tried : {1.6, 2.1, widest_range}) {
      widest = tried;
      all = find_candidates(model, bodies, widest);
      if (all.count(widest) >= wanted) break;
    }
    if (all.count(1.0) > wanted || all.count(widest) < wanted)
      throw InputError(
          fmt::format("[links] asks for {} links; this packing allows {} (elements that touch) to "
                      "{} (range {})",
                      wanted, all.count(1.0), all.count(widest), widest));
    range = solve_range(all, wanted, widest);
  }
  model.interaction_range = range;
  model.links = all.always;
  for (std::size_t k = 0; k < all.link.size() && all.ratio[k] <= range; ++k)
    model.links.push_back(all.link[k]);
  std::sort(model.links.begin(), model.links.end(),
            [](const auto& p, const auto& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
}

std::vector<std::string> free_overlaps(const dem::Model& m, const std::vector<BodyLinks>& bodies) {
  std::vector<Index> everyone(static_cast<std::size_t>(m.size()));
  for (Index i = 0; i < m.size(); ++i) everyone[static_cast<std::size_t>(i)] = i;
  const Neighbourhood model(m, std::move(everyone));
  const auto linked = [&](Index a, Index b) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const BodyLinks& p = bodies[static_cast<std::size_t>(m.group[i])];
    const BodyLinks& q = bodies[static_cast<std::size_t>(m.group[j])];
    if (m.group[i] == m.group[j])
      return p.kind == BodyLinks::Kind::range || p.kind == BodyLinks::Kind::facets ||
             m.bar_next[i] == b || m.bar_previous[i] == b;
    return p.host == m.group[j] || q.host == m.group[i];
  };
  struct Deepest {
    double depth = 0.0;
    Index a = 0, b = 0;
    int pairs = 0;
  };
  std::map<std::pair<int, int>, Deepest> found;
  for (const Index i : model.members) {
    const double mine = m.radius[static_cast<std::size_t>(i)];
    model.visit(m.position[static_cast<std::size_t>(i)], 2.0 * mine, [&](Index j) {
      const double other = m.radius[static_cast<std::size_t>(j)];
      if (other > mine || (other == mine && j >= i)) return;
      const double depth = (1.0 - ratio_of(m, i, j)) * (mine + other);
      if (depth <= rounding * other || linked(i, j)) return;
      const Index a = std::min(i, j), b = std::max(i, j);
      const int p = m.group[static_cast<std::size_t>(a)], q = m.group[static_cast<std::size_t>(b)];
      Deepest& pair = found[{std::min(p, q), std::max(p, q)}];
      ++pair.pairs;
      if (depth > pair.depth || (depth == pair.depth && a < pair.a))
        pair = {depth, a, b, pair.pairs};
    });
  }
  std::vector<std::string> problems;
  for (const auto& [groups, pair] : found) {
    const auto name = [&](Index e) {
      return m.groups[static_cast<std::size_t>(m.group[static_cast<std::size_t>(e)])];
    };
    const Vec3& at = m.position[static_cast<std::size_t>(pair.a)];
    // Grains of one body push each other apart from the start, as dense as they are packed.
    const char* const advice =
        groups.first != groups.second ? ""
        : bodies[static_cast<std::size_t>(groups.first)].of_file
            ? "; spheres of its file lie in each other, which only links of law concrete or "
              "parallel take: smaller radii there"
            : "; loose grains need a smaller pack.compactness, such as 0.5";
    problems.push_back(fmt::format(
        "body.{}: element {} of body {} overlaps element {} of body {} by {:.3g} m at ({:.4g}, "
        "{:.4g}, {:.4g}) m; {} such pairs{}",
        name(pair.a), pair.a, name(pair.a), pair.b, name(pair.b), pair.depth, at.x, at.y, at.z,
        pair.pairs, advice));
  }
  return problems;
}

void drop_links(dem::Model& model, const std::function<bool(const dem::Model::Link&)>& gone) {
  std::vector<bool> lost(model.facets.size());
  std::erase_if(model.links, [&](dem::Model::Link& link) {
    if (!gone(link)) return false;
    link.parted = overlap(model, link);
    const bool go = !link.parted;
    if (go && link.facet >= 0) lost[static_cast<std::size_t>(link.facet)] = true;
    return go;
  });
  std::vector<Index> number(lost.size(), -1);
  std::size_t to = 0;
  for (std::size_t f = 0; f < lost.size(); ++f) {
    if (lost[f]) continue;
    number[f] = static_cast<Index>(to);
    model.facets[to++] = model.facets[f];
  }
  model.facets.resize(to);
  for (dem::Model::Link& link : model.links)
    if (link.facet >= 0) link.facet = number[static_cast<std::size_t>(link.facet)];
}

}  // namespace breccia::prepare
