// One list of rules for the bodies of a case: `check`, `run` and `prepare` refuse alike.

#include "prepare/checks/check_case.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "core/most_names.hpp"
#include "exec/error.hpp"
#include "fdem/setup/materials.hpp"
#include "io/whole_file.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_regions.hpp"
#include "unit/prepare/fdem_scenes.hpp"
#include "unit/prepare/models.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace check_case_test {

/// The message of an InputError; empty if there is none.
std::string refused(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The problems of a message, without its first line.
std::string problems_of(const std::string& message) {
  const std::size_t end = message.find('\n');
  return end == std::string::npos ? "" : message.substr(end);
}

/// Of a box of 0.2 x 0.2 x 0.1 m around the origin: walls that touch it are not told of.
TEST(CheckDem, tells_of_walls_that_nothing_touches_at_the_start) {
  using dem::WallConfig;
  dem::Config config = dem::case_with_materials();
  config.bodies = {dem::box_body("slab", {0.2, 0.2, 0.1}, 100, 0.56)};
  WallConfig floor, high, turned, ball, punch;
  floor.name = "floor";
  floor.point = {0.0, 0.0, -0.05};
  high.name = "high";
  high.point = {5.0, 0.0, 0.053};
  high.normal = {0.0, 0.0, -1.0};
  turned.name = "turned";
  turned.point = {0.0, 0.0, 0.06};
  ball.name = "ball";
  ball.shape = "sphere";
  ball.point = {0.13, 0.0, 0.09};  // 50 mm from the edge
  ball.radius = 0.04;
  punch.name = "punch";
  punch.shape = "cylinder";
  punch.point = {0.0, 0.0, 0.05};
  punch.normal = {0.0, 0.0, -1.0};
  punch.radius = punch.length = 0.02;
  config.walls = {floor, high, turned, ball, punch};
  const std::vector<std::string> told = prepare::doubtful_walls(config, "");
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0],
            "wall.high.point: no body touches the wall at the start; slab is nearest, 3 mm away");
  EXPECT_EQ(told[1],
            "wall.turned.normal: all of slab lies behind the wall, which will throw it out; does "
            "the normal point away from it?");
  EXPECT_EQ(told[2],
            "wall.ball.point: no body touches the wall at the start; slab is nearest, 10 mm away");
  config.time.end = 0.01;
  config.walls[1].velocity = Vec3{0.0, 0.0, -0.1};
  EXPECT_TRUE(
      prepare::doubtful_walls(config, "")[0].ends_with("3 mm away, and it goes 1 mm until "
                                                       "time.end"));
  config.walls[1].velocity = Vec3{0.0, 0.0, 0.1};
  EXPECT_TRUE(prepare::doubtful_walls(config, "")[0].ends_with("and it does not come nearer"));
  config.walls[1].velocity = Vec3{0.0, 0.0, -0.4};
  EXPECT_TRUE(prepare::doubtful_walls(config, "")[0].ends_with("3 mm away"));
  config.gravity = {0.0, 0.0, 9.81};  // towards the wall above
  EXPECT_EQ(prepare::doubtful_walls(config, "").size(), 2U);
}

/// Bars lie within the body that they reinforce and are never the nearest, whatever their order.
TEST(CheckDem, tells_of_no_bars_where_a_wall_is_above_their_body) {
  dem::Config config = dem::case_with_materials();
  dem::BodyConfig bars;
  bars.name = "bars";
  bars.shape = "rebar";
  bars.rebar.in = "slab";
  config.bodies = {bars, dem::box_body("slab", {0.2, 0.2, 0.1}, 100, 0.56)};
  dem::WallConfig high;
  high.name = "high";
  high.point = {0.0, 0.0, 0.053};
  high.normal = {0.0, 0.0, -1.0};
  config.walls = {high};
  EXPECT_EQ(prepare::doubtful_walls(config, ""),
            std::vector<std::string>{"wall.high.point: no body touches the wall at the start; slab "
                                     "is nearest, 3 mm away"});
}

/// A ramp of 45 degrees through the lower right edge of a box, and a punch that has sunk into it.
TEST(CheckDem, tells_of_bodies_that_reach_behind_a_wall) {
  using dem::WallConfig;
  dem::Config config = dem::case_with_materials();
  config.bodies = {dem::box_body("heap", {0.2, 0.2, 0.1}, 100, 0.56)};
  WallConfig ramp, punch, slight;
  ramp.name = "ramp";
  ramp.shape = "box";
  ramp.point = {0.09, 0.0, -0.05};
  ramp.normal = {-1.0, 0.0, 1.0};
  ramp.along = {1.0, 0.0, 1.0};
  ramp.size = {0.4, 0.4};
  ramp.length = 0.1;
  punch.name = "punch";
  punch.shape = "cylinder";
  punch.point = {0.0, 0.0, 0.03};
  punch.normal = {0.0, 0.0, -1.0};
  punch.radius = 0.02;
  punch.length = 0.04;
  slight.name = "slight";
  slight.point = {0.0, 0.0, -0.0495};
  config.walls = {ramp, punch, slight};
  const std::vector<std::string> told = prepare::doubtful_walls(config, "");
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0],  // 10 mm of the edge, over the square root of 2
            "wall.ramp.point: heap reaches 7.071 mm behind the wall's face at the start; what lies "
            "there will be thrown out");
  EXPECT_TRUE(told[1].starts_with("wall.punch.point: heap reaches 20 mm behind")) << told[1];
  // A ball and a cylinder whose boxes alone would reach the ramp.
  config.bodies[0].radius = 0.05;
  config.bodies[0].length = 0.1;
  config.walls = {ramp};
  config.walls[0].point = {0.08, 0.0, 0.0};
  config.walls[0].normal = {-1.0, 1.0, 0.0};
  config.walls[0].along = {0.0, 0.0, 1.0};
  for (const char* shape : {"sphere", "cylinder"}) {
    config.bodies[0].shape = shape;
    EXPECT_EQ(prepare::doubtful_walls(config, "").size(), 0U) << shape;
  }
}

TEST(CheckDem, refuses_softening_that_is_not_steep_before_its_knee) {
  dem::Config config = dem::case_with_materials();
  config.materials[0].knee_strength = 0.6;
  config.materials[0].knee_opening = 0.3;
  EXPECT_EQ(refused([&] { dem::check_case(config); }).find("knee_strength"), std::string::npos);
  config.materials[0].knee_opening = 0.4;
  EXPECT_NE(refused([&] { dem::check_case(config); }).find("knee_strength + knee_opening"),
            std::string::npos);
}

TEST(CheckDem, refuses_mass_for_elements_that_rule_the_step) {
  dem::Config config = dem::case_with_materials();
  EXPECT_EQ(refused([&] { dem::check_case(config); }).find("added_mass"), std::string::npos);
  config.time.added_mass = 0.001;
  EXPECT_NE(refused([&] {
              dem::check_case(config);
            }).find("time.added_mass is for triangles and tetrahedra"),
            std::string::npos);
}

TEST(CheckDem, refuses_friction_that_nears_no_bound) {
  dem::Config config = dem::case_with_materials();
  config.materials[0].friction_bound = "smooth";
  EXPECT_NE(refused([&] { dem::check_case(config); }).find("needs friction_cap"),
            std::string::npos);
  config.materials[0].friction_cap = 3e6;
  EXPECT_EQ(refused([&] { dem::check_case(config); }).find("friction_cap"), std::string::npos);
}

TEST(CheckDem, refuses_a_hyperbola_whose_asymptote_passes_below_the_tensile_strength) {
  dem::Config config = dem::case_with_materials();
  dem::MaterialConfig& m = config.materials[0];
  m.tensile_strength = 2e6;
  m.friction_angle = std::atan(0.5);
  m.cohesion = 0.9e6;
  EXPECT_EQ(refused([&] { dem::check_case(config); }).find("hyperbola"), std::string::npos);
  m.criterion = "hyperbola";
  EXPECT_NE(refused([&] { dem::check_case(config); }).find("needs a cohesion above"),
            std::string::npos);
  m.cohesion = 1.1e6;
  EXPECT_EQ(refused([&] { dem::check_case(config); }).find("hyperbola"), std::string::npos);
}

TEST(CheckDem, refuses_what_ldpm_cannot_do) {
  using dem::Config;
  check_case(dem::ldpm_cube());
  const std::pair<std::function<void(Config&)>, const char*> changes[] = {
      {[](Config& c) { c.bodies[0].shape = "sphere"; }, "boxes, cylinders"},
      {[](Config& c) { c.bodies[0].pack.count = 100; }, "pack has no use"},
      {[](Config& c) { c.materials[0].poisson = 0.25; }, "needs 0 to 0.25"},
      {[](Config& c) { c.materials[0].cohesion = 0.0; }, "tensile_strength and cohesion"},
      {[](Config& c) { c.materials[0].fracture_energy = 50.0; }, "ldpm.tensile_length"},
      {[](Config& c) { c.materials[0].mix.smallest = 0.1; }, "must be below largest"},
      {[](Config& c) { c.materials[0].mix.cement = 1300.0; }, "no room for aggregate"},
      {[](Config& c) {
         c.materials[0].mix.sieves = {6e-3, 12e-3};
       },
       ".mix.sieves has 2 sizes"},
      {[](Config& c) {
         c.materials[0].mix.sieves = {8e-3, 12e-3};
         c.materials[0].mix.passing = {0.0, 1.0};
       },
       "reach from 0.008"},
      {[](Config& c) {
         c.materials[0].mix.sieves = {1e-3, 6e-3, 12e-3};
         c.materials[0].mix.passing = {0.0, 1.0, 1.0};
       },
       "no grains from"},
      {[](Config& c) {
         c.materials[0].mix.passing = {0.0, 1.0};
       },
       ".mix.sieves has 0 sizes"},
      {[](Config& c) { c.materials[0].ldpm.final_hardening = 0.5; }, "final_hardening"},
      {[](Config& c) { c.materials[0].ldpm.final_friction = 0.5; }, "final_friction"},
  };
  for (const auto& [change, words] : changes) {
    Config config = dem::ldpm_cube();
    change(config);
    EXPECT_NE(refused([&] { check_case(config); }).find(words), std::string::npos) << words;
  }
  Config brittle = dem::ldpm_cube();
  brittle.materials[0].ldpm.tensile_length = 5e-3;
  EXPECT_NE(refused([&] { build_model(brittle, ""); }).find("is too short"), std::string::npos);
}

TEST(CheckDem, refuses_a_body_with_the_words_of_the_build) {
  using dem::BodyConfig;
  using dem::Config;
  const std::function<void(Config&)> changes[] = {
      [](Config& c) { c.bodies.clear(); },
      [](Config& c) { c.bodies[0].material = "c45"; },
      [](Config& c) { c.bodies[0].material = "b500"; },
      [](Config& c) { c.bodies[0].size.y = 0.0; },
      [](Config& c) { c.bodies[0].pack.count = 0; },
      [](Config& c) { c.bodies[0].shape = "file"; },
      [](Config& c) {
        c.bodies[0].shape = "element";
        c.bodies[0].size = {};
      },
      [](Config& c) { c.bodies[1].name = c.bodies[0].name; },
      [](Config& c) { c.bodies[1].material = "c30"; },
      [](Config& c) { c.bodies[1].rebar.interface_law = "c30"; },
      [](Config& c) { c.bodies[1].rebar.in = "wall"; },
      [](Config& c) { c.bodies[1].rebar.bars = 26; },
      [](Config& c) { c.bodies[1].velocity.x = 1.0; },
      [](Config& c) {
        c.bodies.erase(c.bodies.begin() + 1);
        c.bodies[0].pack.count = 2;  // of larger radius than the slab is thick
      },
      [](Config& c) {
        c.materials[0].fracture_energy = 80.0;
        c.materials[0].tensile_strength = 0.0;
      },
      [](Config& c) {
        c.bodies.erase(c.bodies.begin() + 1);
        c.bodies[0].shape = "file";
        c.bodies[0].file = "spheres.csv";
        c.bodies[0].size = {};
        c.bodies[0].volume = 1e-3;
        c.materials[0].fabric = "even";
      },
  };
  for (const auto& change : changes) {
    Config config = dem::small_slab();
    change(config);
    const std::string by_check = refused([&] { dem::check_case(config); });
    const std::string by_build = refused([&] { build_model(config, "."); });
    EXPECT_NE(problems_of(by_check), "");
    EXPECT_EQ(problems_of(by_check), problems_of(by_build));
  }
  const Config good = dem::small_slab();
  EXPECT_EQ(refused([&] { dem::check_case(good); }), "");
}

fdem::Config plate_case() {
  fdem::Config config;
  config.materials.emplace_back().name = "rock";
  config.bodies = {fdem::regular_plate({0.1, 0.05}, 0.01)};
  return config;
}

TEST(CheckFdem, refuses_a_body_with_the_words_of_the_build) {
  using fdem::Config;
  const std::function<void(Config&)> changes[] = {
      [](Config& c) { c.bodies.clear(); },
      [](Config& c) { c.bodies[0].material = "rokc"; },
      [](Config& c) { c.bodies[0].mesh_size = 0.0; },
      [](Config& c) { c.bodies[0].size.x = 0.0; },
      [](Config& c) { c.bodies.push_back(c.bodies[0]); },
      [](Config& c) {
        c.bodies[0].grains.kind = "random";
        c.bodies[0].grains.minerals = {{.material = "rock", .fraction = 0.5, .color = {}}};
      },
      [](Config& c) { c.discontinuities.emplace_back().name = "dyke"; },
  };
  for (const auto& change : changes) {
    Config config = plate_case();
    change(config);
    const std::string by_check = refused([&] { fdem::check_case(config); });
    const std::string by_build = refused(
        [&] { build_fdem_model(config.bodies, config.discontinuities, names_of(config), 1, "."); });
    EXPECT_NE(problems_of(by_build), "");
    EXPECT_NE(by_check.find(problems_of(by_build)), std::string::npos) << by_check << by_build;
  }
  EXPECT_EQ(refused([] { fdem::check_case(plate_case()); }), "");
}

TEST(CheckFdem, refuses_more_than_a_model_can_number) {
  const auto told = [](std::size_t count, const char* items, const std::string& most) {
    return "the case has " + std::to_string(count) + " " + items + "; at most " + most +
           " are allowed";
  };
  fdem::Config config = plate_case();
  for (std::size_t k = 0; k <= most_names; ++k) {
    config.loads.emplace_back().name = std::to_string(k);
    config.supports.emplace_back().name = std::to_string(k);
  }
  const std::string text = refused([&] { fdem::check_case(config); });
  EXPECT_NE(text.find(told(32768, "loads", "32767")), std::string::npos) << text;
  EXPECT_NE(text.find(told(32768, "supports", "32767")), std::string::npos) << text;

  config = plate_case();
  config.materials.resize(fdem::most_materials + 1, config.materials[0]);
  const std::string more = refused([&] { fdem::check_case(config); });
  EXPECT_NE(more.find(told(4001, "materials", "4000")), std::string::npos) << more;

  dem::Config spheres = dem::small_slab();
  spheres.walls.resize(20000);
  spheres.supports.resize(12768);
  const std::string both = refused([&] { dem::check_case(spheres); });
  EXPECT_NE(both.find(told(32768, "walls and supports", "32767")), std::string::npos) << both;
}

// Their pairs are more than 16 bits can number.
TEST(CheckFdem, each_two_of_many_materials_have_a_law) {
  fdem::Config config = plate_case();
  const std::size_t n = 257, pairs = n * (n + 1) / 2;
  config.materials.resize(n, config.materials[0]);
  const fdem::BondTable table = fdem::bond_table(config);
  EXPECT_EQ(table.bonds.size(), pairs);
  EXPECT_EQ(table.of_pair.back(), static_cast<Index>(pairs) - 1);
}

TEST(CheckFdem, finds_plain_bodies_in_each_other_as_the_build_does) {
  const auto overlap = [](double x, const char* shape, double edge = 0.01) {
    fdem::Config config = plate_case();
    fdem::BodyConfig other = fdem::disc_of(0.03, edge);
    other.structured = true;
    if (shape == std::string("plate")) other = fdem::regular_plate({0.1, 0.05}, 0.01);
    other.name = "other";
    other.center.x = x;
    config.bodies.push_back(other);
    const bool by_check = !refused([&] { fdem::check_case(config); }).empty();
    const bool by_build =
        !refused([&] { build_fdem_model(config.bodies, {}, names_of(config), 1, "."); }).empty();
    EXPECT_EQ(by_check, by_build) << shape << " at " << x;
    return by_check;
  };
  EXPECT_TRUE(overlap(0.06, "disc"));
  EXPECT_FALSE(overlap(0.0801, "disc"));
  for (const double edge : {0.005, 0.01, 0.02, 0.03}) {  // of 36, 18, 12 and 6 sides
    const double inside = 0.03 * (1.0 - std::cos(pi / (6.0 * std::round(0.03 / edge))));
    EXPECT_TRUE(overlap(0.08 - inside - 0.011 * edge, "disc", edge)) << edge;
  }
  EXPECT_TRUE(overlap(0.099, "plate"));
  EXPECT_FALSE(overlap(0.1, "plate"));
}

TEST(CheckFiles, names_every_file_that_building_could_not_read) {
  const ScratchFolder folder;
  replace_file(folder.path() + "/bad.csv", "0,0,0,0.01\n1,2,three,0.01\n");
  dem::Config config = dem::case_with_materials();
  dem::BodyConfig& bad = config.bodies.emplace_back();
  bad.name = "bad";
  bad.shape = "file";
  bad.material = "gravel";
  bad.file = "bad.csv";
  dem::BodyConfig gone = bad;
  gone.name = "gone";
  gone.file = "gone.csv";
  config.bodies.push_back(gone);
  const std::string text = refused([&] { prepare::check_files(config, folder.path()); });
  EXPECT_NE(text.find("2 problems"), std::string::npos) << text;
  EXPECT_NE(text.find("body.bad.file: "), std::string::npos) << text;
  EXPECT_NE(text.find("line 2"), std::string::npos) << text;
  EXPECT_NE(text.find("body.gone.file: "), std::string::npos) << text;
  config.bodies.erase(config.bodies.begin());
  EXPECT_THROW(prepare::check_files(config, folder.path()), IoError);
  replace_file(folder.path() + "/gone.csv", "0,0,0,0.01\n");
  EXPECT_NO_THROW(prepare::check_files(config, folder.path()));

  fdem::Config plane = plate_case();
  plane.bodies[0].shape = "mesh";
  plane.bodies[0].file = "gone.msh";
  EXPECT_THROW(prepare::check_files(plane, folder.path()), IoError);
  replace_file(folder.path() + "/gone.msh", "no mesh\n");
  EXPECT_THROW(prepare::check_files(plane, folder.path()), InputError);
}

TEST(CheckFiles, tells_of_free_meshes_where_gmsh_is_not_installed) {
  const std::string path = std::getenv("PATH");
  fdem::Config regular = plate_case(), free = plate_case();
  free.bodies[0].structured = false;
  ASSERT_EQ(::setenv("PATH", "/nowhere", 1), 0);
  const std::string of_free = refused([&] { prepare::check_files(free, "."); });
  const std::string of_regular = refused([&] { prepare::check_files(regular, "."); });
  ASSERT_EQ(::setenv("PATH", path.c_str(), 1), 0);
  EXPECT_NE(of_free.find("needs the program gmsh to make its mesh, and it is not installed"),
            std::string::npos)
      << of_free;
  EXPECT_EQ(of_regular, "");
  EXPECT_EQ(refused([&] { prepare::check_files(free, "."); }), "");
}

}  // namespace check_case_test
}  // namespace breccia
