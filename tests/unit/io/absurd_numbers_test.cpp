// Numbers that no material has are refused with line, key and range, for both methods.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "fdem/setup/config.hpp"
#include "io/case/problems.hpp"
#include "run/case_keys.hpp"

namespace breccia {
namespace absurd_numbers_test {

/// Error of reading a case with this key of its material; empty: it is taken.
std::string said(const std::string& method, const std::string& key, const std::string& value) {
  const std::string box = method == "dem3d"
                              ? "shape = \"sphere\"\nradius = 0.1\npack = { count = 30 }\n"
                              : "shape = \"plate\"\nsize = [0.1, 0.1]\nmesh_size = 0.05\n";
  const CaseText text{fmt::format("breccia = 1\nmethod = \"{}\"\n[time]\nend = 1e-6\n[material.m]\n"
                                  "{} = {}\n[[body]]\nname = \"b\"\nmaterial = \"m\"\n{}",
                                  method, key, value, box),
                      "case.toml"};
  try {
    if (method == "dem3d")
      read_case<dem::Config>(text, {});
    else
      read_case<fdem::Config>(text, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(AbsurdNumbers, of_a_material_are_refused_with_line_key_and_range) {
  struct Wrong {
    const char *method, *key, *values[3];
  };
  for (const Wrong& wrong : {
           Wrong{"fdem2d", "joint.tension", {"1e30", "1e-30", "0.0"}},
           Wrong{"fdem2d", "joint.cohesion", {"1e30", "1e-30", "-1.0"}},
           Wrong{"fdem2d", "joint.energy_open", {"1e30", "1e-30", "0.0"}},
           Wrong{"fdem2d", "joint.energy_slide", {"1e30", "1e-30", "0.0"}},
           Wrong{"fdem2d", "joint.stiffness", {"1e30", "1e-30", "0.0"}},
           Wrong{"fdem2d", "contact_stiffness", {"1e30", "1e-30", "0.0"}},
           Wrong{"fdem2d", "tangential_stiffness", {"1e30", "1e-30", "0.0"}},
           Wrong{"fdem2d", "friction", {"1e30", "-0.1", "-1e30"}},
           Wrong{"fdem2d", "damping", {"1e30", "-0.1", "-1e30"}},
           Wrong{"fdem2d", "density", {"1e30", "1e-30", "0.0"}},
           Wrong{"fdem2d", "young", {"1e30", "1e-30", "0.0"}},
           Wrong{"dem3d", "tensile_strength", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "cohesion", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "softening", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "fracture_energy", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "rolling_stiffness", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "rolling_limit", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "friction_cap", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "compaction_strength", {"1e30", "-1.0", "-1e30"}},
           Wrong{"dem3d", "beta", {"1e30", "1e-30", "0.0"}},
       })
    for (const char* value : wrong.values) {
      const std::string message = said(wrong.method, wrong.key, value);
      EXPECT_NE(message.find(fmt::format("line 6, material.m.{} = ", wrong.key)), std::string::npos)
          << wrong.key << " = " << value << ": " << message;
      EXPECT_NE(message.find("is outside ["), std::string::npos) << message;
    }
  EXPECT_EQ(said("fdem2d", "joint.tension", "3e6"), "");
  EXPECT_EQ(said("dem3d", "cohesion", "3e6"), "");
}

/// A force for a modulus is surely a slip; 5 kN for a pressure may belong under another key.
TEST(AbsurdNumbers, a_force_for_a_pressure_is_put_right_only_where_it_is_surely_a_slip) {
  const auto correction = [](const char* value) {
    try {
      read_case<dem::Config>(
          CaseText{
              fmt::format("breccia = 1\nmethod = \"dem3d\"\n[material.m]\nyoung = {}\n", value),
              "case.toml"},
          {});
    } catch (const CaseError& error) {
      for (const Problem& problem : error.problems)
        if (problem.correction) return problem.correction->now;
    }
    return std::string();
  };
  EXPECT_EQ(correction("\"30 GN\""), "\"30 GPa\"");
  EXPECT_EQ(correction("\"5 kN\""), "");
}

}  // namespace absurd_numbers_test
}  // namespace breccia
