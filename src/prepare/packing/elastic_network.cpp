#include "prepare/packing/elastic_network.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/setup/materials.hpp"
#include "exec/plain_vector.hpp"
#include "exec/tasks.hpp"

namespace breccia::prepare {
namespace {

using Six = std::array<double, 6>;

/// Springs by threads go through memory twice, which two threads gain little by.
constexpr int fewest_for_springs = 3;

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
                               std::vector<Index> members, int threads)
    : members_(std::move(members)), threads_(threads) {
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
  if (threads_ < fewest_for_springs) return;
  first_.assign(members_.size() + 1, 0);
  first_visitor_ = first_;
  for (const Spring& s : springs_) {
    ++first_[static_cast<std::size_t>(s.a) + 1];
    ++first_visitor_[static_cast<std::size_t>(s.b) + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::partial_sum(first_visitor_.begin(), first_visitor_.end(), first_visitor_.begin());
  std::vector<std::size_t> next = first_visitor_;
  visitor_.resize(springs_.size());
  for (std::size_t i = 0; i < springs_.size(); ++i)
    visitor_[next[static_cast<std::size_t>(springs_[i].b)]++] = i;
}

template <class Work>
void ElasticNetwork::each_block(std::size_t count, const Work& work) const {
  constexpr std::size_t at_once = 512;
  for_each_task(threads_, static_cast<int>((count + at_once - 1) / at_once), [&](int block) {
    const std::size_t begin = static_cast<std::size_t>(block) * at_once;
    work(begin, std::min(count, begin + at_once));
  });
}

ElasticNetwork::Action ElasticNetwork::action_of(const Spring& s, const Displacements& at) const {
  const Six& a = at[static_cast<std::size_t>(s.a)];
  const Six& b = at[static_cast<std::size_t>(s.b)];
  const Vec3 turn_a = last(a), turn_b = last(b), n = s.normal;
  const Vec3 du = first(b) - first(a) - cross(s.arm_a * turn_a + s.arm_b * turn_b, n);
  const Vec3 force =
      s.shear_stiffness * du + ((s.normal_stiffness - s.shear_stiffness) * dot(n, du)) * n;
  const Vec3 moment = s.turn_stiffness * (turn_b - turn_a);
  const Vec3 lever = cross(n, force);
  return {force, -(s.arm_a * lever) - moment, moment - s.arm_b * lever};
}

void ElasticNetwork::add_forces(const Displacements& at, Displacements& sum) const {
  if (threads_ >= fewest_for_springs) return add_forces_by_threads(at, sum);
  for (const Spring& s : springs_) {
    const Action action = action_of(s, at);
    add(sum[static_cast<std::size_t>(s.a)], -action.force, action.on_a);
    add(sum[static_cast<std::size_t>(s.b)], action.force, action.on_b);
  }
}

/// Springs first, then sums of members in the order of the springs: those that come from lower
/// members have lower numbers than a member's own.
void ElasticNetwork::add_forces_by_threads(const Displacements& at, Displacements& sum) const {
  PlainVector<Action> actions;
  actions.resize(springs_.size());
  each_block(springs_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) actions[i] = action_of(springs_[i], at);
  });
  each_block(members_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t v = first_visitor_[k]; v < first_visitor_[k + 1]; ++v)
        add(sum[k], actions[visitor_[v]].force, actions[visitor_[v]].on_b);
      for (std::size_t i = first_[k]; i < first_[k + 1]; ++i)
        add(sum[k], -actions[i].force, actions[i].on_a);
    }
  });
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
    each_block(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        internal[i] = {};
        for (std::size_t c = 0; c < 6; ++c)
          step[i][c] = is_free(i, c) ? residual[i][c] / stiffness[i][c] + keep * step[i][c] : 0.0;
      }
    });
    add_forces(step, internal);
    const double along = now / total(count, [&](std::size_t i, std::size_t c) {
                           return step[i][c] * internal[i][c];
                         });
    each_block(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t c = 0; c < 6; ++c) {
          x[i][c] += along * step[i][c];
          if (is_free(i, c)) residual[i][c] -= along * internal[i][c];
        }
    });
    before = now;
    now = weighted();
  }
  for (Six& s : x)
    for (std::size_t c = 3; c < 6; ++c) s[c] /= mean_radius_;
  return x;
}

}  // namespace breccia::prepare
