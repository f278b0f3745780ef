#pragma once
// Kernels that a device alone runs: they give several threads to one item, or bound the registers
// of one thread. Forces are those of the kernels of all machines, to the bit.

#include "core/timed.hpp"
#include "exec/early.hpp"
#include "exec/lockstep.hpp"
#include "fdem/triangles/triangle_kernels.hpp"

namespace breccia::fdem {

/// BundleForces by sixteen threads a vertex, each with a corner: all see every corner's force and
/// add those of their own bundle up, in the same order.
struct BundlesWide {
  static constexpr const char* name = "fdem.bundles_wide";
  static constexpr Index width = 16;
  BundleForces all;
  BR_HD void set(const StepTime&) {}
  struct Loaded {
    Index count, leader, node;
    double mass;
    Vec2 force;
  };
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index vertex = i / width, part = i % width;
    loaded.count = 0;
    loaded.leader = -1;
    loaded.mass = 0.0;
    if (vertex + 1 >= all.starts.size) return;
    const Index first = read_now(&all.starts[vertex]);
    loaded.count = read_now(&all.starts[vertex + 1]) - first;
    if (part >= loaded.count) return;
    loaded.leader = read_now(&all.leader[first + part]) - first;
    loaded.node = read_now(&all.nodes[first + part]);
    loaded.mass = read_now(&all.mass[loaded.node / 3]);
  }
  BR_HD void load_late(Index i, Loaded& loaded) const {
    loaded.force = {};
    if (i % width < loaded.count)
      loaded.force = read_record_now(&all.force[loaded.node / 3].at[loaded.node % 3]);
  }
  BR_HD void update(Index i, const Loaded& loaded) const {
    const bool fits = loaded.count <= width;
    const Index corners = fits ? loaded.count : 0;
    const LaneGroup<width> group;
    Vec2 sum{};
    double total = 0.0;
    for (int k = 0; group.any_of_warp(k < corners); ++k) {
      const Vec2 other{group.from(k, loaded.force.x), group.from(k, loaded.force.y)};
      const double other_mass = group.from(k, loaded.mass);
      if (group.from(k, loaded.leader) != loaded.leader || k >= corners) continue;
      sum += other;
      total += other_mass;
    }
    if (!fits && i % width == 0) all(i / width);
    if (i % width < corners)
      all.force[loaded.node / 3].at[loaded.node % 3] = loaded.mass * ((1.0 / total) * sum);
  }
};

}  // namespace breccia::fdem
