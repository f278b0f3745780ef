#pragma once
// Vertices that some rank has marked become known to all.

#include "core/select.hpp"
#include "domain/parcel.hpp"
#include "domain/together.hpp"
#include "fdem_shared/exposed.hpp"

namespace breccia::fdem_shared {

/// Vertices that this rank has marked just now.
struct MarkedAnew {
  View<const std::uint8_t> marked, known;
  BR_HD bool operator()(Index v) const {
    return marked[v] != 0 && (known[v] & vertex_damaged) == 0;
  }
};
/// Damage stays, also where its joint has gone to another rank.
struct KeepMarks {
  static constexpr const char* name = "fdem.keep_marks";
  View<const std::uint8_t> known;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index v) const {
    if ((known[v] & vertex_damaged) != 0) marked[v] = 1;
  }
};
struct TakeMarks {
  static constexpr const char* name = "fdem.take_marks";
  View<const Index> vertex;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const { marked[vertex[i]] = 1; }
};

/// Marks the vertices that some rank has marked. Only what is new crosses to the host: the mesh may
/// have a hundred million vertices.
template <class World>
void share_marks(const World& w, Buffer<std::uint8_t>& marked) {
  if (w.domain.single_rank()) return;
  const auto known = std::as_const(w.exposed.vertex).view();
  std::vector<Index> marked_anew;
  copy_to(marked_anew,
          items_where(w.exec, marked.size(), MarkedAnew{std::as_const(marked).view(), known}));
  Buffer<Index> vertex(w.exec.space);
  copy_to(vertex, joined(*w.domain.ranks, marked_anew));
  for_each(w.exec, marked.size(), KeepMarks{known, marked.view()});
  for_each(w.exec, vertex.size(), TakeMarks{std::as_const(vertex).view(), marked.view()});
}

}  // namespace breccia::fdem_shared
