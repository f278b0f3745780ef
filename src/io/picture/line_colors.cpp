// Colours and widths of lines, and what an x-ray leaves of the rest.

#include "io/picture/line_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/picture/contact_colors.hpp"
#include "io/picture/field_colors.hpp"

namespace breccia {
namespace {

constexpr Color ground_color{1.0F, 1.0F, 1.0F};

const FrameField* line_field(const Frame& frame, const char* name) {
  const Carrier joints = joints_of(frame);
  const FrameField* field = field_of(frame, joints, name);
  const auto count = static_cast<std::size_t>(places_in(frame).count(joints));
  return field != nullptr && field->values.size() == count ? field : nullptr;
}

/// Joints that have softened: thin, from yellow to red by their damage.
void show_softened(const Frame& frame, Coloring& coloring) {
  const FrameField* damage = line_field(frame, "damage");
  if (damage == nullptr || coloring.hidden_lines.empty()) return;
  constexpr Color little{0.93F, 0.72F, 0.25F}, much{0.80F, 0.22F, 0.12F};
  bool any = false;
  coloring.line_widths.assign(coloring.lines.size(), 1.0F);
  for (std::size_t i = 0; i < coloring.lines.size(); ++i) {
    if (!coloring.hidden_lines[i]) continue;
    coloring.lines[i] = blend(little, much, std::clamp(damage->values[i], 0.0F, 1.0F));
    coloring.line_widths[i] = 0.5F;
    any = true;
  }
  coloring.hidden_lines.clear();
  if (any) coloring.legend.swatches.push_back({blend(little, much, 0.5F), "softened"});
}

double length_of(const Frame& frame, std::size_t line) {
  return norm(frame.position[static_cast<std::size_t>(frame.lines[2 * line])] -
              frame.position[static_cast<std::size_t>(frame.lines[2 * line + 1])]);
}

/// Bars, and links that broke, of elements that still lie side by side, instead of all others.
void show_broken(const Frame& frame, Coloring& coloring) {
  const FrameField* state = line_field(frame, "state");
  if (state == nullptr) return;
  const std::array swatches{Legend::Swatch{{0.78F, 0.12F, 0.10F}, "broken link"},
                            Legend::Swatch{{0.05F, 0.05F, 0.06F}, "broken bar"},
                            Legend::Swatch{{0.55F, 0.25F, 0.65F}, "broken bond"}};
  const FrameField* kind = line_field(frame, "kind");
  std::array<bool, swatches.size()> seen{};
  coloring.hidden_lines.assign(coloring.lines.size(), true);
  coloring.line_widths.assign(coloring.lines.size(), 0.75F);
  for (std::size_t i = 0; i < coloring.lines.size(); ++i) {
    const double reach = frame.radius[static_cast<std::size_t>(frame.lines[2 * i])] +
                         frame.radius[static_cast<std::size_t>(frame.lines[2 * i + 1])];
    const float number = kind != nullptr ? kind->values[i] : 0.0F;
    if (number == 1.0F && state->values[i] != 2.0F) {  // a bar, between its elements
      coloring.hidden_lines[i] = false;
      coloring.lines[i] = coloring.points[static_cast<std::size_t>(frame.lines[2 * i])];
      coloring.line_widths[i] = 2.0F;
      continue;
    }
    if (state->values[i] != 2.0F || !(length_of(frame, i) < 2.0 * reach)) continue;
    const std::size_t which = number == 1.0F ? 1 : number == 2.0F ? 2 : 0;
    coloring.hidden_lines[i] = false;
    coloring.lines[i] = swatches[which].color;
    seen[which] = true;
  }
  for (std::size_t k = 0; k < swatches.size(); ++k)
    if (seen[k]) coloring.legend.swatches.push_back(swatches[k]);
}

/// The points within the body with most of them: bars, and other bodies.
std::vector<bool> inside_of(const Frame& frame) {
  const FrameField* group = field_of(frame, Carrier::points, "group");
  const FrameField* bar = field_of(frame, Carrier::points, "bar");
  const std::size_t count = frame.position.size();
  std::vector<bool> inside(count, false);
  if (group != nullptr && group->values.size() == count) {
    std::vector<std::size_t> sizes;
    for (const float g : group->values) {
      const auto number = static_cast<std::size_t>(std::clamp(g, 0.0F, 1e6F));
      if (number >= sizes.size()) sizes.resize(number + 1, 0);
      ++sizes[number];
    }
    const auto main =
        static_cast<float>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    for (std::size_t i = 0; i < count; ++i) inside[i] = group->values[i] != main;
  }
  if (bar != nullptr && bar->values.size() == count)
    for (std::size_t i = 0; i < count; ++i)
      if (bar->values[i] > 0.0F) inside[i] = true;
  return inside;
}

}  // namespace

void size_lines(const std::vector<float>& values, Coloring& coloring) {
  constexpr float least = 0.05F;
  const ValueRange& range = coloring.legend.bar->range;
  const auto largest = static_cast<float>(std::max(std::fabs(range.low), std::fabs(range.high)));
  if (!(largest > 0.0F)) return;
  coloring.line_widths.resize(values.size());
  if (coloring.hidden_lines.empty()) coloring.hidden_lines.assign(values.size(), false);
  bool any = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float share = std::min(1.0F, std::fabs(values[i]) / largest);
    coloring.line_widths[i] = 0.4F + 1.6F * share;
    if (share >= least) continue;
    any |= !coloring.hidden_lines[i];
    coloring.hidden_lines[i] = true;
  }
  if (any) coloring.legend.notes.emplace_back("none below 5 %");
}

void show_cracks(const Frame& frame, Coloring& coloring) {
  const FrameField* mode = line_field(frame, "mode");
  const FrameField* damage = line_field(frame, "damage");
  const std::size_t count = coloring.lines.size();
  const bool spheres = frame.triangles.empty() && frame.tetrahedra.empty();
  if (spheres || mode == nullptr || damage == nullptr) return;
  const std::array swatches{Legend::Swatch{{0.10F, 0.10F, 0.12F}, "crack, opened"},
                            Legend::Swatch{{0.45F, 0.16F, 0.55F}, "crack, both"},
                            Legend::Swatch{{0.10F, 0.32F, 0.72F}, "crack, slid"},
                            Legend::Swatch{{0.45F, 0.30F, 0.14F}, "open from the start"}};
  std::array<bool, swatches.size()> seen{};
  coloring.cracks = true;
  coloring.hidden_lines.assign(count, true);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(damage->values[i] >= 1.0F)) continue;
    const std::size_t kind = mode->values[i] < 0.0F       ? 3
                             : mode->values[i] < 1.0F / 3 ? 0
                             : mode->values[i] < 2.0F / 3 ? 1
                                                          : 2;
    coloring.lines[i] = swatches[kind].color;
    coloring.hidden_lines[i] = false;
    seen[kind] = true;
  }
  for (std::size_t kind = 0; kind < swatches.size(); ++kind)
    if (seen[kind]) coloring.legend.swatches.push_back(swatches[kind]);
}

Coloring color_frame(const Frame& frame, const RenderOptions& options) {
  const bool of_spheres = !frame.radius.empty();
  Coloring coloring = color_frame(frame, options.field, options.range, options.map,
                                  options.show_links && of_spheres, options.log);
  if (options.forces && coloring.contacts.empty()) add_contacts(frame, coloring);
  if (coloring.cracks && (options.show_links || options.xray)) show_softened(frame, coloring);
  if (!options.xray) return coloring;
  for (Color& color : coloring.triangles) color = blend(color, ground_color, 0.8F);
  if (frame.radius.empty()) return coloring;
  if (!options.show_links && !coloring.of_lines) show_broken(frame, coloring);
  coloring.inside = inside_of(frame);
  return coloring;
}

}  // namespace breccia
