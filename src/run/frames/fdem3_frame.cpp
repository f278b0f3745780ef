// A world of tetrahedra as output sees it.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/on_host.hpp"
#include "domain/drift.hpp"
#include "exec/tasks.hpp"
#include "fdem3/joints/joints_to_read.hpp"
#include "fdem3/observe.hpp"
#include "fdem3/ranks.hpp"
#include "fdem3/setup/removal.hpp"
#include "run/frames/mesh_parts.hpp"
#include "run/method/fdem3_method.hpp"

namespace breccia {
namespace fdem3 {
namespace {

using Kind = Quantity::Kind;

void put_vector(FrameField& field, std::size_t place, const Vec3& v) {
  field.values[3 * place] = static_cast<float>(v.x);
  field.values[3 * place + 1] = static_cast<float>(v.y);
  field.values[3 * place + 2] = static_cast<float>(v.z);
}

/// Fills the fields of one moment.
class FrameOfTetrahedra {
 public:
  FrameOfTetrahedra(World& w, const Tetrahedra& t, const Joints& j, const OwnParts& own,
                    const PlacedParts& placed, Frame& f)
      : w_(w), t_(t), j_(j), own_(own), placed_(placed), f_(f), velocity_(velocities_now(w)) {}

  void fill() {
    const std::size_t points =
        4 * own_.elements.size() + 3 * (own_.cracks.size() + own_.open.size());
    f_.position.resize(points);
    f_.point_fields.reserve(4);
    f_.point_fields.push_back(field_of({Kind::velocity}, points));
    add_elements();
    add_cracks();
    add_more(points);
  }

 private:
  void add_elements() {
    const std::size_t count = own_.elements.size();
    f_.tetrahedra.resize(4 * count);
    for (std::size_t k = 0; k < count; ++k) {
      const Index i = own_.elements[k];
      for (std::size_t c = 0; c < 4; ++c) {
        f_.tetrahedra[4 * k + c] =
            static_cast<std::int32_t>(4 * own_.place_of(t_.id.data()[i]) + static_cast<int>(c));
        f_.position[4 * k + c] = t_.nodes.data()[i].at[c].position;
        put_vector(f_.point_fields[0], 4 * k + c, velocity_[at(i)].at[c]);
      }
    }
    const std::vector<Sym3> stress = stresses(w_);
    const std::vector<double> lost = damage(w_);
    const std::vector<std::int32_t> visible = visible_faces(w_);
    field({Kind::stress, 0, 0}, [&](Index i) { return stress[at(i)].xx; });
    field({Kind::stress, 1, 1}, [&](Index i) { return stress[at(i)].yy; });
    field({Kind::stress, 2, 2}, [&](Index i) { return stress[at(i)].zz; });
    field({Kind::stress, 0, 1}, [&](Index i) { return stress[at(i)].xy; });
    field({Kind::stress, 1, 2}, [&](Index i) { return stress[at(i)].yz; });
    field({Kind::stress, 0, 2}, [&](Index i) { return stress[at(i)].xz; });
    field({Kind::pressure}, [&](Index i) { return -trace(stress[at(i)]) / 3.0; });
    field({Kind::damage}, [&](Index i) { return lost[at(i)]; });
    number(Kind::group, [&](Index i, std::size_t) { return t_.group.data()[i]; });
    number(Kind::material, [&](Index i, std::size_t) { return t_.material.data()[i]; });
    number(Kind::fragment, [&](Index, std::size_t k) { return placed_.fragment[k]; });
    number(Kind::exposed, [&](Index i, std::size_t) { return visible[at(i)]; });
    if (!w_.domain.config.show) return;
    const Partition partition = partition_at(w_.domain, w_.reach.drift.velocity, w_.time);
    number(Kind::rank,
           [&](Index i, std::size_t) { return partition.owner(centroid(t_.nodes.data()[i])); });
  }
  template <class Value>
  void field(const Quantity& of, const Value& value) {
    FrameField& made = f_.tetrahedron_fields.emplace_back(field_of(of));
    made.values.reserve(own_.elements.size());
    for (const Index i : own_.elements) made.values.push_back(static_cast<float>(value(i)));
  }
  template <class Value>
  void number(Kind kind, const Value& value) {
    std::vector<std::int32_t> numbers;
    numbers.reserve(own_.elements.size());
    for (std::size_t k = 0; k < own_.elements.size(); ++k)
      numbers.push_back(static_cast<std::int32_t>(value(own_.elements[k], k)));
    f_.tetrahedron_fields.push_back(numbers_of(kind, std::move(numbers)));
  }

  /// Calls visit(node of side a, node of side b) for the corners of a joint.
  template <class Visit>
  void each_corner(Index i, const Visit& visit) const {
    const JointEnds e = JointEnds::of(j_.face_a.data()[i], j_.face_b.data()[i], j_.turn.data()[i]);
    for (int k = 0; k < 3; ++k) visit(e.a[k], e.b[k]);
  }
  void add_cracks() {
    std::size_t point = 4 * own_.elements.size();
    for (std::size_t l = 0; l < own_.cracks.size(); ++l) {
      const Index i = own_.cracks[l];
      auto place = static_cast<std::int32_t>(4 * own_.shown + 3 * placed_.crack[l]);
      each_corner(i, [&](Index a, Index b) {
        f_.triangles.push_back(place++);
        const auto& on_a = t_.nodes.data()[a / 4].at[a % 4];
        const auto& on_b = t_.nodes.data()[b / 4].at[b % 4];
        f_.position[point] = 0.5 * (on_a.position + on_b.position);
        put_vector(f_.point_fields[0], point++,
                   0.5 * (velocity_[at(a / 4)].at[a % 4] + velocity_[at(b / 4)].at[b % 4]));
      });
    }
    const std::int64_t behind = 4 * own_.shown + 3 * placed_.cracks;
    for (const OpenSide& open : own_.open)
      for (const std::int64_t corner : {0, 1, 2})
        f_.triangles.push_back(static_cast<std::int32_t>(behind + 3 * open.place + corner));
    each_open_corner(w_, own_, [&](Index node) {
      f_.position[point] = t_.nodes.data()[node / 4].at[node % 4].position;
      put_vector(f_.point_fields[0], point++, velocity_[at(node / 4)].at[node % 4]);
    });
    const JointsToRead now{t_.nodes.view(), j_.face_a.view(), j_.face_b.view(), j_.turn.view()};
    add_crack_fields(j_, now, own_, f_.triangle_fields);
  }

  /// Of corners; of crack faces the mean of both sides.
  void add_more(std::size_t points) {
    const auto add = [&](Kind kind) -> FrameField& {
      f_.point_fields.push_back(field_of({kind}, points));
      return f_.point_fields.back();
    };
    if (w_.given->shown.displacement) add_displacement(add(Kind::displacement));
    if (w_.given->shown.force) {
      FrameField& force = add(Kind::force);
      for (std::size_t k = 0; k < own_.elements.size(); ++k)
        for (std::size_t c = 0; c < 4; ++c)
          put_vector(force, 4 * k + c, t_.force.data()[own_.elements[k]].at[c]);
    }
    if (w_.given->holds.size() == 0) return;
    const OnHost holds(w_.given->holds, w_.exec.space);
    FrameField& held = add(Kind::held);
    for (std::size_t k = 0; k < own_.elements.size(); ++k) {
      const Index hold = t_.hold.data()[own_.elements[k]];
      if (hold < 0 || holds->data()[hold].loose != 0) continue;
      for (int c = 0; c < 4; ++c)
        held.values[4 * k + static_cast<std::size_t>(c)] =
            static_cast<float>(holds->data()[hold].fixed_at(c));
    }
  }
  void add_displacement(FrameField& field) const {
    const OnHost starts(w_.given->starts, w_.exec.space);
    const auto way = [&](Index node) {
      return t_.nodes.data()[node / 4].at[node % 4].position -
             starts->data()[4 * t_.id.data()[node / 4] + node % 4];
    };
    for (std::size_t k = 0; k < own_.elements.size(); ++k)
      for (Index c = 0; c < 4; ++c)
        put_vector(field, 4 * k + static_cast<std::size_t>(c), way(4 * own_.elements[k] + c));
    std::size_t point = 4 * own_.elements.size();
    for (const Index i : own_.cracks)
      each_corner(i,
                  [&](Index a, Index b) { put_vector(field, point++, 0.5 * (way(a) + way(b))); });
    each_open_corner(w_, own_, [&](Index node) { put_vector(field, point++, way(node)); });
  }

  World& w_;
  const Tetrahedra& t_;
  const Joints& j_;
  const OwnParts& own_;
  const PlacedParts& placed_;
  Frame& f_;
  std::vector<Corners> velocity_;
};

FramePart frame_of(World& w, const World* mesh) {
  const OnHost<Tetrahedra> elements(w.tetrahedra, w.exec.space);
  const OnHost<Joints> joints(w.joints, w.exec.space);
  OwnParts own;
  const std::vector<std::uint8_t> gone = leave_out_removed(w, own);
  list_own(w, *joints, gone_tetrahedra(w), own);
  list_open_sides(w, *elements, w.given->open_cracks, gone, own);
  const PlacedParts known = placed_parts(w, *elements, *joints, own, mesh);

  FramePart part;
  Frame& f = part.frame;
  f.step = w.step;
  f.time = w.time;
  f.groups = w.given->groups;
  FrameOfTetrahedra(w, *elements, *joints, own, known, f).fill();
  const OnHost forces(w.couples.history.force, w.exec.space);
  add_pressing_couples(w, *elements, *forces, part.frame.contacts);
  add_bars(w, f);
  if (!w.domain.single_rank())
    add_places(w, *elements, own, known, part.places, part.places.tetrahedron,
               part.places.triangle);
  part.places.whole = w.domain.single_rank();
  part.places.tetrahedra = own.shown;
  part.places.triangles = known.cracks + own.all_open;
  part.places.points = 4 * own.shown + 3 * part.places.triangles;
  return part;
}

}  // namespace
}  // namespace fdem3

FramePart fdem3_frame(fdem3::World& w, const fdem3::World* mesh) {
  return fdem3::frame_of(w, mesh);
}

}  // namespace breccia
