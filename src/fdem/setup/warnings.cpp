#include "fdem/setup/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/on_host.hpp"
#include "fdem/observe.hpp"
#include "fdem_shared/observe.hpp"
#include "fdem_shared/setup/empty_probes.hpp"
#include "fdem_shared/setup/weight.hpp"

namespace breccia::fdem {
namespace {

Vec2 middle(const TriangleNodes& nodes) {
  return (1.0 / 3.0) * (nodes.at[0].position + nodes.at[1].position + nodes.at[2].position);
}

/// A triangle that makes the steps of all others short.
void look_for_slivers(const World& w, std::vector<std::string>& found) {
  constexpr double factor = 10.0;
  std::vector<double> steps;
  for (const fdem_shared::StepOfElement& of : fdem_shared::stable_steps(w))
    steps.push_back(of.step);
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
  std::snprintf(
      text, sizeof text,
      "triangle %d (%s) at (%.6g, %.6g) m, with edges of %.3g to %.3g m, needs a time "
      "step %.3g times shorter than the median triangle (%.3g s, ruled by %s); %lld "
      "triangles are within a factor of 2 of it. Slivers of the mesh? See docs/meshes.md, "
      "and time.added_mass, which makes such triangles heavier",
      ruling, w.given->groups[at(triangles->group.data()[ruling])].c_str(), middle(nodes).x,
      middle(nodes).y, shortest, longest, *half / least, least, ruling_term(w),
      static_cast<long long>(many));
  found.emplace_back(text);
}

/// The joints of one law against the zone in which they soften, E G_I/f_t^2.
struct ProcessZone {
  double zone = 1e300;              ///< the shortest  [m]
  double sum = 0.0, longest = 0.0;  ///< of their lengths  [m]
  Index count = 0, at_longest = -1;
  double edges() const { return zone * count / sum; }  ///< that it spans in the mean  [-]
};

/// A law whose process zone the mesh does not resolve.
void look_for_long_edges(const World& w, const Config& config, std::vector<std::string>& found) {
  constexpr double wanted = 3.0;
  const OnHost<Joints> joints(w.joints, w.exec.space);
  const OnHost<Triangles> triangles(w.triangles, w.exec.space);
  std::vector<JointBond> bonds;
  copy_to(bonds, w.given->bonds);
  const auto material = [&](Index edge) -> const MaterialConfig& {
    return config.materials[at(triangles->material.data()[edge / 3])];
  };
  std::vector<ProcessZone> zones(bonds.size());
  std::map<std::pair<double, double>, std::size_t> first;  // laws of bedded rock are many
  for (std::size_t k = 0; k < bonds.size(); ++k)
    first.emplace(std::pair{bonds[k].tension, bonds[k].softening_open}, k);
  for (Index i = 0; i < joints->size(); ++i) {
    const JointBond& bond = bonds[at(joints->law.data()[i])];
    if (!(bond.tension > 0.0)) continue;
    ProcessZone& z = zones[first.at({bond.tension, bond.softening_open})];
    const double young = std::min(material(joints->edge_a.data()[i]).young,
                                  material(joints->edge_b.data()[i]).young);
    const double energy = bond.softening_open / config.joints.softening_factor;
    const double length = joints->length.data()[i];
    z.zone = std::min(z.zone, young * energy / (bond.tension * bond.tension));
    z.sum += length;
    ++z.count;
    if (length <= z.longest) continue;
    z.longest = length;
    z.at_longest = i;
  }
  std::erase_if(zones, [](const ProcessZone& z) { return z.count == 0 || !(z.edges() < wanted); });
  if (zones.empty()) return;
  const ProcessZone& worst = *std::min_element(
      zones.begin(), zones.end(),
      [](const ProcessZone& a, const ProcessZone& b) { return a.edges() < b.edges(); });
  const Index a = joints->edge_a.data()[worst.at_longest],
              b = joints->edge_b.data()[worst.at_longest];
  const NodeState* const ends = triangles->nodes.data()[a / 3].at;
  const Vec2 place = 0.5 * (ends[a % 3].position + ends[(a + 1) % 3].position);
  std::string names = material(a).name;
  if (material(b).name != names) names += " and " + material(b).name;
  const JointBond& law = bonds[at(joints->law.data()[worst.at_longest])];
  for (const JointConfig& own : config.joint_laws)
    if (own.strength.tension == law.tension &&
        config.joints.softening_factor * own.strength.energy_open == law.softening_open)
      names = "joint." + own.name + ", " + names;
  std::string others;
  if (zones.size() > 1)
    others = "; " + std::to_string(zones.size()) + " laws of joints are like that";
  char text[700];
  std::snprintf(text, sizeof text,
                "%d joints (%s): their process zone E G_I/f_t^2 = %.3g m spans %.2g edges of %.3g "
                "m (the longest, %.3g m, at (%.6g, %.6g) m), not 3: strength and energy depend on "
                "the mesh, and each row of triangles may break by itself%s. A shorter mesh_size "
                "of %.2g m would do, or an energy_open %.2g times as large; else take "
                "the strength as one of this mesh",
                worst.count, names.c_str(), worst.zone, worst.edges(), worst.sum / worst.count,
                worst.longest, place.x, place.y, others.c_str(), worst.zone / wanted,
                wanted / worst.edges());
  found.emplace_back(text);
}

}  // namespace

std::vector<std::string> doubts(const World& w, const Config& config) {
  std::vector<std::string> found;
  fdem_shared::look_for_empty_probes(w, config, found);
  fdem_shared::look_for_unbalanced_weight(
      config, "xx_slope[0] + xy_slope[1] and xy_slope[0] + yy_slope[1]", found);
  look_for_slivers(w, found);
  look_for_long_edges(w, config, found);
  return found;
}

}  // namespace breccia::fdem
