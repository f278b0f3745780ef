#pragma once
// Bolts in results and in checkpoints.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fdem_shared/bolts/bolts.hpp"
#include "run/method/loose_array.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// bolts.csv; none where there are no bolts.
template <class World>
void add_bolt_table(const World& w, std::vector<Table>& tables) {
  using Shape = fdem_shared::ShapeOf<World>;
  if (w.given->bolts.empty()) return;
  const std::string force = Shape::force_unit;
  Table bolts{"bolts", {"bolt", "x", "y"}, {"-", "m", "m"}, {}};
  if (Shape::dimension == 3) {
    bolts.columns.push_back("z");
    bolts.units.push_back("m");
  }
  for (const char* column : {"force", "across", "slip"}) bolts.columns.push_back(column);
  for (const std::string& unit : {force, force, std::string("m")}) bolts.units.push_back(unit);
  for (const auto& row : fdem_shared::bolt_rows(w)) {
    std::vector<double> numbers{static_cast<double>(row.bolt)};
    for (int axis = 0; axis < Shape::dimension; ++axis)
      numbers.push_back(fdem_shared::part_of(row.place, axis));
    numbers.insert(numbers.end(), {row.force, row.across, row.slip});
    bolts.rows.push_back(numbers);
  }
  tables.push_back(bolts);
}

/// Of each bolt the largest forces and slip, and its energies.
template <class World>
void add_bolt_findings(const World& w, std::vector<Fact>& facts) {
  if (w.given->bolts.empty()) return;
  const std::vector<fdem_shared::BoltEnergy> energies = fdem_shared::bolt_energies(w);
  const auto rows = fdem_shared::bolt_rows(w);
  for (std::size_t b = 0; b < energies.size(); ++b) {
    double force = 0.0, across = 0.0, slip = 0.0;
    for (const auto& row : rows)
      if (row.bolt == b) {
        if (std::abs(row.force) > std::abs(force)) force = row.force;
        if (std::abs(row.across) > std::abs(across)) across = row.across;
        slip = std::max(slip, std::abs(row.slip));
      }
    const std::string path = "bolt." + w.given->bolts[b].name + ".";
    facts.push_back({path + "force", force});
    facts.push_back({path + "across", across});
    facts.push_back({path + "slip", slip});
    facts.push_back({path + "elastic", energies[b].elastic});
    facts.push_back({path + "yielded", energies[b].yielded});
    facts.push_back({path + "rubbed", energies[b].rubbed});
    facts.push_back({path + "crushed", energies[b].crushed});
  }
}

template <class World, class Visit>
void each_stored_bolt(World& w, const Visit& visit) {
  if (w.given->bolts.empty()) return;
  using Node = fdem_shared::BoltNodeOf<typename fdem_shared::ShapeOf<World>::Vector>;
  visit("bolts.time", w.bolts.time);
  visit.fields("bolts", Loose<Node>{"node", w.bolts.nodes});
}

}  // namespace breccia
