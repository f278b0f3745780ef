#pragma once
// Every array of an FDEM world that leads to triangles or to what the case gives.
//
// How a triangle lies in the mesh (World::edges, across, vertex) goes with the triangle itself:
// Neighbourhood in fdem/ranks.cpp.

#include "core/relation.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

/// Calls visit(Relation) for each.
template <class AnyWorld, class Visit>
void each_relation(AnyWorld& w, Visit&& visit) {
  constexpr RelationFrom model = RelationFrom::model, search = RelationFrom::search;
  const RelationEnd triangles{RelationTo::elements, w.triangles.size()};
  const RelationEnd edges{RelationTo::elements, w.triangles.size(), 3};
  const RelationEnd materials{RelationTo::common, w.given->materials};
  const RelationEnd holds{RelationTo::common, w.given->holds.size(), 1, -1};
  const RelationEnd bonds{RelationTo::common, w.given->bonds.size()};
  visit(relation("triangles", "material", w.triangles.material, model, materials));
  visit(relation("triangles", "hold", w.triangles.hold, model, holds));
  visit(relation("joints", "edge_a", w.joints.edge_a, model, edges));
  visit(relation("joints", "edge_b", w.joints.edge_b, model, edges));
  visit(relation("joints", "law", w.joints.law, model, bonds));
  visit(relation("couples", "a", w.couples.pairs.a, search, triangles));
  visit(relation("couples", "b", w.couples.pairs.b, search, triangles));
  visit(relation("reach", "triangle", w.reach.triangle, search, triangles));
}

}  // namespace breccia::fdem
