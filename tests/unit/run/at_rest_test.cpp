// Models at rest: what rounding moves is no error of the ledger.

#include <gtest/gtest.h>

#include <cmath>

#include "run/case.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/energy_of_rounding.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace at_rest_test {

EnergyBalance after_steps(Method& method) {
  while (method.steps() < 300) method.advance({.time = 1e300, .step = 300});
  return method.energy();
}

TEST(AtRest, is_a_last_digit_of_the_farthest_coordinate_each_step) {
  Buffer<double> mass;
  copy_to(mass, std::vector<double>{1.0, 2.0, 5.0});
  const std::vector<Vec2> point{{0.0, 0.0}, {3.0, 4.0}, {-1.0, 0.0}};
  const double speed = 5.0 * std::pow(2.0, -52) / 1e-5;
  EXPECT_DOUBLE_EQ(energy_of_rounding(mass, point, 1e-5), 4.0 * speed * speed);
  EXPECT_EQ(energy_of_rounding(mass, point, 0.0), 0.0);
}

std::string plate(const std::string& more) {
  return "breccia = 1\nmethod = \"fdem2d\"\n[time]\nend = 1.0\n[material.rock]\n"
         "density = 2600.0\nyoung = \"8 GPa\"\npoisson = 0.25\n" +
         more +
         "[[body]]\nname = \"ground\"\nshape = \"plate\"\nmaterial = \"rock\"\n"
         "center = [13.7, 8.3]\nsize = [40.0, 20.0]\nmesh_size = 1.1\nstructured = true\n";
}
EnergyBalance of_plate(const std::string& more, double& rounding, const std::string& body = "") {
  const auto config = read_case<fdem::Config>(CaseText{plate(more) + body, "plate.toml"}, {});
  const auto method = make_method(config, build_model(config, "."), Exec{});
  const EnergyBalance energy = after_steps(*method);
  rounding = method->rounding();
  return energy;
}

TEST(AtRest, of_a_plate_at_rest_is_no_error) {
  double rounding = 0.0;
  const EnergyBalance rest = of_plate("", rounding);
  EXPECT_GT(rest.kinetic + rest.elastic, 0.0) << "it moves, though nothing acts";
  EXPECT_LT(rest.kinetic + rest.elastic, 0.01 * rounding);
  EXPECT_EQ(rest.error_relative, 0.0);
  EXPECT_EQ(rest.contact_relative, 0.0);
  const EnergyBalance thrown = of_plate("", rounding, "velocity = [1e-6, 0.0]\n");
  EXPECT_GT(thrown.kinetic, 100.0 * rounding);
  EXPECT_NE(thrown.error_relative, 0.0);
}

}  // namespace at_rest_test
}  // namespace breccia
