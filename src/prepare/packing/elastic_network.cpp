#include "prepare/packing/elastic_network.hpp"

#include <cmath>

#include "dem/setup/materials.hpp"

namespace breccia::prepare {
namespace {

using Six = std::array<double, 6>;

Vec3 first(const Six& s) {
  return {s[0], s[1], s[2]};
}
Vec3 last(const Six& s) {
  return {s[3], s[4], s[5]};
}
void add(Six& sum, const Vec3& force, const Vec3& torque) {
  const double terms[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
  for (std::size_t c = 0; c < 6; ++c) sum[c] += terms[c];
}

template <class Term>
double total(std::size_t members, const Term& term) {
  double sum = 0.0;
  for (std::size_t i = 0; i < members; ++i)
    for (std::size_t c = 0; c < 6; ++c) sum += term(i, c);
  return sum;
}

}  // namespace

ElasticNetwork::ElasticNetwork(const dem::Model& model, const dem::Config& config,
                               std::vector<Index> members)
    : members_(std::move(members)) {
  std::vector<Index> place(model.position.size(), -1);
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const auto e = static_cast<std::size_t>(members_[k]);
    place[e] = static_cast<Index>(k);
    mean_radius_ += model.radius[e] / static_cast<double>(members_.size());
  }
  for (const dem::Model::Link& link : model.links) {
    if (link.kind != dem::LinkKind::concrete) continue;
    const auto a = static_cast<std::size_t>(link.a), b = static_cast<std::size_t>(link.b);
    if (place[a] < 0 || place[b] < 0) continue;
    const dem::MaterialConfig& material = config.materials[static_cast<std::size_t>(link.material)];
    const Vec3 apart = model.position[b] - model.position[a];
    const double d = norm(apart), ra = model.radius[a], rb = model.radius[b];
    const double kn = dem::link_stiffness(model, link, material);
    const double kt = dem::local_elasticity(material).ratio * kn;
    const double r = 0.5 * (ra + rb) / mean_radius_;  // turns are lengths
    springs_.push_back({place[a], place[b], (1.0 / d) * apart, 0.5 * (d + ra - rb) / mean_radius_,
                        0.5 * (d + rb - ra) / mean_radius_, kn, kt,
                        material.rolling_stiffness * kt * r * r});
  }
}

void ElasticNetwork::add_forces(const Displacements& at, Displacements& sum) const {
  for (const Spring& s : springs_) {
    const Six& a = at[static_cast<std::size_t>(s.a)];
    const Six& b = at[static_cast<std::size_t>(s.b)];
    const Vec3 turn_a = last(a), turn_b = last(b), n = s.normal;
    const Vec3 du = first(b) - first(a) - cross(s.arm_a * turn_a + s.arm_b * turn_b, n);
    const Vec3 force =
        s.shear_stiffness * du + ((s.normal_stiffness - s.shear_stiffness) * dot(n, du)) * n;
    const Vec3 moment = s.turn_stiffness * (turn_b - turn_a);
    const Vec3 lever = cross(n, force);
    add(sum[static_cast<std::size_t>(s.a)], -force, -(s.arm_a * lever) - moment);
    add(sum[static_cast<std::size_t>(s.b)], force, moment - s.arm_b * lever);
  }
}

Displacements ElasticNetwork::diagonal() const {
  Displacements sum(members_.size());
  for (const Spring& s : springs_) {
    const double n[3] = {s.normal.x, s.normal.y, s.normal.z};
    for (std::size_t c = 0; c < 3; ++c) {
      const double along = n[c] * n[c];
      const double push = s.shear_stiffness * (1.0 - along) + s.normal_stiffness * along;
      sum[static_cast<std::size_t>(s.a)][c] += push;
      sum[static_cast<std::size_t>(s.b)][c] += push;
      for (const auto& [end, arm] : {std::pair{s.a, s.arm_a}, {s.b, s.arm_b}})
        sum[static_cast<std::size_t>(end)][3 + c] +=
            s.shear_stiffness * arm * arm * (1.0 - along) + s.turn_stiffness;
    }
  }
  return sum;
}

Displacements ElasticNetwork::forces(const Displacements& at) const {
  Displacements scaled = at, sum(at.size());
  for (Six& s : scaled)
    for (std::size_t c = 3; c < 6; ++c) s[c] *= mean_radius_;
  add_forces(scaled, sum);
  for (Six& s : sum)
    for (std::size_t c = 3; c < 6; ++c) s[c] *= mean_radius_;
  return sum;
}

Displacements ElasticNetwork::relaxed(const Held& held, const Displacements& load,
                                      double tolerance) const {
  const std::size_t count = members_.size();
  Displacements x = held.value, residual(count), step(count), internal(count);
  for (Six& s : x)
    for (std::size_t c = 3; c < 6; ++c) s[c] *= mean_radius_;
  const Displacements stiffness = diagonal();
  const auto is_free = [&](std::size_t i, std::size_t c) {
    return !held.fixed[i][c] && stiffness[i][c] > 0.0;
  };
  add_forces(x, internal);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 6; ++c) {
      if (!is_free(i, c)) continue;
      const double pull = load.empty() ? 0.0 : load[i][c] / (c < 3 ? 1.0 : mean_radius_);
      residual[i][c] = pull - internal[i][c];
    }
  const auto weighted = [&] {
    return total(count, [&](std::size_t i, std::size_t c) {
      return is_free(i, c) ? residual[i][c] * residual[i][c] / stiffness[i][c] : 0.0;
    });
  };
  double now = weighted();
  const double enough = tolerance * tolerance * now;
  double before = 0.0;
  for (std::size_t pass = 0; pass < 50 * count && now > enough && now > 0.0; ++pass) {
    const double keep = before > 0.0 ? now / before : 0.0;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 6; ++c)
        step[i][c] = is_free(i, c) ? residual[i][c] / stiffness[i][c] + keep * step[i][c] : 0.0;
    internal.assign(count, {});
    add_forces(step, internal);
    const double along = now / total(count, [&](std::size_t i, std::size_t c) {
                           return step[i][c] * internal[i][c];
                         });
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 6; ++c) {
        x[i][c] += along * step[i][c];
        if (is_free(i, c)) residual[i][c] -= along * internal[i][c];
      }
    before = now;
    now = weighted();
  }
  for (Six& s : x)
    for (std::size_t c = 3; c < 6; ++c) s[c] /= mean_radius_;
  return x;
}

}  // namespace breccia::prepare
