// The discrete element method on two pages: a ball of bonded spheres strikes a plate of bonded
// spheres, links break, fragments fly. For teaching: one thread, no rotation, no friction.
// Breccia's loop, src/dem/stepping/step.hpp, has the same stages; its laws are in docs/theory.md.
//
//   g++ -O2 -std=c++20 docs/dem_in_100_lines.cpp -o dem && ./dem
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

// clang-format off
struct Vec { double x = 0.0, y = 0.0, z = 0.0; };
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double norm(Vec a) { return std::sqrt(dot(a, a)); }
// clang-format on

struct Link {
  int a, b;
  double length;         // free of force [m]
  double stretch = 0.0;  // in the last step, positive in tension [m]
};

constexpr double radius = 0.01;             // of each sphere [m]
constexpr double mass = 0.02;               // of each sphere [kg]
constexpr double stiffness = 1e7;           // of each link and contact [N/m]
constexpr double strain_at_rupture = 2e-3;  // of a link [-]
constexpr double speed = 4.0;               // of the ball [m/s]
constexpr double margin = 0.3 * radius;     // a search lists pairs with up to this gap [m]

std::vector<Vec> position, velocity, force;
std::vector<Link> links;
std::vector<std::pair<int, int>> near;  // pairs without a link that touch or soon may
double elastic = 0.0, fracture = 0.0;   // energies of links and contacts [J]

/// A body: spheres on a cubic lattice wherever inside(place) holds, each linked to its 6 nearest
/// neighbours and to the 12 across a face of the lattice.
template <class Inside>
void add_body(Vec centre, int half, Vec start, const Inside& inside) {
  const int first = static_cast<int>(position.size());
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j)
      for (int k = -half; k <= half; ++k)
        if (const Vec place = 2.0 * radius * Vec{1.0 * i, 1.0 * j, 1.0 * k}; inside(place))
          position.push_back(centre + place);
  const int last = static_cast<int>(position.size());
  velocity.resize(position.size(), start);
  for (int a = first; a < last; ++a)
    for (int b = a + 1; b < last; ++b)
      if (const double length = norm(position[b] - position[a]); length < 3.0 * radius)
        links.push_back({a, b, length});
}

/// Contact search: a grid whose cells are as wide as the reach, so that neighbours lie in 27 cells.
void find_near_pairs() {
  const double reach = 2.0 * radius + margin;
  std::map<std::tuple<int, int, int>, std::vector<int>> cells;
  const auto cell = [&](double x) { return static_cast<int>(std::floor(x / reach)); };
  std::vector<std::vector<int>> linked(position.size());
  for (const Link& link : links) linked[link.a].push_back(link.b);
  near.clear();
  for (int b = 0; b < static_cast<int>(position.size()); ++b) {
    const int x = cell(position[b].x), y = cell(position[b].y), z = cell(position[b].z);
    for (int i = 0; i < 27; ++i)  // spheres before b are in the grid: each pair is met once
      if (const auto found = cells.find({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1});
          found != cells.end())
        for (const int a : found->second)
          if (norm(position[b] - position[a]) < reach && std::ranges::count(linked[a], b) == 0)
            near.emplace_back(a, b);
    cells[{x, y, z}].push_back(b);
  }
}

/// A spring between two spheres: equal and opposite forces, so that momentum cannot change.
void pull(int a, int b, double stretch) {
  const Vec line = position[b] - position[a];
  const Vec on_a = stiffness * stretch / norm(line) * line;
  force[a] = force[a] + on_a;
  force[b] = force[b] - on_a;
  elastic += 0.5 * stiffness * stretch * stretch;
}

void evaluate_forces() {
  force.assign(position.size(), Vec{});
  elastic = 0.0;
  std::erase_if(links, [](Link& link) {
    const double stretch = norm(position[link.b] - position[link.a]) - link.length;
    const bool breaks = stretch > strain_at_rupture * link.length;
    if (breaks) {  // the stored energy and the work of this step are lost
      fracture += 0.5 * stiffness * link.stretch * stretch;
      near.emplace_back(link.a, link.b);  // what remains is a contact
    } else {
      pull(link.a, link.b, stretch);
    }
    link.stretch = stretch;
    return breaks;
  });
  for (const auto& [a, b] : near)  // contacts push only
    if (const double gap = norm(position[b] - position[a]) - 2.0 * radius; gap < 0.0)
      pull(a, b, gap);
}

int main() {
  add_body({0.0, 0.0, 0.0}, 8, {}, [](Vec p) { return std::abs(p.z) < 3.0 * radius; });  // plate
  add_body({radius, radius, 0.11}, 3, {0.0, 0.0, -speed},
           [](Vec p) { return norm(p) < 0.065; });  // ball
  const std::size_t links_at_start = links.size();
  const double dt =
      0.1 * std::sqrt(2.0 * mass / (6.0 * stiffness));  // a tenth of the stable step [s]
  std::vector<Vec> searched_at;
  Vec momentum, momentum_at_start;
  double kinetic = 0.0, energy_at_start = 0.0, error = 0.0;
  std::puts("   time [ms]  kinetic [J]  elastic [J]  fracture [J]  links");
  for (int step = 0; step <= 6000; ++step) {
    double travel = searched_at.empty() ? margin : 0.0;  // largest since the last search [m]
    for (std::size_t e = 0; e < searched_at.size(); ++e)
      travel = std::max(travel, norm(position[e] - searched_at[e]));
    if (2.0 * travel >= margin) {
      find_near_pairs();
      searched_at = position;
    }
    evaluate_forces();
    kinetic = 0.0;
    momentum = {};
    for (std::size_t e = 0; e < position.size();
         ++e) {  // leapfrog: velocities live between positions
      const Vec before = velocity[e];
      velocity[e] = before + dt / mass * force[e];
      kinetic += 0.5 * mass * dot(before, velocity[e]);  // belongs to the time of positions
      momentum = momentum + mass * velocity[e];
      position[e] = position[e] + dt * velocity[e];
    }
    if (step == 0) {
      energy_at_start = kinetic + elastic;
      momentum_at_start = momentum;
    }
    error =
        std::max(error, std::abs(kinetic + elastic + fracture - energy_at_start) / energy_at_start);
    if (step % 500 == 0)
      std::printf("%12.3f %12.6f %12.6f %13.6f %6zu\n", 1e3 * dt * step, kinetic, elastic, fracture,
                  links.size());
  }
  const double drift = norm(momentum - momentum_at_start) / norm(momentum_at_start);
  std::printf("spheres %zu, broken links %zu of %zu\n", position.size(),
              links_at_start - links.size(), links_at_start);
  std::printf("largest error of energy %.3e, change of momentum %.3e (relative)\n", error, drift);
}
