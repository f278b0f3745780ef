#pragma once
// A mesh of triangles shared out among ranks: see fdem_shared/ranks.hpp.

#include "fdem/shape.hpp"
#include "fdem_shared/ranks.hpp"

namespace breccia::fdem {

using fdem_shared::collect;
using fdem_shared::drop_state;
using fdem_shared::finish_ghosts;
using fdem_shared::migrate;
using fdem_shared::rebalance;
using fdem_shared::refresh_ghosts;
using fdem_shared::select_active_ghosts;
using fdem_shared::share_out;
using fdem_shared::share_parts;
using fdem_shared::start_ghosts;

}  // namespace breccia::fdem
