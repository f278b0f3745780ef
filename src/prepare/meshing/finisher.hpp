#pragma once
// The part of a mesh file's way into a mesh that plane meshes and meshes in space share: numbers
// are looked up, problems gathered.

#include <fmt/format.h>

#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "exec/error.hpp"
#include "prepare/meshing/mesh_file.hpp"

namespace breccia::prepare {

class FinisherBase {
 protected:
  FinisherBase(const RawMesh& raw, const std::string& name) : raw_(raw), name_(name) {}

  static std::string in_line(int line) { return line > 0 ? fmt::format("line {}, ", line) : ""; }
  void add(const std::string& problem) {
    if (++count_ <= 20) problems_.push_back(problem);
  }
  void refuse_if_any() const {
    if (count_ == 0) return;
    std::string text =
        fmt::format("{} problem{} in {}; nothing was run.", count_, count_ == 1 ? "" : "s", name_);
    for (const std::string& problem : problems_) text += "\n  " + problem;
    if (count_ > problems_.size())
      text += fmt::format("\n  ... and {} more", count_ - problems_.size());
    throw InputError(text);
  }
  std::string element_name(std::size_t e) const {
    return fmt::format("{}element {}", in_line(raw_.elements[e].line), raw_.elements[e].number);
  }
  std::string node_name(std::size_t n) const {
    return fmt::format("node {}", raw_.nodes[n].number);
  }

  /// @param corners  of an element: they are numbered, too
  void number_nodes(std::size_t corners, const char* of) {
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
    if (raw_.nodes.size() > most || raw_.elements.size() > most / corners)
      throw InputError(fmt::format(
          "{}: {} nodes and {} {} are too many; at most {} million {} can be numbered", name_,
          raw_.nodes.size(), raw_.elements.size(), of, most / corners / 1'000'000, of));
    position_.reserve(raw_.nodes.size());
    for (std::size_t n = 0; n < raw_.nodes.size(); ++n)
      if (!position_.emplace(raw_.nodes[n].number, n).second)
        add(fmt::format("{}node {} is there twice", in_line(raw_.nodes[n].line),
                        raw_.nodes[n].number));
  }

  /// The elements, each by the positions of its corners in raw_.nodes; marks those nodes as used.
  template <class Corners>
  std::vector<Corners> taken_elements(const char* of) {
    if (raw_.elements.empty())
      add(fmt::format("there are no {}; is it a mesh of another dimension?", of));
    used_.assign(raw_.nodes.size(), false);
    std::vector<Corners> taken;
    taken.reserve(raw_.elements.size());
    for (std::size_t e = 0; e < raw_.elements.size(); ++e) {
      Corners corners{};
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto found = position_.find(raw_.elements[e].nodes[k]);
        if (found == position_.end()) {
          add(fmt::format("{}: there is no node {}", element_name(e), raw_.elements[e].nodes[k]));
          continue;
        }
        corners[k] = static_cast<Index>(found->second);
        used_[found->second] = true;
      }
      taken.push_back(corners);
    }
    return taken;
  }

  /// A vertex of the mesh, or -1.
  Index vertex(std::int64_t number) const {
    const auto found = position_.find(number);
    return found == position_.end() ? -1 : index_[found->second];
  }

  /// Which vertices a set of nodes takes.
  std::vector<bool> vertices_in(const std::string& set, const std::vector<std::int64_t>& numbers) {
    std::vector<bool> in(kept_.size());
    for (const std::int64_t number : numbers)
      if (const Index v = vertex(number); v >= 0)
        in[static_cast<std::size_t>(v)] = true;
      else if (!position_.contains(number))
        add(fmt::format("the node set \"{}\" names node {}, which is not there", set, number));
    return in;
  }

  const RawMesh& raw_;
  const std::string& name_;
  std::unordered_map<std::int64_t, std::size_t> position_;  ///< of a number, in raw_.nodes
  std::vector<bool> used_;                                  ///< node is a corner
  std::vector<Index> index_;                                ///< vertex of a node; -1: dropped
  std::vector<std::size_t> kept_;                           ///< node of a vertex

 private:
  std::vector<std::string> problems_;
  std::size_t count_ = 0;
};

}  // namespace breccia::prepare
