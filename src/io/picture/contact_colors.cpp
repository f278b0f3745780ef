#include "io/picture/contact_colors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace breccia {
namespace {

constexpr Color pale_body{0.90F, 0.90F, 0.89F}, contact_ink{0.10F, 0.11F, 0.13F};
constexpr const char* of_contacts = "contact force";
constexpr double least_force = 0.01;  ///< of the largest force: weaker ones are not drawn  [-]

/// Contacts as the lines of a frame that has nothing else.
Frame contacts_as_lines(const Frame& frame) {
  Frame lines;
  lines.position = {{}, {}};
  FrameField force{of_contacts, places_in(frame).plane() ? "N/m" : "N", 1, {}};
  for (const FrameContact& contact : frame.contacts) {
    lines.lines.insert(lines.lines.end(), {0, 1});
    force.values.push_back(static_cast<float>(norm(contact.force)));
  }
  lines.line_fields = {std::move(force)};
  return lines;
}

/// Contacts by their force, the weakest first; ids decide where forces are equal.
/// @param color  of a contact
template <class ColorOf>
void put_contacts(const Frame& frame, const std::vector<float>& force, double largest,
                  const ColorOf& color, Coloring& coloring) {
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double width = largest > 0.0 ? std::min(1.0, force[i] / largest) : 0.0;
    if (width >= least_force) coloring.contacts.push_back({i, color(i), width});
  }
  const auto order = [&](const ContactLook& look) {
    const FrameContact& contact = frame.contacts[look.contact];
    return std::tuple(look.width, contact.a, contact.b);
  };
  std::sort(coloring.contacts.begin(), coloring.contacts.end(),
            [&](const ContactLook& a, const ContactLook& b) { return order(a) < order(b); });
  coloring.legend.notes.push_back(coloring.contacts.empty() ? "no contact presses"
                                  : coloring.contacts.size() < force.size()
                                      ? fmt::format("none below {:g} %", 100.0 * least_force)
                                      : "");
  if (coloring.legend.notes.back().empty()) coloring.legend.notes.pop_back();
}

}  // namespace

void color_by_contacts(const Frame& frame, const std::optional<ValueRange>& range,
                       const std::string& map, bool log, Coloring& coloring) {
  const Frame lines = contacts_as_lines(frame);
  Coloring of = color_frame(lines, of_contacts, range, map.empty() ? "viridis" : map, true, log);
  coloring.legend = std::move(of.legend);
  for (std::vector<Color>* const colors :
       {&coloring.points, &coloring.triangles, &coloring.tetrahedra})
    std::fill(colors->begin(), colors->end(), pale_body);
  const std::vector<float>& force = lines.line_fields.front().values;
  double largest = coloring.legend.bar ? coloring.legend.bar->range.high : 0.0;
  if (log) largest = std::pow(10.0, largest);
  put_contacts(
      frame, force, largest, [&](std::size_t i) { return of.lines[i]; }, coloring);
}

void add_contacts(const Frame& frame, Coloring& coloring) {
  const Frame lines = contacts_as_lines(frame);
  const std::vector<float>& force = lines.line_fields.front().values;
  const double largest = force.empty() ? 0.0 : *std::max_element(force.begin(), force.end());
  const ScaledUnit scaled = scaled_unit(lines.line_fields.front().unit, largest);
  coloring.legend.notes.push_back(
      fmt::format("contacts up to {:.3g} {}", scaled.factor * largest, scaled.unit));
  put_contacts(
      frame, force, largest, [](std::size_t) { return contact_ink; }, coloring);
}

}  // namespace breccia
