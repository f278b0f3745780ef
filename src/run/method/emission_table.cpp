#include "run/method/emission_table.hpp"

#include <algorithm>
#include <cmath>

namespace breccia {

Table table_of(const std::vector<EmissionEvent>& events) {
  Table table{"events",
              {"time", "duration", "x", "y", "z", "breaks", "magnitude", "moment", "isotropic",
               "mxx", "myy", "mzz", "myz", "mxz", "mxy", "energy"},
              {"s", "s", "m", "m", "m", "-", "-", "N m", "-", "N m", "N m", "N m", "N m", "N m",
               "N m", "J"},
              {}};
  for (const EmissionEvent& e : events)
    table.rows.push_back({e.time, e.duration, e.place.x, e.place.y, e.place.z,
                          static_cast<double>(e.breaks), e.magnitude(), e.scalar(), e.isotropic(),
                          e.moment.xx, e.moment.yy, e.moment.zz, e.moment.yz, e.moment.xz,
                          e.moment.xy, e.energy});
  return table;
}

void add_emission(std::vector<Fact>& facts, const std::vector<EmissionEvent>& events) {
  facts.push_back({"emission.events", static_cast<double>(events.size())});
  if (events.empty()) return;
  std::vector<double> magnitudes;
  for (const EmissionEvent& e : events) magnitudes.push_back(e.magnitude());
  const auto add = [&](const char* path, double value) {
    facts.push_back({std::string("emission.") + path, value});
  };
  add("largest_magnitude", *std::max_element(magnitudes.begin(), magnitudes.end()));
  const std::optional<Frequency> f = frequency_of(magnitudes);
  if (!f) return;
  add("b_value", f->b);
  add("b_deviation", f->deviation);
  add("completeness", f->completeness);
  add("counted", static_cast<double>(f->count));
}

}  // namespace breccia
