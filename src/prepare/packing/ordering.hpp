#pragma once
// Memory order that follows space, so that linked elements are close to each other.

#include <span>

#include "dem/setup/model.hpp"

namespace breccia::prepare {

/// Elements sorted by cubic cells of `edge`, the model's longest direction slowest, its shortest
/// fastest: linked elements are then about one cross-section of the model apart at most.
PlainVector<Index> spatial_order(std::span<const Vec3> position, double edge, int threads = 1);

/// Element order[k] becomes element k. The model has no links yet.
void reorder(dem::Model& model, const PlainVector<Index>& order, int threads = 1);

}  // namespace breccia::prepare
