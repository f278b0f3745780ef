#pragma once
// Every array of a world of triangles or tetrahedra that leads to these or to what the case gives.
//
// How an element lies in the mesh (its sides, World::across, vertex) goes with the element itself:
// Neighbourhood in fdem_shared/migration.hpp.

#include "core/relation.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Calls visit(Relation) for each.
template <class AnyWorld, class Visit>
void each_relation(AnyWorld& w, Visit&& visit) {
  using Shape = ShapeOf<std::remove_const_t<AnyWorld>>;
  constexpr RelationFrom model = RelationFrom::model, search = RelationFrom::search;
  auto& e = Shape::elements(w);
  const RelationEnd elements{RelationTo::elements, e.size()};
  const RelationEnd sides{RelationTo::elements, e.size(), Shape::corners};
  const RelationEnd materials{RelationTo::common, w.given->materials};
  const RelationEnd holds{RelationTo::common, w.given->holds.size(), 1, -1};
  const RelationEnd bonds{RelationTo::common, w.given->bonds.size()};
  visit(relation(Shape::elements_word, "material", e.material, model, materials));
  visit(relation(Shape::elements_word, "hold", e.hold, model, holds));
  visit(relation("joints", Shape::side_a_word, Shape::side_a(w.joints), model, sides));
  visit(relation("joints", Shape::side_b_word, Shape::side_b(w.joints), model, sides));
  visit(relation("joints", "law", w.joints.law, model, bonds));
  visit(relation("couples", "a", w.couples.pairs.a, search, elements));
  visit(relation("couples", "b", w.couples.pairs.b, search, elements));
  visit(relation("reach", Shape::element, w.reach.element, search, elements));
}

}  // namespace breccia::fdem_shared
