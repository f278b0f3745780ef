#pragma once
// Every array of a DEM world that leads to elements or walls.

#include "core/relation.hpp"
#include "dem/world.hpp"

namespace breccia::dem {

/// Calls visit(Relation) for each. A new kind of link is in it by its each_end.
template <class AnyWorld, class Visit>
void each_relation(AnyWorld& w, Visit&& visit) {
  const RelationEnd elements{RelationTo::elements, w.elements.size()};
  const RelationEnd walls{RelationTo::common, static_cast<Index>(w.walls.size())};
  w.each_set([&](auto& set) {
    set.each_end([&](const char* end, auto& array) {
      visit(relation(set.name, end, array, RelationFrom::model, elements));
    });
  });
  auto &contacts = w.contacts.pairs, &at_walls = w.wall_contacts.pairs;
  constexpr RelationFrom search = RelationFrom::search;
  visit(relation("contacts", "a", contacts.a, search, elements));
  visit(relation("contacts", "b", contacts.b, search, elements));
  visit(relation("wall_contacts", "a", at_walls.a, search, elements));
  visit(relation("wall_contacts", "b", at_walls.b, search, walls));
}

}  // namespace breccia::dem
