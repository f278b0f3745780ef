// Copies that ranks read from each other's memory.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "domain/halo.hpp"
#include "domain/simulated_ranks.hpp"

namespace breccia {
namespace peer_link_test {

/// A rank that is a thread and reads the memory of the others.
class LinkedRank final : public Communicator {
 public:
  LinkedRank(Communicator& ranks, std::atomic<std::size_t>& longest)
      : ranks_(ranks), longest_(longest), link_(*this, Space::host) {}

  int rank() const override { return ranks_.rank(); }
  int size() const override { return ranks_.size(); }
  PeerLink* link() override { return &link_; }
  std::unique_ptr<RepeatedMessages> prepare(const std::vector<Post>& to,
                                            const std::vector<Post>& from) override {
    for (const Post& post : to) {
      std::size_t before = longest_;
      while (before < post.bytes && !longest_.compare_exchange_weak(before, post.bytes)) {
      }
    }
    return ranks_.prepare(to, from);
  }
  std::vector<Message> exchange(std::vector<Message> messages) override {
    return ranks_.exchange(std::move(messages));
  }
  double least(double value) override { return ranks_.least(value); }
  void abort(int exit_code) override { ranks_.abort(exit_code); }

  void end() {
    link_.close();
    least(0.0);
  }

 private:
  Communicator& ranks_;
  std::atomic<std::size_t>& longest_;
  PeerLink link_;
};

/// Number of an element in a round of exchanges.
struct Small {
  GlobalId id;
  Index round;
};
struct Large {
  double id, round, more[3];
};
Small item(GlobalId id, Index round, Small) {
  return {id, round};
}
Large item(GlobalId id, Index round, Large) {
  return {1.0 * id, 1.0 * round, {2.0 * id, 3.0 * round, 0.5}};
}

/// Elements that this rank owns, and ghosts of some others: which, that changes with `kind`.
struct Share {
  static constexpr Index all = 300;
  Buffer<GlobalId> ids;
  std::vector<Ghost> ghosts;
  Halo halo;

  Share(Communicator& ranks, int kind) {
    std::vector<GlobalId> here;
    for (GlobalId id = 0; id < all; ++id) {
      const int owner = id * ranks.size() / all;
      // The middle rank owns what all copy, the first has ghosts of nobody in some kinds.
      const bool wanted = (id * 7 + kind * 5 + ranks.rank() * 3) % (4 + owner) == 0;
      if (owner != ranks.rank() && (!wanted || (kind == 1 && ranks.rank() == 0))) continue;
      if (owner != ranks.rank()) ghosts.push_back({static_cast<Index>(here.size()), owner});
      here.push_back(id);
    }
    copy_to(ids, here);
    halo.build(ranks, ids, ghosts);
  }

  template <class T>
  void go_round(Communicator& ranks, Index round) {
    Buffer<T> items(Space::host, ids.size());
    for (Index e = 0; e < ids.size(); ++e) items.data()[e] = item(ids.data()[e], round, T{});
    for (const Ghost& ghost : ghosts) items.data()[ghost.element] = item(-1, -1, T{});
    // Ranks come and go at different times.
    const auto pause = [&](int k) {
      if ((round * 3 + ranks.rank() + k) % 5 == 0)
        std::this_thread::sleep_for(std::chrono::microseconds(300));
    };
    pause(0);
    halo.start(Exec{}, ranks, items);
    pause(2);
    halo.finish(Exec{}, items);
    for (Index e = 0; e < ids.size(); ++e) {
      const T expected = item(ids.data()[e], round, T{});
      ASSERT_EQ(std::memcmp(&items.data()[e], &expected, sizeof expected), 0)
          << "element " << ids.data()[e] << " on rank " << ranks.rank() << " in round " << round;
    }
  }
};

/// Two halos by turns, items of two sizes, and then other ghosts.
std::size_t longest_message(int count) {
  std::atomic<std::size_t> longest = 0;
  simulate_ranks(count, 6, [&](Communicator& threads) {
    LinkedRank ranks(threads, longest);
    Share tied(ranks, 3);
    Index round = 0;
    for (int kind = 0; kind < 3; ++kind) {
      Share share(ranks, kind);
      Share copy = share;
      for (int i = 0; i < 30; ++i) {
        share.go_round<Small>(ranks, ++round);
        if (kind > 0) share.go_round<Large>(ranks, ++round);
        if (i % 3 == 0) tied.go_round<Large>(ranks, ++round);
        if (i % 4 == 0) copy.go_round<Small>(ranks, ++round);
      }
    }
    ranks.end();
  });
  return longest;
}

TEST(PeerLink, copies_are_read_where_their_owners_have_packed_them) {
  for (const int count : {2, 3, 5}) EXPECT_EQ(longest_message(count), 1U);  // tokens
}

TEST(PeerLink, without_it_copies_travel_as_messages) {
  ::setenv("BRECCIA_STAGED_COPIES", "1", 1);
  EXPECT_GT(longest_message(3), 100U);
  ::unsetenv("BRECCIA_STAGED_COPIES");
}

}  // namespace peer_link_test
}  // namespace breccia
