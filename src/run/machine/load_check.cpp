#include "run/machine/load_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "dem/relations.hpp"
#include "dem/wall_key.hpp"
#include "exec/error.hpp"
#include "fdem/relations.hpp"
#include "fdem3/relations.hpp"

namespace breccia {
namespace {

constexpr std::string_view subject = "the checkpoint's section ";

[[noreturn]] void refuse(const std::string& section, const std::string& why) {
  throw CheckpointError(fmt::format("{}{} {}", subject, section, why));
}

class Collector {
 public:
  template <class T>
  void add(const std::string& section, const Buffer<T>& array) {
    std::vector<T> items;
    copy_to(items, array);
    Repeated one{section, std::vector<std::byte>(items.size() * sizeof(T))};
    if (!items.empty()) std::memcpy(one.bytes.data(), items.data(), one.bytes.size());
    all.push_back(std::move(one));
  }
  std::vector<Repeated> all;
};

template <class T>
std::vector<T> on_host(const Buffer<T>& array) {
  std::vector<T> items;
  copy_to(items, array);
  return items;
}

template <class Array>
std::string section_of(const Relation<Array>& r) {
  return std::string(r.state) + "." + r.name;
}

/// Numbers that the model decides must come back as they were.
template <class World>
void collect_relations(const World& w, Collector& c) {
  each_relation(w, [&](const auto& r) {
    if (r.from == RelationFrom::model) c.add(section_of(r), r.numbers);
  });
}

template <class World>
void refuse_wrong_relations(const World& w) {
  each_relation(w, [](const auto& r) {
    for (const Index number : on_host(r.numbers))
      if (!r.holds(number)) refuse(section_of(r), fmt::format("leads to {}", number));
  });
}

template <class T>
void refuse_size(const char* section, const Buffer<T>& array, Index expected) {
  if (array.size() != expected)
    refuse(section, fmt::format("has {} items, expected {}", array.size(), expected));
}

/// Keys ascend, and belong to what the places lead to.
/// @param key  of the pair of two such places
template <class Key>
void refuse_wrong_pairs(const std::string& name, const Pairs& pairs, const Key& key) {
  const auto keys = on_host(pairs.key);
  const auto a = on_host(pairs.a), b = on_host(pairs.b);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] != key(a[i], b[i]) || (i > 0 && keys[i] <= keys[i - 1]))
      refuse(name + ".key", fmt::format("is not that of the pairs (item {})", i));
  }
}

/// Keys of pairs of elements, the lower global id first.
class KeyOfIds {
 public:
  explicit KeyOfIds(const Buffer<GlobalId>& ids) : ids_(on_host(ids)) {}
  PairKey operator()(Index a, Index b) const {
    const GlobalId low = ids_[static_cast<std::size_t>(a)],
                   high = ids_[static_cast<std::size_t>(b)];
    return low < high ? pair_key(low, high) : ~PairKey{0};
  }

 private:
  std::vector<GlobalId> ids_;
};

/// Places that must ascend.
void refuse_unordered(const char* section, const Buffer<Index>& array) {
  const auto places = on_host(array);
  for (std::size_t i = 1; i < places.size(); ++i)
    if (places[i] <= places[i - 1])
      refuse(section, fmt::format("leads to {} (item {})", places[i], i));
}

void refuse_wrong_stages(const Buffer<fdem::JointStage>& stages) {
  for (const fdem::JointStage stage : on_host(stages))
    if (stage > fdem::JointStage::cut) refuse("joints.stage", "holds what is no stage of a joint");
}

/// Keys of contacts with walls, one after the other: a mesh has mesh_slots with each element.
class KeyOfWalls {
 public:
  explicit KeyOfWalls(const dem::World& w) : w_(w), ids_(on_host(w.elements.id)) {}
  PairKey next(Index element, Index wall) {
    const bool goes_on = slot_ > 0;
    if (goes_on && (element != element_ || wall != wall_)) return ~PairKey{0};
    element_ = element;
    wall_ = wall;
    const PairKey key =
        dem::wall_key(wall, ids_[static_cast<std::size_t>(element)], static_cast<int>(slot_));
    if (!dem::mesh_of(w_, wall).empty()) slot_ = (slot_ + 1) % dem::mesh_slots;
    return key;
  }
  bool whole() const { return slot_ == 0; }

 private:
  const dem::World& w_;
  std::vector<GlobalId> ids_;
  Index element_ = -1, wall_ = -1, slot_ = 0;
};

/// Relations, groups, materials and ids of what lies on a device, which holds all elements.
template <class World, class Elements>
void require_on_device(const World& w, const char* state, const Elements& e) {
  if (w.exec.space == Space::host) return;
  const auto require_below = [state](const char* name, const auto& array, std::size_t count) {
    for (const auto number : on_host(array))
      if (number < 0 || static_cast<std::size_t>(number) >= count)
        refuse(fmt::format("{}.{}", state, name), fmt::format("leads to {}", number));
  };
  try {
    refuse_wrong_relations(w);
    require_below("group", e.group, w.given->sets.size());
    require_below("material", e.material, static_cast<std::size_t>(w.given->materials));
    require_below("id", e.id, static_cast<std::size_t>(e.size()));
  } catch (const CheckpointError& error) {
    throw DeviceError(
        fmt::format("step {}: the device's array {}: its memory fails, or the program does; resume "
                    "from the newest checkpoint on another machine",
                    w.step, std::string_view(error.what()).substr(subject.size())));
  }
}

template <class World>
void refuse_wrong_clock(const World& w) {
  constexpr std::int64_t most_steps = std::int64_t{1} << 60;
  const auto is_time = [](double t) { return t >= 0.0 && t < no_limit; };
  if (w.step < 0 || w.step > most_steps || !is_time(w.time) || !is_time(w.last_dt) ||
      !is_time(w.next_dt))
    refuse("step, time, last_dt or next_dt", "holds no count or time");
}

}  // namespace

std::vector<Repeated> repeated_by(const dem::World& w) {
  Collector c;
  c.add("elements.id", w.elements.id);
  c.add("elements.group", w.elements.group);
  c.add("elements.material", w.elements.material);
  c.add("elements.fixed", w.elements.fixed);
  c.add("elements.motion", w.elements.motion);
  collect_relations(w, c);
  return std::move(c.all);
}

std::vector<Repeated> repeated_by(const fdem::World& w) {
  Collector c;
  c.add("triangles.id", w.triangles.id);
  c.add("triangles.group", w.triangles.group);
  collect_relations(w, c);
  return std::move(c.all);
}

std::vector<Repeated> repeated_by(const fdem3::World& w) {
  Collector c;
  c.add("tetrahedra.id", w.tetrahedra.id);
  c.add("tetrahedra.group", w.tetrahedra.group);
  c.add("joints.turn", w.joints.turn);
  collect_relations(w, c);
  return std::move(c.all);
}

void refuse_changed(const std::vector<Repeated>& built, const std::vector<Repeated>& loaded) {
  for (std::size_t i = 0; i < built.size(); ++i)
    if (built[i].bytes != loaded[i].bytes)
      refuse(built[i].section, "is not that of the model that the case builds");
}

void refuse_wrong_places(const dem::World& w) {
  refuse_wrong_clock(w);
  refuse_wrong_relations(w);
  const KeyOfIds key(w.elements.id);
  refuse_wrong_pairs("contacts", w.contacts.pairs, key);
  KeyOfWalls wall_keys(w);
  refuse_wrong_pairs("wall_contacts", w.wall_contacts.pairs,
                     [&](Index element, Index wall) { return wall_keys.next(element, wall); });
  if (!wall_keys.whole()) refuse("wall_contacts.key", "ends within the contacts of an element");
  refuse_size("travel.reference", w.travel.reference, w.elements.size());
}

void refuse_wrong_places(const fdem::World& w) {
  refuse_wrong_clock(w);
  refuse_wrong_relations(w);
  refuse_wrong_pairs("couples", w.couples.pairs, KeyOfIds(w.triangles.id));
  refuse_unordered("reach.triangle", w.reach.element);
  refuse_wrong_stages(w.joints.stage);
}

void refuse_wrong_places(const fdem3::World& w) {
  refuse_wrong_clock(w);
  refuse_wrong_relations(w);
  refuse_wrong_pairs("couples", w.couples.pairs, KeyOfIds(w.tetrahedra.id));
  refuse_unordered("reach.tetrahedron", w.reach.element);
  refuse_wrong_stages(w.joints.stage);
}

void require_places(const dem::World& w) {
  require_on_device(w, "elements", w.elements);
}
void require_places(const fdem::World& w) {
  require_on_device(w, "triangles", w.triangles);
}
void require_places(const fdem3::World& w) {
  require_on_device(w, "tetrahedra", w.tetrahedra);
}

}  // namespace breccia
