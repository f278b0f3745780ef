#include "prepare/packing/soft_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exec/tasks.hpp"
#include "prepare/packing/cell_grid.hpp"

namespace breccia::prepare {
namespace {

// FIRE, with the constants of Bitzek et al. 2006.
constexpr double longest_step = 0.6, first_step = 0.1;
constexpr double faster = 1.1, slower = 0.5;
constexpr double first_mixing = 0.1, mixing_decay = 0.99;
constexpr int patience = 5;

constexpr double wall_stiffness = 2.0;

/// Pairs by threads go through memory twice, which two threads gain nothing by.
constexpr int fewest_threads = 3;

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// visit(image) for each image of a point, but itself, that is within `reach` of the cell.
template <class Visit>
void each_image(const Vec3& x, const double (&period)[3], double reach, const Visit& visit) {
  // Towards a face that is near, or away from it: at most one image along each axis.
  const auto shift = [&](double at, double edge) {
    if (!(edge > 0.0)) return 0.0;
    return at > 0.5 * edge - reach ? -edge : at < reach - 0.5 * edge ? edge : 0.0;
  };
  const Vec3 by{shift(x.x, period[0]), shift(x.y, period[1]), shift(x.z, period[2])};
  for (int k = 1; k < 8; ++k) {
    const Vec3 moved{(k & 1) != 0 ? by.x : 0.0, (k & 2) != 0 ? by.y : 0.0,
                     (k & 4) != 0 ? by.z : 0.0};
    const bool skips = ((k & 1) != 0 && by.x == 0.0) || ((k & 2) != 0 && by.y == 0.0) ||
                       ((k & 4) != 0 && by.z == 0.0);
    if (!skips) visit(x + moved);
  }
}

/// Spheres that one thread takes at a time.
constexpr std::size_t spheres_at_once = 256;
std::size_t blocks_of(std::size_t count) {
  return (count + spheres_at_once - 1) / spheres_at_once;
}
/// work(block, begin, end) for each block of spheres.
template <class Work>
void each_block(int threads, std::size_t count, const Work& work) {
  for_each_task(threads, static_cast<int>(blocks_of(count)), [&](int task) {
    const auto block = static_cast<std::size_t>(task);
    work(block, block * spheres_at_once, std::min(count, (block + 1) * spheres_at_once));
  });
}

template <class T>
void reorder(std::vector<T>& items, std::span<const Index> order) {
  std::vector<T> sorted;
  sorted.reserve(items.size());
  for (const Index i : order) sorted.push_back(items[static_cast<std::size_t>(i)]);
  items.swap(sorted);
}

}  // namespace

SoftSpheres::SoftSpheres(const PackingTask& task, std::vector<Vec3> position,
                         std::vector<double> radius, int threads)
    : task_(task),
      position_(std::move(position)),
      velocity_(position_.size()),
      force_(position_.size()),
      radius_(std::move(radius)),
      margin_(0.4 * mean(radius_)),
      threads_(threads),
      dt_(first_step),
      mixing_(first_mixing) {
  const Vec3 half = task.container.half();
  const double edges[3] = {2.0 * half.x, 2.0 * half.y, 2.0 * half.z};
  for (std::size_t k = 0; k < 3; ++k) period_[k] = task.periodic[k] ? edges[k] : 0.0;
}

double SoftSpheres::push(bool with_energy) {
  if (!neighbours_hold()) find_neighbours();
  energy_ = worst_ = 0.0;
  if (threads_ >= fewest_threads) {
    push_pairs_by_threads(with_energy);
  } else {
    for (Vec3& f : force_) f = {};
    push_pairs();
  }
  push_walls();
  push_obstacles();
  return worst_;
}

/// Two spheres that were further apart than the margin cannot touch before one of them has
/// travelled half of it.
bool SoftSpheres::neighbours_hold() const {
  if (searched_.empty()) return false;
  double furthest = 0.0;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const Vec3 travel = position_[i] - searched_[i];
    furthest = std::max(furthest, dot(travel, travel));
  }
  return 4.0 * furthest < margin_ * margin_;
}

void SoftSpheres::wrap() {
  for (Vec3& x : position_)
    for (const auto& [own, period] :
         {std::pair{&x.x, period_[0]}, {&x.y, period_[1]}, {&x.z, period_[2]}}) {
      if (!(period > 0.0)) continue;
      while (*own >= 0.5 * period) *own -= period;
      while (*own < -0.5 * period) *own += period;
    }
}

/// From a sphere to the nearest image of another; both lie within a step of the cell.
Vec3 SoftSpheres::nearest_image(const Vec3& apart) const {
  const auto near = [](double d, double period) {
    return d > 0.5 * period ? d - period : d < -0.5 * period ? d + period : d;
  };
  return {period_[0] > 0.0 ? near(apart.x, period_[0]) : apart.x,
          period_[1] > 0.0 ? near(apart.y, period_[1]) : apart.y,
          period_[2] > 0.0 ? near(apart.z, period_[2]) : apart.z};
}

void SoftSpheres::find_neighbours() {
  const bool periodic = task_.is_periodic();
  if (periodic) wrap();
  const CellGrid grid(position_, 2.0 * mean(radius_) + margin_);
  // Memory follows space; from here on sphere i is the i-th of the grid's order.
  const std::span<const Index> order = grid.order();
  std::vector<Index> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    rank[static_cast<std::size_t>(order[k])] = static_cast<Index>(k);
  reorder(position_, order);
  reorder(velocity_, order);
  reorder(radius_, order);

  const std::size_t count = position_.size();
  const auto find = [&](std::size_t i, std::vector<Index>& found) {
    const Vec3 here = position_[i];
    const double mine = radius_[i];
    // Each pair is found from its larger sphere.
    const auto look = [&](const Vec3& from) {
      grid.visit(from, 2.0 * mine + margin_, [&](Index item) {
        const Index j = rank[static_cast<std::size_t>(item)];
        const double other = radius_[static_cast<std::size_t>(j)];
        if (other > mine || (other == mine && j >= static_cast<Index>(i))) return;
        const Vec3 apart = position_[static_cast<std::size_t>(j)] - from;
        const double reach = mine + other + margin_;
        if (dot(apart, apart) < reach * reach) found.push_back(j);
      });
    };
    look(here);
    if (periodic) each_image(here, period_, 2.0 * mine + margin_, look);
  };
  first_.assign(count + 1, 0);
  std::vector<std::vector<Index>> found(blocks_of(count));
  each_block(threads_, count, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      find(i, found[block]);
      first_[i + 1] = static_cast<Index>(found[block].size());
    }
  });
  neighbour_.clear();
  for (std::size_t block = 0; block < found.size(); ++block) {
    const auto before = static_cast<Index>(neighbour_.size());
    for (std::size_t i = block * spheres_at_once;
         i < std::min(count, (block + 1) * spheres_at_once); ++i)
      first_[i + 1] += before;
    neighbour_.insert(neighbour_.end(), found[block].begin(), found[block].end());
  }
  if (threads_ >= fewest_threads) list_visitors();

  near_obstacle_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < task_.obstacles.size(); ++k) {
      const Capsule& obstacle = task_.obstacles[k];
      if (norm(from_axis(obstacle, position_[i])) < radius_[i] + obstacle.radius + margin_)
        near_obstacle_.push_back({static_cast<Index>(i), static_cast<Index>(k)});
    }
  }
  searched_ = position_;
}

void SoftSpheres::push_pairs() {
  const std::size_t count = position_.size();
  double energy = 0.0, worst = 0.0;
  const bool periodic = task_.is_periodic();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 here = position_[i];
    const double mine = radius_[i];
    Vec3 total = force_[i];
    for (Index k = first_[i]; k < first_[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(neighbour_[static_cast<std::size_t>(k)]);
      const Vec3 apart = periodic ? nearest_image(position_[j] - here) : position_[j] - here;
      const double squared = dot(apart, apart);
      const double touching = mine + radius_[j];
      if (squared >= touching * touching) continue;
      const double distance = std::sqrt(squared);
      const double overlap = touching - distance;
      energy += 0.5 * overlap * overlap;
      // A neighbour is never the larger of the two.
      if (overlap > worst * radius_[j]) worst = overlap / radius_[j];
      const Vec3 push = distance > 0.0 ? (overlap / distance) * apart : Vec3{overlap, 0.0, 0.0};
      total -= push;
      force_[j] += push;
    }
    force_[i] = total;
  }
  energy_ += energy;
  worst_ = std::max(worst_, worst);
}

/// The pairs that lead to each sphere, ascending.
void SoftSpheres::list_visitors() {
  first_visitor_.assign(position_.size() + 1, 0);
  for (const Index j : neighbour_) ++first_visitor_[static_cast<std::size_t>(j) + 1];
  std::partial_sum(first_visitor_.begin(), first_visitor_.end(), first_visitor_.begin());
  std::vector<Index> next = first_visitor_;
  visitor_.resize(neighbour_.size());
  for (std::size_t pair = 0; pair < neighbour_.size(); ++pair) {
    Index& place = next[static_cast<std::size_t>(neighbour_[pair])];
    visitor_[static_cast<std::size_t>(place++)] = static_cast<Index>(pair);
  }
  push_.resize(neighbour_.size());
  overlap_.resize(neighbour_.size());
}

/// The push of a pair of sphere i.
void SoftSpheres::meet(std::size_t i, Index pair) {
  const auto p = static_cast<std::size_t>(pair), j = static_cast<std::size_t>(neighbour_[p]);
  Vec3 apart = position_[j] - position_[i];
  if (task_.is_periodic()) apart = nearest_image(apart);
  const double squared = dot(apart, apart);
  const double touching = radius_[i] + radius_[j];
  overlap_[p] = -1.0;
  if (squared >= touching * touching) return;
  const double distance = std::sqrt(squared);
  const double overlap = touching - distance;
  overlap_[p] = overlap;
  push_[p] = distance > 0.0 ? (overlap / distance) * apart : Vec3{overlap, 0.0, 0.0};
}

/// Of all pairs of a sphere, in the order in which push_pairs() adds them.
Vec3 SoftSpheres::sum_of(std::size_t i) const {
  Vec3 total{};
  const auto pushed = [&](std::size_t p) { return overlap_[p] >= 0.0; };
  auto visit = static_cast<std::size_t>(first_visitor_[i]);
  const auto end = static_cast<std::size_t>(first_visitor_[i + 1]);
  for (; visit < end && visitor_[visit] < first_[i]; ++visit)
    if (const auto p = static_cast<std::size_t>(visitor_[visit]); pushed(p)) total += push_[p];
  for (auto p = static_cast<std::size_t>(first_[i]); p < static_cast<std::size_t>(first_[i + 1]);
       ++p)
    if (pushed(p)) total -= push_[p];
  for (; visit < end; ++visit)
    if (const auto p = static_cast<std::size_t>(visitor_[visit]); pushed(p)) total += push_[p];
  return total;
}

/// The largest overlap over the radius of the neighbour, of pairs one after the other.
double SoftSpheres::worst_of(std::size_t begin, std::size_t end, double worst) const {
  for (auto p = static_cast<std::size_t>(first_[begin]); p < static_cast<std::size_t>(first_[end]);
       ++p) {
    const double radius = radius_[static_cast<std::size_t>(neighbour_[p])];
    if (overlap_[p] > worst * radius) worst = overlap_[p] / radius;
  }
  return worst;
}

void SoftSpheres::push_pairs_by_threads(bool with_energy) {
  const std::size_t count = position_.size();
  std::vector<double> worst(blocks_of(count), 0.0);
  each_block(threads_, count, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (Index p = first_[i]; p < first_[i + 1]; ++p) meet(i, p);
    worst[block] = worst_of(begin, end, 0.0);
  });
  each_block(threads_, count, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) force_[i] = sum_of(i);
  });
  // Rounding lets the order of pairs decide among those that are as bad as the worst to all digits
  // but the last: blocks that have such pairs are looked at once more, in order.
  const double near = (1.0 - 1e-12) * *std::max_element(worst.begin(), worst.end());
  for (std::size_t block = 0; block < worst.size(); ++block)
    if (worst[block] >= near)
      worst_ =
          worst_of(block * spheres_at_once, std::min(count, (block + 1) * spheres_at_once), worst_);
  if (!with_energy) return;
  for (const double overlap : overlap_)
    if (overlap >= 0.0) energy_ += 0.5 * overlap * overlap;
}

void SoftSpheres::push_walls() {
  const Container& c = task_.container;
  const Vec3 half = c.half();
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const Vec3 p = position_[i];
    const double r = radius_[i];
    const auto wall = [&](double depth, const Vec3& inwards) {
      if (depth <= 0.0) return;
      energy_ += 0.5 * wall_stiffness * depth * depth;
      worst_ = std::max(worst_, 2.0 * depth / r);
      force_[i] += (wall_stiffness * depth) * inwards;
    };
    if (c.shape == Container::Shape::box) {
      if (!task_.periodic[0]) {
        wall(r - half.x - p.x, {1.0, 0.0, 0.0});
        wall(r - half.x + p.x, {-1.0, 0.0, 0.0});
      }
      if (!task_.periodic[1]) {
        wall(r - half.y - p.y, {0.0, 1.0, 0.0});
        wall(r - half.y + p.y, {0.0, -1.0, 0.0});
      }
    } else {
      const Vec3 out{p.x, p.y, c.shape == Container::Shape::sphere ? p.z : 0.0};
      const double free = c.radius - r;
      const double squared = dot(out, out);
      if (squared > free * free) {
        const double distance = std::sqrt(squared);
        wall(distance - free, (-1.0 / distance) * out);
      }
    }
    if (c.shape != Container::Shape::sphere && !task_.periodic[2]) {
      wall(r - half.z - p.z, {0.0, 0.0, 1.0});
      wall(r - half.z + p.z, {0.0, 0.0, -1.0});
    }
  }
}

void SoftSpheres::push_obstacles() {
  for (const NearObstacle& pair : near_obstacle_) {
    const auto i = static_cast<std::size_t>(pair.sphere);
    const Capsule& obstacle = task_.obstacles[static_cast<std::size_t>(pair.obstacle)];
    const Vec3 out = from_axis(obstacle, position_[i]);
    const double distance = norm(out);
    const double depth = radius_[i] + obstacle.radius - distance;
    if (depth <= 0.0 || distance <= 0.0) continue;
    energy_ += 0.5 * wall_stiffness * depth * depth;
    worst_ = std::max(worst_, 2.0 * depth / radius_[i]);
    force_[i] += (wall_stiffness * depth / distance) * out;
  }
}

void SoftSpheres::move() {
  double power = 0.0, force_squared = 0.0, speed_squared = 0.0;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    power += dot(force_[i], velocity_[i]);
    force_squared += dot(force_[i], force_[i]);
    speed_squared += dot(velocity_[i], velocity_[i]);
  }
  double keep = 1.0, turn = 0.0;
  if (power > 0.0) {
    keep = 1.0 - mixing_;
    turn = force_squared > 0.0 ? mixing_ * std::sqrt(speed_squared / force_squared) : 0.0;
    if (++downhill_ > patience) {
      dt_ = std::min(dt_ * faster, longest_step);
      mixing_ *= mixing_decay;
    }
  } else {
    keep = 0.0;
    dt_ *= slower;
    mixing_ = first_mixing;
    downhill_ = 0;
  }
  for (std::size_t i = 0; i < position_.size(); ++i) {
    velocity_[i] = keep * velocity_[i] + (turn + dt_) * force_[i];
    position_[i] += dt_ * velocity_[i];
  }
}

}  // namespace breccia::prepare
