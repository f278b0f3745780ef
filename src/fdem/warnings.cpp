#include "fdem/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/on_host.hpp"
#include "exec/for_each.hpp"
#include "fdem/observe.hpp"

namespace breccia::fdem {
namespace {

struct ListSteps {
  static constexpr const char* name = "fdem.list_steps";
  StableStep stable;
  View<double> step;
  BR_HD void operator()(Index t) const { step[t] = stable(t); }
};

Vec2 middle(const TriangleNodes& nodes) {
  return (1.0 / 3.0) * (nodes.at[0].position + nodes.at[1].position + nodes.at[2].position);
}

/// A triangle that makes the steps of all others short.
void look_for_slivers(const World& w, std::vector<std::string>& found) {
  constexpr double factor = 10.0;
  Buffer<double> listed(w.exec.space, w.triangles.size());
  for_each(w.exec, listed.size(), ListSteps{stable_step(w), listed.view()});
  std::vector<double> steps;
  copy_to(steps, listed);
  const auto ruling =
      static_cast<Index>(std::min_element(steps.begin(), steps.end()) - steps.begin());
  const double least = steps[at(ruling)];
  const auto many =
      std::count_if(steps.begin(), steps.end(), [&](double s) { return s < 2.0 * least; });
  const auto half = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), half, steps.end());
  if (!(*half > factor * least) || !(*half < 1e300)) return;
  const OnHost<Triangles> triangles(w.triangles, w.exec.space);
  const TriangleNodes& nodes = triangles->nodes.data()[ruling];
  double shortest = 1e300, longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double edge = norm(nodes.at[(k + 1) % 3].position - nodes.at[k].position);
    shortest = std::min(shortest, edge);
    longest = std::max(longest, edge);
  }
  char text[500];
  std::snprintf(text, sizeof text,
                "triangle %d (%s) at (%.6g, %.6g) m, with edges of %.3g to %.3g m, needs a time "
                "step %.3g times shorter than the median triangle (%.3g s, ruled by %s); %lld "
                "triangles are within a factor of 2 of it. Slivers of the mesh? See docs/meshes.md",
                ruling, w.groups[at(triangles->group.data()[ruling])].c_str(), middle(nodes).x,
                middle(nodes).y, shortest, longest, *half / least, least, ruling_term(w),
                static_cast<long long>(many));
  found.emplace_back(text);
}

}  // namespace

std::vector<std::string> doubts(const World& w, const Config&) {
  std::vector<std::string> found;
  look_for_slivers(w, found);
  return found;
}

}  // namespace breccia::fdem
