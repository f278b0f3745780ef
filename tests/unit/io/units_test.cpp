#include "io/case/units.hpp"

#include <gtest/gtest.h>

#include <charconv>

#include "math/constants.hpp"

namespace breccia {
namespace units_test {

double in_si(const std::string& text, const std::string& wanted) {
  std::string problem;
  const double value = parse_quantity(text, wanted, problem);
  EXPECT_EQ(problem, "") << text;
  return value;
}

std::string problem_of(const std::string& text, const std::string& wanted) {
  std::string problem;
  parse_quantity(text, wanted, problem);
  return problem;
}

TEST(Units, prefixes_products_quotients_and_powers_convert_to_si) {
  EXPECT_EQ(in_si("40 mm", "m"), 0.04);
  EXPECT_EQ(in_si("40mm", "m"), 0.04);
  EXPECT_EQ(in_si(" +40  mm ", "m"), 0.04);
  EXPECT_EQ(in_si("11 GPa", "Pa"), 11e9);
  EXPECT_EQ(in_si("0.5 mm/s", "m/s"), 5e-4);
  EXPECT_EQ(in_si("2400 kg/m3", "kg/m3"), 2400.0);
  EXPECT_EQ(in_si("2.4 g/cm3", "kg/m3"), 2400.0);
  EXPECT_EQ(in_si("2.4 t / m^3", "kg/m3"), 2400.0);
  EXPECT_EQ(in_si("100 J/m2", "J/m2"), 100.0);
  EXPECT_EQ(in_si("100 N/m", "J/m2"), 100.0);
  EXPECT_EQ(in_si("9.81 m/s2", "m/s2"), 9.81);
  EXPECT_EQ(in_si("9.81 m s-2", "m/s2"), 9.81);
  EXPECT_EQ(in_si("9.81 m/s/s", "m/s2"), 9.81);
  EXPECT_EQ(in_si("1 kN/mm^2", "Pa"), 1e9);
  EXPECT_EQ(in_si("3 N*m", "J"), 3.0);
  EXPECT_EQ(in_si("5 1/s", "Hz"), 5.0);
  EXPECT_EQ(in_si("8 %", "-"), 0.08);
  EXPECT_EQ(in_si("-1e3 us", "s"), -1e-3);
  EXPECT_EQ(in_si("7 \u00b5m", "m"), 7e-6);
  EXPECT_EQ(in_si("2 min", "s"), 120.0);
  EXPECT_EQ(in_si("1.5 h", "s"), 5400.0);
  EXPECT_DOUBLE_EQ(in_si("180 deg", "rad"), pi);
  EXPECT_DOUBLE_EQ(in_si("36 km/h", "m/s"), 10.0);
}

TEST(Units, a_decimal_unit_gives_the_double_that_its_number_in_si_gives) {
  // 9 * 1e-3 is not 0.009: a case must not change its bits with the way it is written.
  for (int n = 1; n <= 2000; ++n) {
    for (const auto& [unit, exponent] : {std::pair{"mm", "e-3"}, {"us", "e-6"}, {"GPa", "e9"}}) {
      const std::string digits = std::to_string(n / 10) + "." + std::to_string(n % 10);
      const std::string in_si_units = digits + exponent;
      double literal = 0.0;
      std::from_chars(in_si_units.data(), in_si_units.data() + in_si_units.size(), literal);
      const std::string wanted = unit[0] == 'm' ? "m" : unit[0] == 'u' ? "s" : "Pa";
      ASSERT_EQ(in_si(digits + " " + unit, wanted), literal) << digits << " " << unit;
    }
  }
}

TEST(Units, what_is_no_quantity_is_refused) {
  for (const char* text :
       {"mm",     "",       "ten mm", "nan mm",  "inf m",   "1,5 mm", "1 furlong",
        "1 m//s", "1 m/",   "1 /s",   "1 m*/s",  "1 m^",    "1 m^x",  "1 m--2",
        "1 kmm",  "1 mdeg", "1 m2.5", "+-1 m\n", "1e999 m", "1 m)"})
    EXPECT_NE(problem_of(text, "m"), "") << text;
  EXPECT_NE(problem_of("1", "m"), "");
}

TEST(Units, lengths_of_a_model_have_bounds) {
  const Range length = given_range(positive, "m", 0.0);
  for (const double good : {1e-12, 1e-3, 1.0, 1e9}) EXPECT_TRUE(length.holds(good)) << good;
  for (const double bad : {1e300, 1e10, 1e-300, 0.0, -1.0}) EXPECT_FALSE(length.holds(bad)) << bad;
  EXPECT_TRUE(given_range(not_negative, "m", 0.0).holds(0.0));
  EXPECT_FALSE(given_range(not_negative, "m", 0.0).holds(1e300));
  EXPECT_TRUE(given_range(not_negative, "m", no_limit).holds(no_limit));
  EXPECT_TRUE(given_range(any_number, "m", 0.0).holds(-1e300));  // a place: everywhere
  EXPECT_TRUE(given_range(positive, "Pa", 0.0).holds(1e300));
}

TEST(Units, a_wrong_dimension_is_named_with_the_units_that_fit) {
  EXPECT_EQ(problem_of("30 GN", "Pa"),
            "\"30 GN\" is a force, a pressure is wanted, in Pa, kPa, MPa, GPa or N/mm2; try "
            "\"30 GPa\"");
  EXPECT_EQ(problem_of("1 ms", "m"),
            "\"1 ms\" is a time, a length is wanted, in m, nm, um, mm, cm or km");
  EXPECT_EQ(problem_of("2 kg", "m/s"),
            "\"2 kg\" is a mass, a velocity is wanted, in m/s, mm/s or km/h");
  EXPECT_EQ(problem_of("10 kN", "N/m"),
            "\"10 kN\" is a force, a force per length is wanted, in N/m, kN/m or MN/m");
}

TEST(Units, a_decimal_comma_is_told) {
  EXPECT_EQ(problem_of("34,0 GPa", "Pa"),
            "\"34,0 GPa\" has a comma; numbers have a decimal point; try \"34.0 GPa\"");
}

TEST(Units, no_unit_is_proposed_that_nobody_means) {
  for (const char* text : {"8 mm", "8 m", "8 kg", "8 ms"})  // no "8 mPa", "8 Pa", "8 kPa"
    EXPECT_EQ(problem_of(text, "Pa").find("try"), std::string::npos) << text;
  EXPECT_EQ(problem_of("50 kg", "m").find("try"), std::string::npos);  // no "50 km"
}

TEST(Units, slips_of_the_pen_are_told_with_what_was_meant) {
  const std::vector<std::array<const char*, 3>> slips{
      {"30 gpa", "Pa", "\"30 GPa\""},
      {"2400 kg/m\u00b3", "kg/m3", "\"2400 kg/m3\""},
      {"30 degrees", "rad", "\"30 deg\""},
      {"0.643", "-", "0.643"},
      {"inf", "m", "inf"},
      {"-Inf", "m", "-inf"},
      {"5 kg/m**3", "kg/m3", "\"5 kg/m3\""},
      {"4 MM", "m", "\"4 mm\""},
      {"26 mPa", "Pa", "\"26 MPa\""},
      {"8 Mm", "m", "\"8 mm\""},
      {"5Ms", "s", "\"5 ms\""}};
  for (const auto& [text, wanted, meant] : slips) {
    std::string problem, better;
    parse_quantity(text, wanted, problem, &better);
    EXPECT_EQ(better, meant) << text;
    EXPECT_TRUE(problem.ends_with("; try " + std::string(meant))) << problem;
  }
}

TEST(Units, thousandths_of_a_pascal_are_told_for_what_they_are) {
  EXPECT_EQ(problem_of("26 mPa", "Pa"),
            "\"26 mPa\" is 0.026 Pa: mPa is a thousandth of a pascal; if it is meant, write the "
            "number in Pa; try \"26 MPa\"");
  EXPECT_EQ(problem_of("26 mN", "N"), "");
  EXPECT_EQ(problem_of("26 mJ", "J"), "");
}

}  // namespace units_test
}  // namespace breccia
