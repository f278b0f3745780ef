#include "fdem3/setup/supports.hpp"

#include "exec/error.hpp"
#include "fdem3/setup/loads.hpp"
#include "fdem3/setup/regions.hpp"
#include "fdem3/setup/writable.hpp"

namespace breccia::fdem3 {
namespace {

/// Held nodes start with the motion of their support: no jump of velocity at the start does work.
void start_held(World& w, const std::vector<Hold>& holds, const std::vector<Index>& hold) {
  std::vector<TetrahedronNodes> nodes;
  copy_to(nodes, w.tetrahedra.nodes);
  for (std::size_t t = 0; t < hold.size(); ++t) {
    if (hold[t] < 0) continue;
    const Hold& h = holds[at(hold[t])];
    for (int k = 0; k < 4; ++k) {
      const Vec3 given = h.motion[k] >= 0 ? w.prescribed[at(h.motion[k])].at(0.0) : Vec3{};
      nodes[t].at[k].velocity = Kick::held(h.fixed >> (3 * k) & 7, given, nodes[t].at[k].velocity);
    }
  }
  copy_to(w.tetrahedra.nodes, nodes);
}

}  // namespace

std::vector<Index> prescribe_supports(World& w, const Config& config) {
  const std::size_t bodies = w.given->sets.size() - config.supports.size();
  std::size_t corners = 0;
  for (std::size_t b = 0; b < bodies; ++b) corners += w.given->sets[b].nodes.size();
  std::vector<Hold> holds;
  std::vector<Index> hold(corners / 4, -1);
  w.prescribed.clear();
  w.servo_motions.clear();
  for (std::size_t s = 0; s < config.supports.size(); ++s) {
    const SupportConfig& support = config.supports[s];
    const std::string where = "support." + support.name;
    int bits = 0;
    for (const std::string& direction : support.fix)
      bits |= direction == "x" ? 1 : direction == "y" ? 2 : 4;
    const Vec3 velocity = Kick::held(bits, scale_of(support.velocity), Vec3{});
    std::int16_t motion = -1;
    if (dot(velocity, velocity) > 0.0 || (support.servo.is_on() && bits != 0)) {
      motion = static_cast<std::int16_t>(w.prescribed.size());
      if (support.servo.is_on())
        w.servo_motions.push_back({s, motion, support.servo.axis_number()});
      w.prescribed.push_back({velocity, amplitude(support.velocity, support.history)});
    }
    if (bits == 0) continue;  // it lets go
    for (const Index n : w.given->sets[bodies + s].nodes) {
      Index& own = hold[at(n / 4)];
      if (own < 0) {
        own = static_cast<Index>(holds.size());
        holds.emplace_back();
      }
      Hold& h = holds[at(own)];
      const int corner = n % 4;
      if ((h.fixed >> (3 * corner) & bits) != 0)
        throw InputError(where + ": prescribes a direction of tetrahedron " +
                         std::to_string(n / 4) + " that another support prescribes, too");
      if (motion >= 0 && h.motion[corner] >= 0)
        throw InputError(where + ": tetrahedron " + std::to_string(n / 4) +
                         " has a corner that another support moves, too");
      h.fixed = static_cast<std::uint16_t>(h.fixed | bits << (3 * corner));
      if (motion >= 0) h.motion[corner] = motion;
    }
  }
  copy_to(set_up(w).holds, holds);
  w.motions.resize(static_cast<Index>(w.prescribed.size()));
  return hold;
}

void set_up_supports(World& w, const Config& config, const Model& model) {
  for (const SupportConfig& support : config.supports)
    set_up(w).sets.push_back(
        {support.name, corners_in(model, support.region, "support." + support.name)});
  w.sets_here.resize(w.given->sets.size());
  const std::vector<Index> hold = prescribe_supports(w, config);
  copy_to(w.tetrahedra.hold, hold);
  std::vector<Hold> holds;
  copy_to(holds, w.given->holds);
  start_held(w, holds, hold);
}

}  // namespace breccia::fdem3
