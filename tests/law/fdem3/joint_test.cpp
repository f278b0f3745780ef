// Joints between faces: reference values, all ways two faces can meet, rotation, energy.

#include <gtest/gtest.h>

#include <cmath>

#include "exec/for_each.hpp"
#include "fdem3/joints/joint_kernels.hpp"

namespace breccia::fdem3 {
namespace joint_test {

constexpr double mm = 1e-3;

JointBond bond() {
  JointBond b{};
  b.stiffness = 150e9;
  b.tension = 3e6;
  b.cohesion = 15e6;
  b.friction = 0.7;
  b.softening_open = fdem::exact_softening_factor * 10.0;
  b.softening_slide = fdem::exact_softening_factor * 50.0;
  return b;
}

/// Two tetrahedra with a joint on a face of 0.45 mm2, h = 0.5 mm.
class OneJoint {
 public:
  /// @param face_a, face_b  faces that lie on each other  @param turn  see JointEnds
  OneJoint(int face_a, int face_b, int turn, const JointBond& law = bond()) {
    copy_to(bonds_, std::vector<JointBond>{law});
    const Vec3 corner[3] = {{0.0, 0.0, 0.0}, {mm, 0.0, 0.0}, {0.2 * mm, 0.9 * mm, 0.0}};
    nodes_.resize(2);
    const JointEnds e = JointEnds::of(face_a, 4 + face_b, turn);
    for (int k = 0; k < 3; ++k) {
      node(e.a[k]).position = node(e.b[k]).position = corner[k];
      a_[k] = e.a[k];
      b_[k] = e.b[k];
    }
    nodes_.data()[0].at[face_a].position = {0.3 * mm, 0.3 * mm, mm};
    nodes_.data()[1].at[face_b].position = {0.3 * mm, 0.3 * mm, -mm};
    copy_to(face_a_, std::vector<Index>{face_a});
    copy_to(face_b_, std::vector<Index>{4 + face_b});
    copy_to(turn_, std::vector<std::uint8_t>{static_cast<std::uint8_t>(turn)});
    copy_to(law_, std::vector<Index>{0});
    copy_to(shape_, std::vector<FaceShape>{FaceShape::of(corner[0], corner[1], corner[2])});
    copy_to(length_, std::vector<double>{0.5 * mm});
    copy_to(strength_, std::vector<double>{1.0});
    stage_.resize(1), failure_.resize(1), force_.resize(1), work_.resize(1), changed_.resize(2);
  }
  NodeState& node(Index n) { return nodes_.data()[n / 4].at[n % 4]; }
  NodeState& on_a(int k) { return node(a_[k]); }
  NodeState& on_b(int k) { return node(b_[k]); }
  /// Moves side a's corners and evaluates.
  JointForce moved(const Vec3& first, const Vec3& second, const Vec3& third, double dt = 0.0) {
    const Vec3 by[3] = {first, second, third};
    for (int k = 0; k < 3; ++k) {
      const Vec3 before = on_a(k).position;
      on_a(k).position = start_[k] + by[k];
      if (dt > 0.0) on_a(k).velocity = (1.0 / dt) * (on_a(k).position - before);
    }
    return evaluated(dt);
  }
  JointForce evaluated(double dt = 0.0) {
    const JointForces kernel{0.0,
                             dt,
                             std::as_const(nodes_).view(),
                             std::as_const(bonds_).view(),
                             std::as_const(face_a_).view(),
                             std::as_const(face_b_).view(),
                             std::as_const(turn_).view(),
                             std::as_const(law_).view(),
                             std::as_const(shape_).view(),
                             std::as_const(length_).view(),
                             std::as_const(strength_).view(),
                             {},
                             {},
                             {},
                             {},
                             stage_.view(),
                             force_.view(),
                             work_.view(),
                             failure_.view(),
                             changed_.view()};
    for_each(Exec{}, 1, kernel);
    return force_.data()[0];
  }
  const JointWork& work() const { return work_.data()[0]; }
  JointStage stage() const { return stage_.data()[0]; }
  double rubbed() const { return failure_.item(0).rubbed; }
  JointPoints points() const { return failure_.item(0).points; }

 private:
  const Vec3 start_[3] = {{0.0, 0.0, 0.0}, {mm, 0.0, 0.0}, {0.2 * mm, 0.9 * mm, 0.0}};
  Index a_[3], b_[3];
  Buffer<TetrahedronNodes> nodes_;
  Buffer<JointBond> bonds_;
  Buffer<Index> face_a_, face_b_, law_;
  Buffer<std::uint8_t> turn_, changed_;
  Buffer<FaceShape> shape_;
  Buffer<double> length_, strength_;
  Buffer<JointStage> stage_;
  RareArray<JointFailure> failure_;
  Buffer<JointForce> force_;
  Buffer<JointWork> work_;
};

void expect_near(const JointForce& f, const Vec3& a0, const Vec3& a1, const Vec3& a2) {
  const Vec3 expected[3] = {a0, a1, a2};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(f.at[k].x, expected[k].x, 1e-9) << k;
    EXPECT_NEAR(f.at[k].y, expected[k].y, 1e-9) << k;
    EXPECT_NEAR(f.at[k].z, expected[k].z, 1e-9) << k;
  }
}

TEST(FaceJoint, gives_the_reference_forces_in_each_branch) {
  OneJoint elastic(0, 0, 0);
  expect_near(elastic.moved({2e-8, 1e-8, 1e-9}, {2e-8, 1e-8, 3e-9}, {2e-8, 1e-8, 2e-9}),
              {-.79937692750691, -.39968846463498, -.07523434948081},
              {-.79937692489432, -.39968846337247, -.09548437573080},
              {-.79937692634068, -.39968846405111, -.08521873760580});
  EXPECT_EQ(elastic.stage(), JointStage::whole);
  OneJoint softening(0, 0, 0);
  expect_near(softening.moved({2e-6, -1e-6, 3e-6}, {2e-6, -1e-6, 1e-6}, {2e-6, -1e-6, 2e-6}),
              {-.87480142900123, .43805405896311, -.19491225342857},
              {-.97290764312586, .48697795139378, -.21675284670362},
              {-.92397815953814, .46256768436642, -.20585917669820});
  EXPECT_EQ(softening.stage(), JointStage::softened);
  OneJoint pressed(0, 0, 0);
  expect_near(pressed.moved({3e-7, 1e-7, -1e-8}, {3e-7, 1e-7, -2e-8}, {3e-7, 1e-7, -3e-8}),
              {-2.62364816002799, -.87454410539602, .78740936368185},
              {-2.69684485718444, -.89894230505120, .89990997364734},
              {-2.76997836687243, -.92331942185786, 1.01241058308605});
  EXPECT_NEAR(pressed.points().point[0].damage, .027376416912, 1e-11);
  EXPECT_NEAR(pressed.points().point[1].damage, .028353734644, 1e-11);
  EXPECT_NEAR(pressed.points().point[2].damage, .027921862630, 1e-11);
  OneJoint tilted(0, 0, 0);
  const JointForce f = tilted.moved({1e-6, 0, 5e-6}, {1e-6, 0, -2e-8}, {1e-6, 0, 1e-6});
  EXPECT_NEAR(f.at[0].x, -1.05124599761019, 1e-9);
  EXPECT_NEAR(f.at[0].y, .00445410131879, 1e-9);
  EXPECT_NEAR(f.at[0].z, -.20751631923826, 1e-9);
}

TEST(FaceJoint, answers_alike_whichever_faces_meet_and_however_they_are_turned) {
  OneJoint one(0, 0, 0);
  const Vec3 by[3] = {{2e-6, -1e-6, 3e-6}, {2e-6, -1e-6, 1e-6}, {2e-6, -1e-6, 2e-6}};
  const JointForce expected = one.moved(by[0], by[1], by[2]);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b)
      for (int turn = 0; turn < 3; ++turn) {
        OneJoint other(a, b, turn);
        const JointForce f = other.moved(by[0], by[1], by[2]);
        for (int k = 0; k < 3; ++k) EXPECT_EQ(norm(f.at[k] - expected.at[k]), 0.0);
        // The two faces lie on each other: corner k of side a is the place of corner k of b.
        for (int k = 0; k < 3; ++k)
          EXPECT_LT(norm(other.on_a(k).position - by[k] - other.on_b(k).position), 1e-18);
      }
}

TEST(FaceJoint, takes_its_fracture_energies_when_it_is_pulled_and_sheared_apart) {
  const double area = 0.45 * mm * mm;
  const auto work_of = [&](const Vec3& way) {
    OneJoint joint(0, 0, 0);
    const int steps = 20000;
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      joint.moved(share * way, share * way, share * way, 1e-6);
    }
    EXPECT_EQ(joint.stage(), JointStage::broken);
    return joint.work();
  };
  // G_I + 2/3 c_t o_p and G_II + 2/3 c s_p: the elastic branches' own work is not given back.
  const JointWork opened = work_of({0.0, 0.0, 1.2e-5});
  EXPECT_NEAR(opened.open / area, 10.04, 2e-3);
  EXPECT_NEAR(opened.slide / area, 0.0, 1e-9);
  const JointWork slid = work_of({1.2e-5, 0.0, 0.0});
  EXPECT_NEAR(slid.slide / area, 51.0, 1e-2);
  EXPECT_NEAR(slid.open / area, 0.0, 1e-9);
}

// Slid apart under a pressure, to any side: of the work G_II + 2/3 f_s s_p an area are softening's,
// the rest, sigma tan phi_r s_t (1 - 1/k), is that of residual friction.
TEST(FaceJoint, tells_the_work_of_residual_friction_apart) {
  const double area = 0.45 * mm * mm, slope = bond().stiffness / (0.5 * mm), pressed = 20e6;
  const double strength = 15e6 + 0.7 * pressed, s_p = 2.0 * strength / slope;
  const double s_t = bond().softening_slide / strength;
  for (const Vec3& way : {Vec3{1.0, 0.0, 0.0}, Vec3{-0.6, 0.8, 0.0}}) {
    JointBond rough = bond();
    rough.residual = 0.5;
    OneJoint joint(0, 0, 0, rough);
    const int steps = 20000;
    for (int i = 1; i <= 100; ++i) {
      const Vec3 at{0.0, 0.0, -0.01 * i * pressed / slope};
      joint.moved(at, at, at, 1e-6);
    }
    for (int i = 1; i <= steps && joint.stage() != JointStage::broken; ++i) {
      const Vec3 at = 1.1 * i / steps * (s_p + s_t) * way + Vec3{0.0, 0.0, -pressed / slope};
      joint.moved(at, at, at, 1e-6);
    }
    ASSERT_EQ(joint.stage(), JointStage::broken);
    const double rubbed = 0.5 * pressed * s_t * (1.0 - 1.0 / fdem::exact_softening_factor);
    EXPECT_NEAR(joint.rubbed() / area, rubbed, 1e-3 * rubbed);
    EXPECT_NEAR((joint.work().slide - joint.rubbed()) / area, 50.0 + 2.0 / 3.0 * strength * s_p,
                0.02);
  }
}

// Pressed to sigma, slipped by s, let go, slipped back: the way round takes T^3/(12 p_f/h) times
// (1/c - 1/(c + sigma tan phi)) an area, T = p_f s/h, which a joint that stays whole does not
// store.
TEST(FaceJoint, books_what_pressure_takes_on_its_slip) {
  const double area = 0.45 * mm * mm, slope = bond().stiffness / (0.5 * mm);
  const double pressed = 40e6 / slope, slipped = 20e6 / slope;
  OneJoint joint(0, 0, 0);
  const int steps = 1000;
  const auto go = [&](const Vec3& from, const Vec3& to) {
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const Vec3 at = (1.0 - share) * from + share * to;
      joint.moved(at, at, at, 1e-6);
    }
  };
  go({}, {0.0, 0.0, -pressed});
  EXPECT_EQ(joint.work().slide, 0.0);
  go({0.0, 0.0, -pressed}, {slipped, 0.0, -pressed});
  EXPECT_NEAR(joint.work().slide, 0.0, 1e-15);
  go({slipped, 0.0, -pressed}, {slipped, 0.0, 0.0});
  const double taken = area * 20e6 * 20e6 * 20e6 / (12.0 * slope) * (1.0 / 15e6 - 1.0 / 43e6);
  EXPECT_NEAR(joint.work().slide, taken, 1e-5 * taken);
  go({slipped, 0.0, 0.0}, {});
  EXPECT_NEAR(joint.work().slide, taken, 1e-5 * taken);
  EXPECT_EQ(joint.work().open, 0.0);
  EXPECT_EQ(joint.stage(), JointStage::whole);
  // Its forces took just that from who moved it.
  double given = 0.0;
  Vec3 last{};
  JointForce before = joint.moved({}, {}, {}, 1e-6);
  const Vec3 corner[4] = {
      {0.0, 0.0, -pressed}, {slipped, 0.0, -pressed}, {slipped, 0.0, 0.0}, Vec3{}};
  for (const Vec3& to : corner) {
    const Vec3 from = last;
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const Vec3 at = (1.0 - share) * from + share * to;
      const JointForce now = joint.moved(at, at, at, 1e-6);
      for (int k = 0; k < 3; ++k) given -= 0.5 * dot(before.at[k] + now.at[k], at - last);
      before = now;
      last = at;
    }
  }
  EXPECT_NEAR(given, taken, 1e-3 * taken);
}

// The faces turn about the line between the points 1 and 2, which stay whole. Corner 2 lies beyond
// that line and presses where point 0 has failed; before, three points hold the faces.
TEST(FaceJoint, holds_a_corner_out_of_the_other_face) {
  const double area = 0.45 * mm * mm, slope = bond().stiffness / (0.5 * mm);
  OneJoint joint(0, 0, 0);
  JointForce f{};
  double depth = 0.0, work = 0.0, pressing = 0.0, stored = 0.0;
  Vec3 last{};
  for (int i = 1; i <= 4000; ++i) {
    depth = 5e-9 * i;
    const JointForce before = f;
    const Vec3 up{0.0, 0.0, depth};
    f = joint.moved(up, up, -up, 1e-6);
    for (int k = 0; k < 3; ++k)
      work -= 0.5 * dot(before.at[k] + f.at[k], k < 2 ? up - last : last - up);
    last = up;
    const double lost = joint.stage() == JointStage::whole
                            ? 0.0
                            : 1.0 - fdem::softening(joint.points().point[0].damage);
    const double now = area / 12.0 * lost * slope * depth;
    stored += 0.5 * (pressing + now) * 5e-9;
    pressing = now;
  }
  EXPECT_EQ(joint.stage(), JointStage::softened);
  EXPECT_NEAR(joint.points().point[0].damage, 1.0, 1e-12);
  EXPECT_LT(joint.points().point[1].damage, 1e-6);
  const double pressed = area / 12.0 * slope * depth;
  EXPECT_NEAR(f.at[2].z, pressed, 1e-3 * pressed);
  EXPECT_NEAR(f.at[0].z, 0.0, 1e-3 * pressed);
  EXPECT_NEAR(work, stored + area / 3.0 * 10.0, 1e-3 * stored);
  EXPECT_NEAR(joint.work().open + joint.work().slide, work, 1e-3 * work);
}

// The energy of a corner is the work of its force on the way into the other face: in proportion to
// the depth until that is as far as the point is open, and the same from then on.
TEST(FaceJoint, stores_what_its_corner_presses_with) {
  const double open = 2e-6;
  double work = 0.0, before = 0.0;
  for (int i = 0; i <= 3000; ++i) {
    const double far = 1e-9 * i, other = 0.5 * (open - far);
    const PressedCorner corner = PressedCorner::of({open, other, other}, 0);
    EXPECT_NEAR(corner.depth, std::min(far, open), 1e-15);
    if (i > 0) work += 0.5 * (before + corner.depth) * 1e-9;
    before = corner.depth;
    EXPECT_NEAR(corner.work, work, 1e-16);
  }
  // A softened joint adds that to what its points hold; a whole one has no such spring.
  const double area = 0.45 * mm * mm, h = 0.5 * mm;
  const auto apart = [&](JointPoints points) {
    const Vec3 up{0.0, 0.0, open};
    const Vec3 b[3] = {{0.0, 0.0, 0.0}, {mm, 0.0, 0.0}, {0.2 * mm, 0.9 * mm, 0.0}};
    const Vec3 a[3] = {b[0] + up, b[1] + up, b[2] - up};
    JointOpening o = opening_of(a, b);
    o.open[1] = o.open[2] = 0.0;  // but for rounding they are
    return stored_in(bond(), 1.0, h, area, {}, o, points).open;
  };
  JointPoints points{};
  const double whole = apart(points);
  points.point[0].damage = 1.0;
  points.point[0].opening = open;
  const double spring = area / 12.0 * bond().stiffness / h;
  EXPECT_NEAR(apart(points), 0.5 * spring * open * open, 1e-3 * spring * open * open);
  EXPECT_LT(whole, 0.1 * apart(points));
}

TEST(FaceJoint, turns_its_forces_with_the_body) {
  const auto turned = [](const Vec3& v) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    return Vec3{c * v.x - s * v.y, 0.6 * (s * v.x + c * v.y) - 0.8 * v.z,
                0.8 * (s * v.x + c * v.y) + 0.6 * v.z};
  };
  OneJoint joint(1, 2, 1);
  const JointForce f = joint.moved({2e-6, -1e-6, 3e-6}, {2e-6, -1e-6, 1e-6}, {2e-6, -1e-6, 2e-6});
  OneJoint other(1, 2, 1);
  for (int k = 0; k < 3; ++k) {
    other.on_a(k).position = turned(joint.on_a(k).position);
    other.on_b(k).position = turned(joint.on_b(k).position);
  }
  const JointForce g = other.evaluated();
  for (int k = 0; k < 3; ++k) EXPECT_LT(norm(g.at[k] - turned(f.at[k])), 1e-10);
}

TEST(PrincipalStresses, are_found_by_rotations) {
  const Sym3 s{3e6, -2e6, 5e6, 1.5e6, -0.7e6, 2.2e6};
  const Principal p = principal(s);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(norm(p.axis[k]), 1.0, 1e-14);
    EXPECT_LT(norm(s * p.axis[k] - p.value[k] * p.axis[k]), 1e-9 * 5e6);
  }
  EXPECT_GE(p.value[0], p.value[1]);
  EXPECT_GE(p.value[1], p.value[2]);
  EXPECT_TRUE(exceeds(s, 0.999 * p.value[0]));
  EXPECT_FALSE(exceeds(s, 1.001 * p.value[0]));
}

}  // namespace joint_test
}  // namespace breccia::fdem3
