#pragma once
// A made-up moment of an impact test, of the size of the full case: for pictures and files.

#include <cmath>

#include "io/frame.hpp"

namespace breccia::test {

/// A 1 x 1 x 0.1 m slab of 12,718 spheres and 784 of steel, a ball of 772 above its crater, damage
/// and velocities that fall off from the centre, a few fragments that flew far, some links.
inline Frame slab_scene() {
  std::uint64_t state = 88172645463325252ULL;
  const auto random = [&state] {  // xorshift, G. Marsaglia (2003)
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return static_cast<double>(state >> 11) / 9007199254740992.0;
  };
  Frame frame;
  frame.step = 48213;
  frame.time = 1.206e-3;
  frame.groups = {"slab", "steel", "impactor"};
  FrameField group{"group", "-", 1, {}}, damage{"damage", "-", 1, {}},
      velocity{"velocity", "m/s", 3, {}};
  const auto add = [&](const Vec3& point, double radius, float body, double hurt,
                       const Vec3& speed) {
    frame.position.push_back(point);
    frame.radius.push_back(radius);
    group.values.push_back(body);
    damage.values.push_back(static_cast<float>(hurt < 0.0 ? 0.0 : hurt > 1.0 ? 1.0 : hurt));
    for (const double v : {speed.x, speed.y, speed.z}) {
      velocity.values.push_back(static_cast<float>(v));
    }
  };
  // Concrete: a jittered grid of 51 x 51 x 5 less some, so that neighbours about touch.
  for (int n = 0; frame.position.size() < 12718 && n < 13005; ++n) {
    const double spacing = 1.0 / 51.0;
    const Vec3 place{(n % 51 + 0.5) * spacing - 0.5, (n / 51 % 51 + 0.5) * spacing - 0.5,
                     (n / 2601 + 0.5) * 0.02 - 0.1};
    const Vec3 jitter{0.5 * spacing * (random() - 0.5), 0.5 * spacing * (random() - 0.5),
                      0.4 * spacing * (random() - 0.5)};
    const double r = std::sqrt(place.x * place.x + place.y * place.y);
    const double hurt = 1.35 - r / 0.17 + 0.5 * (random() - 0.5);
    const double ray = std::fabs(place.x * 0.8 - place.y * 0.6) < 0.02 ? 0.5 * random() : 0.0;
    const double depth = r < 0.13 ? 0.05 * (1.0 - r * r / 0.0169) : 0.0;
    const Vec3 lifted{jitter.x, jitter.y, jitter.z - depth * (1.0 + place.z / 0.1)};
    const double speed = -18.0 / (1.0 + 400.0 * r * r * r);
    add(place + lifted, (0.0095 + 0.002 * random()), 0.0F, hurt > 0.0 ? hurt : ray * (1.0 - r),
        {4.0 * place.x / (r + 0.1), 4.0 * place.y / (r + 0.1), speed});
  }
  for (int n = 0; n < 784; ++n) {
    const double along = (n % 98 + 0.5) / 98.0 - 0.5, across = (n / 98 % 4 + 0.5) / 4.0 - 0.5;
    const Vec3 place = n < 392 ? Vec3{along, across, -0.085} : Vec3{across, along, -0.075};
    add(place, 0.006, 1.0F, 0.0, {0, 0, -1.0});
  }
  while (frame.position.size() < 14274 - 12) {
    const Vec3 place{0.3 * random() - 0.15, 0.3 * random() - 0.15, 0.3 * random() - 0.15};
    if (norm(place) > 0.14) continue;
    add(place + Vec3{0.0, 0.0, 0.17}, 0.013, 2.0F, 0.0, {0, 0, -8.0});
  }
  while (frame.position.size() < 14274) {  // fragments
    add({6.0 * random() - 3.0, 6.0 * random() - 3.0, 4.0 * random()}, 0.01, 0.0F, 1.0,
        {0, 0, 40.0 + 60.0 * random()});
  }
  FrameField kind{"kind", "-", 1, {}}, force{"force", "N", 1, {}};
  for (std::int32_t i = 0; i + 2652 < 12718; ++i) {
    for (const std::int32_t j : {i + 1, i + 51, i + 2601}) {
      const Vec3 apart =
          frame.position[static_cast<std::size_t>(j)] - frame.position[static_cast<std::size_t>(i)];
      if (norm(apart) > 0.03 || damage.values[static_cast<std::size_t>(i)] > 0.9F) continue;
      frame.lines.insert(frame.lines.end(), {i, j});
      kind.values.push_back(0.0F);
      const Vec3 centre = frame.position[static_cast<std::size_t>(i)];
      force.values.push_back(static_cast<float>(2e3 * (random() - 0.6) / (0.1 + norm(centre))));
    }
  }
  for (std::int32_t n = 0; n < 783; ++n) {
    if (n % 98 == 97) continue;
    frame.lines.insert(frame.lines.end(), {12718 + n, 12719 + n});
    kind.values.push_back(1.0F);
    force.values.push_back(5e3F);
  }
  frame.point_fields = {group, damage, velocity};
  frame.line_fields = {kind, force};
  return frame;
}

}  // namespace breccia::test
