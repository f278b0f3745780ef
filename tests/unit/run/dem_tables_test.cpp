// Lists that a DEM run leaves: broken links, pieces.

#include "run/method/dem_tables.hpp"

#include <gtest/gtest.h>

#include "physics/dem/scene.hpp"

namespace breccia {
namespace dem_tables_test {

const Table& named(const std::vector<Table>& tables, const std::string& name) {
  for (const Table& table : tables)
    if (table.name == name) return table;
  throw std::runtime_error(name);
}

TEST(DemTables, list_broken_links_and_pieces) {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  for (int i = 0; i < 3; ++i)
    s.sphere({0.02 * i, 0.0, 0.0}, 0.01, {i == 2 ? 200.0 : 0.0, 0.0, 0.0});
  s.link(0, 1);
  s.link(1, 2);
  dem::World w = s.world();
  ASSERT_EQ(named(dem_tables(w), "fragments").rows.size(), 1U);
  for (int i = 0; i < 60; ++i) dem::step(w);
  const std::vector<Table> tables = dem_tables(w);
  const Table &links = named(tables, "broken_links"), &pieces = named(tables, "fragments");
  ASSERT_EQ(links.rows.size(), 1U);
  EXPECT_EQ(links.rows[0][0], 1.0);
  EXPECT_EQ(links.rows[0][1], 2.0);
  ASSERT_EQ(pieces.rows.size(), 2U);
  EXPECT_NEAR(pieces.rows[0][2], 2.0 / 3.0, 1e-12);
  EXPECT_EQ(pieces.rows[0][3], 2.0);
  const double momentum =
      pieces.rows[0][1] * pieces.rows[0][7] + pieces.rows[1][1] * pieces.rows[1][7];
  EXPECT_NEAR(momentum, 200.0 * pieces.rows[1][1], 1e-6 * momentum);
}

}  // namespace dem_tables_test
}  // namespace breccia
