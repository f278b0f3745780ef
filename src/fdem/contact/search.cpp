// New couples of triangles: fdem_shared/search.hpp.

#include "fdem_shared/search.hpp"

#include "fdem/ranks.hpp"

namespace breccia::fdem {

MarginRule margin_rule(const World& w) {
  return fdem_shared::mesh_margin_rule(w);
}

void ask_ranks_for_search(World& w) {
  fdem_shared::ask_mesh_for_search(w);
}

bool couples_are_due(World& w) {
  return fdem_shared::mesh_couples_are_due(w);
}

void find_couples(World& w) {
  fdem_shared::find_mesh_couples(w);
}

void derive_couples(World& w) {
  fdem_shared::derive_mesh_couples(w);
}

}  // namespace breccia::fdem
