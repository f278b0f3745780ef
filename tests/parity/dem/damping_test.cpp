// Equal bits for damped links: threads, packs, the shadow space, tiles, ranks, precision, across a
// checkpoint.
#include "small_slab_runs.hpp"

namespace breccia {
namespace damping_test {

const testing::SmallSlabRuns& slab() {
  static const testing::SmallSlabRuns runs({"material.c30.link_damping=0.3"});
  return runs;
}

TEST(DampingBits, differ_from_those_of_links_without_damping) {
  dem::Config none = slab().config();
  for (dem::MaterialConfig& m : none.materials) m.link_damping = 0.0;
  const testing::SlabEnd plain = slab().end_of(none);
  EXPECT_NE(plain.hash, slab().reference().hash);
  EXPECT_EQ(plain.energy.damping, 0.0);
  EXPECT_GT(slab().reference().energy.damping, 0.0);
  EXPECT_LT(slab().reference().energy.error_relative, 1e-3);
}

TEST(DampingBits, are_the_same_on_threads_packs_and_in_the_shadow_space_with_tiles_or_without) {
  slab().expect_same_on_threads_packs_and_in_the_shadow_space({0, 5});
}

/// Each class of links of its fabric is a group of its own, with few links in a tile of the host.
TEST(DampingBits, are_the_same_for_concrete_of_the_library_in_many_groups) {
  for (const char* const precision : {"double", "mixed", "single"}) {
    const testing::SmallSlabRuns library(
        {"material.c30.use=C30", std::string("precision=") + precision});
    EXPECT_GT(library.world().concrete.groups.size(), 16U);
    library.expect_same_on_threads_packs_and_in_the_shadow_space();
  }
}

TEST(DampingBits, are_the_same_on_ranks) {
  slab().expect_same_on_ranks(
      [](const dem::World& w) -> const auto& { return w.concrete.branch_normal; });
  slab().expect_same_on_ranks(
      [](const dem::World& w) -> const auto& { return w.concrete.damped_away; });
}

TEST(DampingBits, are_the_same_across_a_checkpoint) {
  slab().expect_same_across_a_checkpoint();
}

}  // namespace damping_test
}  // namespace breccia
