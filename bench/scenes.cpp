#include "bench/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "dem/setup/model_arrays.hpp"
#include "exec/tasks.hpp"

namespace breccia {
namespace {

std::vector<dem::MaterialConfig> slab_materials() {
  dem::MaterialConfig concrete;
  concrete.name = "c30";
  concrete.softening = 10.0;
  concrete.rolling_limit = 0.15;
  dem::MaterialConfig steel;
  steel.name = "b500";
  steel.law = "steel";
  steel.density = 7850.0;
  steel.young = 200e9;
  steel.poisson = 0.3;
  dem::MaterialConfig bond;
  bond.name = "bond";
  bond.law = "interface";
  bond.softening = 10.0;
  return {steel, bond, concrete};
}

dem::SupportConfig held_edge(const char* name, const Vec3& low, const Vec3& high) {
  dem::SupportConfig support;
  support.name = name;
  support.min = low;
  support.max = high;
  support.fix = {"all"};
  return support;
}

dem::BodyConfig packed_body(const char* name, int count) {
  dem::BodyConfig body;
  body.name = name;
  body.material = "c30";
  body.pack = {.count = count, .size_ratio = 2.0, .compactness = 0.56};
  return body;
}

}  // namespace

dem::Config slab_scene(double scale) {
  const auto times = [&](int count, double factor) {
    return static_cast<int>(std::lround(count * factor));
  };
  dem::Config config;
  config.time.end = 5e-3;
  config.materials = slab_materials();

  const double half = 0.5 * scale, thick = 0.05, inside = half - 0.02;
  dem::BodyConfig slab = packed_body("slab", times(12718, scale * scale));
  slab.size = {scale, scale, 0.1};
  dem::BodyConfig steel;
  steel.name = "steel";
  steel.shape = "rebar";
  steel.material = "b500";
  steel.rebar.in = "slab";
  steel.rebar.interface_law = "bond";
  steel.rebar.bars = times(7, scale);
  steel.rebar.elements = times(28, scale);
  dem::BodyConfig rock = packed_body("impactor", 772);
  rock.shape = "sphere";
  rock.center = {0.0, 0.0, 0.164};
  rock.radius = 0.113;
  rock.velocity = {0.0, 0.0, -30.0};
  config.bodies = {slab, steel, rock};

  const int bar_elements = 4 * steel.rebar.bars * steel.rebar.elements;
  const int elements = slab.pack.count + bar_elements + rock.pack.count;
  config.links.count = times(79211, elements / 14274.0);

  config.supports = {held_edge("west", {-half, -half, -thick}, {-inside, half, thick}),
                     held_edge("east", {inside, -half, -thick}, {half, half, thick}),
                     held_edge("south", {-inside, -half, -thick}, {inside, -inside, thick}),
                     held_edge("north", {-inside, inside, -thick}, {inside, half, thick})};
  return config;
}

fdem::Config granite() {
  fdem::Config config;
  config.method = "fdem2d";
  config.time.evaluate_every = 100;
  config.joints.criterion = "edge";
  fdem::MaterialConfig rock;
  rock.name = "rock";
  rock.damping = 0.1;
  config.materials.push_back(rock);
  return config;
}

dem::Model side_by_side(const dem::Model& one, int copies, int threads) {
  return side_by_side(one, TileRun{0, copies, copies}, threads);
}

dem::Model side_by_side(const dem::Model& one, const TileRun& copies, int threads) {
  constexpr double pitch = 2.0;
  const auto row = static_cast<int>(std::lround(std::sqrt(copies.count)));
  const int built = copies.last - copies.first;
  const auto count = static_cast<std::size_t>(built);
  dem::Model all;
  all.groups = one.groups;
  all.interaction_range = one.interaction_range;
  std::vector<const void*> sources;
  dem::each_element_array(one, [&](const char*, const auto& items) { sources.push_back(&items); });
  dem::each_element_array(
      all, [&](const char*, auto& items) { items.resize(count * one.position.size()); });
  all.links.resize(count * one.links.size());
  for_each_task(threads, built, [&](int k) {
    const int copy = copies.first + k;
    const Index first = k * one.size();
    const Vec3 shift{pitch * (copy % row), pitch * (copy / row), 0.0};
    auto source = sources.begin();
    dem::each_element_array(all, [&](const char*, auto& items) {
      const auto& from = *static_cast<const std::remove_reference_t<decltype(items)>*>(*source++);
      std::copy(from.begin(), from.end(), items.begin() + first);
    });
    for (Index e = first; e < first + one.size(); ++e) {
      all.position[at(e)] += shift;
      for (Index* along : {&all.bar_previous[at(e)], &all.bar_next[at(e)]})
        if (*along >= 0) *along += first;
    }
    auto to = all.links.begin() + static_cast<std::ptrdiff_t>(at(k) * one.links.size());
    for (dem::Model::Link link : one.links) {
      link.a += first;
      link.b += first;
      *to++ = link;
    }
  });
  return all;
}

}  // namespace breccia
