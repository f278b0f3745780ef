#include "prepare/packing/linking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

#include "core/rows.hpp"
#include "exec/error.hpp"
#include "exec/filling.hpp"
#include "exec/sort_scan.hpp"
#include "prepare/packing/cell_grid.hpp"

namespace breccia::prepare {
namespace {

constexpr double widest_range = 3.0;

/// Overlaps below this share of the smaller radius are rounding  [-]
constexpr double rounding = 1e-6;

/// Two elements that may be linked.
struct Candidate {
  Index a, b;    ///< a < b
  double ratio;  ///< distance over the sum of radii  [-]
  dem::LinkKind kind;
  std::int16_t material;
  bool always = false;  ///< along a bar, or one of the four nearest of a bar's element

  dem::Model::Link link() const { return {a, b, kind, material}; }
};

double ratio_of(const dem::Model& m, Index a, Index b) {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return norm(m.position[j] - m.position[i]) / (m.radius[i] + m.radius[j]);
}

Buffer<Index> members_of(const dem::Model& m, std::size_t body, int threads) {
  return numbers_where(threads, m.size(),
                       [&](Index i) { return static_cast<std::size_t>(m.group[at(i)]) == body; });
}

/// Some elements of a model and the grid that finds them.
struct Neighbourhood {
  const dem::Model& model;
  Buffer<Index> members;
  double largest = 0.0, mean = 0.0;  ///< radius  [m]
  CellGrid grid;

  Neighbourhood(const dem::Model& m, Buffer<Index> elements, int threads)
      : model(m), members(std::move(elements)), grid(make_grid(threads)) {}

  CellGrid make_grid(int threads) {
    Buffer<Vec3> points;
    fill_items(points, members.size(), threads,
               [this](Index k) { return model.position[at(members.data()[k])]; });
    double sum = 0.0;
    for (const Index e : members.host()) {
      largest = std::max(largest, model.radius[at(e)]);
      sum += model.radius[at(e)];
    }
    mean = members.empty() ? 1.0 : sum / static_cast<double>(members.size());
    return {std::as_const(points).host(), 2.0 * mean, threads};
  }

  /// visit(element) for each member whose centre is within `reach` of `center`, and some more.
  template <class Visit>
  void visit(const Vec3& center, double reach, Visit&& visit) const {
    grid.visit(center, reach, [&](Index item) { visit(members.data()[item]); });
  }
};

/// Finds of runs of elements, in the order of the elements.
using Found = std::vector<PlainVector<Candidate>>;

/// add(member, found) for each of the members.
template <class Add>
void search(const Buffer<Index>& members, int threads, Found& found, const Add& add) {
  for (auto& run : of_runs(threads, members.size(), [&](Index begin, Index end) {
         constexpr std::size_t many = 8;  // candidates of one; memory that is not written is free
         PlainVector<Candidate> own;
         own.reserve(many * at(end - begin));
         for (Index k = begin; k < end; ++k) add(members.data()[k], own);
         return own;
       }))
    found.push_back(std::move(run.found));
}

/// Each pair of members within `range` once.
void find_within(const BodyLinks& links, const Neighbourhood& body, double range, int threads,
                 Found& found) {
  const dem::Model& m = body.model;
  search(body.members, threads, found, [&](Index i, PlainVector<Candidate>& own) {
    const double mine = m.radius[at(i)];
    // Each pair is found from its larger element, so that few large ones cost little.
    body.visit(m.position[at(i)], range * 2.0 * mine, [&](Index j) {
      const double other = m.radius[at(j)];
      if (other > mine || (other == mine && j >= i)) return;
      const double ratio = ratio_of(m, i, j);
      if (ratio <= range)
        own.push_back({std::min(i, j), std::max(i, j), ratio, links.link, links.material});
    });
  });
}

/// The partners of a bar's element within `range`, nearest first, and four at least.
std::vector<std::pair<double, Index>> partners(const Neighbourhood& host, Index steel,
                                               double range) {
  const dem::Model& m = host.model;
  const auto least = std::min(at(host.members.size()), at(least_interface_links));
  std::vector<std::pair<double, Index>> found;
  for (double reach = range;; reach *= 1.5) {
    found.clear();
    host.visit(m.position[at(steel)], reach * (m.radius[at(steel)] + host.largest), [&](Index c) {
      const double ratio = ratio_of(m, steel, c);
      if (ratio <= reach) found.emplace_back(ratio, c);
    });
    if (found.size() >= least) break;
  }
  std::sort(found.begin(), found.end());
  std::size_t kept = found.size();
  while (kept > least && found[kept - 1].first > range) --kept;
  found.resize(kept);
  return found;
}

/// Links along a bar, and with the elements around it.
void find_along(const BodyLinks& links, const Buffer<Index>& bar, const Neighbourhood& host,
                double range, int threads, Found& found) {
  const dem::Model& m = host.model;
  search(bar, threads, found, [&](Index s, PlainVector<Candidate>& own) {
    const auto add = [&](Index other, double ratio, dem::LinkKind kind, std::int16_t material,
                         bool always) {
      own.push_back({std::min(s, other), std::max(s, other), ratio, kind, material, always});
    };
    const Index next = m.bar_next[at(s)];
    if (next >= 0) add(next, 0.0, dem::LinkKind::steel, links.material, true);
    int rank = 0;
    for (const auto& [ratio, c] : partners(host, s, range))
      add(c, ratio, dem::LinkKind::interface, links.interface, rank++ < least_interface_links);
  });
}

/// Everything that may be linked within a range, ready to be counted for a narrower one.
struct Candidates {
  Found found;
  std::size_t always = 0;
  Buffer<std::uint64_t> ratios;  ///< bits of those of all others, ascending; if they are counted

  std::size_t count(double range) const {
    const auto all = ratios.host();
    return always + static_cast<std::size_t>(std::upper_bound(all.begin(), all.end(),
                                                              std::bit_cast<std::uint64_t>(range)) -
                                             all.begin());
  }
  /// Numbers that are not negative sort as their bits do.
  void sort_ratios(int threads) {
    std::vector<Index> first{0};  // of each run
    for (const auto& run : found) {
      const auto kept =
          std::count_if(run.begin(), run.end(), [](const Candidate& c) { return !c.always; });
      first.push_back(first.back() + static_cast<Index>(kept));
      always += run.size() - static_cast<std::size_t>(kept);
    }
    ratios.resize_unfilled(first.back());
    for_each_task(threads, static_cast<int>(found.size()), [&](int k) {
      std::uint64_t* to = ratios.data() + first[at(k)];
      for (const Candidate& c : found[at(k)])
        if (!c.always) *to++ = std::bit_cast<std::uint64_t>(c.ratio);
    });
    Buffer<std::uint64_t> scratch;
    sort_keys({.threads = threads}, ratios, scratch, 64);
  }
};

Candidates find_candidates(const dem::Model& m, const std::vector<BodyLinks>& bodies, double range,
                           int threads) {
  Candidates all;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const BodyLinks& body = bodies[k];
    if (body.kind == BodyLinks::Kind::range) {
      const Neighbourhood own(m, members_of(m, k, threads), threads);
      find_within(body, own, range, threads, all.found);
    } else if (body.kind == BodyLinks::Kind::bars) {
      Buffer<Index> around = members_of(m, static_cast<std::size_t>(body.host), threads);
      if (body.within) {
        std::vector<Index> kept;
        for (const Index e : around.host())
          if (body.within(m.position[at(e)])) kept.push_back(e);
        copy_to(around, kept);
      }
      const Neighbourhood host(m, std::move(around), threads);
      find_along(body, members_of(m, k, threads), host, range, threads, all.found);
    }
  }
  return all;
}

/// The candidates within a range as links, sorted by a, then b.
void put_links(dem::Model& model, const Candidates& all, double range, int threads) {
  const auto each = [&](const auto& visit) {
    for_each_task(threads, static_cast<int>(all.found.size()), [&](int k) {
      for (const Candidate& c : all.found[at(k)])
        if (c.always || c.ratio <= range) visit(c);
    });
  };
  Buffer<Index> starts(Space::host, model.size() + 1);
  each([&](const Candidate& c) { count_up(starts.data()[c.a]); });
  model.links.clear();
  model.links.resize(at(exclusive_scan({.threads = threads}, starts)));
  Buffer<Index> next(starts);
  each([&](const Candidate& c) { model.links[at(count_up(next.data()[c.a]))] = c.link(); });
  each_portion(threads, model.size(), [&](Index begin, Index end) {
    for (Index e = begin; e < end; ++e)
      sort_row(model.links.data() + starts.data()[e], starts.data()[e + 1] - starts.data()[e],
               [](const dem::Model::Link& p, const dem::Model::Link& q) { return p.b < q.b; });
  });
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
                   const dem::LinksConfig& config, int threads) {
  const FillingThreads filling(threads);
  Candidates all;
  double range = config.range;
  const std::size_t wanted = wanted_links(model, config);
  if (wanted == 0) {
    all = find_candidates(model, bodies, range, threads);
  } else {
    double widest = 0.0;
    for (const double tried : {1.6, 2.1, widest_range}) {
      widest = tried;
      all = find_candidates(model, bodies, widest, threads);
      all.sort_ratios(threads);
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
  put_links(model, all, range, threads);
}

namespace {

/// The overlaps between two bodies, by their numbers.
struct Deepest {
  double depth = 0.0;
  Index a = 0, b = 0;
  int pairs = 0;

  void add(const Deepest& other) {
    const int both = pairs + other.pairs;
    if (other.depth > depth || (other.depth == depth && other.a < a)) *this = other;
    pairs = both;
  }
};
using Overlaps = std::map<std::pair<int, int>, Deepest>;

/// Pairs of elements that overlap without a link.
Overlaps deepest_overlaps(const dem::Model& m, const std::vector<BodyLinks>& bodies, int threads) {
  Buffer<Index> everyone;
  fill_items(everyone, m.size(), threads, [](Index i) { return i; });
  const Neighbourhood model(m, std::move(everyone), threads);
  const auto linked = [&](Index a, Index b) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const BodyLinks& p = bodies[static_cast<std::size_t>(m.group[i])];
    const BodyLinks& q = bodies[static_cast<std::size_t>(m.group[j])];
    if (m.group[i] == m.group[j])
      return p.kind == BodyLinks::Kind::range || p.kind == BodyLinks::Kind::facets ||
             m.bar_next[i] == b || m.bar_previous[i] == b;
    return p.host == m.group[j] || q.host == m.group[i];
  };
  Overlaps found;
  for (const auto& run : of_runs(threads, m.size(), [&](Index begin, Index end) {
         Overlaps own;
         for (Index i = begin; i < end; ++i) {
           const double mine = m.radius[at(i)];
           model.visit(m.position[at(i)], 2.0 * mine, [&](Index j) {
             const double other = m.radius[at(j)];
             if (other > mine || (other == mine && j >= i)) return;
             const double depth = (1.0 - ratio_of(m, i, j)) * (mine + other);
             if (depth <= rounding * other || linked(i, j)) return;
             const Index a = std::min(i, j), b = std::max(i, j);
             const int p = m.group[at(a)], q = m.group[at(b)];
             own[{std::min(p, q), std::max(p, q)}].add({depth, a, b, 1});
           });
         }
         return own;
       }))
    for (const auto& [groups, pair] : run.found) found[groups].add(pair);
  return found;
}

}  // namespace

std::vector<std::string> free_overlaps(const dem::Model& m, const std::vector<BodyLinks>& bodies,
                                       int threads) {
  const Overlaps found = deepest_overlaps(m, bodies, threads);
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
