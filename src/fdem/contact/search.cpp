// New couples of triangles: fdem_shared/search.hpp, and how runs on a device ask for one.

#include "fdem_shared/search.hpp"

#include "fdem/ranks.hpp"

namespace breccia::fdem {
namespace {

/// Change bits on a device, as its move has noted them, and whether a margin is used up.
std::uint64_t noted_bits(World& w) {
  std::int32_t flags[2];
  peek_marked_bytes(flags, w.device_flags.data(), w.exec.space, sizeof flags);
  w.margin_used = flags[0] != 0;
  if (w.margin_used) clear_bytes(w.device_flags.data(), w.exec.space, sizeof flags[0]);
  return static_cast<std::uint64_t>(flags[1]);
}

}  // namespace

MarginRule margin_rule(const World& w) {
  return fdem_shared::mesh_margin_rule(w);
}

void ask_for_search(World& w) {
  const bool on_device = w.exec.space != Space::host;
  if (w.domain.single_rank() && !on_device) return;
  const StageTime timed(w.exec, "travel");
  const std::uint64_t changed = on_device ? noted_bits(w) : fdem_shared::changed_bits(w);
  if (!w.domain.single_rank())
    w.domain.ranks->start_any_of(changed | (w.margin_used ? fdem_shared::margin_bit : 0));
}

bool couples_are_due(World& w) {
  const StageTime timed(w.exec, "travel");
  if (!w.domain.single_rank()) return fdem_shared::any_rank_is_due(w);
  return w.margin_used || fdem_shared::marking_is_due(w);
}

void find_couples(World& w) {
  fdem_shared::find_mesh_couples(w);
}

void derive_couples(World& w) {
  fdem_shared::derive_mesh_couples(w);
}

}  // namespace breccia::fdem
