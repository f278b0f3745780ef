// Quantities of a case over time: one value or a table, read, written, refused.

#include <gtest/gtest.h>

#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "fdem/setup/config.hpp"
#include "run/case_keys.hpp"

namespace breccia {
namespace over_time_test {

const std::string dem_case = R"([time]
end = "1 ms"
[[wall]]
name = "top"
[[support]]
name = "grip"
velocity = )";

template <class Config>
Config read(const std::string& text) {
  return read_case<Config>(CaseText{text, "case.toml"}, {});
}
template <class Config>
std::string refusal(const std::string& text) {
  try {
    read<Config>(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OverTime, one_value_or_a_table_with_units) {
  const auto constant = read<dem::Config>(dem_case + "[0.0, 0.0, \"5 mm/s\"]\n");
  EXPECT_FALSE(constant.supports[0].velocity.is_table());
  EXPECT_EQ(constant.supports[0].velocity.value.z, 5e-3);
  const auto table =
      read<dem::Config>(dem_case + "[[0.0, 0.0, 0.0, 0.0], [\"2 ms\", 1, 2, \"3 mm/s\"]]\n");
  const OverTime<Vec3>& velocity = table.supports[0].velocity;
  ASSERT_EQ(velocity.times, (std::vector<double>{0.0, 2e-3}));
  EXPECT_EQ(norm(velocity.values[1] - Vec3{1.0, 2.0, 3e-3}), 0.0);
  const auto plane = read<fdem::Config>(R"([time]
end = 1.0
[[load]]
name = "blast"
pressure = [[0, 0], ["10 us", "5 MPa"], ["1 ms", 0]]
force = [[0, 1, 2], [1, 3, 4]]
)");
  EXPECT_EQ(plane.loads[0].pressure.values, (std::vector<double>{0.0, 5e6, 0.0}));
  EXPECT_EQ(norm(plane.loads[0].force.values[1] - Vec2{3.0, 4.0}), 0.0);
}

TEST(OverTime, the_completed_case_gives_the_same_table) {
  const auto config =
      read<dem::Config>(dem_case + "[[0.0, 0.0, 0.0, 0.0], [\"2 ms\", 1, 2, \"3 mm/s\"]]\n");
  const auto again = read<dem::Config>(completed_case(config));
  EXPECT_EQ(value_text(again.supports[0].velocity), value_text(config.supports[0].velocity));
  EXPECT_FALSE(again.walls[0].velocity.is_table());
}

TEST(OverTime, wrong_tables_are_refused_by_line_and_key) {
  const std::string back =
      refusal<dem::Config>(dem_case + "[[0.0, 0, 0, 0],\n[2.0, 1, 0, 0],\n" + "[1.0, 0, 0, 0]]\n");
  EXPECT_NE(back.find("line 9, support.grip.velocity[2]: its time 1 s is not after 2 s of the row "
                      "before; times must grow"),
            std::string::npos)
      << back;
  const std::string narrow = refusal<dem::Config>(dem_case + "[[0.0, 0.0]]\n");
  EXPECT_NE(narrow.find("line 7, support.grip.velocity[0] wants a time and 3 numbers"),
            std::string::npos)
      << narrow;
  const std::string fast = refusal<dem::Config>(dem_case + "[[0.0, 0, 0, 1e9]]\n");
  EXPECT_NE(fast.find("support.grip.velocity[0][3] = 1000000000 is outside"), std::string::npos)
      << fast;
  EXPECT_NE(refusal<dem::Config>(dem_case + "[[\"2 mm\", 0, 0, 1]]\n").find("velocity[0][0]"),
            std::string::npos);
}

}  // namespace over_time_test
}  // namespace breccia
