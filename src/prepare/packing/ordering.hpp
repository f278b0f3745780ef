#pragma once
// Memory order that follows space, so that linked elements are close to each other.

#include <vector>

#include "dem/setup/model.hpp"

namespace breccia::prepare {

/// Elements sorted by cubic cells of `edge`, the model's longest direction slowest, its shortest
/// fastest: linked elements are then about one cross-section of the model apart at most.
std::vector<Index> spatial_order(const std::vector<Vec3>& position, double edge);

/// Element order[k] becomes element k. The model has no links yet.
void reorder(dem::Model& model, const std::vector<Index>& order);

}  // namespace breccia::prepare
