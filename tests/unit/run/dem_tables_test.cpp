// Lists that a DEM run leaves: contacts with the forces that act, broken links, pieces.

#include "run/method/dem_tables.hpp"

#include <gtest/gtest.h>

#include "physics/dem/scene.hpp"

namespace breccia {
namespace {

const Table& named(const std::vector<Table>& tables, const std::string& name) {
  for (const Table& table : tables)
    if (table.name == name) return table;
  throw std::runtime_error(name);
}

TEST(DemTables, tell_the_forces_that_act_in_contacts) {
  for (const bool hertz : {false, true}) {
    dem::testing::Scene s;
    s.material("c", "concrete", 30e9, 0.2, 2400.0);
    s.config.contact.law = hertz ? "hertz" : "linear";
    s.config.contact.friction = 0.5;
    s.sphere({0.0, 0.0, 0.0}, 0.01, {1.0, 0.2, 0.0});
    s.sphere({0.0199, 0.0, 0.0}, 0.01);
    s.sphere({0.5, 0.0, 0.0}, 0.01);
    dem::World w = s.world();
    for (int i = 0; i < 5; ++i) dem::step(w);
    const Table& contacts = named(dem_tables(w), "contacts");
    ASSERT_EQ(contacts.rows.size(), 1U);
    const std::vector<double>& row = contacts.rows[0];
    EXPECT_EQ(row[0], 0.0);
    EXPECT_EQ(row[1], 1.0);
    EXPECT_NEAR(row[5], 1.0, 1e-3);  // along x
    const Vec3 force = w.contact_actions.data()[0].force_on_b();
    const Vec3 normal{row[5], row[6], row[7]};
    EXPECT_NEAR(row[8], dot(force, normal), 1e-9 * norm(force));
    EXPECT_NEAR(row[9], norm(force - dot(force, normal) * normal), 1e-9 * norm(force));
  }
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

}  // namespace
}  // namespace breccia
