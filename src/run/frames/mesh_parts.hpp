#pragma once
// Parts of a frame that both finite-discrete methods share: a rank's own elements and cracks, their
// places in the whole, fields of cracks, couples that press.

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "core/on_host.hpp"
#include "core/precision.hpp"
#include "domain/parcel.hpp"
#include "fdem_shared/bolts/bolts.hpp"
#include "fdem_shared/shape.hpp"
#include "run/frames/fields.hpp"

namespace breccia {

/// Places of fragments and cracks, which a rank cannot know by itself.
struct PlacedParts {
  std::vector<Index> fragment;  ///< of each own element
  std::vector<Index> crack;     ///< place of each own crack
  std::int64_t cracks = 0;      ///< of the whole
};

/// A side of a crack that was open from the start.
struct OpenSide {
  Index element;       ///< place in memory
  Index side;          ///< of the element
  std::int32_t place;  ///< among the open sides of the frame of the whole
};

/// The elements, and the joints that have softened or broken, of this rank: by their places in
/// memory; sides of cracks that were open from the start.
struct OwnParts {
  std::vector<Index> elements, cracks;
  std::vector<OpenSide> open;
  std::int32_t all_open = 0;        ///< such sides in the frame of the whole
  std::vector<std::int32_t> place;  ///< of elements in the frame, by global id; empty: their ids
  std::int64_t shown = 0;           ///< elements in the frame of the whole

  std::int32_t place_of(GlobalId id) const {
    return place.empty() ? static_cast<std::int32_t>(id) : place[at(id)];
  }
};

/// Frames leave out bodies that have been taken out.
/// @returns 1: of each element of the whole mesh that has been; empty: none has
template <class World>
std::vector<std::uint8_t> leave_out_removed(const World& w, OwnParts& own) {
  constexpr Index corners = fdem_shared::ShapeOf<World>::corners;
  const auto& given = *w.given;
  const auto elements = [&](std::size_t b) { return given.sets[b].nodes.size() / at(corners); };
  own.shown = 0;
  std::size_t all = 0;
  for (std::size_t b = 0; b < given.groups.size(); ++b) {
    all += elements(b);
    if (given.removed[b] == 0) own.shown += static_cast<std::int64_t>(elements(b));
  }
  if (static_cast<std::size_t>(own.shown) == all) return {};
  std::vector<std::uint8_t> gone(all, 0);
  for (std::size_t b = 0; b < given.groups.size(); ++b)
    if (given.removed[b] != 0)
      for (const Index n : given.sets[b].nodes) gone[at(n / corners)] = 1;
  std::int32_t count = 0;
  for (const std::uint8_t out : gone) {
    own.place.push_back(count);
    count += out == 0 ? 1 : 0;
  }
  return gone;
}

/// @param gone  1: of each element of this rank that has been taken out; cracks beside them left
///              with them
template <class World, class Joints>
void list_own(const World& w, const Joints& joints, const std::vector<std::uint8_t>& gone,
              OwnParts& own) {
  using Shape = fdem_shared::ShapeOf<World>;
  for (Index t = 0; t < Shape::elements(w).size(); ++t)
    if (w.domain.owns(t) && (gone.empty() || gone[at(t)] == 0)) own.elements.push_back(t);
  for (Index i = 0; i < joints.size(); ++i)
    if (is_damaged(joints.stage.data()[i]) &&
        !fdem_shared::is_beside_gone<World>(joints, i, gone) &&
        w.domain.owns(Shape::side_a(joints).data()[i] / Shape::corners))
      own.cracks.push_back(i);
}

/// @param cracks  of the whole mesh: `a` and `b` are their sides by global number
/// @param gone    1: of each element of the whole mesh that is not shown; empty: none
template <class World, class Elements, class Cracks>
void list_open_sides(const World&, const Elements& elements, const Cracks& cracks,
                     const std::vector<std::uint8_t>& gone, OwnParts& own) {
  constexpr Index corners = fdem_shared::ShapeOf<World>::corners;
  if (cracks.empty()) return;
  std::unordered_map<Index, Index> place;
  for (const Index t : own.elements) place[static_cast<Index>(elements.id.data()[t])] = t;
  const auto is_out = [&](Index side) { return !gone.empty() && gone[at(side / corners)] != 0; };
  for (const auto& crack : cracks) {
    if (is_out(crack.a) || is_out(crack.b)) continue;  // a border now
    for (const Index side : {crack.a, crack.b}) {
      const std::int32_t next = own.all_open++;
      const auto found = place.find(side / corners);
      if (found != place.end()) own.open.push_back({found->second, side % corners, next});
    }
  }
}

/// Calls visit(node) for the corners of open sides, by their numbers on this rank.
template <class World, class Visit>
void each_open_corner(const World&, const OwnParts& own, const Visit& visit) {
  using Shape = fdem_shared::ShapeOf<World>;
  for (const OpenSide& open : own.open)
    for (Index k = 0; k < Shape::dimension; ++k)
      visit(Shape::corners * open.element + Shape::corner_of_side(open.side, k));
}

/// Rank 0: fragments and places of cracks, from lists that all ranks have sent.
template <class World>
std::vector<Message> parts_placed_on_first(const std::vector<Message>& sent, const World& mesh) {
  std::vector<std::vector<Index>> elements, cracks;
  std::vector<std::uint8_t> broken(at(mesh.joints.size()), 0);
  std::vector<Index> place(at(mesh.joints.size()), 0);
  for (const Message& message : sent) {
    Unpacking from(message);
    elements.push_back(from.array<Index>());
    cracks.push_back(from.array<Index>());
    for (const Index joint : cracks.back()) place[at(joint)] = 1;
    for (const Index joint : from.array<Index>()) broken[at(joint)] = 1;
  }
  Index count = 0;
  for (Index& one : place) one = std::exchange(count, count + one);
  const std::vector<Index> fragment = fragments(mesh, broken).of;
  std::vector<Message> replies;
  for (std::size_t r = 0; r < sent.size(); ++r) {
    for (Index& t : elements[r]) t = fragment[at(t)];
    for (Index& joint : cracks[r]) joint = place[at(joint)];
    Message& reply = replies.emplace_back();
    put_array(reply, elements[r]);
    put_array(reply, cracks[r]);
    put_value(reply, count);
  }
  return replies;
}

/// @param mesh  rank 0: the whole, whose broken joints may be out of date
template <class World, class Elements, class Joints>
PlacedParts placed_parts(const World& w, const Elements& t, const Joints& joints,
                         const OwnParts& own, const World* mesh) {
  PlacedParts placed;
  if (w.domain.single_rank()) {
    const std::vector<Index> of = fragments(w).of;
    for (const Index i : own.elements) placed.fragment.push_back(of[at(i)]);
    for (std::size_t l = 0; l < own.cracks.size(); ++l)
      placed.crack.push_back(static_cast<Index>(l));
    placed.cracks = static_cast<std::int64_t>(own.cracks.size());
    return placed;
  }
  using Stage = std::remove_cvref_t<decltype(joints.stage.data()[0])>;
  std::vector<Index> ids, cracks, broken;
  for (const Index i : own.elements) ids.push_back(t.id.data()[i]);
  for (const Index i : own.cracks) {
    cracks.push_back(w.mesh.joint_number.data()[i]);
    if (joints.stage.data()[i] == Stage::broken) broken.push_back(cracks.back());
  }
  Communicator& ranks = *w.domain.ranks;
  std::vector<Message> messages(at(ranks.size()));
  for (const std::vector<Index>* list : {&ids, &cracks, &broken}) put_array(messages[0], *list);
  messages = ranks.exchange(std::move(messages));
  messages = ranks.exchange(mesh != nullptr ? parts_placed_on_first(messages, *mesh)
                                            : std::vector<Message>(at(ranks.size())));
  Unpacking from(messages[0]);
  placed.fragment = from.array<Index>();
  placed.crack = from.array<Index>();
  placed.cracks = from.value<Index>();
  return placed;
}

/// Mode, damage, time of break, opening and slip of each own crack; of those open from the start
/// -1, 1, 0, 0 and 0.
/// @param now  a method's: opening(i) and slip(i) of joint i  [m]
template <class Joints, class Now>
void add_crack_fields(const Joints& j, const Now& now, const OwnParts& own,
                      std::vector<FrameField>& fields) {
  using Stage = std::remove_cvref_t<decltype(j.stage.data()[0])>;
  using Kind = Quantity::Kind;
  const std::size_t cracks = own.cracks.size(), all = cracks + own.open.size();
  const auto add = [&](Kind kind, float of_open, const auto& value) {
    FrameField& made = fields.emplace_back(field_of({kind}));
    made.values.assign(all, of_open);
    for (std::size_t l = 0; l < cracks; ++l)
      made.values[l] = static_cast<float>(value(own.cracks[l]));
  };
  add(Kind::mode, -1.0F, [&](Index i) { return mode_of(j, i); });
  add(Kind::damage, 1.0F, [&](Index i) {
    double worst = j.stage.data()[i] == Stage::broken ? 1.0 : 0.0;
    const auto& points = points_of(j, i);
    for (const auto& p : points.point) worst = std::max(worst, p.damage);
    return worst;
  });
  add(Kind::time, 0.0F, [&](Index i) { return broke_at(j, i); });
  add(Kind::opening, 0.0F, [&](Index i) { return now.opening(i); });
  add(Kind::slip, 0.0F, [&](Index i) { return now.slip(i); });
}

/// Couples that press on each other, by the forces of the last step: between centroids.
/// @param forces  of all couples, on the host
template <class World, class Elements, class Force>
void add_pressing_couples(const World& w, const Elements& t, const Buffer<Force>& forces,
                          std::vector<FrameContact>& contacts) {
  const OnHost a(w.couples.pairs.a, w.exec.space), b(w.couples.pairs.b, w.exec.space);
  for (Index i = 0; i < w.couples.size(); ++i) {
    const Index from = a->data()[i], to = b->data()[i];
    Vec3 force{};
    for (const auto& corner : forces.data()[i].on_b.at) force += fdem_shared::to_space(corner);
    if (!w.domain.owns(from) || dot(force, force) == 0.0) continue;
    contacts.push_back({t.id.data()[from], t.id.data()[to], centroid(t.nodes.data()[from]),
                        centroid(t.nodes.data()[to]), force});
  }
}

/// Bolts that are there. All ranks call it.
template <class World>
void add_bars(const World& w, Frame& f) {
  f.bolted = !w.given->bolts.empty();
  for (const auto& s : fdem_shared::bolt_segments(w))
    f.bars.push_back({fdem_shared::to_space(s.begin), fdem_shared::to_space(s.end),
                      static_cast<float>(s.force), static_cast<float>(s.across),
                      static_cast<float>(s.slip), static_cast<std::int32_t>(s.bolt)});
}

/// Where the items of a part stand in the whole: points of elements first, then those of cracks.
/// @param elements, cracks  the lists of the frame's parts that they are
template <class World, class Elements>
void add_places(const World&, const Elements& t, const OwnParts& own, const PlacedParts& placed,
                FramePlaces& places, std::vector<std::int32_t>& elements,
                std::vector<std::int32_t>& cracks) {
  using Shape = fdem_shared::ShapeOf<World>;
  constexpr auto corners = static_cast<std::int32_t>(Shape::corners), ends = corners - 1;
  for (const Index i : own.elements) elements.push_back(own.place_of(t.id.data()[i]));
  cracks.assign(placed.crack.begin(), placed.crack.end());
  for (const OpenSide& open : own.open)
    cracks.push_back(static_cast<std::int32_t>(placed.cracks) + open.place);
  for (const std::int32_t id : elements)
    for (std::int32_t c = 0; c < corners; ++c) places.point.push_back(corners * id + c);
  const auto behind = static_cast<std::int32_t>(corners * own.shown);
  for (const std::int32_t crack : cracks)
    for (std::int32_t c = 0; c < ends; ++c) places.point.push_back(behind + ends * crack + c);
}

}  // namespace breccia
