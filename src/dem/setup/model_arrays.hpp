#pragma once
// The arrays of a model by what they hold: for its memory order, its file and its checks.

#include "dem/setup/model.hpp"

namespace breccia::dem {

/// Calls array(name, items) for each array with one item an element.
template <class AnyModel, class Visit>
void each_element_array(AnyModel& model, Visit&& array) {
  array("group", model.group);
  array("material", model.material);
  array("radius", model.radius);
  array("mass", model.mass);
  array("inertia", model.inertia);
  array("position", model.position);
  array("velocity", model.velocity);
  array("spin", model.spin);
  array("bar_previous", model.bar_previous);
  array("bar_next", model.bar_next);
}

/// Calls visit(number, least) for each number of an element that a model holds; least is -1 where
/// it may lead nowhere, else 0.
template <class AnyModel, class Visit>
void each_element_number(AnyModel& model, Visit&& visit) {
  for (auto& link : model.links) {
    visit(link.a, 0);
    visit(link.b, 0);
  }
  for (auto& facet : model.facets)
    for (auto* corner : {&facet.a, &facet.b, &facet.c, &facet.d}) visit(*corner, 0);
  for (auto* neighbours : {&model.bar_previous, &model.bar_next})
    for (auto& element : *neighbours) visit(element, -1);
}

}  // namespace breccia::dem
