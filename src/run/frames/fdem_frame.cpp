// An FDEM world as output sees it.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/on_host.hpp"
#include "domain/drift.hpp"
#include "exec/tasks.hpp"
#include "fdem/joints/joints_to_read.hpp"
#include "fdem/observe.hpp"
#include "fdem/ranks.hpp"
#include "fdem/setup/removal.hpp"
#include "run/frames/mesh_parts.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace fdem {
namespace {

using Kind = Quantity::Kind;

/// Fields of points besides velocity, in the order in which frames hold them.
struct PointFields {
  FrameField *displacement = nullptr, *force = nullptr, *held = nullptr;

  /// Adds them, of so many points.
  PointFields(const Case& given, std::size_t points, Frame& f) {
    f.point_fields.reserve(4);
    const auto add = [&](Kind kind) {
      f.point_fields.push_back(field_of({kind}, points, true));
      return &f.point_fields.back();
    };
    if (given.shown.displacement) displacement = add(Kind::displacement);
    if (given.shown.force) force = add(Kind::force);
    if (given.holds.size() > 0) held = add(Kind::held);
  }
  static void put(FrameField* field, std::size_t place, const Vec2& value) {
    if (field == nullptr) return;
    field->values[3 * place] = static_cast<float>(value.x);
    field->values[3 * place + 1] = static_cast<float>(value.y);
  }
};

void put_point(Frame& f, std::size_t place, const Vec2& position, const Vec2& velocity) {
  f.position[place] = {position.x, position.y, 0.0};
  const double v[] = {velocity.x, velocity.y, 0.0};
  for (std::size_t c = 0; c < 3; ++c)
    f.point_fields[0].values[3 * place + c] = static_cast<float>(v[c]);
}

/// work(k) for all k < count, by threads.
template <class Work>
void each_of(std::size_t count, int threads, const Work& work) {
  constexpr std::size_t chunk = 4096;
  for_each_task(threads, static_cast<int>((count + chunk - 1) / chunk), [&](int task) {
    const std::size_t begin = chunk * static_cast<std::size_t>(task);
    for (std::size_t k = begin; k < std::min(count, begin + chunk); ++k) work(k);
  });
}

void add_triangles(const World& w, const Triangles& t, const std::vector<Corners>& velocity,
                   const OwnParts& own, const PlacedParts& placed, Frame& f) {
  const std::size_t count = own.elements.size();
  f.triangles.resize(3 * count);
  each_of(count, w.exec.threads, [&](std::size_t k) {
    const Index i = own.elements[k];
    for (std::size_t c = 0; c < 3; ++c) {
      f.triangles[3 * k + c] =
          static_cast<std::int32_t>(3 * own.place_of(t.id.data()[i]) + static_cast<int>(c));
      put_point(f, 3 * k + c, t.nodes.data()[i].at[c].position, velocity[at(i)].at[c]);
    }
  });
  const auto field = [&](const Quantity& of, const auto& value) {
    FrameField& made = f.triangle_fields.emplace_back(field_of(of, count));
    each_of(count, w.exec.threads,
            [&](std::size_t k) { made.values[k] = static_cast<float>(value(own.elements[k], k)); });
  };
  const auto number = [&](Kind kind, const auto& value) {
    std::vector<std::int32_t> numbers(count);
    each_of(count, w.exec.threads, [&](std::size_t k) {
      numbers[k] = static_cast<std::int32_t>(value(own.elements[k], k));
    });
    f.triangle_fields.push_back(numbers_of(kind, std::move(numbers)));
  };
  const std::vector<Sym2> stress = stresses(w);
  const std::vector<double> across = stresses_across(w), lost = damage(w);
  field({Kind::stress, 0, 0}, [&](Index i, std::size_t) { return stress[at(i)].xx; });
  field({Kind::stress, 1, 1}, [&](Index i, std::size_t) { return stress[at(i)].yy; });
  field({Kind::stress, 2, 2}, [&](Index i, std::size_t) { return across[at(i)]; });
  field({Kind::stress, 0, 1}, [&](Index i, std::size_t) { return stress[at(i)].xy; });
  field({Kind::pressure},
        [&](Index i, std::size_t) { return -0.5 * (stress[at(i)].xx + stress[at(i)].yy); });
  field({Kind::damage}, [&](Index i, std::size_t) { return lost[at(i)]; });
  number(Kind::group, [&](Index i, std::size_t) { return t.group.data()[i]; });
  number(Kind::material, [&](Index i, std::size_t) { return t.material.data()[i]; });
  number(Kind::fragment, [&](Index, std::size_t k) { return placed.fragment[k]; });
  if (!w.domain.config.show) return;
  const Vec2 drift = w.reach.drift.velocity;
  const Partition partition = partition_at(w.domain, {drift.x, drift.y, 0.0}, w.time);
  number(Kind::rank,
         [&](Index i, std::size_t) { return partition.owner(centroid(t.nodes.data()[i])); });
}

std::size_t points_of(const OwnParts& own) {
  return 3 * own.elements.size() + 2 * (own.cracks.size() + own.open.size());
}

/// Of corners; of the ends of cracks the mean of both sides.
void add_more(const World& w, const Triangles& t, const Joints& j, const OwnParts& own, Frame& f) {
  const std::size_t points = points_of(own);
  const PointFields fields(*w.given, points, f);
  const OnHost starts(w.given->starts, w.exec.space);
  const OnHost holds(w.given->holds, w.exec.space);
  const auto way = [&](Index node) {
    return t.nodes.data()[node / 3].at[node % 3].position -
           starts->data()[3 * t.id.data()[node / 3] + node % 3];
  };
  each_of(own.elements.size(), w.exec.threads, [&](std::size_t k) {
    const Index i = own.elements[k], hold = t.hold.data()[i];
    for (int c = 0; c < 3; ++c) {
      const std::size_t place = 3 * k + static_cast<std::size_t>(c);
      if (fields.displacement != nullptr)
        PointFields::put(fields.displacement, place, way(3 * i + c));
      PointFields::put(fields.force, place, t.force.data()[i].at[c]);
      if (fields.held != nullptr && hold >= 0 && holds->data()[hold].loose == 0)
        fields.held->values[place] = static_cast<float>(holds->data()[hold].fixed_at(c));
    }
  });
  if (fields.displacement == nullptr) return;
  std::size_t point = 3 * own.elements.size();
  for (const Index i : own.cracks) {
    const JointEnds e = JointEnds::of(j.edge_a.data()[i], j.edge_b.data()[i]);
    for (const auto& [on_a, on_b] : {std::pair{e.a0, e.b0}, std::pair{e.a1, e.b1}})
      PointFields::put(fields.displacement, point++, 0.5 * (way(on_a) + way(on_b)));
  }
  each_open_corner(w, own,
                   [&](Index node) { PointFields::put(fields.displacement, point++, way(node)); });
}

void add_lines(const World& w, const Triangles& t, const Joints& j,
               const std::vector<Corners>& velocity, const OwnParts& own, const PlacedParts& placed,
               Frame& f) {
  const View<const NodeState> nodes = by_number(t.nodes.view());
  std::size_t point = 3 * own.elements.size();
  for (std::size_t l = 0; l < own.cracks.size(); ++l) {
    const Index i = own.cracks[l];
    const JointEnds e = JointEnds::of(j.edge_a.data()[i], j.edge_b.data()[i]);
    auto place = static_cast<std::int32_t>(3 * own.shown + 2 * placed.crack[l]);
    for (const auto& [on_a, on_b] : {std::pair{e.a0, e.b0}, std::pair{e.a1, e.b1}}) {
      const NodeState &a = nodes[on_a], &b = nodes[on_b];
      f.lines.push_back(place++);
      const Vec2 &of_a = velocity[at(on_a / 3)].at[on_a % 3],
                 &of_b = velocity[at(on_b / 3)].at[on_b % 3];
      put_point(f, point++, 0.5 * (a.position + b.position), 0.5 * (of_a + of_b));
    }
  }
  const std::int64_t behind = 3 * own.shown + 2 * placed.cracks;
  for (const OpenSide& open : own.open)
    for (const std::int64_t end : {0, 1})
      f.lines.push_back(static_cast<std::int32_t>(behind + 2 * open.place + end));
  each_open_corner(w, own, [&](Index node) {
    put_point(f, point++, nodes[node].position, velocity[at(node / 3)].at[node % 3]);
  });
  const JointsToRead now{t.nodes.view(), j.edge_a.view(), j.edge_b.view()};
  add_crack_fields(j, now, own, f.line_fields);
}

FramePart frame_of(World& w, const World* mesh) {
  const OnHost<Triangles> triangles(w.triangles, w.exec.space);
  const OnHost<Joints> joints(w.joints, w.exec.space);
  OwnParts own;
  const std::vector<std::uint8_t> gone = leave_out_removed(w, own);
  list_own(w, *joints, gone_triangles(w), own);
  list_open_sides(w, *triangles, w.given->open_cracks, gone, own);
  const PlacedParts known = placed_parts(w, *triangles, *joints, own, mesh);

  FramePart part;
  Frame& f = part.frame;
  f.step = w.step;
  f.time = w.time;
  f.groups = w.given->groups;
  const std::size_t points = points_of(own);
  f.position.resize(points);
  f.point_fields.push_back(field_of({Kind::velocity}, points));
  const std::vector<Corners> velocity = velocities_now(w);
  add_triangles(w, *triangles, velocity, own, known, f);
  add_lines(w, *triangles, *joints, velocity, own, known, f);
  add_more(w, *triangles, *joints, own, f);
  with_number(w.couples.history.precision, [&](auto number) {
    const OnHost forces(w.couples.history.force.as<decltype(number)>(), w.exec.space);
    add_pressing_couples(w, *triangles, *forces, part.frame.contacts);
  });
  add_bars(w, f);
  if (!w.domain.single_rank())
    add_places(w, *triangles, own, known, part.places, part.places.triangle, part.places.line);
  part.places.whole = w.domain.single_rank();
  part.places.triangles = own.shown;
  part.places.lines = known.cracks + own.all_open;
  part.places.points = 3 * own.shown + 2 * part.places.lines;
  return part;
}

}  // namespace
}  // namespace fdem

FramePart fdem_frame(fdem::World& w, const fdem::World* mesh) {
  return fdem::frame_of(w, mesh);
}

}  // namespace breccia
