// A DEM world as output sees it.

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/on_host.hpp"
#include "dem/observe.hpp"
#include "dem/stress.hpp"
#include "domain/drift.hpp"
#include "run/frames/fields.hpp"
#include "run/frames/wall_triangles.hpp"
#include "run/method/dem_method.hpp"

namespace breccia {
namespace dem {
namespace {

using Kind = Quantity::Kind;

/// How many elements and links there are in all, and bodies.
struct Totals {
  std::array<std::int64_t, link_kinds + 1> items;  ///< links by kind, then elements  [-]
  std::size_t bodies;
};

/// @param own  of this rank, as in Totals::items  [-]
Totals totals(const Domain& domain, std::array<std::int64_t, link_kinds + 1> own,
              std::int16_t last_body) {
  double last = last_body;
  if (!domain.single_rank()) {
    domain.ranks->add_up(own);
    last = -domain.ranks->least(-last);
  }
  return {own, static_cast<std::size_t>(last + 1.0)};
}

/// Numbers in the whole of the links, of all ranks, with an end that has been taken out, ascending:
/// they left with it.
template <class Links>
std::vector<Index> links_taken_out(const World& w, const Elements& e, const Links& set) {
  const std::vector<std::uint8_t>& removed = w.given->removed;
  if (std::find(removed.begin(), removed.end(), 1) == removed.end()) return {};
  const OnHost a(set.a, w.exec.space), b(set.b, w.exec.space);
  const auto gone = [&](Index end) { return is_gone(e.fixed.data()[end]); };
  std::vector<Index> out;
  for (Index i = 0; i < set.size(); ++i)
    if (w.domain.owns(a->data()[i]) && (gone(a->data()[i]) || gone(b->data()[i])))
      out.push_back(w.domain.single_rank() ? i : set.numbers.data()[i]);
  if (w.domain.single_rank()) return out;
  Communicator& ranks = *w.domain.ranks;
  std::vector<Message> messages(static_cast<std::size_t>(ranks.size()));
  for (Message& message : messages) put_array(message, out);
  out.clear();
  for (const Message& message : ranks.exchange(std::move(messages))) {
    const std::vector<Index> more = Unpacking(message).array<Index>();
    out.insert(out.end(), more.begin(), more.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Elements of a frame, and places of lines that end on them.
class DemFrame {
 public:
  explicit DemFrame(const dem::World& w) : w_(w), elements_(w.elements, w.exec.space) {}

  FramePart made() {
    const Elements& e = *elements_;
    for (Index i = 0; i < e.size(); ++i)
      if (w_.domain.owns(i)) own_.push_back(i);
    std::int16_t last_body = -1;
    for (const Index i : own_) last_body = std::max(last_body, e.group.data()[i]);
    std::array<std::int64_t, link_kinds + 1> items{};
    w_.each_set([&](const auto& set) {
      const auto kind = static_cast<std::size_t>(set.kind);
      out_[kind] = links_taken_out(w_, e, set);
      items[kind] = own(set);
    });
    items.back() = static_cast<std::int64_t>(own_.size());
    const Totals all = totals(w_.domain, items, last_body);
    Frame& f = part_.frame;
    f.step = w_.step;
    f.time = w_.time;
    for (std::size_t g = 0; g < all.bodies; ++g) f.groups.push_back(w_.given->sets[g].name);
    for (std::size_t k = 0; k < w_.walls.size(); ++k) {
      const Wall& wall = w_.walls[k];
      const bool mesh = wall.shape == dem::WallShape::mesh;
      f.walls.push_back({wall.point, wall.normal, mesh ? corners_of(k) : wall_triangles(wall)});
    }
    add_elements();
    if (w_.given->sets.size() > all.bodies) {
      constexpr std::uint8_t places = fixed_x | fixed_y | fixed_z;
      f.point_fields.push_back(scalar(Kind::held, [&](Index i) {
        const std::uint8_t fixed = elements_->fixed.data()[i];
        return is_gone(fixed) ? 0 : fixed & places;
      }));
    }
    add_more();
    add_links(all);
    add_contacts();
    FramePlaces& places = part_.places;
    places.whole = w_.domain.single_rank();
    places.has_spheres = true;
    places.points = all.items.back();
    places.lines = std::accumulate(all.items.begin(), all.items.end() - 1, std::int64_t{0});
    return std::move(part_);
  }

 private:
  template <class Links>
  std::int64_t own(const Links& links) const {
    const OnHost ends(links.a, w_.exec.space);
    std::int64_t count = 0;
    for (Index i = 0; i < links.size(); ++i)
      count += w_.domain.owns(ends->data()[i]) && !is_out(links, i) ? 1 : 0;
    return count;
  }
  template <class Links>
  Index number_of(const Links& links, Index i) const {
    return w_.domain.single_rank() ? i : links.numbers.data()[i];
  }
  /// Links of this kind with lower numbers that have been taken out.
  std::ptrdiff_t out_before(LinkKind kind, Index number) const {
    const std::vector<Index>& out = out_[static_cast<std::size_t>(kind)];
    return std::lower_bound(out.begin(), out.end(), number) - out.begin();
  }
  template <class Links>
  bool is_out(const Links& links, Index i) const {
    const std::vector<Index>& out = out_[static_cast<std::size_t>(links.kind)];
    return !out.empty() && std::binary_search(out.begin(), out.end(), number_of(links, i));
  }

  template <class Value>
  FrameField scalar(Kind kind, const Value& value) const {
    FrameField field = field_of({kind});
    field.values.reserve(own_.size());
    for (const Index i : own_) field.values.push_back(static_cast<float>(value(i)));
    return field;
  }
  template <class Value>
  FrameField number(Kind kind, const Value& value) const {
    std::vector<std::int32_t> numbers;
    numbers.reserve(own_.size());
    for (const Index i : own_) numbers.push_back(static_cast<std::int32_t>(value(i)));
    return numbers_of(kind, std::move(numbers));
  }
  FrameField vector(Kind kind, const std::vector<Vec3>& of) const {
    FrameField field = field_of({kind});
    field.values.reserve(3 * own_.size());
    for (const Index i : own_) {
      const Vec3& v = of[static_cast<std::size_t>(i)];
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
      f.radius.push_back(is_gone(e.fixed.data()[i]) ? 0.0 : e.state.data()[i].radius);
      if (!w_.domain.single_rank()) part_.places.point.push_back(e.id.data()[i]);
    }
    const MotionNow now = motion_now(w_);
    f.point_fields.push_back(vector(Kind::velocity, now.velocity));
    f.point_fields.push_back(vector(Kind::spin, now.spin));
    f.point_fields.push_back(number(Kind::group, [&](Index i) { return e.group.data()[i]; }));
    const std::vector<double> lost = damage(w_);
    f.point_fields.push_back(
        scalar(Kind::damage, [&](Index i) { return lost[static_cast<std::size_t>(i)]; }));
    const std::vector<std::uint8_t>& bars = w_.given->bars;
    if (std::find(bars.begin(), bars.end(), 1) != bars.end())
      f.point_fields.push_back(number(Kind::bar, [&](Index i) {
        return bars[static_cast<std::size_t>(e.material.data()[i])];
      }));
    f.point_fields.push_back(number(Kind::id, [&](Index i) { return e.id.data()[i]; }));
    if (!w_.domain.config.show) return;
    const Partition partition = partition_at(w_.domain, w_.travel.drift.velocity, w_.time);
    f.point_fields.push_back(
        number(Kind::rank, [&](Index i) { return partition.owner(e.state.data()[i].position); }));
  }

  /// Fields that the case asks for.
  void add_more() {
    const Elements& e = *elements_;
    const MoreFields& more = w_.given->shown;
    Frame& f = part_.frame;
    std::vector<Vec3> of(static_cast<std::size_t>(e.size()));
    if (more.displacement) {
      const OnHost starts(w_.given->starts, w_.exec.space);
      for (const Index i : own_)
        of[static_cast<std::size_t>(i)] =
            e.state.data()[i].position - starts->data()[e.id.data()[i]];
      f.point_fields.push_back(vector(Kind::displacement, of));
    }
    if (more.force) {
      for (const Index i : own_) of[static_cast<std::size_t>(i)] = e.force.data()[i];
      f.point_fields.push_back(vector(Kind::force, of));
    }
    if (!more.stress) return;
    const std::vector<Stress> all = stresses(w_);
    FrameField field = field_of({Kind::stress});
    for (const Index i : own_)
      for (const double part : all[static_cast<std::size_t>(i)])
        field.values.push_back(static_cast<float>(part));
    f.point_fields.push_back(std::move(field));
  }

  /// Of the triangles of a wall.  [m]
  std::vector<Vec3> corners_of(std::size_t k) const {
    const OnHost triangles(w_.given->meshes.triangles, w_.exec.space);
    const dem::WallMeshes::Part& part = w_.given->meshes.parts[k];
    std::vector<Vec3> all;
    for (Index t = part.first_triangle; t < part.last_triangle; ++t)
      for (const Vec3& c : triangles->data()[t].corner)
        all.push_back(w_.walls[k].point + dem::out_of_mesh(w_.walls[k], c));
    return all;
  }

  // Links: kind 0 concrete, 1 steel, 2 interface; state 0 whole, 1 softened or yielded, 2 broken.
  void add_links(const Totals& all) {
    const OnHost actions(w_.bar_actions, w_.exec.space);
    std::int64_t before = 0;
    Index first_action = 0;
    const bool has_facets = all.items[static_cast<std::size_t>(LinkKind::ldpm)] > 0;
    w_.each_set([&](const auto& set) {
      const OnHost arrays(set.arrays(), w_.exec.space);
      kind_ = static_cast<std::int32_t>(set.kind);
      for (const auto& g : set.groups)
        for (Index i = g.begin; i < g.end; ++i) {
          if (!w_.domain.owns(arrays->a.data()[i]) || is_out(set, i)) continue;
          double pull = 0.0;
          if constexpr (std::remove_reference_t<decltype(set)>::swept)
            pull = norm(link_force(g.law, *arrays, *elements_, i));
          else
            pull = norm(actions->data()[first_action + i].force_on_b());
          add_line(*arrays, i, static_cast<std::int32_t>(stage_of(g.law, *arrays, *elements_, i)),
                   pull);
          if (has_facets) add_crack(g.law, *arrays, i);
          if (!w_.domain.single_rank())
            part_.places.line.push_back(static_cast<std::int32_t>(
                before + set.numbers.data()[i] - out_before(set.kind, set.numbers.data()[i])));
        }
      before += all.items[static_cast<std::size_t>(set.kind)];
      if (!set.swept) first_action += set.size();
    });
    part_.frame.line_fields.push_back(numbers_of(Kind::link, std::move(kinds_)));
    part_.frame.line_fields.push_back(numbers_of(Kind::state, std::move(states_)));
    FrameField force = field_of({Kind::force});
    force.components = 1;
    force.values = std::move(pull_);
    part_.frame.line_fields.push_back(std::move(force));
    if (!has_facets) return;
    for (const auto& [kind, values] :
         {std::pair{Kind::opening, &openings_}, {Kind::slip, &slips_}}) {
      FrameField field = field_of({kind});
      field.values = std::move(*values);
      part_.frame.line_fields.push_back(std::move(field));
    }
  }

  /// Contacts that press, by the forces of the last step.
  void add_contacts() {
    const auto& state = elements_->state;
    const auto& id = elements_->id;
    const OnHost actions(w_.contact_actions, w_.exec.space);
    const OnHost a(w_.contacts.pairs.a, w_.exec.space), b(w_.contacts.pairs.b, w_.exec.space);
    const Index known = actions->size() == w_.contacts.size() ? w_.contacts.size() : 0;
    for (Index i = 0; i < known; ++i) {
      const Index from = a->data()[i], to = b->data()[i];
      const Vec3 force = actions->data()[i].force_on_b();
      if (!w_.domain.owns(from) || dot(force, force) == 0.0) continue;
      part_.frame.contacts.push_back({id.data()[from], id.data()[to], state.data()[from].position,
                                      state.data()[to].position, force});
    }
    const OnHost of(w_.wall_contacts.pairs.a, w_.exec.space);
    const OnHost wall(w_.wall_contacts.pairs.b, w_.exec.space);
    const OnHost on_wall(w_.wall_contacts.history.on_wall, w_.exec.space);
    const OnHost place(w_.wall_contacts.history.place, w_.exec.space);
    for (Index i = 0; i < w_.wall_contacts.size(); ++i) {
      const Index from = of->data()[i], k = wall->data()[i];
      const Vec3& force = on_wall->data()[i];
      if (!w_.domain.owns(from) || dot(force, force) == 0.0) continue;
      const Vec3& x = state.data()[from].position;
      const Vec3 foot = dem::foot_on(w_.walls[static_cast<std::size_t>(k)], x, place->data()[i]);
      part_.frame.contacts.push_back({id.data()[from], -1 - k, x, foot, force});
    }
  }

  template <class Links>
  void add_line(const Links& links, Index i, std::int32_t state, double pull) {
    for (const Buffer<Index>* ends : {&links.a, &links.b})
      part_.frame.lines.push_back(elements_->id.data()[ends->data()[i]]);
    pull_.push_back(static_cast<float>(pull));
    kinds_.push_back(kind_);
    states_.push_back(state);
  }
  /// How far a facet has opened and slid; other links have none.
  template <class Law, class Links>
  void add_crack(const Law& law, const Links& links, Index i) {
    double opening = 0.0, slip = 0.0;
    if constexpr (Links::kind == LinkKind::ldpm) {
      const double length = links.place.data()[i].length;
      const LdpmFacetState& s = links.state.data()[i];
      opening = law.opening(length, s), slip = law.slip(length, s);
    }
    openings_.push_back(static_cast<float>(opening));
    slips_.push_back(static_cast<float>(slip));
  }
  const dem::World& w_;
  OnHost<Elements> elements_;
  std::vector<Index> own_;
  std::array<std::vector<Index>, link_kinds> out_;  ///< links taken out, by kind: numbers
  std::int32_t kind_ = 0;                           ///< of the lines that are added now
  std::vector<std::int32_t> kinds_, states_;
  std::vector<float> pull_;              ///< |force on b|  [N]
  std::vector<float> openings_, slips_;  ///< of cracks, if there are facets  [m]
  FramePart part_;
};

FramePart frame_of(const World& w) {
  return DemFrame(w).made();
}

}  // namespace
}  // namespace dem

FramePart dem_frame(const dem::World& w) {
  return dem::frame_of(w);
}

}  // namespace breccia
