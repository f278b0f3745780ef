#include "core/relation.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "dem/relations.hpp"
#include "fdem/relations.hpp"

namespace breccia {
namespace relation_test {

using Names = std::set<std::string>;

/// The arrays of a state that hold places; global ids are of the same type, and lead nowhere.
template <class State>
void list_places(const std::string& name, State& state, Names& names) {
  state.each_field([&](const char* field, const char*, auto& array) {
    if constexpr (std::is_same_v<decltype(array), Buffer<Index>&>)
      if (std::string(field) != "id") names.insert(name + "." + field);
  });
}
template <class World>
Names declared(World& w) {
  Names names;
  each_relation(w, [&](const auto& r) {
    EXPECT_TRUE(names.insert(std::string(r.state) + "." + r.name).second) << r.state << r.name;
  });
  return names;
}

TEST(Relations, of_the_dem_are_all_places_that_its_state_holds) {
  dem::World w{Exec{}};
  Names held;
  list_places("elements", w.elements, held);
  w.each_set([&](auto& set) { list_places(set.name, set, held); });
  list_places("contacts", w.contacts, held);
  list_places("wall_contacts", w.wall_contacts, held);
  list_places("travel", w.travel, held);
  EXPECT_EQ(declared(w), held);
}

TEST(Relations, of_the_fdem_are_all_places_that_its_state_holds) {
  fdem::World w{Exec{}};
  Names held;
  list_places("triangles", w.triangles, held);
  list_places("joints", w.joints, held);
  list_places("couples", w.couples, held);
  list_places("reach", w.reach, held);
  EXPECT_EQ(declared(w), held);
}

TEST(Relations, follow_triangles_to_other_numbers_edge_by_edge) {
  fdem::World w{Exec{}};
  copy_to(w.joints.edge_a, std::vector<Index>{0, 5});
  copy_to(w.joints.edge_b, std::vector<Index>{4, 8});
  copy_to(w.joints.law, std::vector<Index>{1, 0});
  copy_to(w.couples.pairs.a, std::vector<Index>{2});
  copy_to(w.triangles.hold, std::vector<Index>{-1, 0, 1});
  renumber_relations(w, [](Index t) { return 10 + t; });
  EXPECT_EQ(w.joints.edge_a.data()[0], 30);
  EXPECT_EQ(w.joints.edge_a.data()[1], 35);
  EXPECT_EQ(w.joints.edge_b.data()[1], 38);
  EXPECT_EQ(w.couples.pairs.a.data()[0], 12);
  EXPECT_EQ(w.joints.law.data()[0], 1) << "leads to no triangle";
  EXPECT_EQ(w.triangles.hold.data()[0], -1);
}

TEST(Relations, mark_only_what_the_model_joins) {
  dem::World w{Exec{}};
  w.elements.id.resize(6);
  copy_to(w.steel.a, std::vector<Index>{1});
  copy_to(w.steel.b, std::vector<Index>{2});
  copy_to(w.ldpm.d, std::vector<Index>{4});
  copy_to(w.contacts.pairs.a, std::vector<Index>{0});
  std::vector<std::uint8_t> joined(6, 0);
  mark_joined(w, joined);
  EXPECT_EQ(joined, (std::vector<std::uint8_t>{0, 1, 1, 0, 1, 0}));
  EXPECT_EQ(element_ends(w, "ldpm").size(), 4U);
  EXPECT_EQ(element_ends(w, "wall_contacts").size(), 1U) << "b leads to walls";
}

}  // namespace relation_test
}  // namespace breccia
