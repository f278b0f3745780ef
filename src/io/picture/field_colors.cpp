#include "io/picture/field_colors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "core/quantity.hpp"
#include "exec/error.hpp"
#include "io/frame_pair.hpp"
#include "io/picture/color_bar.hpp"
#include "io/picture/contact_colors.hpp"
#include "io/picture/line_colors.hpp"
#include "io/picture/stress_measures.hpp"

namespace breccia {
namespace {

constexpr Color pale{0.84F, 0.83F, 0.81F}, dark{0.32F, 0.33F, 0.35F};
constexpr std::size_t most_swatches = 9;

/// A field, or one component of it, that an option names.
struct Selected {
  Carrier carrier;
  const FrameField* field;
  int component;                                ///< -1: the length of a vector
  std::shared_ptr<const FrameField> made = {};  ///< holds a field that the frame lacks
};

const std::vector<FrameField>& fields_of(const Frame& frame, Carrier carrier) {
  if (carrier == Carrier::lines) return frame.line_fields;
  if (carrier == Carrier::tetrahedra) return frame.tetrahedron_fields;
  return carrier == Carrier::triangles ? frame.triangle_fields : frame.point_fields;
}

std::size_t items_of(const Frame& frame, Carrier carrier) {
  return static_cast<std::size_t>(places_in(frame).count(carrier));
}

const FrameField* field_named(const std::vector<FrameField>& fields, const std::string& name) {
  for (const FrameField& field : fields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

/// All carriers of fields, joints behind bodies.
constexpr std::array all_carriers{Carrier::points, Carrier::tetrahedra, Carrier::triangles,
                                  Carrier::lines};

/// @param lines_first  of two fields of a name that of lines counts
std::optional<Selected> find(const Frame& frame, const std::string& name,
                             bool lines_first = false) {
  std::array carriers = all_carriers;
  if (lines_first) std::rotate(carriers.begin(), carriers.end() - 1, carriers.end());
  for (const Carrier carrier : carriers) {
    if (const FrameField* field = field_named(fields_of(frame, carrier), name)) {
      return Selected{carrier, field, field->components == 1 ? 0 : -1};
    }
  }
  constexpr std::array parts{"_xx", "_yy", "_zz", "_xy", "_yz", "_xz"};
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (!name.ends_with(parts[part])) continue;
    for (const Carrier carrier : carriers)
      if (const FrameField* field =
              field_named(fields_of(frame, carrier), name.substr(0, name.size() - 3));
          field != nullptr && field->components == 6)
        return Selected{carrier, field, static_cast<int>(part)};
  }
  if (const auto made = stress_measure(frame, name)) {
    const auto held = std::make_shared<const FrameField>(*made);
    return Selected{Stresses(frame).carrier(), held.get(), 0, held};
  }
  if (name.size() < 3 || name[name.size() - 2] != '_') return std::nullopt;
  const int component = name.back() - 'x';
  const std::string vector_name = name.substr(0, name.size() - 2);
  for (const Carrier carrier : carriers) {
    const FrameField* field = field_named(fields_of(frame, carrier), vector_name);
    if (field != nullptr && component >= 0 && component < 3 && field->components == 3) {
      return Selected{carrier, field, component};
    }
  }
  return std::nullopt;
}

std::string names_of_fields(const Frame& frame) {
  std::string names;
  std::set<std::string> told;
  for (const Carrier carrier : all_carriers) {
    for (const FrameField& field : fields_of(frame, carrier)) {
      if (told.insert(field.name).second) names += (names.empty() ? "" : ", ") + field.name;
    }
  }
  return names.empty() ? "none" : names;
}

std::vector<float> scalar_values(const Frame& frame, const Selected& selected) {
  const FrameField& field = *selected.field;
  const std::size_t count = items_of(frame, selected.carrier);
  const auto width = static_cast<std::size_t>(field.components);
  if (field.values.size() != width * count) {
    throw InputError(fmt::format("field {} has {} values; {} items with {} components need {}",
                                 field.name, field.values.size(), count, width, width * count));
  }
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (selected.component >= 0) {
      values[i] = field.values[width * i + static_cast<std::size_t>(selected.component)];
      continue;
    }
    float square = 0.0F;
    for (std::size_t c = 0; c < width; ++c) {
      square += field.values[width * i + c] * field.values[width * i + c];
    }
    values[i] = std::sqrt(square);
  }
  return values;
}

/// Group of every item, 0 where the frame does not say.
std::vector<std::size_t> groups_of(const Frame& frame, Carrier carrier) {
  std::vector<std::size_t> groups(items_of(frame, carrier), 0);
  const FrameField* field = field_named(fields_of(frame, carrier), "group");
  if (field == nullptr || field->components != 1 || field->values.size() != groups.size()) {
    return groups;
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const float value = field->values[i];
    if (value >= 0.0F && value < 1e6F) groups[i] = static_cast<std::size_t>(value);
  }
  return groups;
}

std::string group_name(const Frame& frame, std::size_t group) {
  return group < frame.groups.size() ? frame.groups[group] : fmt::format("group {}", group);
}

/// The body with most elements has the colour of concrete; the others follow in their order.
struct GroupTints {
  std::vector<Color> tint;  ///< by group
  std::size_t main = 0;
  std::vector<Legend::Swatch> others;  ///< of the groups besides the main one
};
GroupTints group_tints(const Frame& frame, const std::vector<std::size_t>& groups) {
  std::vector<std::size_t> sizes;
  for (const std::size_t group : groups) {
    if (group >= sizes.size()) sizes.resize(group + 1, 0);
    ++sizes[group];
  }
  GroupTints tints;
  tints.tint.resize(sizes.size());
  if (sizes.empty()) return tints;
  tints.main =
      static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  tints.tint[tints.main] = map_color(ColorMap::damage, 0.0F);
  std::size_t number = 1;
  for (std::size_t group = 0; group < sizes.size(); ++group) {
    if (group == tints.main || sizes[group] == 0) continue;
    tints.tint[group] = category_color(number++);
    if (tints.others.size() < most_swatches) {
      tints.others.push_back({tints.tint[group], group_name(frame, group)});
    }
  }
  return tints;
}

/// The name of a category in a legend: groups have names, and so have kinds and states of links.
std::string category_name(const Frame& frame, const Selected& selected, double value) {
  constexpr std::array kinds{"concrete", "steel", "interface"};
  constexpr std::array states{"whole", "softened", "broken"};
  const auto number = static_cast<std::size_t>(std::clamp(value, 0.0, 1e6));
  const bool known = value == static_cast<double>(number);
  const std::string& name = selected.field->name;
  if (known && name == "group") return group_name(frame, number);
  if (known && number < 3 && selected.carrier == Carrier::lines) {
    if (name == "kind") return kinds[number];
    if (name == "state") return states[number];
  }
  return fmt::format("{:g}", value);
}

/// One colour a distinct value, in the order of the values.
std::vector<Color> category_colors(const Frame& frame, const Selected& selected,
                                   const std::vector<float>& values, Legend& legend) {
  std::map<float, std::size_t> numbers;
  for (const float value : values) {
    if (value == value) numbers.emplace(value, 0);
  }
  const bool states = selected.field->name == "state" && selected.carrier == Carrier::lines;
  constexpr std::array of_states{Color{0.70F, 0.71F, 0.73F}, Color{0.93F, 0.60F, 0.18F},
                                 Color{0.80F, 0.12F, 0.10F}};
  const auto color_of = [&](std::size_t place, float value) {
    const bool known = states && (value == 0.0F || value == 1.0F || value == 2.0F);
    return known ? of_states[static_cast<std::size_t>(value)] : category_color(place);
  };
  std::size_t number = 0;
  legend.title = selected.field->name;
  for (auto& [value, place] : numbers) {
    place = number++;
    if (place == most_swatches) legend.swatches.push_back({{1.0F, 1.0F, 1.0F}, "..."});
    if (place >= most_swatches) continue;
    legend.swatches.push_back(
        {color_of(place, value), category_name(frame, selected, static_cast<double>(value))});
  }
  std::vector<Color> colors(values.size(), Color{1.0F, 0.0F, 1.0F});
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] == values[i]) colors[i] = color_of(numbers.at(values[i]), values[i]);
  }
  return colors;
}

/// Reinforcement keeps its own colour, and shows through the concrete of the main body: a little
/// where that is whole, most of it where it is damaged. Of the spheres' own field, which parts of a
/// frame on ranks have, too.
void show_bars(const Frame& frame, const std::vector<std::size_t>& groups, const GroupTints& tints,
               const std::vector<float>& damage, Coloring& coloring) {
  constexpr float through_whole = 0.25F, through_damaged = 0.75F;
  const FrameField* field = field_named(frame.point_fields, "bar");
  if (field == nullptr || field->values.size() != damage.size()) return;
  coloring.bars.resize(damage.size());
  coloring.veil.resize(damage.size(), 0.0F);
  for (std::size_t i = 0; i < damage.size(); ++i) {
    coloring.bars[i] = field->values[i] > 0.0F;
    if (coloring.bars[i])
      coloring.points[i] = tints.tint[groups[i]];
    else if (groups[i] == tints.main)
      coloring.veil[i] = through_whole + (through_damaged - through_whole) *
                                             std::clamp(2.0F * damage[i], 0.0F, 1.0F);
  }
}

/// Damage tints every body from its own colour: only the main one starts as light concrete.
void tint_bodies(const Frame& frame, const std::vector<float>& damage, Coloring& coloring) {
  const std::vector<std::size_t> groups = groups_of(frame, Carrier::points);
  const GroupTints tints = group_tints(frame, groups);
  for (std::size_t i = 0; i < damage.size(); ++i) {
    if (groups[i] == tints.main) continue;
    const float share = std::clamp(4.0F * damage[i], 0.0F, 1.0F);
    coloring.points[i] = blend(tints.tint[groups[i]], coloring.points[i], share);
  }
  coloring.legend.swatches = tints.others;
  show_bars(frame, groups, tints, damage, coloring);
}

/// Bodies of tetrahedra by group; a single one is pale.
void fill_solids(const Frame& frame, Coloring& coloring) {
  coloring.tetrahedra.assign(items_of(frame, Carrier::tetrahedra), pale);
  if (frame.tetrahedra.empty()) return;
  const std::vector<std::size_t> groups = groups_of(frame, Carrier::tetrahedra);
  const GroupTints tints = group_tints(frame, groups);
  if (tints.others.empty()) return;
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (groups[i] != tints.main) coloring.tetrahedra[i] = tints.tint[groups[i]];
  coloring.legend.swatches.push_back({pale, group_name(frame, tints.main)});
  coloring.legend.swatches.insert(coloring.legend.swatches.end(), tints.others.begin(),
                                  tints.others.end());
}

/// Tetrahedra beside spheres: each as its first corner.
void color_as_corners(const Frame& frame, Coloring& coloring) {
  for (std::size_t i = 0; i < coloring.tetrahedra.size(); ++i)
    coloring.tetrahedra[i] = coloring.points[static_cast<std::size_t>(frame.tetrahedra[4 * i])];
}

/// Colours for what the field does not colour: bodies by group, lines by kind, triangles pale.
void fill_default_colors(const Frame& frame, Coloring& coloring) {
  if (frame.tetrahedra.empty())
    coloring.triangles.assign(items_of(frame, Carrier::triangles), pale);
  coloring.lines.assign(items_of(frame, joints_of(frame)), dark);
  fill_solids(frame, coloring);
  const FrameField* kind = field_named(frame.line_fields, "kind");
  if (kind != nullptr && kind->values.size() == coloring.lines.size()) {
    for (std::size_t i = 0; i < coloring.lines.size(); ++i) {
      const bool first_kind = !(kind->values[i] > 0.0F && kind->values[i] < 1e6F);
      if (!first_kind) {
        coloring.lines[i] = category_color(static_cast<std::size_t>(kind->values[i]));
      }
    }
  }
  const FrameField* state = field_named(frame.line_fields, "state");
  if (state != nullptr && state->values.size() == coloring.lines.size()) {
    for (const float value : state->values) coloring.hidden_lines.push_back(value == 2.0F);
  }
  const std::vector<std::size_t> groups = groups_of(frame, Carrier::points);
  const GroupTints tints = group_tints(frame, groups);
  coloring.points.resize(groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) coloring.points[i] = tints.tint[groups[i]];
  if (is_paired(frame)) color_as_corners(frame, coloring);
  if (tints.others.empty()) return;
  coloring.legend.swatches = tints.others;
  const Legend::Swatch main{tints.tint[tints.main], group_name(frame, tints.main)};
  coloring.legend.swatches.insert(coloring.legend.swatches.begin(), main);
}

/// Bodies take the mean of their corners. @param per_item  corners
std::vector<Color> colors_by_means(const std::vector<std::int32_t>& corners, std::size_t per_item,
                                   const std::vector<float>& values, const Legend::Bar& bar) {
  std::vector<float> means(corners.size() / per_item);
  for (std::size_t i = 0; i < means.size(); ++i) {
    float sum = 0.0F;
    for (std::size_t k = 0; k < per_item; ++k) {
      const std::int32_t node = corners[per_item * i + k];
      const bool known = node >= 0 && static_cast<std::size_t>(node) < values.size();
      sum += known ? values[static_cast<std::size_t>(node)] : 0.0F;
    }
    means[i] = sum / static_cast<float>(per_item);
  }
  return mapped_colors(bar, means);
}

/// Of the points' own field.
void color_by_points(const Frame& frame, const std::vector<float>& values,
                     std::vector<Color> colors, Coloring& coloring) {
  coloring.points = std::move(colors);
  if (!coloring.legend.bar) return;
  const Legend::Bar& bar = *coloring.legend.bar;
  if (frame.tetrahedra.empty())
    coloring.triangles = colors_by_means(frame.triangles, 3, values, bar);
  else
    coloring.tetrahedra = colors_by_means(frame.tetrahedra, 4, values, bar);
  if (bar.map == ColorMap::damage) tint_bodies(frame, values, coloring);
  if (is_paired(frame)) color_as_corners(frame, coloring);
}

}  // namespace

Carrier joints_of(const Frame& frame) {
  return frame.tetrahedra.empty() ? Carrier::lines : Carrier::triangles;
}

const FrameField* field_of(const Frame& frame, Carrier carrier, const std::string& name) {
  return field_named(fields_of(frame, carrier), name);
}

bool has_field(const Frame& frame, const std::string& field) {
  return field.empty() || is_of_contacts(frame, field) || find(frame, field).has_value();
}

bool is_of_contacts(const Frame& frame, const std::string& field) {
  if (field == contact_field) return true;
  if (field != "force") return false;
  const std::optional<Selected> selected = find(frame, field);
  return !selected || (selected->carrier == Carrier::lines && frame.lines.empty());
}

bool may_show_contacts(const RenderOptions& options) {
  return options.forces || options.field == contact_field || options.field == "force";
}

bool shows_contacts(const Frame& frame, const RenderOptions& options) {
  return options.forces || is_of_contacts(frame, options.field);
}

bool has_cracks(const Frame& frame) {
  const std::vector<FrameField>& fields = fields_of(frame, joints_of(frame));
  return field_named(fields, "mode") != nullptr && field_named(fields, "damage") != nullptr;
}

bool colors_lines(const Frame& frame, const std::string& field) {
  const std::optional<Selected> selected = find(frame, field);
  return selected && selected->carrier == joints_of(frame);
}

Coloring color_frame(const Frame& frame, const std::string& field,
                     const std::optional<ValueRange>& range, const std::string& map,
                     bool lines_first, bool log) {
  Coloring coloring;
  fill_default_colors(frame, coloring);
  if (field.empty()) {
    show_cracks(frame, coloring);
    return coloring;
  }
  if (is_of_contacts(frame, field)) {
    color_by_contacts(frame, range, map, log, coloring);
    return coloring;
  }
  const std::optional<Selected> selected = find(frame, field, lines_first);
  if (!selected) {
    throw InputError(fmt::format(
        "there is no field \"{}\" in this frame; it has {}{}", field, names_of_fields(frame),
        is_stress_measure(field) ? "; output.more = [\"stress\"] in the case adds stresses" : ""));
  }
  coloring.legend = {};
  coloring.of_lines = selected->carrier == joints_of(frame);
  std::vector<float> values = scalar_values(frame, *selected);
  std::vector<Color> colors;
  if (is_name_of_things(field)) {
    colors = category_colors(frame, *selected, values, coloring.legend);
  } else {
    const Spread spread = spread_of(values);
    coloring.legend.bar = bar_of(field, selected->field->unit, spread, range);
    const bool bodies = !coloring.of_lines && selected->carrier != Carrier::points;
    if (coloring.legend.bar->map == ColorMap::damage && bodies)
      coloring.legend.bar->map = ColorMap::ground;
    if (!map.empty()) coloring.legend.bar->map = map_named(map);
    if (log) {
      colors = log_colors(coloring.legend, field, selected->field->unit, values, range, map);
    } else {
      finish_legend(coloring.legend, field, selected->field->unit, spread.whole);
      colors = mapped_colors(*coloring.legend.bar, values);
    }
  }
  if (coloring.of_lines) {
    coloring.lines = std::move(colors);
    if (coloring.legend.bar && !log && !frame.radius.empty()) size_lines(values, coloring);
    if (field == "state") coloring.hidden_lines.clear();
    std::fill(coloring.points.begin(), coloring.points.end(), pale);
    std::fill(coloring.tetrahedra.begin(), coloring.tetrahedra.end(), pale);
    return coloring;
  }
  if (selected->carrier == Carrier::points)
    color_by_points(frame, values, std::move(colors), coloring);
  else
    (selected->carrier == Carrier::tetrahedra ? coloring.tetrahedra : coloring.triangles) =
        std::move(colors);
  show_cracks(frame, coloring);
  return coloring;
}

}  // namespace breccia
