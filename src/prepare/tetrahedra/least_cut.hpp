#pragma once
// The cheapest way to part a network between a source and a sink.

#include <cstdint>
#include <vector>

#include "exec/types.hpp"

namespace breccia::prepare {

class LeastCut {
 public:
  explicit LeastCut(Index nodes);

  /// Adds the cost of a cut between a node and the source, or the sink.
  void tie_to_source(Index node, std::int64_t cost) { connect(source(), node, cost, 0); }
  void tie_to_sink(Index node, std::int64_t cost) { connect(node, sink(), cost, 0); }
  /// Adds the cost of a cut between two nodes.
  void join(Index a, Index b, std::int64_t cost) { connect(a, b, cost, cost); }

  /// Whether each node stays with the source: of all cheapest cuts the one with the fewest such
  /// nodes, which is one and the same in whatever order the network was told.
  ///
  /// By maximum flow (Dinic 1970): by the theorem of Ford and Fulkerson it is as large as the
  /// cheapest cut, and what the source can still reach lies on its side.
  std::vector<bool> with_source();

 private:
  struct Arc {
    Index to;
    std::int64_t left;  ///< of its capacity; the arc back has the number with the last bit changed
  };
  Index source() const { return nodes_; }
  Index sink() const { return nodes_ + 1; }
  void connect(Index from, Index to, std::int64_t forth, std::int64_t back);
  bool set_levels();
  bool push_one_path();

  Index nodes_;
  std::vector<Arc> arcs_;
  std::vector<std::vector<Index>> from_;  ///< arcs of each node
  std::vector<Index> level_;              ///< arcs from the source; -1: not reached
  std::vector<std::size_t> next_;         ///< first arc of each node that may still lead on
};

}  // namespace breccia::prepare
