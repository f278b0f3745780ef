#include "fdem_shared/ghosts.hpp"

#include "fdem3/shape.hpp"

namespace breccia::fdem_shared {

template void start_ghosts(fdem3::World&);
template void finish_ghosts(fdem3::World&);
template void refresh_ghosts(fdem3::World&);
template void select_active_ghosts(fdem3::World&);

}  // namespace breccia::fdem_shared
