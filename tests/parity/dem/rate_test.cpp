// Equal bits for links whose strength depends on their strain rate and whose softening has a
// knee: threads, packs, the shadow space, ranks, precision, across a checkpoint.
#include "small_slab_runs.hpp"

namespace breccia {
namespace rate_test {

const testing::SmallSlabRuns& slab() {
  static const testing::SmallSlabRuns runs(
      {"material.c30.rate=malvar_ross", "material.c30.knee_strength=0.3333"});
  return runs;
}

TEST(RateBits, differ_from_those_of_links_without_a_rate_or_without_a_knee) {
  dem::Config none = slab().config();
  none.materials[0].rate = "none";
  for (const dem::MaterialConfig& m : none.materials) EXPECT_EQ(m.rate, "none");
  EXPECT_NE(slab().end_of(none).hash, slab().reference().hash);
  dem::Config straight = slab().config();
  straight.materials[0].knee_strength = 0.0;
  EXPECT_NE(slab().end_of(straight).hash, slab().reference().hash);
}

TEST(RateBits, are_the_same_on_threads_packs_and_in_the_shadow_space) {
  slab().expect_same_on_threads_packs_and_in_the_shadow_space();
}

TEST(RateBits, are_the_same_on_ranks) {
  slab().expect_same_on_ranks([](const dem::World& w) -> const auto& { return w.concrete.rate; });
}

TEST(RateBits, are_the_same_across_a_checkpoint) {
  slab().expect_same_across_a_checkpoint();
}

}  // namespace rate_test
}  // namespace breccia
