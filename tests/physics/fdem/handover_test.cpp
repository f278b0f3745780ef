// A joint pressed and sheared until it breaks: the contact that is born goes on with its forces.

#include <gtest/gtest.h>

#include "fdem/stepping/step.hpp"
#include "physics/fdem/scene.hpp"
#include "prepare/build_fdem.hpp"

namespace breccia::fdem {
namespace handover_test {

using testing::nodes;
using testing::rotated;
using testing::Scene;

/// Two triangles with one joint that are moved by hand: the lower one rests. The directions are
/// those of the joint's edge, turned with the scene.
struct Pair {
  static constexpr double dt = 1e-8, edge = 1e-3;
  double angle;  ///< of the scene  [rad]
  World w;
  double taken = 0.0;  ///< work that moving has put in  [J/m]
  Vec2 last{};         ///< force on the upper triangle, of joint and contact  [N/m]

  /// @param first      corner of each triangle that its list begins with
  /// @param unloading  of a joint that fails by its own tractions; null: it fails with the rock
  explicit Pair(const MaterialConfig& material, double turn = 0.0, int first = 0,
                bool upper_first = true, const char* unloading = nullptr)
      : angle(turn),
        w(make(material, turn, first, upper_first, unloading)),
        upper_(upper_first ? 0 : 1) {
    w.last_dt = w.next_dt = dt;
  }
  void move(const Vec2& along) {
    const Vec2 by = rotated(along, angle);
    for (NodeState& n : nodes(w, upper_).at) {
      n.position += by;
      n.velocity = (1.0 / dt) * by;
    }
    go_on();
    const Vec2 now = force();
    taken -= 0.5 * dot(last + now, along);
    last = now;
  }
  /// Turns the upper triangle about the left end of the joint while it slides along it, of a scene
  /// that lies as it is drawn. `taken` is left as it is.
  void tilt(double turn, double slip) {
    for (NodeState& n : nodes(w, upper_).at) {
      const Vec2 by{slip, turn * n.position.x};
      n.position += by;
      n.velocity = (1.0 / dt) * by;
    }
    go_on();
    last = force();
  }
  /// On the upper triangle, along the joint and across it.  [N/m]
  Vec2 force() const {
    const JointForce& f = w.joints.force.in_double.data()[0];
    Vec2 sum = f.first + f.second;
    if (w.couples.size() > 0)
      for (const Vec2& g : w.couples.history.force.in_double.data()[0].on_a.at) sum += g;
    return rotated(upper_ == 0 ? sum : -sum, -angle);
  }
  bool broken() const { return w.joints.stage.data()[0] == JointStage::broken; }
  /// Slides by this a step until the joint breaks.
  void break_by(double slip) {
    for (int steps = 0; !broken() && steps < 20000; ++steps) move({slip, 0.0});
    ASSERT_TRUE(broken());
  }

  const CoupleState& couple() const { return w.couples.history.state.data()[0]; }
  const JointHandover& handover() const { return w.joints.handover.data()[0]; }
  const JointWork& inherited() const { return w.joints.inherited_work.data()[0]; }

 private:
  void go_on() {
    w.time += dt;
    find_couples(w);
    w.next_dt = dt;
    HostRun{}.pair_forces(w);
  }
  static World make(const MaterialConfig& material, double turn, int first, bool upper_first,
                    const char* unloading) {
    Scene scene;
    if (unloading != nullptr) {
      scene.config.joints.unloading = unloading;
      scene.config.joints.criterion = "edge";
    }
    scene.config.materials.push_back(material);
    prepare::Mesh mesh;
    mesh.point = {{0.0, 0.0}, {edge, 0.0}, {0.5 * edge, 0.8 * edge}, {0.5 * edge, -0.8 * edge}};
    for (Vec2& x : mesh.point) x = rotated(x, turn);
    prepare::Triangle upper{0, 1, 2}, lower{0, 3, 1};
    std::rotate(upper.begin(), upper.begin() + first, upper.end());
    std::rotate(lower.begin(), lower.begin() + (2 * first) % 3, lower.end());
    mesh.triangle = {upper_first ? upper : lower, upper_first ? lower : upper};
    scene.body("pair", mesh);
    return scene.world();
  }
  int upper_;
};

MaterialConfig rock(double friction, double residual) {
  MaterialConfig m;
  m.name = "rock";
  m.young = 30e9;
  m.poisson = 0.2;
  m.density = 2500.0;
  m.joints = "intrinsic";
  m.joint.tension = 3e6;
  m.joint.cohesion = 30e6;
  m.joint.energy_open = 5.0;
  m.joint.energy_slide = 50.0;
  m.joint.friction_angle = m.joint.residual_angle = std::atan(residual);
  m.friction = friction;
  return m;
}

/// When the faces meet again later, they meet as any others do.
TEST(Handover, pressure_goes_on_in_the_contact) {
  for (const double penalty : {5.0, 20.0, 50.0}) {
    MaterialConfig m = rock(0.0, 0.0);
    m.joint.stiffness = penalty;
    Pair pair(m);
    for (int i = 0; i < 20; ++i) pair.move({0.0, -1e-9});
    const double pressed = pair.force().y;
    EXPECT_NEAR(pressed, penalty * 30e9 * 2e-8, 1e-6 * pressed);
    pair.break_by(5e-9);
    EXPECT_NEAR(pair.force().y, pressed, 1e-6 * pressed);
    for (int i = 0; i < 3; ++i) {
      pair.move({5e-9, 0.0});
      ASSERT_EQ(pair.w.couples.size(), 1);
      EXPECT_EQ(norm(pair.w.joints.force.in_double.data()[0].first), 0.0);
      EXPECT_NEAR(pair.force().y, pressed, 0.01 * pressed) << penalty;
    }
    EXPECT_NE(pair.w.couples.history.state.data()[0].scale, 1.0);
    pair.move({0.0, 2e-3});
    find_couples(pair.w);
    EXPECT_EQ(pair.w.couples.size(), 0);
    pair.move({0.0, -2e-3});
    ASSERT_EQ(pair.w.couples.size(), 1);
    EXPECT_EQ(pair.w.couples.history.state.data()[0].scale, 1.0);
  }
}

/// A joint whose residual friction is that of its faces: nothing changes when it breaks while it
/// slides on. The faces' own friction carries all but what lies at the two ends of the edge, a
/// share of the overlap over the edge.
TEST(Handover, shear_goes_on_in_the_friction_of_the_faces) {
  constexpr double mu = 0.6, slip = 5e-9, depth = 2e-8;
  for (const double sign : {1.0, -1.0})
    for (const double angle : {0.0, 0.7, 2.5, -1.9})
      for (const int first : {0, 1, 2})
        for (const bool upper_first : {true, false}) {
          Pair pair(rock(mu, mu), angle, first, upper_first);
          for (int i = 0; i < 20; ++i) pair.move({0.0, -depth / 20});
          pair.break_by(sign * slip);
          const Vec2 before = pair.force();
          EXPECT_NEAR(before.x, -sign * mu * before.y, 1e-3 * before.y);
          for (int i = 0; i < 3; ++i) {
            pair.move({sign * slip, 0.0});
            EXPECT_EQ(norm(pair.w.joints.force.in_double.data()[0].first), 0.0);
            EXPECT_NEAR(pair.force().x, before.x, 1e-3 * std::abs(before.x))
                << sign << ' ' << angle << ' ' << first << ' ' << upper_first;
          }
        }
}

/// An edge that slides back unloads springs that are as stiff as the joint was, at which they hold
/// what it held, and not as soft as those of other faces, p_t each.
TEST(Handover, shear_unloads_with_the_stiffness_of_the_joint) {
  constexpr double mu = 0.6, slip = 5e-9, young = 30e9;
  Pair pair(rock(mu, mu));
  for (int i = 0; i < 20; ++i) pair.move({0.0, -1e-9});
  pair.break_by(slip);
  const double before = pair.force().x, held = pair.handover().held.slide;
  const double stiffness = before * before / (2.0 * held);
  EXPECT_GT(stiffness, 10.0 * young);  // p_f 20 E, two springs 2 E
  EXPECT_LT(stiffness, 20.5 * young);
  constexpr double back = 1e-9;
  double gone = 0.0;
  for (int i = 1; i <= 5; ++i) {
    pair.move({-back, 0.0});
    gone += back;
    EXPECT_NEAR(pair.force().x, before + stiffness * gone, 0.01 * stiffness * gone);
  }
}

/// More than the friction of the faces bears is not handed over, nor is friction without any.
TEST(Handover, shear_is_cut_at_the_friction_of_the_faces) {
  for (const double mu : {0.0, 0.2}) {
    Pair pair(rock(mu, 0.6));
    for (int i = 0; i < 20; ++i) pair.move({0.0, -1e-9});
    pair.break_by(5e-9);
    const Vec2 before = pair.force();
    EXPECT_NEAR(before.x, -0.6 * before.y, 1e-3 * before.y);
    pair.move({5e-9, 0.0});
    EXPECT_NEAR(pair.force().x, -mu * before.y, 1e-3 * before.y);
  }
}

/// Energy of the contact when it begins is the part of the joint's work that is not spent, and no
/// more than the joint held: its springs of friction are ten times as stiff as those of the faces.
/// It gives just that back when the faces part, and every joule that moving took is fracture or
/// friction.
TEST(Handover, energy_goes_on_too) {
  constexpr double slip = 1e-9, depth = 2e-8, young = 30e9, p_f = 20.0 * young;
  // friction of the faces, and of the joint as it breaks: the last brings more than its faces bear
  for (const auto& [mu, of_joint] :
       {std::pair{0.6, 0.0}, std::pair{0.6, 0.6}, std::pair{0.2, 0.6}}) {
    Pair pair(rock(mu, of_joint));
    for (int i = 0; i < 20; ++i) pair.move({0.0, -depth / 20});
    pair.break_by(slip);
    const double at_break = pair.taken, drag = pair.force().x;
    pair.move({1e-13, 0.0});  // so little that nothing but the handover happens
    const EnergyBalance born = energies(pair.w).balance;
    // that of linear springs: p_f across; along, p_t = E at each of both edges, or the joint's p_f
    const Vec2 force = pair.force();
    const double spring = force.x * force.x / (4.0 * young), joint = drag * drag / (2.0 * p_f);
    const double held = 0.5 * force.y * depth + std::min(spring, joint);
    EXPECT_NEAR(born.elastic, held, 0.01 * held);
    EXPECT_EQ(born.contact, 0.0);
    // all that is spent is spent on sliding; pressing is stored, before and after
    EXPECT_NEAR(cracks(pair.w)[0].mode, 1.0, 1e-3);
    // the trapezoidal rule by which the test sums work, on the elastic parabola of the joint
    const double off = slip * slip * p_f / 12.0;
    EXPECT_NEAR(born.elastic + born.fracture + born.friction, at_break, 2.0 * off);

    constexpr int parts = 1000;
    for (int i = 0; i < 2 * parts; ++i) pair.move({0.0, depth / parts});
    const EnergyBalance b = energies(pair.w).balance;
    EXPECT_EQ(b.elastic, 0.0);
    EXPECT_NEAR(b.fracture, born.fracture, 1e-9 * born.fracture);
    EXPECT_NEAR(b.fracture + b.friction + b.contact, pair.taken, 2.0 * off);
    EXPECT_LT(std::abs(b.contact), 0.01 * held);
  }
}

/// A joint that has opened at one end while the other is pressed and bears shear: a twentieth of
/// the edge is inside, and springs as soft as that would hold many times what the joint held. Its
/// crack would have an energy below 0.
TEST(Handover, a_tilted_joint_hands_over_what_it_held) {
  for (const double sign : {1.0, -1.0}) {
    Pair pair(rock(0.6, 0.0));
    for (int i = 0; i < 50; ++i) pair.move({0.0, -4e-9});
    for (int i = 0; !pair.broken() && i < 20000; ++i) pair.tilt(2e-6, sign * 1e-10);
    ASSERT_TRUE(pair.broken());
    const JointWork held = pair.handover().held;
    const double pressing = pair.handover().pressing, work = energies(pair.w).balance.fracture;
    ASSERT_GT(pressing, 0.0);
    ASSERT_GT(held.open, 0.0);
    pair.tilt(1e-12, 0.0);
    ASSERT_EQ(pair.w.couples.size(), 1);
    const double left = nodes(pair.w, 0).at[0].position.y,
                 right = nodes(pair.w, 0).at[1].position.y;
    const double inside = left / (left - right);                                 // of both edges
    EXPECT_NEAR(held.open, 20.0 * 30e9 * left * left / 12.0, 0.05 * held.open);  // of one end
    EXPECT_LT(inside, 0.06);
    double springs = 0.0;
    const double k = pair.couple().stiffness;
    for (const double drag : pair.couple().drag) springs += 0.5 * drag * drag / k;
    EXPECT_LE(springs, (1.0 + 1e-12) * held.slide);
    EXPECT_LE(pair.inherited().open, held.open);
    EXPECT_LE(pair.inherited().slide, held.slide);
    EXPECT_NEAR(pair.couple().sprung, springs, 1e-6 * springs);
    EXPECT_NEAR(pair.couple().sprung, pair.inherited().slide, 1e-6 * springs);
    const EnergyBalance born = energies(pair.w).balance;
    EXPECT_GE(born.fracture, (1.0 - 1e-3) * (work - held.open - held.slide));
    EXPECT_GT(cracks(pair.w)[0].energy, 0.0);
    EXPECT_GE(born.friction, 0.0);
  }
}

/// A disc of granite split between plates of steel, 1,100 triangles, where cracks begin to press
/// and slide as it falls apart; joints from the start, and joints that wake.
TEST(Handover, no_crack_of_a_split_disc_gives_energy) {
  const auto split = [](const char* joints) {
    Scene scene;
    MaterialConfig granite = rock(std::tan(pi / 6.0), 0.0);
    granite.joints = joints;
    granite.young = 60e9;
    granite.poisson = 0.25;
    granite.density = 2630.0;
    granite.damping = 0.5;
    granite.joint.tension = 8e6;
    granite.joint.cohesion = 33e6;
    granite.joint.friction_angle = 52.0 / 180.0 * pi;
    granite.joint.energy_open = 30.0;
    granite.joint.energy_slide = 140.0;
    MaterialConfig steel = granite;
    steel.name = "steel";
    steel.young = 200e9;
    steel.density = 7850.0;
    steel.joints = "none";
    steel.damping = 0.0;
    steel.friction = 0.1;
    scene.config.materials = {granite, steel};
    BodyConfig disc;
    disc.name = "disc";
    disc.shape = "disc";
    disc.material = "rock";
    disc.radius = 40e-3;
    disc.mesh_size = 5e-3;
    disc.structured = true;
    BodyConfig plate = disc;
    plate.name = "top";
    plate.shape = "plate";
    plate.material = "steel";
    plate.center = {0.0, 42e-3};
    plate.size = {24e-3, 4e-3};
    plate.mesh_size = 2e-3;
    scene.config.bodies = {disc, plate};
    plate.name = "bottom";
    plate.center = {0.0, -42e-3};
    scene.config.bodies.push_back(plate);
    for (const double side : {1.0, -1.0}) {
      const char* const name = side > 0.0 ? "top" : "bottom";
      scene
          .support(name, {-testing::far, -testing::far}, {testing::far, testing::far}, {"x", "y"},
                   {0.0, -0.5 * side}, name)
          .history.ramp = 10e-6;
    }
    scene.model = build_fdem_model(scene.config.bodies, {}, {{"rock", "steel"}, {}}, 1, "");
    return scene.world();
  };
  for (const char* const joints : {"intrinsic", "extrinsic"}) {
    World w = split(joints);
    double fracture = 0.0, fell = 0.0, friction = 0.0;
    for (int i = 0; w.time < 0.2e-3; ++i) {
      step(w);
      if (i % 40 != 0) continue;
      const EnergyBalance now = energies(w).balance;
      fell += std::max(0.0, fracture - now.fracture);
      fracture = now.fracture;
      EXPECT_GE(now.friction, friction - 1e-12 * now.work)
          << "springs give what they were not given";
      friction = now.friction;
    }
    const std::vector<Crack> all = cracks(w);
    double handed = 0.0, least = 0.0;
    for (const Crack& crack : all) least = std::min(least, crack.energy);
    for (const JointWork& h : w.joints.inherited_work.host()) handed += h.open + h.slide;
    const EnergyBalance b = energies(w).balance;
    std::printf("%s: %zu cracks, fracture %.3g J/m, fell by %.2g; handed %.2g, contact %.2g\n",
                joints, all.size(), b.fracture, fell, handed, b.contact);
    EXPECT_GT(all.size(), 20U);
    EXPECT_GT(handed, 0.0);
    EXPECT_GE(least, 0.0);
    EXPECT_LT(fell, 0.01 * fracture);
    EXPECT_LT(b.error_relative, 0.005);
    EXPECT_LT(std::abs(b.contact), 1e-3 * b.work);
  }
}

/// Pressed by sigma, slid until it breaks and on: softening takes G_II besides the elastic branch,
/// 2/3 f_s s_p, an area, whatever presses; all else is friction, sigma tan phi_r (1 - z) on the way
/// through softening, whose mean is 1 - 1/k, and sigma tan phi_r once it is over.
TEST(Handover, a_joint_that_rubs_spends_its_own_energy_on_fracture_and_the_rest_on_friction) {
  constexpr double residual = 0.4, depth = 2e-8, slip = 1e-9, young = 30e9;
  constexpr double sigma = 20.0 * young * depth / Pair::edge;
  MaterialConfig m = rock(residual, residual);
  m.joint.friction_angle = std::atan(0.7);
  for (const char* const unloading : {"secant", "reversible"})
    for (const double sign : {1.0, -1.0}) {
      Pair pair(m, 0.0, 0, true, unloading);
      for (int i = 0; i < 20; ++i) pair.move({0.0, -depth / 20});
      const double strength = 30e6 + 0.7 * sigma;  // f_s
      const double elastic = 2.0 * Pair::edge * strength / (20.0 * young);
      const double process = exact_softening_factor * 50.0 / strength;  // s_t
      double slid = 0.0;
      const auto slide_to = [&](double end) {
        for (; slid < end && !pair.broken(); slid += slip) pair.move({sign * slip, 0.0});
      };
      // Half way through: D = 1/2, and what friction has taken but holds still is not spent.
      slide_to(elastic + 0.5 * process);
      double soft = 0.0;  // integral of z over D
      for (int i = 0; i < 1000; ++i) soft += softening((i + 0.5) / 2000.0) / 2000.0;
      const double z = softening(0.5), rub = residual * sigma;
      double taken = rub * process * (0.5 - soft), held = (1.0 - z) * rub * 0.5 * slid;
      if (std::string(unloading) == "reversible") held = (1.0 - z) * rub * 2.0 / 3.0 * elastic;
      EnergySplit now = energies(pair.w);
      EXPECT_NEAR(now.balance.friction, Pair::edge * (taken - held), 2e-3 * Pair::edge * taken)
          << unloading;
      slide_to(2.0 * (elastic + process));
      ASSERT_TRUE(pair.broken());
      const double at_break = slid;
      for (; slid < at_break + 200.0 * slip; slid += slip) pair.move({sign * slip, 0.0});
      now = energies(pair.w);
      const double fracture = Pair::edge * (2.0 / 3.0 * strength * elastic + 50.0);
      EXPECT_NEAR(now.fracture_slide, fracture, 2e-3 * fracture) << unloading;
      EXPECT_NEAR(now.fracture_open, 0.0, 1e-6 * fracture);
      // Springs of the faces hold the rest.
      taken = rub * Pair::edge * (slid - elastic - process / exact_softening_factor);
      EXPECT_NEAR(now.balance.friction + pair.couple().sprung, taken, 5e-3 * taken) << unloading;
      EXPECT_NEAR(cracks(pair.w)[0].energy, fracture, 2e-3 * fracture);
      EXPECT_NEAR(
          now.balance.fracture + now.balance.friction + now.balance.elastic + now.balance.contact,
          pair.taken, 1e-3 * pair.taken);
    }
}

/// Pressed as hard as rock fails, with joints as soft as the classical codes': the springs of the
/// contact, p_t = E in two faces, hold tau^2 h / (4 E), the joint took tau^2 h (4/3) / (5 E) on its
/// elastic branch alone. What is left is its fracture energy at least.
TEST(Handover, gives_the_contact_no_more_than_the_joint_took) {
  MaterialConfig m = rock(0.6, 0.6);
  m.joint.stiffness = 5.0;
  Pair pair(m);
  for (int i = 0; i < 100; ++i) pair.move({0.0, -6e-9});  // 90 MPa
  pair.break_by(2e-8);
  pair.move({2e-8, 0.0});
  EXPECT_NEAR(pair.force().x, -0.6 * pair.force().y, 1e-2 * pair.force().y);
  EXPECT_GT(energy_split(pair.w).fracture_slide, m.joint.energy_slide * Pair::edge);
  EXPECT_GT(cracks(pair.w)[0].energy, m.joint.energy_slide * Pair::edge);
}

/// A block sheared off under pressure, its joints as rough as their faces.
TEST(Handover, keeps_the_ledger_and_the_bits) {
  Scene scene;
  scene.config.materials.push_back(rock(std::tan(pi / 6.0), std::tan(pi / 6.0)));
  scene.config.materials[0].joint.tension = 20e6;
  scene.config.materials[0].joint.cohesion = 15e6;
  scene.config.materials[0].damping = 0.5;
  scene.config.time.evaluate_every = 100;
  scene.body("block", prepare::equilateral_rectangle({{0.0, 0.0}, {8e-3, 8e-3}}, 1e-3));
  scene.support("top", {-testing::far, 4e-3 - 1e-9}, {testing::far, testing::far}, {"y"},
                {0.0, -0.2});
  scene.support("bottom", {-testing::far, -testing::far}, {testing::far, -4e-3 + 1e-9}, {"y"},
                {0.0, 0.2});
  scene.config.supports[0].history.ramp = scene.config.supports[1].history.ramp = 20e-6;
  std::uint64_t reference = 0;
  for (const int threads : {1, 2, 3, 7}) {
    World w = scene.world(threads);
    testing::run_to(w, 9e-5);
    if (threads == 1) {
      reference = state_hash(w);
      double handed = 0.0;
      for (const JointWork& h : w.joints.inherited_work.host()) handed += h.slide;
      EXPECT_GT(handed, 0.0);
      EXPECT_LT(energies(w).balance.error_relative, 1e-3);
    }
    EXPECT_EQ(state_hash(w), reference) << threads;
  }
}

}  // namespace handover_test
}  // namespace breccia::fdem
