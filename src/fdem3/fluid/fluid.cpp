#include "fdem3/fluid/fluid.hpp"

#include "fdem3/fluid/cavity.hpp"
#include "fdem_shared/fluid/gas.hpp"

namespace breccia::fdem3 {
namespace {

struct TellCrack {
  static constexpr const char* name = "fdem3.tell_cracks";
  View<const Index> joint, face_a, face_b, vertex;
  View<const std::uint8_t> turn;
  View<const FaceShape> shape;
  View<const GlobalId> id;
  View<const double> length;
  TimesOfBreak broke_at;
  View<CrackSide> crack;
  BR_HD void operator()(Index i) const {
    const Index j = joint[i], a = face_a[j], b = face_b[j];
    const FaceShape& s = shape[j];
    const auto corner = [&](int k) { return vertex[4 * (b / 4) + corner_of_face(b % 4, k)]; };
    const Index p = corner(0), q = corner(1), r = corner(2);
    const double rest = s.along - s.size;
    crack[i] = {4 * id[a / 4] + a % 4,
                4 * id[b / 4] + b % 4,
                turn[j],
                {fdem_shared::port_between(p, q), fdem_shared::port_between(q, r),
                 fdem_shared::port_between(r, p)},
                {s.size, sqrt(rest * rest + s.across * s.across),
                 sqrt(s.along * s.along + s.across * s.across)},
                length[j],
                broke_at[j]};
  }
};

}  // namespace

OpenFace opened(const CrackSide& crack, const FaceNow& a, const FaceNow& b) {
  Vec3 on_a[3], on_b[3];
  for (int k = 0; k < 3; ++k) {
    on_a[k] = a.at[(crack.turn + 3 - k) % 3];
    on_b[k] = b.at[k];
  }
  const JointOpening o = opening_of(on_a, on_b);
  OpenFace now{};
  for (int k = 0; k < 3; ++k) now.edge[k] = norm(o.middle[(k + 1) % 3] - o.middle[k]);
  now.area = 0.5 * o.twice;
  now.opening = (o.open[0] + o.open[1] + o.open[2]) / 3.0;
  return now;
}

fdem_shared::FaceCell cell_of(const FlowCase& flow, const CrackSide& crack, const OpenFace& now) {
  const double aperture = flow.aperture + std::max(now.opening, 0.0);
  return {{crack.port[0], crack.port[1], crack.port[2]},
          {now.edge[0], now.edge[1], now.edge[2]},
          now.area,
          aperture,
          flow.bulk_in(aperture, crack.length),
          0.0};
}

void tell_cracks(World& part, const Buffer<Index>& joints, Buffer<CrackSide>& told) {
  const Joints& j = part.joints;
  told.resize(joints.size());
  for_each(
      part.exec, joints.size(),
      TellCrack{joints.view(), j.face_a.view(), j.face_b.view(), fdem_shared::node_vertices(part),
                j.turn.view(), j.shape.view(), std::as_const(part.tetrahedra.id).view(),
                j.length.view(), times_of_break(j), told.view()});
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
  if (w.given->loaded.empty() && w.given->fluids.empty() && w.given->bolts.empty()) return;
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

}  // namespace breccia::fdem3
