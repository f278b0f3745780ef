#include "io/frame_pair.hpp"

#include <algorithm>

namespace breccia {
namespace {

std::size_t numbers(const FrameField& field, std::size_t items) {
  return items * static_cast<std::size_t>(field.components);
}
void append(FrameField& to, const FrameField& from) {
  to.values.insert(to.values.end(), from.values.begin(), from.values.end());
  if (!to.integers) return;
  if (from.integers)
    to.integers->insert(to.integers->end(), from.integers->begin(), from.integers->end());
  else
    to.integers->resize(to.values.size(), 0);
}

/// Values of corners by a field of tetrahedra: each belongs to one.
bool append_of_tetrahedra(FrameField& to, const Frame& solids) {
  for (const FrameField& of : solids.tetrahedron_fields) {
    if (of.name != to.name || of.components != 1 || to.components != 1) continue;
    const std::size_t first = to.values.size();
    to.values.resize(first + solids.position.size(), 0.0F);
    if (to.integers) to.integers->resize(to.values.size(), 0);
    for (std::size_t c = 0; c < solids.tetrahedra.size(); ++c) {
      const std::size_t point = first + static_cast<std::size_t>(solids.tetrahedra[c]);
      to.values[point] = of.values[c / 4];
      if (to.integers && of.integers) (*to.integers)[point] = (*of.integers)[c / 4];
    }
    return true;
  }
  return false;
}

/// Fields of both kinds of points; zero for those that a field is not of.
std::vector<FrameField> point_fields(const Frame& a, const Frame& b) {
  std::vector<FrameField> all = a.point_fields;
  std::vector<bool> taken(b.point_fields.size(), false);
  for (FrameField& field : all) {
    bool found = false;
    for (std::size_t k = 0; k < taken.size() && !found; ++k) {
      const FrameField& other = b.point_fields[k];
      found = other.name == field.name && other.components == field.components;
      if (!found) continue;
      append(field, other);
      taken[k] = true;
    }
    if (found || append_of_tetrahedra(field, b)) continue;
    field.values.resize(numbers(field, a.position.size() + b.position.size()), 0.0F);
    if (field.integers) field.integers->resize(field.values.size(), 0);
  }
  for (std::size_t k = 0; k < taken.size(); ++k) {
    if (taken[k]) continue;
    const FrameField& from = b.point_fields[k];
    FrameField field{from.name, from.unit, from.components, {}};
    field.values.resize(numbers(from, a.position.size()), 0.0F);
    append(field, from);
    all.push_back(std::move(field));
  }
  return all;
}

}  // namespace

void join_contacts(Frame& all, const Frame& solids) {
  const std::int32_t first = first_solid(all);
  for (FrameContact contact : solids.contacts) {
    contact.a += first;
    if (contact.b >= 0) contact.b += first;
    all.contacts.push_back(contact);
  }
}

std::int32_t first_solid(const Frame& frame) {
  return frame.tetrahedra.empty()
             ? 0
             : *std::min_element(frame.tetrahedra.begin(), frame.tetrahedra.end());
}

Frame paired(const Frame& spheres, const Frame& of_solids) {
  Frame all = spheres, solids = of_solids;
  const auto groups = static_cast<std::int32_t>(spheres.groups.size());
  for (FrameField& field : solids.tetrahedron_fields) {
    if (field.name != "group") continue;
    for (float& value : field.values) value += static_cast<float>(groups);
    if (field.integers)
      for (std::int32_t& value : *field.integers) value += groups;
  }
  all.position.insert(all.position.end(), solids.position.begin(), solids.position.end());
  all.radius.resize(all.position.size(), 0.0);
  all.point_fields = point_fields(spheres, solids);
  const auto first = static_cast<std::int32_t>(spheres.position.size());
  const auto shifted = [first](std::vector<std::int32_t> points) {
    for (std::int32_t& point : points) point += first;
    return points;
  };
  all.triangles = shifted(solids.triangles);
  all.triangle_fields = solids.triangle_fields;
  all.tetrahedra = shifted(solids.tetrahedra);
  all.tetrahedron_fields = solids.tetrahedron_fields;
  all.groups.insert(all.groups.end(), solids.groups.begin(), solids.groups.end());
  all.walls.insert(all.walls.end(), solids.walls.begin(), solids.walls.end());
  join_contacts(all, solids);
  all.bolted = all.bolted || solids.bolted;
  all.bars.insert(all.bars.end(), solids.bars.begin(), solids.bars.end());
  return all;
}

}  // namespace breccia
