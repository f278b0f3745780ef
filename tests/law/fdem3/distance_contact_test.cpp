// Contact of tetrahedra by the distance to the nearest face: reference values, balance, energy.

#include "fdem3/laws/distance_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/random.hpp"
#include "exec/for_each.hpp"
#include "fdem3/contact/couples.hpp"

namespace breccia::fdem3 {
namespace distance_contact_test {

struct Body {
  Vec3 x[4];
};
struct Pair {
  Vec3 on_a[4] = {}, on_b[4] = {};
  int hits = 0;
  double energy = 0.0;
};

Target target_of(const Body& body) {
  Target target = Target::of(body.x);
  target.measure_heights();
  return target;
}

/// Forces of the faces of both, with a penalty of 1.
Pair forces_of(const Body& a, const Body& b, bool with_shape = false) {
  Pair sum;
  const Target of_a = target_of(a), of_b = target_of(b);
  Inside in_a(of_a), in_b(of_b);
  const auto add = [&](const Body& own, const Target& target, Vec3(&on_own)[4], Vec3(&on_other)[4],
                       Inside& inside, Inside& mine) {
    for (int f = 0; f < 4; ++f) {
      Vec3 face[3], on_face[3], on_target[4];
      for (int k = 0; k < 3; ++k) face[k] = own.x[corner_of_face(f, k)];
      FaceOverlap o;
      if (!overlap_of_face(face, target, o)) continue;
      ++sum.hits;
      inside.add_other(inside.share_of(o, face));
      mine.add_own(f, o.area * norm(cross(face[1] - face[0], face[2] - face[0])));
      push(o, face, 1.0, on_face, on_target);
      for (int k = 0; k < 3; ++k) on_own[corner_of_face(f, k)] += on_face[k];
      for (int k = 0; k < 4; ++k) on_other[k] += on_target[k];
    }
  };
  add(a, of_b, sum.on_a, sum.on_b, in_b, in_a);
  add(b, of_a, sum.on_b, sum.on_a, in_a, in_b);
  sum.energy = in_a.energy(1.0) + in_b.energy(1.0);
  if (with_shape) {
    in_a.add_shape_forces(of_a, 1.0, sum.on_a);
    in_b.add_shape_forces(of_b, 1.0, sum.on_b);
  }
  return sum;
}

const Body a{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {.2, .9, 0.0}, {.3, .25, .8}}};
const Body b{{{.35, .3, .5}, {1.25, .4, .55}, {.5, 1.2, .6}, {.6, .5, 1.4}}};

void expect_near(const Vec3& value, const Vec3& expected) {
  const double tolerance = 1e-17;
  EXPECT_NEAR(value.x, expected.x, tolerance);
  EXPECT_NEAR(value.y, expected.y, tolerance);
  EXPECT_NEAR(value.z, expected.z, tolerance);
}

TEST(DistanceContact, gives_the_reference_forces) {
  const Pair p = forces_of(a, b);
  EXPECT_EQ(p.hits, 4);
  expect_near(p.on_a[0], {-2.037028496385e-6, -1.810691996787e-6, -1.216558685341e-6});
  expect_near(p.on_a[1], {-8.973241324985e-6, -9.107897009089e-6, -6.278511154262e-6});
  expect_near(p.on_a[2], {-1.238740345475e-5, -9.879342795118e-6, -7.751683399431e-6});
  expect_near(p.on_a[3], {-4.467805393800e-5, -3.971382572266e-5, -2.540958384717e-5});
  expect_near(p.on_b[0], {6.431050740170e-5, 5.717227333307e-5, 3.846945376114e-5});
  expect_near(p.on_b[1], {3.925203375445e-7, 1.547400130099e-6, 1.218342127737e-6});
  expect_near(p.on_b[2], {1.688095001156e-6, 2.188298058092e-7, 1.166382061685e-6});
  expect_near(p.on_b[3], {1.684604473719e-6, 1.573254254685e-6, -1.978408643552e-7});
}

TEST(DistanceContact, gives_the_reference_forces_and_energy_with_those_of_shape) {
  const Pair p = forces_of(a, b, true);
  EXPECT_NEAR(p.energy, 1.441881722243e-6, 1e-17);
  EXPECT_LT(norm(p.on_a[0]), 1e-19);
  expect_near(p.on_a[1], {-1.028589743621e-5, -9.143019943298e-6, -6.142966524403e-6});
  expect_near(p.on_a[3], {-4.503223222360e-5, -4.002865086542e-5, -2.689424980021e-5});
  expect_near(p.on_b[0], {6.480644502251e-5, 5.761264725658e-5, 3.876961290691e-5});
}

/// Forces on a and b by the kernel of couples, which exposes faces by bits.
/// @param held  whether the couple has pressed before
CoupleForce couple_forces(std::uint8_t exposed_of_a, std::uint8_t exposed_of_b, bool held = true) {
  const auto buffer = []<class T>(const std::vector<T>& items) {
    Buffer<T> made;
    copy_to(made, items);
    return made;
  };
  std::vector<TetrahedronNodes> corners(2);
  for (int k = 0; k < 4; ++k) {
    corners[0].at[k].position = a.x[k];
    corners[1].at[k].position = b.x[k];
  }
  const Buffer<TetrahedronNodes> nodes = buffer(corners);
  const Buffer<Index> material = buffer(std::vector<Index>{0, 0});
  const Buffer<ContactPair> laws = buffer(std::vector<ContactPair>{{1.0, 0.0, 0.0}});
  const Buffer<std::uint8_t> exposed = buffer(std::vector{exposed_of_a, exposed_of_b});
  const Buffer<Index> first = buffer(std::vector<Index>{0}), other = buffer(std::vector<Index>{1});
  const Buffer<Index> no_joint = buffer(std::vector<Index>{-1});
  Buffer<CoupleState> state(Space::host, 1);
  Buffer<CoupleForce> force(Space::host, 1);
  Buffer<fdem_shared::CouplePhase> phase(Space::host, 1);
  phase.data()[0] = fdem_shared::CouplePhase::acts;
  state.data()[0].scale = 1.0;           // it is not new: nothing is taken off
  if (held) state.data()[0].slid = 1.0;  // and does not rest
  for_each(Exec{}, 1,
           CoupleForces{0.0,
                        nodes.view(),
                        material.view(),
                        laws.view(),
                        1,
                        exposed.view(),
                        first.view(),
                        other.view(),
                        no_joint.view(),
                        {},
                        state.view(),
                        force.view(),
                        phase.view()});
  return force.data()[0];
}

/// A fragment's free corner in the joined flank of another: faces of one alone are exposed. Joined
/// faces push with them, so that forces are the slope of the couple's energy.
TEST(DistanceContact, pushes_where_faces_of_one_alone_are_exposed) {
  const struct { std::uint8_t of_a, of_b; } cases[] = {{15, 0}, {0, 15}, {15, 15}, {15, 1}};
  for (const auto& c : cases) {
    SCOPED_TRACE(testing::Message() << int{c.of_a} << " " << int{c.of_b});
    const CoupleForce force = couple_forces(c.of_a, c.of_b);
    const Pair expected = forces_of(a, b, true);
    for (int k = 0; k < 4; ++k) {
      expect_near(force.on_a.at[k], expected.on_a[k]);
      expect_near(force.on_b.at[k], expected.on_b[k]);
    }
    EXPECT_GT(norm(force.on_a.at[3]), 1e-6);
  }
}

/// Joined faces alone begin nothing; what has pressed before does so until the overlap ends.
TEST(DistanceContact, begins_by_an_exposed_face_and_ends_with_the_overlap) {
  const CoupleForce begun = couple_forces(0, 0, true), none = couple_forces(0, 0, false);
  const Pair expected = forces_of(a, b, true);
  for (int k = 0; k < 4; ++k) {
    expect_near(begun.on_a.at[k], expected.on_a[k]);
    EXPECT_EQ(norm(none.on_a.at[k]), 0.0);
  }
}

/// What overlapped by joined faces before an exposed one reached in begins without force; what
/// meets by exposed faces alone has its force at once.
TEST(DistanceContact, begins_without_the_overlap_of_joined_faces) {
  const CoupleForce joined = couple_forces(15, 1, false), free = couple_forces(15, 15, false);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(norm(joined.on_a.at[k]), 0.0);
    EXPECT_EQ(norm(joined.on_b.at[k]), 0.0);
  }
  const Pair expected = forces_of(a, b, true);
  for (int k = 0; k < 4; ++k) expect_near(free.on_a.at[k], expected.on_a[k]);
}

/// Of the corner element (0, e1, e2, e3) and a face given by its corners.
FaceOverlap in_corner(const Vec3& p, const Vec3& q, const Vec3& r, bool& touches) {
  const Vec3 x[4] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const Vec3 face[3] = {p, q, r};
  FaceOverlap o{};
  const Body corner{{x[0], x[1], x[2], x[3]}};
  touches = overlap_of_face(face, target_of(corner), o);
  return o;
}

TEST(DistanceContact, integrates_faces_exactly) {
  const struct {
    Vec3 p, q, r;
    double moment[3], area;
  } cases[] = {
      {{0, 0, .1}, {1, 0, .1}, {0, 1, .1}, {.010937681794, .007544728389, .007544728389}, .405},
      // In the plane between two regions: counted once.
      {{.25, .25, .25}, {1, 0, 0}, {0, 1, 0}, {.012028130608, .006014065304, .006014065304}, .5},
      {{0, 0, 0}, {1, 1, 1}, {1, 1, 0}, {.004337063947, .000799304309, .000733766894}, 1.0 / 12.0},
      {{-1, -1, .2}, {3, -1, .2}, {-1, 3, .2}, {.000533165156, .000447733819, .000447733819}, .02}};
  for (const auto& c : cases) {
    bool touches = false;
    const FaceOverlap o = in_corner(c.p, c.q, c.r, touches);
    ASSERT_TRUE(touches);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(o.moment[k], c.moment[k], 1e-12);
    EXPECT_NEAR(o.area, c.area, 1e-12);
  }
  bool touches = true;
  in_corner({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, touches);  // a face on a face
  EXPECT_FALSE(touches);
}

TEST(DistanceContact, presses_two_faces_with_twice_the_penalty_times_depth) {
  // Regular elements, apexes apart, in depth 1e-3 of the edge.
  const double depth = 1e-3, height = std::sqrt(2.0 / 3.0), third = std::sqrt(3.0) / 6.0;
  const Body low{{{0, 0, 0}, {0.5, std::sqrt(0.75), 0}, {1, 0, 0}, {0.5, third, -height}}};
  const Body high{{{0, 0, -depth},
                   {1, 0, -depth},
                   {0.5, std::sqrt(0.75), -depth},
                   {0.5, third, height - depth}}};
  ASSERT_GT(Target::of(low.x).six_volumes, 0.0);
  ASSERT_GT(Target::of(high.x).six_volumes, 0.0);
  Vec3 force{};
  for (const Vec3& f : forces_of(low, high).on_b) force += f;
  const double area = std::sqrt(3.0) / 4.0;
  EXPECT_NEAR(force.z / (area * depth), 1.987529, 2e-6);
}

TEST(DistanceContact, balances_forces_and_moments_of_random_pairs) {
  const Random random{7, 3};
  int touching = 0;
  for (std::uint32_t i = 0; i < 400; ++i) {
    Body p, q;
    std::uint32_t draw = 0;
    const auto point = [&](double from) {
      const auto next = [&] { return from + random.uniform(i, draw++); };
      const double x = next(), y = next(), z = next();
      return Vec3{x, y, z};
    };
    for (int k = 0; k < 4; ++k) p.x[k] = point(0.0);
    for (int k = 0; k < 4; ++k) q.x[k] = point(0.25);
    for (Body* body : {&p, &q})
      if (Target::of(body->x).six_volumes < 0.0) std::swap(body->x[0], body->x[1]);
    const Pair f = forces_of(p, q);
    if (f.hits == 0) continue;
    ++touching;
    Vec3 sum{}, moment{};
    double largest = 0.0;
    for (int k = 0; k < 4; ++k) {
      sum += f.on_a[k] + f.on_b[k];
      moment += cross(p.x[k], f.on_a[k]) + cross(q.x[k], f.on_b[k]);
      largest = std::max({largest, norm(f.on_a[k]), norm(f.on_b[k])});
    }
    EXPECT_LE(norm(sum), 1e-13 * largest);
    EXPECT_LE(norm(moment), 1e-12 * largest);
  }
  EXPECT_GT(touching, 100);
}

TEST(DistanceContact, is_the_slope_of_its_energy_for_deformable_pairs) {
  const Pair p = forces_of(a, b, true);
  const double h = 1e-6;
  for (int body = 0; body < 2; ++body)
    for (int k = 0; k < 4; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const auto energy_at = [&](double by) {
          Body moved[2] = {a, b};
          Vec3& x = moved[body].x[k];
          (axis == 0 ? x.x : axis == 1 ? x.y : x.z) += by;
          return forces_of(moved[0], moved[1]).energy;
        };
        const double slope = (energy_at(h) - energy_at(-h)) / (2.0 * h);
        const Vec3& f = (body == 0 ? p.on_a : p.on_b)[k];
        EXPECT_NEAR(-slope, axis == 0 ? f.x : axis == 1 ? f.y : f.z, 1e-10);
      }
}

/// Sums of a couple of two of which all faces press, with a penalty of 1.
Pressing pressing_of(const Body& first, const Body& second) {
  Partner one{}, other{};
  for (int k = 0; k < 4; ++k) {
    one.x[k] = first.x[k];
    other.x[k] = second.x[k];
  }
  one.exposed = other.exposed = 15;
  one.target = target_of(first);
  other.target = target_of(second);
  one.in_other = CornersInside::of(first.x, other.target);
  other.in_other = CornersInside::of(second.x, one.target);
  Pressing sum;
  Inside in_a(one.target), in_b(other.target);
  add_faces(one, other.target, 1.0, true, sum, in_b, in_a);
  add_faces(other, one.target, 1.0, false, sum, in_a, in_b);
  in_a.add_shape_forces(one.target, 1.0, sum.force.on_a.at);
  in_b.add_shape_forces(other.target, 1.0, sum.force.on_b.at);
  sum.energy = in_a.energy(1.0) + in_b.energy(1.0);
  return sum;
}

/// Two that stand on one plane, as on a flat side of a body, overlap by a wedge: their faces in
/// that plane bound it together. Rounding lifts one of them, or none, and must not change what they
/// feel.
TEST(DistanceContact, counts_faces_in_one_plane_once) {
  const Body standing{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.2, 0.3, 1.0}}};
  const Body beside{{{0.6, -0.1, 0.0}, {1.7, 0.2, 0.0}, {0.7, 1.1, 0.0}, {0.9, 0.3, 1.1}}};
  const auto lifted = [&](double by) {
    Body moved = beside;
    for (Vec3& x : moved.x) x.z += by;
    return pressing_of(standing, moved);
  };
  const Pressing above = lifted(1e-7), below = lifted(-1e-7);
  ASSERT_GT(above.energy, 0.0);
  EXPECT_NEAR(above.energy, below.energy, 1e-5 * above.energy);
  for (const double by : {0.0, 1e-17, -1e-17, 1e-16, -1e-16, 1e-14, -1e-14}) {
    const Pressing now = lifted(by);
    EXPECT_NEAR(now.energy, above.energy, 1e-5 * above.energy) << by;
    for (int k = 0; k < 4; ++k) {
      const double size = 1e-5 * norm(above.on_a);
      EXPECT_LT(norm(now.force.on_a.at[k] - above.force.on_a.at[k]), size) << by << ", " << k;
      EXPECT_LT(norm(now.force.on_b.at[k] - above.force.on_b.at[k]), size) << by << ", " << k;
    }
  }
}

/// Two beside a crack that ends in a flat side of a body, with faces in both planes: moved by
/// rounding errors, they share a line or a point and a volume of rounding errors.
TEST(DistanceContact, feels_nothing_beside_a_crack_that_meets_a_side) {
  const Random random{5, 0};
  int felt = 0;
  for (std::uint64_t item = 0; item < 60000; ++item) {
    std::uint32_t draw = 0;
    const auto in = [&](double low, double high) {
      return low + (high - low) * random.uniform(item, draw++);
    };
    const Vec3 mouth{0.5, in(-0.1, 0.1), 0.05};
    const auto at_mouth = [&] { return Vec3{0.5, in(0.0, 0.2), 0.05}; };
    const auto inner = [&] { return Vec3{in(0.38, 0.48), in(-0.05, 0.15), 0.05}; };
    const double above = 0.05 + in(0.03, 0.13), below = 0.05 - in(0.03, 0.13);
    Body one{{mouth, at_mouth(), inner(), {0.5, in(-0.05, 0.15), above}}};
    Body other{
        {mouth, item % 2 == 0 ? one.x[1] : at_mouth(), inner(), {0.5, in(-0.05, 0.15), below}}};
    const double size = std::pow(10.0, in(-17.0, -14.0));
    for (Body* body : {&one, &other}) {
      if (dot(body->x[1] - body->x[0], cross(body->x[2] - body->x[0], body->x[3] - body->x[0])) <
          0.0)
        std::swap(body->x[1], body->x[2]);
      for (Vec3& x : body->x) x += size * Vec3{in(-1.0, 1.0), in(-1.0, 1.0), in(-1.0, 1.0)};
    }
    const Target of_one = target_of(one), of_other = target_of(other);
    if (of_one.six_volumes < 1e-4 || of_other.six_volumes < 1e-4) continue;
    if (CornersInside::of(one.x, of_other).beyond_a_face() ||
        CornersInside::of(other.x, of_one).beyond_a_face())
      continue;
    const Pressing now = pressing_of(one, other);
    for (int k = 0; k < 4; ++k)
      if (norm(now.force.on_a.at[k]) + norm(now.force.on_b.at[k]) > 1e-11) ++felt;
  }
  EXPECT_EQ(felt, 0);  // of some 1e-6 where something is felt
}

/// The six tetrahedra of a cube and of the one on top: faces, edges and planes coincide. Moved by
/// rounding errors they must not feel more than depths of rounding errors.
TEST(DistanceContact, feels_nothing_where_faces_coincide) {
  constexpr int paths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
  std::vector<Body> bodies;
  for (const double floor : {0.0, 1.0})
    for (int p = 0; p < 6; ++p) {
      Body body{};
      double at[3] = {0.0, 0.0, floor};
      for (int corner = 0; corner < 4; ++corner) {
        const int place = p < 3 || corner == 0 || corner == 3 ? corner : 3 - corner;
        body.x[place] = {at[0], at[1], at[2]};
        if (corner < 3) at[paths[p][corner]] += 1.0;
      }
      bodies.push_back(body);
    }
  for (const double noise : {1e-16, 1e-14, 1e-12, 1e-10})
    for (std::uint64_t round = 0; round < 20; ++round) {
      const Random random{round, 7};
      std::vector<Body> moved = bodies;
      std::uint64_t draw = 0;
      for (Body& body : moved)
        for (Vec3& x : body.x)
          x += noise *
               Vec3{random.uniform(draw, 0), random.uniform(draw, 1), random.uniform(draw++, 2)};
      for (std::size_t i = 0; i < moved.size(); ++i)
        for (std::size_t j = i + 1; j < moved.size(); ++j) {
          const Pair pair = forces_of(moved[i], moved[j], true);
          for (int k = 0; k < 4; ++k) {
            // A face of area 0.71 pressed by 2 sqrt 3 noise, and rounding.
            EXPECT_LE(norm(pair.on_a[k]), 4.0 * noise + 1e-15) << i << " " << j;
            EXPECT_LE(norm(pair.on_b[k]), 4.0 * noise + 1e-15) << i << " " << j;
          }
        }
    }
}

}  // namespace distance_contact_test
}  // namespace breccia::fdem3
