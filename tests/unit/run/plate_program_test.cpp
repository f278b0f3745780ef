// The program and a plate of triangles that is torn: what it refuses, names and writes.

#include <cmath>
#include <sstream>

#include "unit/run/program_fixture.hpp"

namespace breccia {
namespace program_test {

/// A plate that is torn, its middle row of another material.
const std::string torn_plate = R"(
method = "fdem2d"
time.end = "20 us"
output.frames = 1
output.pictures = false
energy.stop = 0.0  # supports that move at once
[material.rock]
young = "30 GPa"
joint = { tension = "3 MPa", energy_open = 1.0 }
[[body]]
name = "plate"
material = "rock"
size = ["8 mm", "8 mm"]
mesh_size = "2 mm"
structured = true
[[support]]
name = "up"
min = [-1.0, "3.9 mm"]
velocity = [0.0, 1.0]
[[support]]
name = "down"
max = [1.0, "-3.9 mm"]
velocity = [0.0, -1.0]
)";

TEST_F(Program, RefusesConstantsThatLeaveNoTimeStep) {
  replace_file(path("plate.toml"), torn_plate);
  const auto refused = [&](const std::string& set) {
    return run("run " + path("plate.toml") + " --steps 9 -o " + path("out") + " --set " + set) == 2;
  };
  EXPECT_TRUE(refused("material.rock.density=1e-300"));
  EXPECT_NE(output().find("0.001"), std::string::npos) << output();
  EXPECT_TRUE(refused("material.rock.young=1e300"));
  EXPECT_NE(output().find("outside [1000, 1e+15]"), std::string::npos) << output();
  EXPECT_TRUE(refused("material.rock.contact_stiffness=1e300"));
  EXPECT_NE(output().find("outside [1e-06, 1000000]"), std::string::npos) << output();
  EXPECT_TRUE(refused("material.rock.joint.stiffness=1e40"));
  EXPECT_NE(output().find("outside [1e-06, 1000000]"), std::string::npos) << output();
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(Program, ComputesTrianglesInSinglePrecision) {
  replace_file(path("plate.toml"), "precision = \"single\"\n" + torn_plate);
  EXPECT_EQ(run("check " + path("plate.toml")), 0) << output();
  EXPECT_EQ(run("run " + path("plate.toml") + " --steps 9 -o " + path("out")), 0) << output();
}

TEST_F(Program, RefusesToComputeTetrahedraInSinglePrecision) {
  replace_file(path("box.toml"), R"(
breccia = 1
method = "fdem3d"
precision = "single"
time = { end = "20 us", max_step = "33 ns" }
[material.rock]
density = 2500
young = "30 GPa"
poisson = 0.2
[[body]]
name = "box"
shape = "box"
material = "rock"
size = ["8 mm", "8 mm", "8 mm"]
mesh_size = "4 mm"
structured = true
)");
  EXPECT_EQ(run("check " + path("box.toml")), 2);
  EXPECT_NE(output().find("allowed here are double, mixed"), std::string::npos) << output();
  EXPECT_EQ(run("run " + path("box.toml") + " --steps 9 -o " + path("out")), 2);
}

TEST_F(Program, NamesStepTimeAndBodyWhereNumbersGoWrong) {
  replace_file(path("plate.toml"), torn_plate);
  EXPECT_EQ(run("run " + path("plate.toml") + " -o " + path("out") +
                " --set 'support.up.velocity=[0,1e5]'"),
            4);
  for (const char* part : {"step ", ", t = ", "(plate)"})
    EXPECT_NE(output().find(part), std::string::npos) << output();
  EXPECT_TRUE(fs::exists(path("out/crash.br")));
}

TEST_F(Program, NamesWhatAProbeInThePlaneCanRead) {
  replace_file(path("plate.toml"), torn_plate + "[[probe]]\nname = \"p\"\n");
  EXPECT_EQ(run("check " + path("plate.toml")), 2);
  EXPECT_NE(output().find("allowed: position_x, position_y, displacement_x"), std::string::npos)
      << output();
}

TEST_F(Program, RefusesMoreFrictionInABrokenJointThanInAWholeOne) {
  replace_file(path("plate.toml"), torn_plate);
  EXPECT_EQ(run("check " + path("plate.toml") + " --set material.rock.joint.residual_angle=0.8"),
            2);
  EXPECT_NE(output().find("residual_angle: must not be above friction_angle"), std::string::npos);
}

TEST_F(Program, RefusesGrainsThatNothingJoins) {
  std::string grains = torn_plate;
  grains.insert(grains.find("[[support]]"), R"(
[body.grains]
kind = "voronoi"
size = "2 mm"
mineral = [{ material = "rock", fraction = 0.5 }, { material = "steel", fraction = 0.5 }]
[material.steel]
joints = "none"
)");
  replace_file(path("grains.toml"), grains);
  EXPECT_EQ(run("check " + path("grains.toml")), 2);
  EXPECT_NE(output().find("nothing joins steel"), std::string::npos) << output();
  replace_file(path("joined.toml"), grains + "[joint.skin]\nbetween = [\"rock\", \"steel\"]\n");
  EXPECT_EQ(run("check " + path("joined.toml")), 0) << output();
}

/// Its cracks by the place where they were: in a plate torn apart, they lie elsewhere by now.
TEST_F(Program, TellsWhereCracksWereAtTheStart) {
  replace_file(path("plate.toml"), torn_plate);
  ASSERT_EQ(run("run " + path("plate.toml") + " -o " + path("out")), 0) << output();
  std::istringstream table(read_whole_file(path("out/cracks.csv")));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "time,x,y,length,mode,energy,x0,y0,x1,y1");
  std::getline(table, line);
  int count = 0;
  double first = 0.0;
  for (; std::getline(table, line); ++count) {
    std::istringstream row(line);
    double value[10];
    char comma = ',';
    for (double& v : value) row >> v >> comma;
    if (count == 0) first = value[0];
    for (int k = 6; k < 10; ++k) {  // vertices of five rows of triangles
      const double steps = value[k] / (k % 2 == 0 ? 1e-3 : 0.8e-3);
      EXPECT_NEAR(steps, std::round(steps), 1e-9);
    }
    EXPECT_NEAR(value[3], std::hypot(value[8] - value[6], value[9] - value[7]), 0.1e-3);
    EXPECT_LT(
        std::hypot(value[1] - 0.5 * (value[6] + value[8]), value[2] - 0.5 * (value[7] + value[9])),
        0.5e-3);
  }
  EXPECT_GT(count, 3);
  EXPECT_EQ(summary("out")["fracture"]["first_break"], first);
  EXPECT_EQ(summary("out")["fracture"]["broken_joints"], count);
}

}  // namespace program_test
}  // namespace breccia
