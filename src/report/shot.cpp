#include "report/shot.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "io/vtu/vtu_reader.hpp"

namespace breccia::report {
namespace {

/// A field of elements from one of points: means over the corners.
FrameField of_elements(const FrameField& field, const std::vector<std::int32_t>& corners,
                       std::size_t each) {
  FrameField made{field.name, field.unit, field.components, {}};
  const auto width = static_cast<std::size_t>(field.components);
  made.values.resize(corners.size() / each * width);
  for (std::size_t e = 0; e < corners.size() / each; ++e)
    for (std::size_t c = 0; c < width; ++c) {
      float sum = 0.0F;
      for (std::size_t k = 0; k < each; ++k)
        sum += field.values[width * at(corners[each * e + k]) + c];
      made.values[width * e + c] = sum / static_cast<float>(each);
    }
  return made;
}

/// Puts elements, and what names them, into the order of their ids.
void sort_by_id(Shot& shot) {
  const FrameField* const id = field_named(shot.element_fields, "id");
  if (id == nullptr || !shot.spheres()) return;
  std::vector<std::size_t> order(shot.elements());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto earlier = [&](std::size_t a, std::size_t b) {
    return id->integers ? (*id->integers)[a] < (*id->integers)[b] : id->values[a] < id->values[b];
  };
  if (std::is_sorted(order.begin(), order.end(), earlier)) return;
  std::stable_sort(order.begin(), order.end(), earlier);
  const Shot old = shot;
  std::vector<std::int32_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::int32_t>(i);
    shot.corner[i] = old.corner[order[i]];
    shot.radius[i] = old.radius[order[i]];
  }
  for (std::size_t f = 0; f < shot.element_fields.size(); ++f) {
    FrameField& field = shot.element_fields[f];
    const auto width = static_cast<std::size_t>(field.components);
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t c = 0; c < width; ++c)
        field.values[width * i + c] = old.element_fields[f].values[width * order[i] + c];
  }
  for (std::int32_t& end : shot.ends) end = place[at(end)];
}

/// Which element of the first shot each of a later one is: bodies are taken out as a whole, and
/// what is left keeps its order. Empty: it cannot be told.
std::vector<std::size_t> places_in_first(const Shot& shot, const Shot& first) {
  const FrameField* const now = field_named(shot.element_fields, "group");
  const FrameField* const then = field_named(first.element_fields, "group");
  if (now == nullptr || then == nullptr) return {};
  const std::set<float> left(now->values.begin(), now->values.end());
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < first.elements(); ++i)
    if (left.contains(then->values[i])) places.push_back(i);
  if (places.size() != shot.elements()) return {};
  for (std::size_t k = 0; k < places.size(); ++k)
    if (then->values[places[k]] != now->values[k]) return {};
  return places;
}

Shot of_spheres(Frame&& frame) {
  Shot shot;
  shot.corner = std::move(frame.position);
  shot.radius = std::move(frame.radius);
  shot.radius.resize(shot.corner.size(), 0.0);
  shot.element_fields = std::move(frame.point_fields);
  shot.ends = std::move(frame.lines);
  return shot;
}

/// Of triangles, or of tetrahedra.
Shot of_bodies(Frame&& frame) {
  Shot shot;
  shot.solid = !frame.tetrahedra.empty();
  shot.plane = !shot.solid;
  const std::vector<std::int32_t>& corners = shot.solid ? frame.tetrahedra : frame.triangles;
  for (const std::int32_t node : corners) shot.corner.push_back(frame.position[at(node)]);
  for (const std::int32_t node : shot.solid ? frame.triangles : frame.lines)
    shot.end.push_back(frame.position[at(node)]);
  shot.element_fields = std::move(shot.solid ? frame.tetrahedron_fields : frame.triangle_fields);
  for (const FrameField& field : frame.point_fields)
    if (field_named(shot.element_fields, field.name) == nullptr)
      shot.element_fields.push_back(of_elements(field, corners, shot.corners_of_element()));
  return shot;
}

}  // namespace

Vec3 Shot::middle(std::size_t line) const {
  if (solid) return (1.0 / 3.0) * (end[3 * line] + end[3 * line + 1] + end[3 * line + 2]);
  if (plane) return 0.5 * (end[2 * line] + end[2 * line + 1]);
  return 0.5 * (corner[at(ends[2 * line])] + corner[at(ends[2 * line + 1])]);
}

const FrameField* field_named(const std::vector<FrameField>& fields, const std::string& name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const FrameField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

Shot read_shot(const std::string& folder, int number) {
  Frame frame = read_frame(folder, number);
  add_contacts_of(folder, number, frame);
  std::vector<FrameContact> contacts = std::move(frame.contacts);
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const FrameContact& a, const FrameContact& b) {
                     return dot(a.force, a.force) > dot(b.force, b.force);
                   });
  const std::int64_t step = frame.step;
  const double time = frame.time;
  std::vector<std::string> groups = std::move(frame.groups);
  std::vector<FrameBar> bolts = std::move(frame.bars);
  const bool solid = !frame.tetrahedra.empty();
  std::vector<FrameField> line_fields =
      std::move(solid ? frame.triangle_fields : frame.line_fields);
  Shot shot = solid || !frame.triangles.empty() ? of_bodies(std::move(frame))
                                                : of_spheres(std::move(frame));
  shot.step = step;
  shot.time = time;
  shot.groups = std::move(groups);
  shot.contacts = std::move(contacts);
  shot.bolts = std::move(bolts);
  shot.line_fields = std::move(line_fields);
  sort_by_id(shot);
  return shot;
}

bool match(Shot& shot, const Shot& first) {
  const bool alike = shot.plane == first.plane && shot.solid == first.solid;
  if (shot.elements() == first.elements() && alike) return true;
  if (!alike || shot.elements() == 0) return false;
  const std::vector<std::size_t> places = places_in_first(shot, first);
  if (places.empty()) return false;
  const std::size_t host =
      !shot.spheres()
          ? 0
          : static_cast<std::size_t>(std::max_element(shot.radius.begin(), shot.radius.end()) -
                                     shot.radius.begin());
  std::vector<std::size_t> from(first.elements(), host);
  std::vector<bool> gone(first.elements(), true);
  for (std::size_t k = 0; k < places.size(); ++k) {
    from[places[k]] = k;
    gone[places[k]] = false;
  }
  const Shot old = shot;
  const std::size_t each = shot.corners_of_element();
  shot.corner.clear();
  shot.radius.clear();
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (std::size_t c = 0; c < each; ++c)
      shot.corner.push_back(old.corner[each * from[i] + (gone[i] ? 0 : c)]);
    if (shot.spheres()) shot.radius.push_back(gone[i] ? 0.0 : old.radius[from[i]]);
  }
  for (std::size_t f = 0; f < shot.element_fields.size(); ++f) {
    FrameField& field = shot.element_fields[f];
    const auto width = static_cast<std::size_t>(field.components);
    field.values.clear();
    field.integers.reset();
    for (const std::size_t i : from)
      for (std::size_t c = 0; c < width; ++c)
        field.values.push_back(old.element_fields[f].values[width * i + c]);
  }
  for (std::int32_t& end : shot.ends) end = static_cast<std::int32_t>(places[at(end)]);
  return true;
}

std::vector<std::uint8_t> broken_lines(const Shot& shot) {
  std::vector<std::uint8_t> broken(shot.lines(), 0);
  const FrameField* const state = field_named(shot.line_fields, "state");
  const FrameField* const damage = field_named(shot.line_fields, "damage");
  const FrameField* const mode = field_named(shot.line_fields, "mode");
  for (std::size_t l = 0; l < broken.size(); ++l) {
    if (mode != nullptr && mode->values[l] < 0.0F) continue;  // open from the start
    broken[l] = (state != nullptr && state->values[l] >= 2.0F) ||
                (state == nullptr && damage != nullptr && damage->values[l] >= 1.0F);
  }
  return broken;
}

}  // namespace breccia::report
