// Lists that a DEM run leaves: broken links, pieces.

#include "run/method/dem_tables.hpp"

#include <gtest/gtest.h>

#include <array>

#include "dem/observe.hpp"
#include "physics/dem/scene.hpp"

namespace breccia {
namespace dem_tables_test {

const Table& named(const std::vector<Table>& tables, const char* name) {
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

// Links break at different times; each is listed with that of the first row after its break, and
// with it once more rows have been written, on the host and by the schedule of devices.
TEST(DemTables, tell_when_links_broke) {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  const std::array<double, 5> speed{-5.0, 0.0, 0.0, 0.0, 1.0};
  for (int i = 0; i < 5; ++i)
    s.sphere({0.02 * i, 0.0, 0.0}, 0.01, {speed[std::size_t(i)], 0.0, 0.0});
  for (int i = 0; i < 4; ++i) s.link(i, i + 1);
  dem::World w = s.world();
  std::vector<double> broke(4, -1.0), expected(4, -1.0);
  const auto look = [&](std::vector<double>& when) {
    const auto is_broken = std::as_const(w.concrete).broken<double>();
    for (Index i = 0; i < 4; ++i)
      if (is_broken(i) && when[std::size_t(i)] < 0.0) when[std::size_t(i)] = w.time;
  };
  for (int row = 0; row < 30; ++row) {
    for (int step = 0; step < 4; ++step) {
      dem::step(w);
      look(broke);
    }
    dem::note_breaks(w);
    look(expected);
  }
  ASSERT_GT(broke[0], 0.0);
  ASSERT_GT(broke[3], broke[0]) << "the two ends are to part one after the other";
  const std::vector<Table> tables = dem_tables(w);
  const Table& links = named(tables, "broken_links");
  ASSERT_EQ(links.columns.back(), "time");
  ASSERT_GE(links.rows.size(), 2U);
  bool between_rows = false;
  for (const std::vector<double>& row : links.rows) {
    const auto link = std::size_t(row[0]);
    EXPECT_EQ(row.back(), expected[link]);
    EXPECT_LE(row.back() - broke[link], 4.0 * w.last_dt * (1.0 + 1e-9));
    between_rows |= row.back() > broke[link];
  }
  Exec device;
  device.space = Space::shadow;
  dem::World there = dem::make_world(s.config, s.model, device);
  for (std::int64_t row = 1; row <= 30; ++row) {
    while (there.step < 4 * row) dem::advance(there, {1e300, 4 * row});
    dem::note_breaks(there);
  }
  EXPECT_EQ(named(dem_tables(there), "broken_links").rows, links.rows);
  EXPECT_TRUE(between_rows) << "all broke in the very step of a row: the test sees no difference";
}

}  // namespace dem_tables_test
}  // namespace breccia
