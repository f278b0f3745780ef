#include "io/picture/hidden.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_set>

#include "exec/error.hpp"
#include "io/frame_pair.hpp"

namespace breccia {
namespace {

/// Whether each item is drawn, by its field "group".
std::vector<bool> shown_items(const std::vector<FrameField>& fields, std::size_t count,
                              const std::vector<bool>& hidden_group) {
  std::vector<bool> shown(count, true);
  for (const FrameField& field : fields) {
    if (field.name != "group" || field.components != 1 || field.values.size() != count) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const float group = field.values[i];
      const bool known = group >= 0.0F && group < static_cast<float>(hidden_group.size());
      shown[i] = !(known && hidden_group[static_cast<std::size_t>(group)]);
    }
  }
  return shown;
}

void keep(std::vector<FrameField>& fields, const std::vector<bool>& kept) {
  for (FrameField& field : fields) {
    const auto width = static_cast<std::size_t>(field.components);
    std::size_t to = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
      for (std::size_t c = 0; kept[i] && c < width; ++c)
        field.values[to++] = field.values[width * i + c];
    field.values.resize(to);
  }
}

/// Keeps the items all of whose ends are kept; ends become their new numbers.
void keep_ends(std::vector<std::int32_t>& ends, std::size_t per_item, std::vector<bool> kept,
               std::vector<FrameField>& fields, const std::vector<std::int32_t>& place) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t k = 0; k < per_item; ++k)
      kept[i] = kept[i] && place[static_cast<std::size_t>(ends[per_item * i + k])] >= 0;
    for (std::size_t k = 0; kept[i] && k < per_item; ++k)
      ends[to++] = place[static_cast<std::size_t>(ends[per_item * i + k])];
  }
  ends.resize(to);
  keep(fields, kept);
}

/// Leaves out contacts of elements whose group is hidden, by ids.
void keep_contacts(Frame& part, const Frame& whole, const std::vector<bool>& hidden_group) {
  std::unordered_set<std::int32_t> gone;
  const auto add = [&](const std::vector<FrameField>& fields, std::size_t count,
                       std::int32_t behind) {
    const std::vector<bool> shown = shown_items(fields, count, hidden_group);
    for (const FrameField& field : fields) {
      if (field.name != "id" || field.values.size() != count) continue;
      for (std::size_t i = 0; i < count; ++i)
        if (!shown[i])
          gone.insert(behind + (field.integers ? (*field.integers)[i]
                                               : static_cast<std::int32_t>(field.values[i])));
    }
  };
  if (!whole.tetrahedra.empty())
    add(whole.tetrahedron_fields, whole.tetrahedra.size() / 4,
        is_paired(whole) ? first_solid(whole) : 0);
  if (!whole.radius.empty()) add(whole.point_fields, whole.position.size(), 0);
  if (whole.tetrahedra.empty() && !whole.triangles.empty())
    add(whole.triangle_fields, whole.triangles.size() / 3, 0);
  std::erase_if(part.contacts, [&](const FrameContact& contact) {
    return gone.contains(contact.a) || gone.contains(contact.b);
  });
}

}  // namespace

Frame without_groups(const Frame& frame, const std::set<std::string>& hidden) {
  std::vector<bool> hidden_group;
  for (const std::string& name : frame.groups) hidden_group.push_back(hidden.contains(name));
  for (const std::string& name : hidden)
    if (std::find(frame.groups.begin(), frame.groups.end(), name) == frame.groups.end())
      throw InputError(fmt::format("no group \"{}\" to hide; this run has {}", name,
                                   fmt::join(frame.groups, ", ")));
  Frame part = frame;
  const std::vector<bool> points =
      shown_items(frame.point_fields, frame.position.size(), hidden_group);
  std::vector<std::int32_t> place(points.size(), -1);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i]) continue;
    place[i] = next++;
    part.position[static_cast<std::size_t>(place[i])] = frame.position[i];
    if (!frame.radius.empty()) part.radius[static_cast<std::size_t>(place[i])] = frame.radius[i];
  }
  part.position.resize(static_cast<std::size_t>(next));
  if (!frame.radius.empty()) part.radius.resize(static_cast<std::size_t>(next));
  keep(part.point_fields, points);
  keep_ends(part.lines, 2, std::vector<bool>(frame.lines.size() / 2, true), part.line_fields,
            place);
  keep_ends(part.triangles, 3,
            shown_items(frame.triangle_fields, frame.triangles.size() / 3, hidden_group),
            part.triangle_fields, place);
  keep_ends(part.tetrahedra, 4,
            shown_items(frame.tetrahedron_fields, frame.tetrahedra.size() / 4, hidden_group),
            part.tetrahedron_fields, place);
  keep_contacts(part, frame, hidden_group);
  if (part.tetrahedra.size() != frame.tetrahedra.size())  // its neighbours are seen from within
    std::erase_if(part.tetrahedron_fields,
                  [](const FrameField& field) { return field.name == "exposed"; });
  return part;
}

}  // namespace breccia
