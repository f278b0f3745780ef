#include "fdem/fluid/fluid.hpp"

#include "fdem/fluid/cavity.hpp"
#include "fdem_shared/fluid/gas.hpp"

namespace breccia::fdem {
namespace {

struct TellCrack {
  static constexpr const char* name = "fdem.tell_cracks";
  View<const Index> joint, edge_a, edge_b, vertex;
  View<const GlobalId> id;
  View<const double> length, broke_at;
  View<CrackSide> crack;
  BR_HD void operator()(Index i) const {
    const Index j = joint[i], a = edge_a[j], b = edge_b[j];
    crack[i] = {3 * id[a / 3] + a % 3,
                3 * id[b / 3] + b % 3,
                {vertex[a], vertex[JointEnds::next_corner(a)]},
                length[j],
                broke_at[j]};
  }
};

}  // namespace

OpenLine opened(const CrackSide&, const EdgeNow& a, const EdgeNow& b) {
  const JointOpening<double> o = opening_of(a.at[0], a.at[1], b.at[1], b.at[0]);
  return {o.size, o.open[1]};
}

fdem_shared::LineCell cell_of(const FlowCase& flow, const CrackSide& crack, const OpenLine& now) {
  const double aperture = flow.aperture + std::max(now.opening, 0.0);
  return {{crack.port[0], crack.port[1]},
          now.length,
          aperture,
          flow.bulk_in(aperture, now.length),
          0.0};
}

void tell_cracks(World& part, const Buffer<Index>& joints, Buffer<CrackSide>& told) {
  const Joints& j = part.joints;
  told.resize(joints.size());
  for_each(part.exec, joints.size(),
           TellCrack{joints.view(), j.edge_a.view(), j.edge_b.view(),
                     fdem_shared::node_vertices(part), std::as_const(part.triangles.id).view(),
                     j.length.view(), j.broke_at.view(), told.view()});
}

std::vector<CrackSide> open_cracks(World& part) {
  return fdem_shared::cracks_until(part, part.time);
}

void flow_on(World& part) {
  const StageTime timed(part.exec, "fluid");
  fdem_shared::flow_until(part, part.time);
}

void spread_fluid(World& part) {
  if (part.given->flow.on) return;  // it flows in each step
  const StageTime timed(part.exec, "fluid");
  fdem_shared::spread_with_gas(part, part.time, true);
}
void restore_fluid(World& part) {
  if (part.fluid.time < 0.0) return;
  if (part.given->flow.on)
    fdem_shared::flow_until(part, part.fluid.time);
  else
    fdem_shared::spread_with_gas(part, part.fluid.time, false);
}

void list_loaded(World& w) {
  fdem_shared::list_all_loaded(w);
}

void note_walls(const World& part, FluidSource& source) {
  fdem_shared::note_walls_of_gas(part, source);
}
double gas_volume(World& part, const FluidSource& source) {
  return fdem_shared::room_of_gas(part, source).volume;
}

fdem_shared::FilledPart filled_part(const World& whole, std::size_t load) {
  return fdem_shared::filled_part(whole, load);
}

}  // namespace breccia::fdem
