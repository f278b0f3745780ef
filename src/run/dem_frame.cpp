// A DEM world as output sees it.

#include <algorithm>
#include <utility>

#include "dem/observe.hpp"
#include "run/dem_method.hpp"

namespace breccia {
namespace {

using namespace dem;

FrameField vector_field(const char* name, const char* unit, const Elements& elements,
                        Vec3 ElementState::*member) {
  FrameField field{name, unit, 3, {}};
  for (const ElementState& state : elements.state.host()) {
    const Vec3& v = state.*member;
    for (const double c : {v.x, v.y, v.z}) field.values.push_back(static_cast<float>(c));
  }
  return field;
}

}  // namespace

Frame dem_frame(const dem::World& w) {
  const Elements e = host_copy(w.elements);
  Frame f;
  f.step = w.step;
  f.time = w.time;
  for (const ElementState& state : e.state.host()) {
    f.position.push_back(state.position);
    f.radius.push_back(state.radius);
  }
  const auto groups =
      static_cast<std::size_t>(*std::max_element(e.group.host().begin(), e.group.host().end()) + 1);
  for (std::size_t g = 0; g < groups; ++g) f.groups.push_back(w.sets[g].name);
  f.point_fields.push_back(vector_field("velocity", "m/s", e, &ElementState::velocity));
  f.point_fields.push_back(vector_field("spin", "rad/s", e, &ElementState::spin));
  FrameField group{"group", "-", 1, {}}, lost{"damage", "-", 1, {}}, id{"id", "-", 1, {}};
  for (const std::int16_t g : e.group.host()) group.values.push_back(static_cast<float>(g));
  for (const double d : damage(w)) lost.values.push_back(static_cast<float>(d));
  for (const GlobalId g : e.id.host()) id.values.push_back(static_cast<float>(g));
  f.point_fields.push_back(std::move(group));
  f.point_fields.push_back(std::move(lost));
  f.point_fields.push_back(std::move(id));
  if (w.domain.config.show) {
    FrameField rank{"rank", "-", 1, {}};
    for (const ElementState& s : e.state.host())
      rank.values.push_back(static_cast<float>(w.domain.partition.owner(s.position)));
    f.point_fields.push_back(std::move(rank));
  }

  // Links: kind 0 concrete, 1 steel, 2 interface; state 0 whole, 1 softened or yielded, 2 broken.
  FrameField kind{"kind", "-", 1, {}}, state{"state", "-", 1, {}}, force{"force", "N", 1, {}};
  const auto line = [&](Index a, Index b, float k, float s, double pull) {
    f.lines.push_back(a);
    f.lines.push_back(b);
    force.values.push_back(static_cast<float>(pull));  // |force on b|
    kind.values.push_back(k);
    state.values.push_back(s);
  };
  const ConcreteLinks c = host_copy(w.concrete);
  for (const auto& g : w.concrete_groups)
    for (Index i = g.begin; i < g.end; ++i) {
      const double opening = link_opening(c, i);
      const double r =
          std::min(e.state.data()[c.a.data()[i]].radius, e.state.data()[c.b.data()[i]].radius);
      const double onset =
          g.law.tensile_strength * 3.14159265358979323846 * r * r / c.stiffness.data()[i];
      line(c.a.data()[i], c.b.data()[i], 0.0F,
           opening < 0.0     ? 2.0F
           : opening > onset ? 1.0F
                             : 0.0F,
           norm(link_force(g.law, c, e, i)));
    }
  Buffer<Action> actions;
  copy_to(actions, w.bar_actions);
  const auto bar_pull = [&](Index i) { return norm(actions.data()[i].force_on_b()); };
  const SteelLinks s = host_copy(w.steel);
  for (Index i = 0; i < s.size(); ++i) {
    const double hardening = s.state.data()[i].hardening;
    line(s.a.data()[i], s.b.data()[i], 1.0F,
         hardening < 0.0   ? 2.0F
         : hardening > 0.0 ? 1.0F
                           : 0.0F,
         bar_pull(i));
  }
  const InterfaceLinks b = host_copy(w.interface);
  for (Index i = 0; i < b.size(); ++i)
    line(b.a.data()[i], b.b.data()[i], 2.0F, b.state.data()[i].opening < 0.0 ? 2.0F : 0.0F,
         bar_pull(s.size() + i));
  f.line_fields.push_back(std::move(kind));
  f.line_fields.push_back(std::move(state));
  f.line_fields.push_back(std::move(force));
  return f;
}

}  // namespace breccia
