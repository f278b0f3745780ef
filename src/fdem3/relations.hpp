#pragma once
// Every array of a world of tetrahedra that leads to tetrahedra or to what the case gives.
//
// How a tetrahedron lies in the mesh (World::faces, across, vertex) goes with it itself:
// Neighbourhood in fdem3/ranks.cpp.

#include "core/relation.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// Calls visit(Relation) for each.
template <class AnyWorld, class Visit>
void each_relation(AnyWorld& w, Visit&& visit) {
  constexpr RelationFrom model = RelationFrom::model, search = RelationFrom::search;
  const RelationEnd elements{RelationTo::elements, w.tetrahedra.size()};
  const RelationEnd faces{RelationTo::elements, w.tetrahedra.size(), 4};
  const RelationEnd materials{RelationTo::common, w.given->materials};
  const RelationEnd holds{RelationTo::common, w.given->holds.size(), 1, -1};
  const RelationEnd bonds{RelationTo::common, w.given->bonds.size()};
  visit(relation("tetrahedra", "material", w.tetrahedra.material, model, materials));
  visit(relation("tetrahedra", "hold", w.tetrahedra.hold, model, holds));
  visit(relation("joints", "face_a", w.joints.face_a, model, faces));
  visit(relation("joints", "face_b", w.joints.face_b, model, faces));
  visit(relation("joints", "law", w.joints.law, model, bonds));
  visit(relation("couples", "a", w.couples.pairs.a, search, elements));
  visit(relation("couples", "b", w.couples.pairs.b, search, elements));
  visit(relation("reach", "tetrahedron", w.reach.tetrahedron, search, elements));
}

}  // namespace breccia::fdem3
