#include "fdem_shared/ghosts.hpp"

#include "fdem/shape.hpp"

namespace breccia::fdem_shared {

template void start_ghosts(fdem::World&);
template void finish_ghosts(fdem::World&);
template void refresh_ghosts(fdem::World&);
template void select_active_ghosts(fdem::World&);

}  // namespace breccia::fdem_shared
