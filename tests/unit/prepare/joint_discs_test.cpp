// Sets of joints in space: what was asked for is what is drawn, discs keep clear of each other,
// files are read or refused, and a mesh follows them.

#include "prepare/tetrahedra/joint_discs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/build_fdem3.hpp"
#include "prepare/meshing/length_law.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::prepare {
namespace joint_discs_test {

fdem3::JointSetConfig random_set() {
  fdem3::JointSetConfig set;
  set.name = "set";
  set.min = {-10.0, -5.0, 0.0};
  set.max = {10.0, 5.0, 8.0};
  set.intensity = 1.5;
  set.normal = {1.0, 2.0, 2.0};
  set.concentration = 20.0;
  set.radius = 0.6;
  set.clear = 0.0;
  return set;
}
std::vector<fdem3::DiscontinuityConfig> drawn(const fdem3::JointSetConfig& set, double clear = 0.0,
                                              std::int64_t seed = 7) {
  CrackNetwork network(clear);
  return polygons_of_set(set, seed, 0, "", network);
}

/// kappa by R/n = coth kappa - 1/kappa, R the length of the sum of n normals.
double kappa_of(double mean_length) {
  double low = 1e-3, high = 1e4;
  for (int k = 0; k < 100; ++k) {
    const double kappa = std::sqrt(low * high);
    (1.0 / std::tanh(kappa) - 1.0 / kappa < mean_length ? low : high) = kappa;
  }
  return low;
}

TEST(JointDiscs, have_the_intensity_and_the_directions_that_were_asked_for) {
  for (const char* law : {"constant", "exponential", "lognormal", "power"})
    for (const double kappa : {5.0, 80.0}) {
      SCOPED_TRACE(::testing::Message() << law << " " << kappa);
      fdem3::JointSetConfig set = random_set();
      set.concentration = kappa;
      set.radius_law = law;
      set.radius_deviation = 0.2;
      if (set.radius_law == "power") {
        set.radius_exponent = 4.0;
        set.least = 0.4;
        set.most = 1.2;
      }
      Vec3 sum{};
      double area = 0.0;
      const auto all = drawn(set);
      for (const auto& d : all) {
        const Vec3 a = area_vector(d.points);
        area += norm(a);
        sum += (1.0 / norm(a)) * a;
        for (const Vec3& x : d.points)
          EXPECT_TRUE(std::abs(x.x) < 10.0 + 1e-9 && std::abs(x.y) < 5.0 + 1e-9 && x.z > -1e-9 &&
                      x.z < 8.0 + 1e-9);
      }
      EXPECT_NEAR(area, 1.5 * 1600.0, 1e-6);
      const double n = static_cast<double>(all.size()), mean_length = norm(sum) / n;
      // of the mean direction: variance of each of two angles 1/(n kappa R/n) (Fisher 1953)
      const Vec3 axis = (1.0 / 3.0) * Vec3{1.0, 2.0, 2.0};
      const double off = norm(cross(axis, (1.0 / norm(sum)) * sum));
      EXPECT_LT(off, 3.5 / std::sqrt(n * kappa * mean_length));
      EXPECT_NEAR(kappa_of(mean_length), kappa, 4.0 * kappa / std::sqrt(n));
    }
}

/// Means of 20,000 draws, within four deviations of such means.
TEST(LengthLaw, has_the_means_that_were_asked_for) {
  // r^-4 between 0.4 and 1.2: mean 3/2 (1/0.16 - 1/1.44)/(1/0.064 - 1/1.728), mean square
  // 3 (1/0.4 - 1/1.2)/(1/0.064 - 1/1.728)
  const double cubes = 1.0 / 0.064 - 1.0 / 1.728, power = 1.5 * (1.0 / 0.16 - 1.0 / 1.44) / cubes,
               squares = 3.0 * (1.0 / 0.4 - 1.0 / 1.2) / cubes;
  const struct {
    const char* law;
    double least, most, mean, deviation;
  } all[] = {{"constant", 0.0, 0.0, 0.6, 1e-9},
             {"exponential", 0.0, 0.0, 0.6, 0.6},
             {"lognormal", 0.0, 0.0, 0.6, 0.2},
             {"power", 0.4, 1.2, power, std::sqrt(squares - power * power)}};
  for (const auto& [name, least, most, mean, deviation] : all) {
    const LengthLaw law{name, 0.6, 0.2, 4.0, least, most};
    constexpr int n = 20000;
    double sum = 0.0;
    for (std::uint64_t item = 0; item < n; ++item) sum += law.drawn({3, 7}, item);
    EXPECT_NEAR(sum / n, mean, 4.0 * deviation / std::sqrt(n)) << name;
  }
}

TEST(JointDiscs, of_no_concentration_have_every_direction_and_of_an_infinite_one_that_of_the_set) {
  fdem3::JointSetConfig set = random_set();
  set.concentration = 0.0;
  Vec3 squares{};
  const auto all = drawn(set);
  for (const auto& d : all) {
    const Vec3 a = area_vector(d.points), n = (1.0 / norm(a)) * a;
    squares += Vec3{n.x * n.x, n.y * n.y, n.z * n.z};
  }
  const double n = static_cast<double>(all.size());
  for (const double part : {squares.x, squares.y, squares.z})
    EXPECT_NEAR(part / n, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / n));
  set.concentration = no_limit;
  for (const auto& d : drawn(set)) {
    const Vec3 a = area_vector(d.points);
    EXPECT_LT(norm(cross(a, Vec3{1.0, 2.0, 2.0})), 1e-9 * norm(a));
  }
}

/// P30 of discs whose middle lies in the box, and as many from another seed, elsewhere.
TEST(JointDiscs, are_as_many_as_asked_for) {
  fdem3::JointSetConfig set = random_set();
  set.intensity = 0.0;
  set.number = 200.0;
  set.sides = 12;
  const auto all = drawn(set), others = drawn(set, 0.0, 8);
  // those from outside of the box are in it as well
  EXPECT_GT(all.size(), 200U);
  EXPECT_LT(all.size(), 320U);
  EXPECT_NE(all[0].points[0].x, others[0].points[0].x);
  EXPECT_EQ(drawn(set)[5].points[2].y, all[5].points[2].y);
}

double apart(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double t = std::min(1.0, std::max(0.0, dot(point - from, way) / dot(way, way)));
  return norm(point - from - t * way);
}

/// Points of each disc's rim and of lines across it, against the corners of all others.
TEST(JointDiscs, keep_clear_of_each_other) {
  fdem3::JointSetConfig set = random_set();
  set.concentration = 3.0;
  set.intensity = 0.6;
  constexpr double clear = 0.15;
  const auto near_pairs = [&](double kept) {
    const auto all = drawn(set, kept);
    double area = 0.0;
    int near = 0;
    for (const auto& d : all) area += norm(area_vector(d.points));
    EXPECT_NEAR(area, 0.6 * 1600.0, 1e-6);
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = 0; j < all.size(); ++j) {
        if (i == j) continue;
        const auto &p = all[i].points, &q = all[j].points;
        double least = 1.0;
        for (const Vec3& x : p)
          for (std::size_t k = 0; k < q.size(); ++k)
            least = std::min(least, apart(x, q[k], q[(k + 1) % q.size()]));
        if (least < 0.999 * clear) ++near;
      }
    return near;
  };
  EXPECT_GT(near_pairs(0.0), 20);
  EXPECT_EQ(near_pairs(clear), 0);
}

TEST(CrackNetwork, refuses_what_would_leave_slivers) {
  const Corners3 floor{{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}, {-1.0, 1.0, 0.0}};
  CrackNetwork network(0.1);
  network.add_crack(floor);
  const auto moved = [](Corners3 corners, const Vec3& by) {
    for (Vec3& x : corners) x += by;
    return corners;
  };
  EXPECT_TRUE(network.fits(moved(floor, {0.0, 0.0, 0.11})));
  EXPECT_FALSE(network.fits(moved(floor, {0.0, 0.0, 0.09})));
  EXPECT_TRUE(network.fits(moved(floor, {2.11, 0.0, 0.0})));
  EXPECT_FALSE(network.fits(moved(floor, {2.09, 0.0, 0.0})));
  const Corners3 wall{{0.0, -0.5, -0.5}, {0.0, 0.5, -0.5}, {0.0, 0.5, 0.5}, {0.0, -0.5, 0.5}};
  EXPECT_TRUE(network.fits(wall));
  EXPECT_FALSE(network.fits(moved(wall, {0.0, 0.0, 0.45}))) << "it hardly passes through";
  EXPECT_TRUE(network.fits(moved(wall, {0.0, 0.0, 0.65})));
  EXPECT_FALSE(network.fits(moved(wall, {0.95, 0.0, 0.0}))) << "beside the rim";
  EXPECT_FALSE(network.fits(moved(wall, {1.05, 0.0, 0.0}))) << "outside of the rim";
  EXPECT_TRUE(network.fits(moved(wall, {1.11, 0.0, 0.0})));
  const Corners3 strip{{0.0, -0.04, -0.5}, {0.0, 0.04, -0.5}, {0.0, 0.04, 0.5}, {0.0, -0.04, 0.5}};
  EXPECT_FALSE(network.fits(strip)) << "it is narrower than that";
  EXPECT_FALSE(network.fits(moved(wall, {0.0, 0.45, 0.0}))) << "it ends beside the rim";
  EXPECT_FALSE(network.fits(moved(wall, {0.0, 1.45, 0.0}))) << "it meets a corner's width";
  EXPECT_TRUE(network.fits(moved(wall, {0.0, 0.8, 0.0})));
  const Corners3 slope{
      {-0.5, -0.5, -0.15}, {0.5, -0.5, 0.15}, {0.5, 0.5, 0.15}, {-0.5, 0.5, -0.15}};
  EXPECT_FALSE(network.fits(slope)) << "17 degrees";
  network.add_crack(wall);
  EXPECT_FALSE(network.fits(moved(wall, {0.05, 0.0, 0.0})));
  const Corners3 third{
      {-0.7, -0.3, 0.3}, {-0.05, -0.3, 0.3}, {-0.05, -0.3, -0.3}, {-0.7, -0.3, -0.3}};
  EXPECT_FALSE(network.fits(third)) << "its line in the floor ends beside that of the wall";
  EXPECT_TRUE(network.fits(moved(third, {-0.2, 0.0, 0.0})));
  // Across both, its side leaves the floor and the wall at some distance from each other.
  const auto aslant = [](double steepness, double up_the_wall) {
    const auto x = [&](double z) { return (z - up_the_wall) / steepness; };
    return Corners3{
        {x(-0.3), -0.3, -0.3}, {x(0.75), -0.3, 0.75}, {-2.0, -0.3, 0.75}, {-2.0, -0.3, -0.3}};
  };
  EXPECT_FALSE(network.fits(aslant(3.0, 0.15)))
      << "its line in the floor ends beside that in which floor and wall meet";
  EXPECT_FALSE(network.fits(aslant(0.25, 0.05))) << "and here that in the wall";
  EXPECT_TRUE(network.fits(aslant(1.0, 0.2)));
}

TEST(CrackNetwork, refuses_the_same_whichever_comes_first) {
  const Corners3 floor{{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}, {-1.0, 1.0, 0.0}};
  const auto fits_after = [](const Corners3& first, const Corners3& second) {
    CrackNetwork network(0.1);
    network.add_crack(first);
    return network.fits(second);
  };
  for (const double end : {0.8, 0.95})
    for (const double low : {-0.5, -0.05, 0.15}) {
      const Corners3 wall{{0.0, -0.5, low}, {0.0, end, low}, {0.0, end, 0.5}, {0.0, -0.5, 0.5}};
      const bool fits = low > 0.1 || (end < 0.9 && low < -0.1);
      EXPECT_EQ(fits_after(floor, wall), fits) << end << " " << low;
      EXPECT_EQ(fits_after(wall, floor), fits) << end << " " << low;
    }
}

/// Floor and ramp meet at 30 degrees; a side of the third leaves them where they are too near.
TEST(CrackNetwork, refuses_lines_of_one_crack_that_end_beside_each_other) {
  const Corners3 floor{{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}, {-1.0, 1.0, 0.0}};
  const double rise = 0.6 * std::tan(pi / 6.0);
  const Corners3 ramp{{-0.6, -0.8, -rise}, {0.6, -0.8, rise}, {0.6, 0.8, rise}, {-0.6, 0.8, -rise}};
  CrackNetwork network(0.1);
  network.add_crack(floor);
  EXPECT_TRUE(network.fits(ramp));
  network.add_crack(ramp);
  const auto from = [](double x) {
    return Corners3{{x, 0.1, -0.5}, {0.8, 0.1, -0.5}, {0.8, 0.1, 0.5}, {x, 0.1, 0.5}};
  };
  EXPECT_FALSE(network.fits(from(0.15)));
  EXPECT_TRUE(network.fits(from(0.25)));
}

TEST(CrackNetwork, takes_a_crack_that_ends_in_faces_and_in_the_edge_between_them) {
  CrackNetwork network(0.1);
  network.add_face({{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}, {-1.0, 1.0, 0.0}});
  network.add_face({{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, -1.0, 1.0}, {-1.0, -1.0, 1.0}});
  EXPECT_TRUE(network.fits({{0.0, -1.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.5, 0.5}, {0.0, -1.0, 0.5}}));
  EXPECT_FALSE(
      network.fits({{0.0, -1.0, 0.05}, {0.0, 0.5, 0.05}, {0.0, 0.5, 0.5}, {0.0, -1.0, 0.5}}));
}

TEST(JointDiscs, come_from_files_or_are_refused_by_line) {
  const ScratchFolder scratch;
  const auto read = [&](const char* name, const char* text) {
    std::ofstream(scratch / name) << text;
    fdem3::JointSetConfig set;
    set.name = "set";
    set.file = name;
    CrackNetwork network(0.0);
    return polygons_of_set(set, 1, 0, scratch / "", network);
  };
  const auto polygons =
      read("a.wkt",
           "# joints\nPOLYGON Z ((0 0 1, 1 0 1, 1 1 1, 0 0 1));\nMULTIPOLYGON Z (((0 0 0, 0 1 0, 0 "
           "1 2, 0 0 0)), ((1 0 0, 1 1 0, 1 1 2)))\nPOLYGON ((0 0, 1 0, 0 1, 0 0))");
  ASSERT_EQ(polygons.size(), 4U);
  EXPECT_EQ(polygons[0].points.size(), 3U);
  EXPECT_EQ(polygons[0].points[1].z, 1.0);
  EXPECT_EQ(polygons[1].points[2].z, 2.0);
  EXPECT_EQ(polygons[3].points[2].y, 1.0);
  const auto discs = read("a.csv", "x,y,z,nx,ny,nz,radius\n1,2,3,0,0,2,0.5\n");
  ASSERT_EQ(discs.size(), 1U);
  EXPECT_NEAR(norm(area_vector(discs[0].points)), pi * 0.25, 1e-12);
  EXPECT_NEAR(discs[0].points[3].z, 3.0, 1e-12);
  const auto refused = [&](const char* name, const char* text, const char* part) {
    try {
      read(name, text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused("b.wkt", "POLYGON Z ((0 0 0, 1 0 0, 1 1 0))\nLINESTRING (0 0, 1 1)", "b.wkt, line 2");
  refused("b.wkt", "POLYGON Z ((0 0 0, 1 0 0, 1 1 0), (0 0 0, 1 0 0, 0 1 0))", "a hole");
  refused("b.wkt", "POLYGON Z ((0 0 0, 1 0 0, 1 1 0, 0 1 0.1))", "polygon 1 is not flat");
  refused("b.wkt", "POLYGON EMPTY", "it has no polygon");
  refused("b.csv", "0,0,0,0,0,1,0.5\n0,0,0,0,0,0,0.5\n", "line 2");
}

TEST(JointDiscs, of_wrong_keys_are_a_problem) {
  const auto problem = [](const auto& change) {
    fdem3::JointSetConfig set = random_set();
    change(set);
    const std::vector<std::string> all = joint_set_problems(set, {"weak"});
    return all.empty() ? std::string() : all.front();
  };
  EXPECT_EQ(problem([](auto&) {}), "");
  EXPECT_EQ(
      problem([](auto& s) { s.kind = "cohesive", s.material = "week"; }),
      "joint_set.set.material = \"week\" is not a joint law; there are: weak; did you mean weak?");
  EXPECT_EQ(problem([](auto& s) { s.max = s.min; }),
            "joint_set.set: random discs need the box that they fill, min and max");
  EXPECT_EQ(problem([](auto& s) { s.number = 3.0; }),
            "joint_set.set.number: give it or an intensity, one of them");
  EXPECT_EQ(problem([](auto& s) { s.intensity = 0.0; }),
            "joint_set.set.intensity or number must be above 0, or file must name one");
  EXPECT_EQ(problem([](auto& s) { s.radius = 0.0; }), "joint_set.set.radius must be above 0");
  EXPECT_EQ(problem([](auto& s) { s.radius_law = "power"; }),
            "joint_set.set.radius_law: a power law needs 0 < least < most");
  EXPECT_EQ(problem([](auto& s) { s.normal = {}; }), "joint_set.set.normal has no length");
  EXPECT_EQ(problem([](auto& s) { s.file = "a.stl"; }),
            "joint_set.set.file = \"a.stl\" is neither a .csv nor a .wkt file");
  fdem3::JointSetConfig crowded = random_set();
  crowded.intensity = 30.0;
  EXPECT_THROW(drawn(crowded, 0.3), InputError);
}

/// Faces of a mesh that gmsh makes lie on the discs, as much of them as was asked for.
TEST(JointDiscs, are_followed_by_a_mesh) {
  fdem3::Config config;
  config.seed = 3;
  config.materials.emplace_back();
  config.materials.back().name = "rock";
  config.joint_laws.emplace_back();
  config.joint_laws.back().name = "weak";
  fdem3::BodyConfig body;
  body.name = "block";
  body.material = "rock";
  body.size = {1.0, 1.0, 1.0};
  body.mesh_size = 0.2;
  config.bodies = {body};
  fdem3::JointSetConfig set = random_set();
  set.min = {-0.5, -0.5, -0.5};
  set.max = {0.5, 0.5, 0.5};
  set.intensity = 2.0;
  set.radius = 0.35;
  set.clear = -1.0;
  set.kind = "cohesive";
  set.material = "weak";
  config.joint_sets = {set};
  const fdem3::Model model = build_model(config, "");
  double area = 0.0;
  for (const auto& d : model.discontinuities) {
    const Vec3 a = model.point[static_cast<std::size_t>(d.face[0])];
    area += 0.5 * norm(cross(model.point[static_cast<std::size_t>(d.face[1])] - a,
                             model.point[static_cast<std::size_t>(d.face[2])] - a));
  }
  EXPECT_NEAR(area, 2.0, 1e-6);
  config.joint_sets[0].min = {0.2, 0.2, 3.0};
  config.joint_sets[0].max = {0.4, 0.4, 4.0};
  config.joint_sets[0].radius = 0.1;
  EXPECT_THROW(build_model(config, ""), InputError);
}

}  // namespace joint_discs_test
}  // namespace breccia::prepare
