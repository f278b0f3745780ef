// A DEM world as output sees it.

#include <algorithm>
#include <array>
#include <utility>

#include "core/on_host.hpp"
#include "dem/observe.hpp"
#include "math/constants.hpp"
#include "run/dem_method.hpp"

namespace breccia {
namespace {

using namespace dem;

/// How many elements and links there are in all, and bodies.
struct Totals {
  std::int64_t elements, concrete, steel, interface;
  std::size_t bodies;
};

/// @param own  elements and links of this rank  [-]
Totals totals(const Domain& domain, std::array<std::int64_t, 4> own, std::int16_t last_body) {
  double last = last_body;
  if (!domain.alone()) {
    domain.ranks->add_up(own);
    last = -domain.ranks->least(-last);
  }
  return {own[0], own[1], own[2], own[3], static_cast<std::size_t>(last + 1.0)};
}

/// Elements of a frame, and places of lines that end on them.
class DemFrame {
 public:
  explicit DemFrame(const dem::World& w)
      : w_(w),
        elements_(w.elements, w.exec.space),
        concrete_(w.concrete, w.exec.space),
        steel_(w.steel, w.exec.space),
        interface_(w.interface, w.exec.space) {}

  FramePart made() {
    const Elements& e = *elements_;
    for (Index i = 0; i < e.size(); ++i)
      if (w_.domain.owns(i)) own_.push_back(i);
    std::int16_t last_body = -1;
    for (const Index i : own_) last_body = std::max(last_body, e.group.data()[i]);
    const Totals all = totals(
        w_.domain,
        {static_cast<std::int64_t>(own_.size()), own(*concrete_), own(*steel_), own(*interface_)},
        last_body);
    Frame& f = part_.frame;
    f.step = w_.step;
    f.time = w_.time;
    for (std::size_t g = 0; g < all.bodies; ++g) f.groups.push_back(w_.sets[g].name);
    add_elements();
    add_links(all);
    FramePlaces& places = part_.places;
    places.whole = w_.domain.alone();
    places.has_spheres = true;
    places.points = all.elements;
    places.lines = all.concrete + all.steel + all.interface;
    return std::move(part_);
  }

 private:
  template <class Links>
  std::int64_t own(const Links& links) const {
    if (w_.domain.alone()) return links.size();
    return std::count_if(links.a.host().begin(), links.a.host().end(),
                         [this](Index a) { return w_.domain.owns(a); });
  }

  template <class Value>
  FrameField scalar(const char* name, const Value& value) const {
    FrameField field{name, "-", 1, {}};
    field.values.reserve(own_.size());
    for (const Index i : own_) field.values.push_back(static_cast<float>(value(i)));
    return field;
  }
  FrameField vector(const char* name, const char* unit, Vec3 ElementState::*member) const {
    FrameField field{name, unit, 3, {}};
    field.values.reserve(3 * own_.size());
    for (const Index i : own_) {
      const Vec3& v = elements_->state.data()[i].*member;
      for (const double c : {v.x, v.y, v.z}) field.values.push_back(static_cast<float>(c));
    }
    return field;
  }

  void add_elements() {
    const Elements& e = *elements_;
    Frame& f = part_.frame;
    f.position.reserve(own_.size());
    f.radius.reserve(own_.size());
    for (const Index i : own_) {
      f.position.push_back(e.state.data()[i].position);
      f.radius.push_back(e.state.data()[i].radius);
      if (!w_.domain.alone()) part_.places.point.push_back(e.id.data()[i]);
    }
    f.point_fields.push_back(vector("velocity", "m/s", &ElementState::velocity));
    f.point_fields.push_back(vector("spin", "rad/s", &ElementState::spin));
    f.point_fields.push_back(scalar("group", [&](Index i) { return e.group.data()[i]; }));
    const std::vector<double> lost = damage(w_);
    f.point_fields.push_back(
        scalar("damage", [&](Index i) { return lost[static_cast<std::size_t>(i)]; }));
    f.point_fields.push_back(scalar("id", [&](Index i) { return e.id.data()[i]; }));
    if (w_.domain.config.show)
      f.point_fields.push_back(scalar(
          "rank", [&](Index i) { return w_.domain.partition.owner(e.state.data()[i].position); }));
  }

  // Links: kind 0 concrete, 1 steel, 2 interface; state 0 whole, 1 softened or yielded, 2 broken.
  void add_links(const Totals& all) {
    const ConcreteLinks& c = *concrete_;
    kind_ = 0.0F;
    for (const auto& g : w_.concrete_groups)
      for (Index i = g.begin; i < g.end; ++i) {
        if (!w_.domain.owns(c.a.data()[i])) continue;
        const ElementState* const state = elements_->state.data();
        const double opening = link_opening(c, i);
        const double r = std::min(state[c.a.data()[i]].radius, state[c.b.data()[i]].radius);
        const double onset = g.law.tensile_strength * pi * r * r / c.stiffness.data()[i];
        add_line(c, i,
                 opening < 0.0     ? 2.0F
                 : opening > onset ? 1.0F
                                   : 0.0F,
                 norm(link_force(g.law, c, *elements_, i)));
        note_place(w_.numbers.concrete, i, 0);
      }
    Buffer<Action> copy;
    if (w_.exec.space != Space::host) copy_to(copy, w_.bar_actions);
    const Buffer<Action>& actions = w_.exec.space != Space::host ? copy : w_.bar_actions;
    const auto bar_pull = [&](Index i) { return norm(actions.data()[i].force_on_b()); };
    const SteelLinks& s = *steel_;
    kind_ = 1.0F;
    for (Index i = 0; i < s.size(); ++i) {
      if (!w_.domain.owns(s.a.data()[i])) continue;
      const double hardening = s.state.data()[i].hardening;
      add_line(s, i, hardening < 0.0 ? 2.0F : hardening > 0.0 ? 1.0F : 0.0F, bar_pull(i));
      note_place(w_.numbers.steel, i, all.concrete);
    }
    const InterfaceLinks& b = *interface_;
    kind_ = 2.0F;
    for (Index i = 0; i < b.size(); ++i) {
      if (!w_.domain.owns(b.a.data()[i])) continue;
      add_line(b, i, b.state.data()[i].opening < 0.0 ? 2.0F : 0.0F, bar_pull(s.size() + i));
      note_place(w_.numbers.interface, i, all.concrete + all.steel);
    }
    part_.frame.line_fields.push_back(std::move(kinds_));
    part_.frame.line_fields.push_back(std::move(states_));
    part_.frame.line_fields.push_back(std::move(force_));
  }

  template <class Links>
  void add_line(const Links& links, Index i, float state, double pull) {
    for (const Buffer<Index>* ends : {&links.a, &links.b})
      part_.frame.lines.push_back(elements_->id.data()[ends->data()[i]]);
    force_.values.push_back(static_cast<float>(pull));  // |force on b|
    kinds_.values.push_back(kind_);
    states_.values.push_back(state);
  }
  /// @param before  lines of other kinds
  void note_place(const Buffer<Index>& numbers, Index i, std::int64_t before) {
    if (!w_.domain.alone())
      part_.places.line.push_back(static_cast<std::int32_t>(before + numbers.data()[i]));
  }

  const dem::World& w_;
  OnHost<Elements> elements_;
  OnHost<ConcreteLinks> concrete_;
  OnHost<SteelLinks> steel_;
  OnHost<InterfaceLinks> interface_;
  std::vector<Index> own_;
  float kind_ = 0.0F;  ///< of the lines that are added now
  FrameField kinds_{"kind", "-", 1, {}}, states_{"state", "-", 1, {}}, force_{"force", "N", 1, {}};
  FramePart part_;
};

}  // namespace

FramePart dem_frame(const dem::World& w) {
  return DemFrame(w).made();
}

}  // namespace breccia
